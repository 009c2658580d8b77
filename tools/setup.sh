#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs what rootsoil needs and this machine lacks, from Debian's own packages (Debian 12):
# tools/setup.sh [--test] [--soil] [--dev]
# Says what and why. Does nothing, in a blink, when all is there.
set -euo pipefail

# Package, then what it is for. What a run needs, from compiler to picture:
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
python3-h5py         tools: read run.h5
python3-numpy        tools: arithmetic
python3-matplotlib   tools: overview.png and the other figures
python3-tomli-w      tools: write scene files (TOML)
"
test_packages="
libgtest-dev         tests of the program
libgmock-dev         tests of the program: matchers
libbenchmark-dev     benchmarks
python3-pytest       tests of the tools and of the command line
python3-pytest-xdist two of these tests at once
python3-scipy        tests of the tools: regions, minima and Voronoi diagrams to compare cell walls with
"
# A scene without [soil] starts no process and needs none of this.
soil_packages="
yade                 moves the grains of the soil, in a process of its own
"
dev_packages="
clang-format         style of C++
clang-tidy           faults in C++
cppcheck             more faults in C++
shellcheck           faults in shell scripts
black                style of Python
flake8               faults in Python
mypy                 types in Python
codespell            spelling
pre-commit           all this before a commit
"
for argument in "$@"; do
  case "$argument" in
    -h | --help)
      echo "usage: tools/setup.sh [--test] [--soil] [--dev]    install the Debian packages that a run needs and that are missing"
      echo "  --test  also what the tests and benchmarks need"
      echo "  --soil  also what only scenes with [soil], the penetrometer and their tests need: YADE"
      echo "  --dev   also what checks style, spelling and types"
      exit 0
      ;;
    --test) packages+=${test_packages#$'\n'} ;;
    --soil) packages+=${soil_packages#$'\n'} ;;
    --dev) packages+=${dev_packages#$'\n'} ;;
    *)
      echo "setup: unknown argument '$argument' (allowed: --test, --soil, --dev)" >&2
      exit 2
      ;;
  esac
done

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
