#!/usr/bin/env bash
# golden.sh [SQUALL]: writes tests/golden/hashes.txt, the hash of the state that every scene of scenes/ ends in with every
# pressure solver, computed on the reference in single precision: what all backends promise to the bit
# (docs/determinism.md). Without SQUALL, build/release is built. About a minute.
# Only for results that were meant to change, in a commit of its own that says why.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/packages.sh

particles=600   # about so many, by --particles
longest=240     # frames; shorter scenes end earlier

squall=${1:-}
if [ -z "$squall" ]; then
  install_packages "${run_packages[@]}" python3
  configure_release
  build_release squall_app
  squall=build/release/src/app/squall
fi
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

# FIELD of the run in $out/run.json
field() { python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["runs"][0][sys.argv[2]])' "$out/run.json" "$1"; }

{
  echo "# scene, pressure solver, --particles, frames, hash of the state after them. Written by scripts/golden.sh."
  for scene in scenes/*.toml; do
    name=$(basename "$scene" .toml)
    forced=$(sed -n 's/^pressure = "\(.*\)"$/\1/p' "$scene")
    frames=$(python3 - "$scene" "$longest" <<'PYTHON'
import sys, tomllib
time = tomllib.load(open(sys.argv[1], "rb"))["time"]
print(min(int(sys.argv[2]), round(time["duration_s"] * time.get("frame_rate_hz", 60))))
PYTHON
    )
    for pressure in ${forced:-wcsph mueller dfsph}; do
      say "$name, $pressure, $frames frames"
      "$squall" run "$scene" --backend reference --precision single --pressure "$pressure" --particles "$particles" \
        --frames "$frames" --quiet --json "$out/run.json" >/dev/null || fail "$name with $pressure: exit code $?"
      [ "$(field frames)" = "$frames" ] || fail "$name with $pressure ended after $(field frames) frames"
      echo "$name $pressure $particles $frames $(field state_hash)"
    done
  done
} >"$out/hashes.txt"
mv "$out/hashes.txt" tests/golden/hashes.txt
git --no-pager diff --stat -- tests/golden/hashes.txt >&2 || true
