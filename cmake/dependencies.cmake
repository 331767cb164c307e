# SPDX-License-Identifier: Apache-2.0
#
# Everything comes from the distribution; cmake/debian-packages.txt names the packages.
find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(tomlplusplus REQUIRED)
# The C interface alone.
set(MPI_CXX_SKIP_MPICXX ON)
find_package(MPI REQUIRED COMPONENTS C)
find_package(HDF5 REQUIRED COMPONENTS C)

# Used header-only (XXH_INLINE_ALL), so that hashing is inlined and no library is needed when running.
find_path(XXHASH_INCLUDE_DIR xxhash.h REQUIRED)
