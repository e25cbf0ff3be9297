# The example over MPI, which the other steps build and run only where CMake finds MPI.
need_cmake
need_gcc
need mpicc libopenmpi-dev openmpi-bin

bake_mpi() {
    cmake -S . -B "$work/mpi" -DCMAKE_COMPILE_WARNING_AS_ERROR=ON -DSH_BUILD_BENCH=OFF
    cmake --build "$work/mpi" --target bake_mpi
    ctest --test-dir "$work/mpi" --output-on-failure --no-tests=error -R bake_mpi
    rm -rf "$work/mpi"
}

check "bake over MPI" bake_mpi
