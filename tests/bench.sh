#!/bin/sh
# bench.sh SH_BENCH: what sh_bench says and leaves behind when something is wrong.
set -u

bench=$1
work=$(mktemp -d "${TMPDIR:-/tmp}/bench.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
passed=0
failed=0

# refused WORDS ARGUMENT...: exit status 2, one line with WORDS on stderr; old.svg stays as it was, and no other file appears.
refused() {
    words=$1
    shift
    echo old >old.svg
    status=0
    "$bench" "$@" >out.txt 2>err.txt || status=$?
    if [ "$status" = 2 ] && [ "$(wc -l <err.txt)" -eq 1 ] && grep -q "$words" err.txt && [ "$(cat old.svg)" = old ] &&
        [ "$(echo *)" = 'err.txt old.svg out.txt' ]; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "FAILED: $*: status $status"
        sed 's/^/    /' err.txt
    fi
}

refused 'unknown option' --fast
refused 'nothing follows' --filter
refused 'no case name contains' --filter nothing/like/this
refused 'No such file' --quick --filter eval/irradiance/L0 --json no/such/folder.json
refused 'No such file' --bounds no/such/folder.svg
refused 'cannot read panorama' --models old.svg --env missing.pfm
refused 'cannot read panorama' --models old.svg --env err.txt
echo "$passed passed, $failed failed"
test "$failed" = 0
