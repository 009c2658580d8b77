# SPDX-License-Identifier: MIT
# At every build: writes OUTPUT from INPUT with the version of the program, and leaves it alone where nothing has changed.
# cmake -D SOURCE=... -D VERSION=... -D INPUT=... -D OUTPUT=... -P version.cmake
#
# The version holds the last commit that changed what the program is made of, so that a commit to a page or a test makes
# no other program: 0.1.0+c8ef50d123. What is not committed is marked, and told apart by a digest of it:
# 0.1.0+c8ef50d123-dirty-1a2b3c4d. Sources that are not git's (an archive, even unpacked in another repository) have
# the plain version.
set(made_of CMakeLists.txt cmake root_sph soil_coupling scenarios/CMakeLists.txt scenarios/main.cpp)
set(ENV{GIT_OPTIONAL_LOCKS} 0)  # a build takes no lock that a commit under way needs

function(git result)
  execute_process(COMMAND git ${ARGN} WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE text RESULT_VARIABLE status
    ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT status EQUAL 0)
    set(text "")
  endif()
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

git(below rev-parse --show-prefix)
git(commit log -1 --format=%h --abbrev=10 -- ${made_of})
if(commit AND below STREQUAL "")
  string(APPEND VERSION "+${commit}")
  git(difference diff HEAD --no-ext-diff --no-color -- ${made_of})
  git(strangers ls-files --others --exclude-standard -- ${made_of})
  if(NOT "${difference}${strangers}" STREQUAL "")
    string(SHA256 digest "${difference}${strangers}")
    string(SUBSTRING ${digest} 0 8 digest)
    string(APPEND VERSION "-dirty-${digest}")
  endif()
endif()
configure_file(${INPUT} ${OUTPUT} @ONLY)
