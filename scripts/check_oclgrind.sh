#!/usr/bin/env bash
# check_oclgrind.sh SQUALL SCENE: two frames of the scene on the opencl backend under Oclgrind, a simulator of a device
# that reports out-of-bounds accesses, data races and uninitialised values. It exits 0 whatever it finds, so an empty log
# is what counts. Its compiler needs -O1. It takes what the host writes into the middle of a buffer, as appended drops
# are, for uninitialised: that check runs on the scene without its rain (which stands last in the file).
set -euo pipefail
squall=$1
scene=$2
command -v oclgrind >/dev/null || {
  echo "error: oclgrind is missing (Debian: apt-get install oclgrind)" >&2
  exit 1
}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

check() {  # check SCENE PRESSURE SIMD READBACK PRECISION OPTION...: kernels of one solver and width, and one read-back mode
  local scene=$1 pressure=$2 simd=$3 readback=$4 precision=$5
  shift 5
  oclgrind --log "$out/log" --build-options -O1 --max-errors 20 "$@" \
    "$squall" run "$scene" --pressure "$pressure" --backend opencl --simd "$simd" --precision "$precision" \
    --readback "$readback" --frames 2 --quiet --json "$out/run.json"
  python3 - "$out/run.json" <<'PYTHON'
import json, sys
run = json.load(open(sys.argv[1]))["runs"][0]
assert run["backend"] == "opencl" and "oclgrind" in run["device"].lower(), f"ran on {run['backend']}, {run['device']}"
assert run["frames"] == 2 and run["particles"] > 0 and "error" not in run, run
PYTHON
  if [ -s "$out/log" ]; then
    echo "error: oclgrind found:" >&2
    head -c 20000 "$out/log" >&2
    exit 1
  fi
}

sed '/^\[\[rain\]\]/,$d' "$scene" >"$out/dry.toml"
for simd in scalar avx2; do # a work-item per particle; blocks of eight
  check "$scene" wcsph "$simd" mapped single --data-races
  check "$scene" dfsph "$simd" mapped single --data-races
  check "$out/dry.toml" wcsph "$simd" mapped single --data-races --uninitialized
done
for readback in async quantized; do # the kernels that write positions, and the queue that async adds
  check "$out/dry.toml" wcsph scalar "$readback" single --data-races --uninitialized
done
# Oclgrind 21.10 itself crashes in this check of dfsph's kernels with a work-item per particle.
check "$out/dry.toml" dfsph avx2 mapped single --data-races --uninitialized
# In double precision the kernels are the same text; vectors are of four, and positions are rounded on the way out.
for simd in scalar avx2; do
  check "$scene" wcsph "$simd" mapped double --data-races
  check "$scene" dfsph "$simd" mapped double --data-races
done
echo "oclgrind found nothing"
