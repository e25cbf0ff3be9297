#!/usr/bin/env bash
# targets_table.sh check|write: whether README's table of targets is the one that `.ci/run targets` made, or puts that one there.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
new=$(mktemp)
trap 'rm -f "$new"' EXIT
awk '
    /^<!-- end of what is made -->$/ { inside = 0 }
    !inside
    /^<!-- made by .ci\/steps\/70-targets.sh -->$/ {
        inside = 1
        while ((getline line < "build-ci/targets.md") > 0)
            print line
    }' README.md >"$new"
case $1 in
check) diff README.md "$new" ;;
write) cat "$new" >README.md ;;
esac
