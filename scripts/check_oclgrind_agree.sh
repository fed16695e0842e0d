#!/usr/bin/env bash
# check_oclgrind_agree.sh SQUALL SCENE: `squall agree` on the device that Oclgrind simulates, one work-item per particle
# and in blocks of eight, against omp and the reference. Whatever that device promises is what it is held to.
set -euo pipefail
squall=$1
scene=$2
command -v oclgrind >/dev/null || {
  echo "error: oclgrind is missing (Debian: apt-get install oclgrind)" >&2
  exit 1
}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

oclgrind --log "$out/log" --build-options -O1 \
  "$squall" agree "$scene" --simd scalar,avx2 --frames 2 --quiet --json "$out/agree.json"
python3 - "$out/agree.json" <<'PYTHON'
import json, sys
result = json.load(open(sys.argv[1]))
simulated = [run for run in result["runs"] if run["backend"] == "opencl"]
assert len(simulated) == 2, [run["label"] for run in result["runs"]]
for run in simulated:
    assert "oclgrind" in run["device"].lower() and run["agrees"] and "error" not in run, run
    assert run["run_to_run"] == run["restart"] == "same", run
PYTHON
if [ -s "$out/log" ]; then
  echo "error: oclgrind found:" >&2
  head -c 20000 "$out/log" >&2
  exit 1
fi
