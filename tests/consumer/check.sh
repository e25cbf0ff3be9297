#!/bin/sh
# check.sh KIND BUILD: builds and runs a small program that gets sh.h in the way KIND names, from this source tree or from its build
# tree BUILD, with the compiler CC.
set -eu

kind=$1
build=$2
here=$(cd "$(dirname "$0")" && pwd)
source=$(cd "$here/../.." && pwd)
prefix=$build/consumer/prefix
work=$build/consumer/$kind

rm -rf "$work"
mkdir -p "$work"

case $kind in
add_subdirectory | fetch_content | find_package)
    cmake -S "$here/$kind" -B "$work" -DCMAKE_BUILD_TYPE=Release -DSH_SOURCE_DIR="$source" -DCMAKE_PREFIX_PATH="$prefix"
    cmake --build "$work" --config Release
    "$(find "$work" -type f -name consumer -perm -u+x)"
    ;;
install)
    rm -rf "$prefix"
    cmake --install "$build" --config Release --prefix "$prefix"
    test -f "$prefix/include/sh.h"
    ;;
pkg_config)
    PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name sh.pc)")
    export PKG_CONFIG_PATH
    pkg-config --print-errors --exists 'sh >= 0.1'
    # The flags are words of a command line, as every user of pkg-config has them.
    # shellcheck disable=SC2046
    $CC "$here/main.c" $(pkg-config --cflags --libs sh) -o "$work/consumer"
    "$work/consumer"
    ;;
one_line)
    cd "$source"
    $CC -O2 -Iinclude examples/shlight.c -o "$work/shlight" -lm
    "$work/shlight" --quiet -o "$work/shlight.png"
    test -s "$work/shlight.png"
    ;;
*)
    echo "check.sh: unknown kind $kind" >&2
    exit 1
    ;;
esac
