#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Looks for what is wrong with the files that git tracks, and says which command mends it: tools/lint.sh [--quick]
# It changes nothing. Exit 1: something is wrong, or a tool is missing.
set -euo pipefail

quick=false
case "${1:-}" in
  -h | --help)
    echo "usage: tools/lint.sh [--quick]    check every file that git tracks; --quick: format and spelling only (seconds)"
    exit 0
    ;;
  --quick) quick=true ;;
  "") ;;
  *)
    echo "lint: unknown argument '$1' (allowed: --quick)" >&2
    exit 2
    ;;
esac

cd "$(dirname "${BASH_SOURCE[0]}")/.."

# tracked ARRAY PATTERN...: the tracked files that match and that are there, into ARRAY.
tracked() {
  local -n files=$1
  local file
  files=()
  while IFS= read -r -d '' file; do
    [[ ! -f "$file" ]] || files+=("$file")
  done < <(git ls-files -z -- "${@:2}")
}
cpp=() sources=() python=() checked_python=() shell=() texts=()
tracked cpp '*.cpp' '*.hpp'
tracked sources '*.cpp' ':!tests' # GoogleTest's macros are no C++ to cppcheck
tracked python '*.py'
tracked checked_python 'tools/*.py' 'soil_coupling/yade_side/*.py'
tracked shell '*.sh' '.ci/run'
tracked texts ':!*.png' ':!tests/fuzz/corpus'
if ((${#cpp[@]} == 0 || ${#python[@]} == 0)); then
  echo "lint: git tracks no C++ or no Python file here; run it in a checkout of the project" >&2
  exit 1
fi

wrong=()
# check NAME REMEDY TOOL ARGUMENTS...: runs the tool; what it prints is shown only if it fails, with the remedy.
check() {
  local name=$1 remedy=$2 said start=$SECONDS
  shift 2
  if ! command -v "$1" >/dev/null; then
    echo "lint: $name: $1 is not installed; install it with: tools/setup.sh --dev" >&2
    wrong+=("$name")
  elif said=$("$@" 2>&1); then
    echo "lint: $name: clean ($((SECONDS - start)) s)"
  else
    printf '%s\nlint: %s: wrong as said above. To mend it: %s\n' "$said" "$name" "$remedy" >&2
    wrong+=("$name")
  fi
}

# clang-tidy reads each folder of sources as one lump: Eigen, which takes most of the time, is read once a folder. Only
# the file that holds the version is made. The tests would take twice as long as all the rest: the compiler's warnings
# look at them.
# shellcheck disable=SC2317  # called through check
tidy() {
  { cmake -S . -B build/lint -G Ninja -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=0 -DROOTSOIL_UNITY=OFF \
    -DROOTSOIL_PRECOMPILED_HEADERS=OFF -DROOTSOIL_TESTS=OFF && cmake --build build/lint --target rootsoil_version; } \
    >build/lint.log 2>&1 || { cat build/lint.log; return 1; }
  sed -n 's/^ *"file": "\(.*\)",\{0,1\}$/\1/p' build/lint/compile_commands.json |
    xargs -d '\n' -P "$(nproc)" -n 1 clang-tidy --quiet -p build/lint
}

check "format of C++" "clang-format -i \$(git ls-files '*.cpp' '*.hpp')" clang-format --dry-run -Werror "${cpp[@]}"
check "format of Python" "black \$(git ls-files '*.py')" black --check --quiet --diff "${python[@]}"
check "spelling" "correct the word, or add it to .codespellrc if it is right" codespell "${texts[@]}"
if ! $quick; then
  mkdir -p build
  check "shell scripts" "each SC number is explained by its page on shellcheck's wiki" shellcheck "${shell[@]}"
  check "Python (flake8)" "change the lines said above; rules stand in .flake8" flake8 "${python[@]}"
  check "types of Python (mypy)" "annotate as said above; rules stand in pyproject.toml" mypy "${checked_python[@]}"
  check "C++ (cppcheck)" "change the lines said above; exceptions, each with its reason, stand in .cppcheck" \
    cppcheck --quiet -j "$(nproc)" --std=c++20 --language=c++ -I . --library=openmp \
    --enable=warning,style,performance,portability --inline-suppr --suppressions-list=.cppcheck --error-exitcode=1 \
    --template='{file}:{line}: {severity}: {message} [{id}]' "${sources[@]}"
  if command -v clang-tidy >/dev/null; then
    check "C++ (clang-tidy)" "change the lines said above; the choice of checks stands in .clang-tidy" tidy
  else
    check "C++ (clang-tidy)" "" clang-tidy
  fi
fi

if ((${#wrong[@]})); then
  printf -v list '%s, ' "${wrong[@]}"
  echo "lint: not clean: ${list%, }" >&2
  exit 1
fi
