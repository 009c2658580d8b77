# SPDX-License-Identifier: MIT
# rootsoil_module(NAME SOURCES ... USES ...): one library per folder. A module
# sees only the modules it names in USES, so an arrow against the architecture
# fails to link; tests/architecture checks the includes as well.
function(rootsoil_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;USES;LIBRARIES" ${ARGN})
  set(target rootsoil_${name})
  if(ARG_SOURCES)
    add_library(${target} STATIC ${ARG_SOURCES})
    set(scope PUBLIC)
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  target_link_libraries(${target} ${scope} rootsoil_flags Eigen3::Eigen ${ARG_LIBRARIES})
  foreach(used IN LISTS ARG_USES)
    target_link_libraries(${target} ${scope} rootsoil_${used})
  endforeach()
endfunction()
