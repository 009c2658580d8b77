# SPDX-License-Identifier: MIT
# Eigen is a third of the time that most files take to compile. Precompiled, it is read once. A compiler cache can't look
# through precompiled headers, and is worth more where there is one.
if(ROOTSOIL_PRECOMPILED_HEADERS AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(precompiled_source ${CMAKE_BINARY_DIR}/precompiled.cpp)
  file(CONFIGURE OUTPUT ${precompiled_source} CONTENT "// for the headers only\n")
  add_library(rootsoil_precompiled OBJECT ${precompiled_source})
  target_link_libraries(rootsoil_precompiled PRIVATE rootsoil_flags Eigen3::Eigen OpenMP::OpenMP_CXX)
  target_precompile_headers(rootsoil_precompiled PRIVATE <Eigen/Dense> <algorithm> <cmath> <filesystem> <functional>
    <map> <memory> <optional> <span> <string> <vector>)
endif()

# rootsoil_module(NAME SOURCES ... USES ...): one library per folder. A module
# sees only the modules it names in USES, so an arrow against the architecture
# fails to link; tests/architecture checks the includes as well.
function(rootsoil_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;USES;LIBRARIES" ${ARGN})
  set(target rootsoil_${name})
  if(ARG_SOURCES)
    add_library(${target} STATIC ${ARG_SOURCES})
    set(scope PUBLIC)
    if(TARGET rootsoil_precompiled)
      target_precompile_headers(${target} REUSE_FROM rootsoil_precompiled)
    endif()
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  target_link_libraries(${target} ${scope} rootsoil_flags Eigen3::Eigen ${ARG_LIBRARIES})
  foreach(used IN LISTS ARG_USES)
    target_link_libraries(${target} ${scope} rootsoil_${used})
  endforeach()
endfunction()
