#!/usr/bin/env bash
# nightly.sh [PART...]: what takes too long for every change, some hours on 2 cores; all of it, or these parts:
#   tidy       clang-tidy over every source file
#   soak       heavy rain under a memory limit; lost particles, energy, level and memory watched (scripts/soak.py)
#   rest       still water for a million sub-steps
#   stress     squall stress, every case on every backend
#   steps      squall stress --largest-step: where every pressure solver becomes unstable, and how far squall stays from it
#   validate   squall validate, every case
#   sweep      squall sweep on collapse, with plots
#   bits       collapse, 120 frames: one hash on every backend, width and number of threads
#   property   random scenes that nobody has tried yet, under sanitizers
#   fuzz       the fuzzers, longer
# SQUALL_NIGHTLY_MINUTES: of soak for each pressure solver and of fuzz for each target, 30. Smaller for a trial; with 2 or less rest,
# stress, steps, validate, sweep and bits are tried, too, in a shorter form.
# Every part is run, whatever fails; the exit code is 1 if one did. What it writes lies in build/nightly.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/packages.sh
source scripts/parts.sh

parts="tidy soak rest stress steps validate sweep bits property fuzz"
minutes=${SQUALL_NIGHTLY_MINUTES:-30}
[[ $minutes =~ ^[0-9]+(\.[0-9]+)?$ ]] || fail "SQUALL_NIGHTLY_MINUTES='$minutes' is no number of minutes"
squall=build/release/src/app/squall
out=build/nightly
trial=no
awk "BEGIN { exit !($minutes <= 2) }" && trial=yes

# What a trial leaves out is said.
in_trial() { [ "$trial" = yes ] && left_out "$1" "SQUALL_NIGHTLY_MINUTES is $minutes"; }

build_squall() {
  configure_tests
  build_release squall_app
}

# field FILE NAME: of the only run of a result
field() { python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["runs"][0][sys.argv[2]])' "$1" "$2"; }

part_tidy() {
  cmake --preset asan -B build/tidy -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DSQUALL_BUILD_BENCH=ON >&2
  git ls-files 'src/*.cpp' 'tests/*.cpp' 'bench/*.cpp' 'fuzz/*.cpp' ':!bench/peers' |
    xargs -P "$(nproc)" -n 4 clang-tidy-14 -p build/tidy --quiet
}

part_soak() {
  local pressure
  build_squall
  for pressure in wcsph mueller dfsph; do
    echo "$pressure:"
    python3 scripts/soak.py "$squall" tests/scenes/downpour.toml "$minutes" "$pressure"
  done
}

part_rest() {
  build_squall
  if in_trial "a million sub-steps, but for 1,000 of each pressure solver"; then
    "$squall" run scenes/still.toml --pressure wcsph --frames 70 --quiet
    return
  fi
  "$squall" stress --case 24 --backend omp
}

part_stress() {
  local switches=()
  build_squall
  ! in_trial "the long cases of stress" || switches=(--quick --backend omp)
  "$squall" stress "${switches[@]}" --json "$out/stress.json"
}

part_steps() {
  local switches=()
  build_squall
  ! in_trial "most settings of steps" || switches=(--quick)
  "$squall" stress --largest-step "${switches[@]}" --json "$out/largest_step.json"
}

part_validate() {
  local switches=()
  build_squall
  ! in_trial "fine scenes of validate" || switches=(--quick)
  rm -rf "$out/validate"
  "$squall" validate "${switches[@]}" --out "$out/validate"
}

part_sweep() {
  local switches=()
  build_squall
  ! in_trial "large sizes of sweep" || switches=(--particles "500,1000" --frames 5)
  rm -rf "$out/sweep"
  "$squall" sweep scenes/collapse.toml "${switches[@]}" --out "$out/sweep"
}

# Each call of compare holds its runs against each other after every frame; between calls the last hash is compared.
part_bits() {
  local pressure simd frames=120 size=() file="$out/bits.json" widths=(scalar)
  build_squall
  ! grep -qw avx2 /proc/cpuinfo || widths+=(avx2)
  ! grep -qw avx512vl /proc/cpuinfo || widths+=(avx512)
  [ "${widths[-1]}" = avx512 ] || left_out "omp with AVX-512" "this processor has none"
  if in_trial "the full size of collapse"; then size=(--particles 1000); fi
  for pressure in wcsph mueller dfsph; do
    # compare counts its frames after five to warm up.
    "$squall" run scenes/collapse.toml "${size[@]}" --pressure "$pressure" --backend reference --precision single \
      --frames $((frames + 5)) --quiet --json "$file" >/dev/null
    field "$file" state_hash >"$out/hashes"
    for simd in "${widths[@]}"; do
      "$squall" compare scenes/collapse.toml "${size[@]}" --pressure "$pressure" --simd "$simd" --threads 1,2,3 --readback mapped \
        --frames "$frames" --quiet --json "$file" >/dev/null
      python3 -c 'import json, sys
result = json.load(open(sys.argv[1]))
assert result["agreement"]["bitwise"] is True and len(result["runs"]) >= 4, result["agreement"]
print("\n".join(run["state_hash"] for run in result["runs"]))' "$file" >>"$out/hashes"
    done
    echo "$pressure: $(wc -l <"$out/hashes") runs, $(sort -u "$out/hashes" | wc -l) different hashes"
    [ "$(sort -u "$out/hashes" | wc -l)" = 1 ]
  done
}

part_property() {
  local seed
  seed=$(date +%s)
  build_preset asan properties_tests
  use_sanitizer_options
  echo "seed $seed"
  RC_PARAMS="seed=$seed max_success=$([ "$trial" = yes ] && echo 20 || echo 1000)" build/asan/tests/properties_tests
}

part_fuzz() {
  build_preset asan fuzz_scene fuzz_checkpoint fuzz_csv fuzz_command_line
  fuzz "$(awk "BEGIN { printf \"%d\", 60 * $minutes }")"
}

install_packages "${nightly_packages[@]}"
mkdir -p "$out"
# shellcheck disable=SC2086 # a list of words
[ $# -gt 0 ] || set -- $parts
run_parts "$parts" "$@"
