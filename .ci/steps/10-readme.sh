# README's two commands, as a newcomer types them on a fresh clone.
need_cmake
need_gcc
need pkg-config pkg-config

fresh() {
    cmake -E rm -rf build
    "$@"
}

demo() {
    fresh cmake --workflow --preset demo
    test -s build/shlight.png
    test -x build/bin/shlight
}

check "cmake --workflow --preset test" fresh cmake --workflow --preset test
check "cmake --workflow --preset demo" demo
