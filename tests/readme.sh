#!/bin/sh
# readme.sh REPOSITORY: holds README.md to its word, with the compiler CC (cc). Its first C block compiles as C99 without warnings and
# prints what the block after it shows; every function and macro that it names exists; every file that it links to exists.
set -u

source=$(cd "${1:-$(dirname "$0")/..}" && pwd) || exit 1
readme=$source/README.md
cc=${CC:-cc}
work=$(mktemp -d "${TMPDIR:-/tmp}/readme.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
LC_ALL=C
export LC_ALL
passed=0
failed=0

check() { # check NAME COMMAND...
    name=$1
    shift
    if "$@" >"$work/log" 2>&1; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "FAILED: $name"
        sed 's/^/    /' "$work/log"
    fi
}

# block N LANGUAGE: the N-th fenced block of that language.
block() {
    awk -v wanted="$1" -v language="$2" '
        /^```/ { if (inside) inside = 0; else { inside = 1; mine = $0 == "```" language; count += mine }; next }
        inside && mine && count == wanted' "$readme"
}

block 1 c >"$work/example.c"
block 1 text >"$work/expected.txt"

compiles() {
    test -s "$work/example.c" && "$cc" -std=c99 -O2 -Wall -Wextra -Werror -I"$source/include" "$work/example.c" -o "$work/example" -lm
}

runs() {
    "$work/example" >"$work/printed.txt"
}

prints() {
    diff "$work/expected.txt" "$work/printed.txt"
}

named() { # named PATTERN FILE...: whether every name in README that matches the pattern is a word of a file
    pattern=$1
    shift
    missing=$(grep -oE "\\b$pattern\\b" "$readme" | sort -u | while read -r name; do
        grep -qwF -- "$name" "$@" || echo "$name"
    done)
    echo "$missing"
    test -z "$missing"
}

linked() {
    missing=$(grep -oE '(\]\(|src=")[^)":# ]+' "$readme" | sed -E 's/^(\]\(|src=")//' | sort -u | while read -r file; do
        test -e "$source/$file" || echo "$file"
    done)
    echo "$missing"
    test -z "$missing"
}

check "the example compiles" compiles
check "the example runs" runs
check "the example prints what README shows" prints
check "functions exist" named 'sh_[a-z0-9_]*[a-z0-9]' "$source/include/sh.h" "$source/bench/sh_bench.c"
check "macros exist" named 'SH_[A-Z0-9_]*[A-Z0-9]' "$source/include/sh.h" "$source/CMakeLists.txt"
check "linked files exist" linked
echo "$passed passed, $failed failed"
test "$failed" = 0
