# The builds leave no file in the source tree that git sees.
tree_is_clean() {
    local now
    now=$(source_tree)
    echo "$now"
    [ "$now" = "$tree_at_start" ]
}

if [ -d .git ]; then
    check "source tree is clean" tree_is_clean
fi
