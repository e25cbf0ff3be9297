# What several steps have in common. $jobs and $work come from .ci/run.

export warnings="-Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wcast-qual -Wcast-align -Wshadow -Wdouble-promotion -Wundef"

# The Debian packages that a fresh machine lacks, by compiler.
need_gcc() {
    need gcc gcc libc6-dev
    need g++ g++
}
need_clang() {
    need clang clang libclang-rt-dev libc6-dev
    need clang++ clang libstdc++-12-dev
}
need_cmake() {
    need cmake cmake
    need make make
}

# What git sees in the source tree beyond the last commit.
source_tree() {
    git -c safe.directory='*' status --porcelain
}

# cxx_of CC: the C++ compiler of the same family.
cxx_of() {
    case $1 in
    gcc*) echo "${1/gcc/g++}" ;;
    clang*) echo "${1/clang/clang++}" ;;
    esac
}

# parallel: runs the lines of the standard input as commands, one on each processor, and fails if any of them did.
parallel() {
    xargs -P "$jobs" -d '\n' -n 1 bash -euxc
}

# build_and_test NAME CC FLAGS [CMAKE-ARGUMENT...]: configures with warnings as errors and exactly these compiler flags, builds, and
# runs every test but those that are scripts, which depend on the compiler and nothing else.
build_and_test() {
    local dir=$work/$1 cc=$2 flags=$3
    shift 3
    cmake -S . -B "$dir" -DCMAKE_BUILD_TYPE=None -DCMAKE_COMPILE_WARNING_AS_ERROR=ON -DCMAKE_C_COMPILER="$cc" \
        -DCMAKE_CXX_COMPILER="$(cxx_of "$cc")" -DCMAKE_C_FLAGS="$flags" -DCMAKE_CXX_FLAGS="$flags" "$@"
    cmake --build "$dir" -j "$jobs"
    ctest --test-dir "$dir" -j "$jobs" --output-on-failure --no-tests=error -LE script
    rm -rf "$dir"
}
