#!/usr/bin/env bash
# check_oclgrind.sh SQUALL SCENE: a frame of the scene, after two to warm up, on the opencl backend under Oclgrind, a
# simulator of a device that reports out-of-bounds accesses, data races and uninitialised values. It exits 0 whatever it
# finds, so an empty stderr is what counts; not its --log, which every context begins anew, and a run has two. Its compiler
# needs -O1. It takes what the host writes into the middle of a buffer, as appended drops are, for uninitialised: that check
# runs on the scene without its rain (which stands last in the file).
# Every kernel of kernels/*.cl must have run, or the scene is too small.
set -euo pipefail
squall=$1
scene=$2
kernels=$(dirname "${BASH_SOURCE[0]}")/../kernels
command -v oclgrind >/dev/null || {
  echo "error: oclgrind is missing (Debian: apt-get install oclgrind)" >&2
  exit 1
}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

# Its check of uninitialised values does not know the instruction freeze, which its compiler makes of summary in programs
# with blocks; what it says of these is left out, in that check alone.
known() {  # known SIMD OPTIONS
  if [[ $1 = avx2 && $2 = *--uninitialized* ]]; then
    awk 'BEGIN { RS = "" } !/Unsupported instruction: freeze/ && !/Kernel: summary/'
  else
    cat
  fi
}
echo "left out: uninitialised values in summary beside blocks of eight: Oclgrind 21.10 does not know its instruction freeze"

check() {  # check SCENE PRESSURE SIMD READBACK PRECISION OPTION...: kernels of one solver and width, and one read-back mode
  local scene=$1 pressure=$2 simd=$3 readback=$4 precision=$5
  shift 5
  echo "$pressure, $simd, $readback, $precision, $*"
  oclgrind --build-options -O1 --max-errors 100000 "$@" \
    "$squall" run "$scene" --pressure "$pressure" --backend opencl --simd "$simd" --precision "$precision" \
    --readback "$readback" --frames 1 --quiet --json "$out/run.json" --trace "$out/trace.json" >/dev/null 2>"$out/said"
  known "$simd" "$*" <"$out/said" >"$out/log"
  python3 - "$out/run.json" <<'PYTHON'
import json, sys
run = json.load(open(sys.argv[1]))["runs"][0]
assert run["backend"] == "opencl" and "oclgrind" in run["device"].lower(), f"ran on {run['backend']}, {run['device']}"
assert run["frames"] == 1 and run["particles"] > 0 and "error" not in run, run
PYTHON
  grep -o '"name":"[a-z_]*"' "$out/trace.json" >>"$out/launched"
  if [ -s "$out/log" ]; then
    echo "error: oclgrind found:" >&2
    head -c 20000 "$out/log" >&2
    exit 1
  fi
}

sed '/^\[\[rain\]\]/,$d' "$scene" >"$out/dry.toml"
for simd in scalar avx2; do # a work-item per particle; blocks of eight
  for pressure in wcsph mueller dfsph; do
    check "$scene" $pressure $simd mapped single --data-races
    check "$out/dry.toml" $pressure $simd mapped single --data-races --uninitialized
  done
done
for readback in async quantized; do # the kernels that write positions, and the queue that async adds
  check "$out/dry.toml" wcsph scalar "$readback" single --data-races --uninitialized
done
# In double precision the kernels are the same text; vectors are of four, and positions are rounded on the way out.
for simd in scalar avx2; do
  check "$out/dry.toml" wcsph "$simd" mapped double --data-races
  check "$out/dry.toml" dfsph "$simd" mapped double --data-races
done

# Every solver probes the memory before its first frame, where no trace is kept.
echo '"name":"probe_memory"' >>"$out/launched"
missing=0
for kernel in "$kernels"/*.cl; do
  grep -q "\"name\":\"$(basename "$kernel" .cl)\"" "$out/launched" || { missing=1 && echo "error: $kernel was never launched" >&2; }
done
[ $missing = 0 ]
echo "oclgrind found nothing in $(find "$kernels" -name '*.cl' | wc -l) kernels"
