#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs what rootsoil needs and this machine lacks, from Debian's own packages (Debian 12). tools/setup.sh [--soil]
# Says what and why. Does nothing, in a blink, when all is there.
set -euo pipefail

with_soil=false
case "${1:-}" in
  -h | --help)
    echo "usage: tools/setup.sh [--soil]    install the Debian packages that rootsoil needs and that are missing"
    echo "  --soil  also what only scenes with [soil], the penetrometer and their tests need: YADE"
    exit 0
    ;;
  --soil) with_soil=true ;;
  "") ;;
  *)
    echo "setup: unknown argument '$1' (allowed: --soil)" >&2
    exit 2
    ;;
esac

# The one list: package, then what it is for.
packages="
g++                  the C++20 compiler, with OpenMP (parallel loops)
cmake                configures the build
ninja-build          runs the build
libeigen3-dev        vectors and small matrices
libhdf5-dev          run.h5 and checkpoint.h5
libtomlplusplus-dev  reads scene files (TOML)
libcli11-dev         the command line
libfmt-dev           formats messages
libspdlog-dev        run.log
nlohmann-json3-dev   summary.json
libgtest-dev         tests
libgmock-dev         tests: matchers
libbenchmark-dev     benchmarks
python3-h5py         tools: read run.h5
python3-numpy        tools: arithmetic
python3-matplotlib   tools: overview.png and the other figures
python3-tomli-w      tools: write scene files (TOML)
python3-pytest       tools: tests
"
# A scene without [soil] starts no process and needs none of this.
soil_packages="
yade                 moves the grains of the soil, in a process of its own
"
if $with_soil; then packages+=${soil_packages#$'\n'}; fi

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "setup: this is not a Debian system (no dpkg or apt-get). Install by other means:" >&2
  echo "$packages" >&2
  exit 1
fi

installed=$(dpkg-query --show --showformat '${db:Status-Abbrev}${Package}\n' 2>/dev/null | sed -n 's/^.i //p')
missing=()
while read -r name reason; do
  [[ -n "$name" ]] || continue
  if ! grep --quiet --line-regexp --fixed-strings -- "$name" <<<"$installed"; then
    ((${#missing[@]})) || echo "setup: missing Debian packages:"
    printf '  %-20s %s\n' "$name" "$reason"
    missing+=("$name")
  fi
done <<<"$packages"
((${#missing[@]})) || exit 0

as_root=()
if ((EUID != 0)); then
  # Without a password, or with a terminal to ask for it.
  if command -v sudo >/dev/null && { sudo --non-interactive true 2>/dev/null || [[ -t 0 ]]; }; then
    as_root=(sudo)
  else
    echo "setup: only an administrator can install packages. Run this once, as root:" >&2
    echo "  apt-get update && apt-get install --yes --no-install-recommends ${missing[*]}" >&2
    exit 1
  fi
fi

apt_get() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get --yes --quiet -o DPkg::Lock::Timeout=300 "$@" </dev/null
}
echo "setup: installing ${#missing[@]} packages${as_root[*]:+ with sudo}"
apt_get update
apt_get install --no-install-recommends "${missing[@]}"
