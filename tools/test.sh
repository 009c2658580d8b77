#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Sets up, builds and runs the tests: tools/test.sh [--quick] [--werror]
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

lint_choice=()
ctest_choice=()
pytest_choice=()
build_choice=()
for argument in "$@"; do
  case "$argument" in
    --quick)
      lint_choice=(--quick)
      ctest_choice=(--label-exclude slow)
      pytest_choice=(-m "not slow")
      ;;
    --werror) build_choice=(--werror) ;;
    -h | --help)
      echo "usage: tools/test.sh [--quick] [--werror]    build everything and run every test"
      echo "  --quick   without the slow ones"
      echo "  --werror  a compiler's warning is an error, as in continuous integration (compiles anew what was built without)"
      exit 0
      ;;
    *)
      echo "test: unknown argument '$argument' (allowed: --quick, --werror)" >&2
      exit 2
      ;;
  esac
done

"$root/tools/setup.sh" --test --soil --dev # the soil's tests run the real YADE; lint its tools
"$root/tools/lint.sh" "${lint_choice[@]}"
"$root/tools/build.sh" "${build_choice[@]}"
export OMP_WAIT_POLICY=passive # two tests run at once: waiting threads must not take the other's core
/usr/bin/python3 -m pytest -q -p no:cacheprovider --import-mode=importlib --numprocesses 2 --dist loadscope "${pytest_choice[@]}" "$root/tests"
ctest --test-dir "$root/build/release" --parallel 2 --output-on-failure --no-tests=error "${ctest_choice[@]}"
