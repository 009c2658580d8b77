#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Sets up what is missing, then configures and builds the preset `release` into build/release.
# Prints nothing when everything is up to date.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build="$root/build/release"

"$root/tools/setup.sh"
cd "$root"
if [[ ! -f "$build/build.ninja" ]]; then
  cmake --preset release
fi
if ! ninja -C "$build" -n | grep 'no work to do' >/dev/null; then
  cmake --build --preset release --parallel "$(nproc)"
fi
