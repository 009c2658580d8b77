#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Sets up, builds and runs a scene: tools/run.sh [SCENE] [ARGS of `rootsoil run`]
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

if [[ "${1:-}" == "-h" || "${1:-}" == "--help" ]]; then
  cat <<HELP
usage: tools/run.sh [SCENE] [ARGS]

Installs what a run needs and lacks, builds the program (no tests), and runs SCENE.
  SCENE  a scene file, or the bare name of one in scenarios/ (default: case2_arabidopsis)
  ARGS   go to 'rootsoil run': --out DIR, --threads N, --resume, --set key.path=value,
         --accuracy fast|balanced|reference, --until H, --quiet
Scenes:
$(cd "$root/scenarios" && printf '  %s\n' *.toml | sed 's/\.toml$//')
HELP
  exit 0
fi

scene="$root/scenarios/case2_arabidopsis.toml"
if (($# > 0)) && [[ "$1" != -* ]]; then
  scene=$1
  shift
  if [[ ! -f "$scene" && -f "$root/scenarios/${scene%.toml}.toml" ]]; then
    scene="$root/scenarios/${scene%.toml}.toml"
  fi
fi

if [[ -f "$scene" ]] && grep --quiet '^ *\[soil\]' "$scene"; then
  "$root/tools/setup.sh" --soil
fi
"$root/tools/build.sh" rootsoil
exec "$root/build/release/rootsoil" run "$scene" "$@"
