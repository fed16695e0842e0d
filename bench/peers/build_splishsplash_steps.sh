#!/usr/bin/env bash
# Compiles splishsplash_steps.cpp against a build of SPlisHSPlasH's library, with that build's own flags.
#   build_splishsplash_steps.sh SOURCE_FOLDER BUILD_FOLDER PROGRAM
# BUILD_FOLDER: after cmake -DCMAKE_BUILD_TYPE=Release -DSPH_LIBS_ONLY=ON -DCMAKE_EXPORT_COMPILE_COMMANDS=ON and make SPlisHSPlasH.
set -euo pipefail
[ $# -eq 3 ] || { echo "usage: build_splishsplash_steps.sh SOURCE_FOLDER BUILD_FOLDER PROGRAM" >&2; exit 2; }
source=$1 build=$2 program=$3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
commands=$build/compile_commands.json
[ -e "$commands" ] || { echo "$commands is missing: configure with CMAKE_EXPORT_COMPILE_COMMANDS=ON" >&2; exit 1; }
# Definitions and code generation decide the layout of its classes: take those of the file that steps.
flags=$(python3 - "$commands" <<'PY'
import json, shlex, sys
entry = next(entry for entry in json.load(open(sys.argv[1])) if entry["file"].endswith("WCSPH/TimeStepWCSPH.cpp"))
wanted = ("-D", "-I", "-O", "-m", "-f", "-std=")
print(" ".join(word for word in shlex.split(entry["command"]) if word.startswith(wanted)))
PY
)
for name in SPlisHSPlasH Utilities Discregrid CompactNSearch; do
  [ -n "$(find "$build" -name "lib$name.a")" ] || { echo "lib$name.a is not in $build: make SPlisHSPlasH first" >&2; exit 1; }
done
mapfile -t libraries < <(find "$build" -name '*.a' | sort)
# shellcheck disable=SC2086  # flags are words
g++ $flags -I"$source" "$here/splishsplash_steps.cpp" -o "$program" -Wl,--start-group "${libraries[@]}" -Wl,--end-group -fopenmp
