#!/usr/bin/env bash
# Which lines of include/sh.h the tests execute, merged over the instruction sets that this machine runs: .ci/coverage.sh DIR
#
# Prints the percentage, then each line and each error that no test reaches; fails under 98 % of the lines, or where an error is not
# reached. A line counts if the compiler makes code of it for one of the instruction sets, whether a test calls its function or not.
# DIR/TEST.VARIANT.hits lists the lines that one program executes, DIR/TEST.VARIANT.seconds its time, for .ci/mutate.py.
set -eu
cd "$(dirname "${BASH_SOURCE[0]}")/.."
mkdir -p "$1"
dir=$(cd "$1" && pwd)
export dir
least=98

# The header as it is measured: each error number that an expression yields goes through its own line of errors.h, and no function is
# inlined by force, since the compiler would not keep it where nothing calls it.
awk -v errors="$dir/errors.h" '
    {
        sub(/ __attribute__\(\(always_inline\)\)/, "")
        rest = text = $0
        line = ""
        sub(/^ */, "", text)
        while (match(rest, /(return|[?:=]) SH_(ERROR|WARNING)_[A-Z]+/)) {
            before = RSTART + index(substr(rest, RSTART), " ")
            error = substr(rest, before, RSTART + RLENGTH - before)
            line = line substr(rest, 1, before - 1) "error_" ++count "(" error ")"
            rest = substr(rest, RSTART + RLENGTH)
            print "static int error_" count "(int error) { return error; } // line " NR ": " text >errors
        }
        print line rest
    }' include/sh.h >"$dir/sh.h"

# variant_flags VARIANT
variant_flags() {
    case $1 in
    scalar) echo -DSH_NO_SIMD ;;
    default) ;;
    avx2) echo -mavx2 -mfma ;;
    avx512) echo -mavx512f ;;
    esac
}
export -f variant_flags

# compile NAME VARIANT SOURCE FLAG...: NAME.o, which counts.
compile() {
    # shellcheck disable=SC2046 # a list of flags
    gcc -std=c99 -O0 -w --coverage "${@:4}" $(variant_flags "$2") -DSH_ENVS_DIR='"../shared/envs"' -I"$dir" -include "$dir/errors.h" \
        -c "$3" -o "$dir/$1.o"
}

# counts NAME FILE: `line count` for each line of FILE that NAME.o has code for.
counts() {
    gcov -t "$dir/$1.o" 2>/dev/null | awk -F: -v file="/$2" '
        $3 == "Source" { wanted = substr($4, length($4) - length(file) + 1) == file }
        wanted && $2 > 0 && $1 !~ /-/ { print $2 + 0, $1 ~ /#/ ? 0 : $1 + 0 }'
}

# measure TEST VARIANT
measure() {
    local TIMEFORMAT=%U
    compile "$1.$2" "$2" "tests/$1.c"
    gcc --coverage "$dir/$1.$2.o" -o "$dir/$1.$2" -lm
    { time "$dir/$1.$2" >"$dir/$1.$2.log"; } 2>"$dir/$1.$2.seconds"
    counts "$1.$2" sh.h >"$dir/$1.$2.hits"
    counts "$1.$2" errors.h >"$dir/$1.$2.errors"
    rm "$dir/$1.$2" "$dir/$1.$2".gc*
}
export -f compile counts measure

variants="scalar default"
for flag in avx2 avx512f; do
    grep -qw $flag /proc/cpuinfo && variants="$variants ${flag%f}"
done

# All lines that have code: a file that only includes the header, whose functions are kept.
echo '#include "sh.h"' >"$dir/all.c"
for variant in $variants; do
    compile "all.$variant" "$variant" "$dir/all.c" -fkeep-inline-functions
    counts "all.$variant" sh.h >"$dir/all.$variant.hits"
    counts "all.$variant" errors.h >"$dir/all.$variant.errors"
done

# Only batches, images, arrays of samples and lights go through the vector backends.
for test in tests/test_*.c; do
    name=$(basename "$test" .c)
    for variant in $variants; do
        if [ "$variant" = scalar ] || grep -qE '_batch|_samples|image|_directional|SH_SIMD' "$test"; then
            echo measure "$name" "$variant"
        fi
    done
done | xargs -P "${jobs:-2}" -d '\n' -n 1 bash -euc

# report FILE COUNTS...: the percentage of lines executed, then those that are not.
report() {
    cat "${@:2}" | awk -v source="$1" '
        { count[$1] += $2 }
        END {
            for (line in count) {
                total++
                hit += count[line] > 0
            }
            printf "%.2f %% of %d lines of %s\n", 100 * hit / total, total, source
            for (n = 1; (getline text <source) > 0; n++)
                if (n in count && count[n] == 0)
                    print "not executed: " n ": " text
        }'
}
report include/sh.h "$dir"/*.hits | tee "$dir/lines.txt"
report "$dir/errors.h" "$dir"/*.errors | tee "$dir/errors.txt"
awk -v least=$least 'FNR == 1 && $1 < (FILENAME ~ /errors/ ? 100 : least) { failed = 1 } END { exit failed }' "$dir/lines.txt" "$dir/errors.txt"
