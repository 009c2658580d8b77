# SPDX-License-Identifier: MIT
# Every dependency is a Debian package (tools/setup.sh installs them).
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(OpenMP REQUIRED COMPONENTS CXX)
find_package(HDF5 REQUIRED COMPONENTS C)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(Threads REQUIRED)

# What every target of the project is compiled with.
add_library(rootsoil_flags INTERFACE)
target_include_directories(rootsoil_flags INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(rootsoil_flags INTERFACE -Wall -Wextra -Wshadow -Wno-psabi
  # GCC 12 warns about its own AVX-512 headers (GCC bug 105593); clang-tidy and cppcheck look for the fault itself.
  -Wno-maybe-uninitialized -Wno-uninitialized
  # errno and floating-point traps are never read; this keeps results
  # deterministic (unlike -ffast-math) and lets the compiler vectorise
  -fno-math-errno -fno-trapping-math
  # The compiler may keep several copies of a loop's body (first iteration, rest) and fuse other products in each: the last
  # bits of a cell would depend on where a thread's share begins
  -ffp-contract=off)
if(ROOTSOIL_WERROR)
  target_compile_options(rootsoil_flags INTERFACE -Werror)
endif()
if(ROOTSOIL_NATIVE)
  target_compile_options(rootsoil_flags INTERFACE -march=native)
endif()
if(ROOTSOIL_NAN_FILL)
  target_compile_definitions(rootsoil_flags INTERFACE EIGEN_INITIALIZE_MATRICES_BY_NAN)
endif()
if(ROOTSOIL_SANITIZE)
  target_compile_options(rootsoil_flags INTERFACE -fsanitize=${ROOTSOIL_SANITIZE}
    -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(rootsoil_flags INTERFACE -fsanitize=${ROOTSOIL_SANITIZE})
endif()
