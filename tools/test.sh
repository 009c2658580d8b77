#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Sets up, builds and runs the tests: tools/test.sh [--quick]
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

ctest_choice=()
pytest_choice=()
for argument in "$@"; do
  case "$argument" in
    --quick)
      ctest_choice=(--label-exclude slow)
      pytest_choice=(-m "not slow")
      ;;
    -h | --help)
      echo "usage: tools/test.sh [--quick]    run every test; --quick: those that take under 3 minutes in total"
      exit 0
      ;;
    *)
      echo "test: unknown argument '$argument' (allowed: --quick)" >&2
      exit 2
      ;;
  esac
done

"$root/tools/setup.sh" --soil # the soil's tests run the real YADE
"$root/tools/build.sh"
export OMP_WAIT_POLICY=passive # two tests run at once: waiting threads must not take the other's core
/usr/bin/python3 -m pytest -q -p no:cacheprovider --import-mode=importlib "${pytest_choice[@]}" "$root/tests"
ctest --test-dir "$root/build/release" --parallel 2 --output-on-failure --no-tests=error "${ctest_choice[@]}"
