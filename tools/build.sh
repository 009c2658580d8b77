#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Sets up what is missing, then configures and builds the preset `release` into build/release:
# tools/build.sh [--werror] [TARGET...]
# TARGET: what to build, e.g. rootsoil (default: everything, with the tests). --werror: warnings are errors from now on.
# Prints nothing when everything is up to date.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build="$root/build/release"

if [[ "${1:-}" == "-h" || "${1:-}" == "--help" ]]; then
  sed -n '3,6s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
  exit 0
fi

options=()
if [[ "${1:-}" == --werror ]]; then
  options=(-DROOTSOIL_WERROR=ON)
  shift
fi
targets=("$@")

if ((${#targets[@]})); then
  "$root/tools/setup.sh"
else
  "$root/tools/setup.sh" --test
fi
cd "$root"
# Also where the tests were left out because GoogleTest was missing, which the cache remembers.
if [[ ! -f "$build/build.ninja" ]] || ((${#options[@]})) ||
  { ((${#targets[@]} == 0)) && grep --quiet 'GTest_DIR-NOTFOUND' "$build/CMakeCache.txt"; }; then
  cmake --preset release "${options[@]}"
fi
if ! ninja -C "$build" -n "${targets[@]}" | grep 'no work to do' >/dev/null; then
  ninja -C "$build" -j "$(nproc)" "${targets[@]}"
fi
