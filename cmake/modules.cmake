# SPDX-License-Identifier: MIT
# How the first build stays short:
# - Eigen is a third of the time that most files take. Precompiled, it is read once.
# - The files of a module marked UNITY are compiled a few at a time, so that what they all instantiate is compiled once.
# - A module marked COLD holds no loop that runs at every step: -O1 compiles it in half the time. Results can't differ:
#   -ffp-contract=off, and the compiler reorders no sums at any level.
# A compiler cache can't look through precompiled headers and remembers single files, and is worth more where there is one.
set(ROOTSOIL_COLD_OPTIONS $<$<CONFIG:Release>:-O1>)
if(CMAKE_CXX_COMPILER_LAUNCHER)
  set(ROOTSOIL_PRECOMPILED_HEADERS OFF)
  set(ROOTSOIL_UNITY OFF)
endif()

# rootsoil_precompiled_headers(NAME HEADERS ... LIBRARIES ... [COLD]): a target for REUSE_FROM. The compiler refuses
# headers that were precompiled with another level of optimisation.
function(rootsoil_precompiled_headers name)
  cmake_parse_arguments(ARG "COLD" "" "HEADERS;LIBRARIES" ${ARGN})
  set(source ${CMAKE_BINARY_DIR}/precompiled.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "// for the headers only\n")
  add_library(${name} OBJECT EXCLUDE_FROM_ALL ${source})
  target_link_libraries(${name} PRIVATE rootsoil_flags Eigen3::Eigen OpenMP::OpenMP_CXX fmt::fmt ${ARG_LIBRARIES})
  target_precompile_headers(${name} PRIVATE <Eigen/Dense> <fmt/format.h> <fmt/ranges.h> ${ARG_HEADERS} <algorithm>
    <cmath> <filesystem> <functional> <map> <memory> <optional> <span> <string> <vector>)
  if(ARG_COLD)
    target_compile_options(${name} PRIVATE ${ROOTSOIL_COLD_OPTIONS})
  endif()
endfunction()

if(ROOTSOIL_PRECOMPILED_HEADERS)
  rootsoil_precompiled_headers(rootsoil_precompiled)
  rootsoil_precompiled_headers(rootsoil_precompiled_cold COLD
    HEADERS <nlohmann/json.hpp> LIBRARIES nlohmann_json::nlohmann_json)
endif()

# rootsoil_compile(TARGET [COLD] [UNITY n]): how a target of the project is compiled; UNITY: n files at a time.
function(rootsoil_compile target)
  cmake_parse_arguments(ARG "COLD" "UNITY" "" ${ARGN})
  set(precompiled rootsoil_precompiled)
  if(ARG_COLD)
    set(precompiled rootsoil_precompiled_cold)
    target_compile_options(${target} PRIVATE ${ROOTSOIL_COLD_OPTIONS})
  endif()
  if(TARGET ${precompiled})
    target_precompile_headers(${target} REUSE_FROM ${precompiled})
  endif()
  if(ROOTSOIL_UNITY AND ARG_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${ARG_UNITY})
    # GCC takes a file that another one includes for a header, and warns of anonymous namespaces in headers.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
endfunction()

# rootsoil_module(NAME SOURCES ... USES ... [LIBRARIES ...] [COLD] [UNITY n]): one library per folder. A module
# sees only the modules it names in USES, so an arrow against the architecture
# fails to link; tests/architecture checks the includes as well.
function(rootsoil_module name)
  cmake_parse_arguments(ARG "COLD" "UNITY" "SOURCES;USES;LIBRARIES" ${ARGN})
  set(target rootsoil_${name})
  if(ARG_SOURCES)
    add_library(${target} STATIC ${ARG_SOURCES})
    set(scope PUBLIC)
    set(how "")
    if(ARG_COLD)
      list(APPEND how COLD)
    endif()
    if(ARG_UNITY)
      list(APPEND how UNITY ${ARG_UNITY})
    endif()
    rootsoil_compile(${target} ${how})
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  target_link_libraries(${target} ${scope} rootsoil_flags Eigen3::Eigen ${ARG_LIBRARIES})
  foreach(used IN LISTS ARG_USES)
    target_link_libraries(${target} ${scope} rootsoil_${used})
  endforeach()
endfunction()
