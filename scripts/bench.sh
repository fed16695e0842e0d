#!/usr/bin/env bash
# Installs what is missing, builds squall with its benchmarks, runs them and prints what each stage costs and what share of
# the machine's own bound that is. Writes bench/results/MACHINE/{machine,omp,opencl}.json, with --quick into quick/ of it.
#   scripts/bench.sh [--quick] [--machine NAME]     NAME: of the folder; else from processor and cores
# About 12 minutes on 2 cores; with --quick two, without the million particles.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/packages.sh

# "AMD EPYC", 2 cores: amd-epyc-2core
machine_name() {
  local cpu
  cpu=$(sed -n 's/^model name[[:space:]]*: //p' /proc/cpuinfo | head -n 1)
  printf '%s-%dcore' "${cpu:-$(uname -m)}" "$(nproc)" | tr '[:upper:]' '[:lower:]' | sed 's/([^)]*)//g; s/[^a-z0-9]\+/-/g'
}

effort=full
machine=$(machine_name)
while [ $# -gt 0 ]; do
  case $1 in
    --quick) effort=quick ;;
    --machine)
      [ $# -gt 1 ] || fail "--machine needs a name"
      machine=$2
      shift
      ;;
    *) fail "unknown option $1; there are --quick and --machine NAME" ;;
  esac
  shift
done
[[ $machine =~ ^[A-Za-z0-9][A-Za-z0-9._-]*$ ]] || fail "--machine '$machine' is no name of a folder: letters, digits, . _ -"
folder=bench/results/$machine
[ "$effort" = full ] || folder=$folder/quick

install_packages "${bench_packages[@]}"
configure_release -DSQUALL_BUILD_TESTS=OFF -DSQUALL_BUILD_BENCH=ON
build_release
mkdir -p "$folder"
log=$(mktemp)
trap 'rm -f "$log" "$folder"/*.json.new' EXIT
status=0
for part in machine omp opencl; do
  program=build/release/bench/bench_$part
  [ -x "$program" ] || fail "$program was not built; see the messages of the build"
  say "bench_$part --$effort"
  # Its own table is one line per row and statistic; ours follows.
  "$program" "--$effort" --benchmark_out="$folder/$part.json.new" --benchmark_out_format=json >/dev/null 2>"$log" ||
    { status=1 && grep '^error' "$log" >&2 || say "bench_$part: a row failed; see the table"; }
  python3 scripts/bench_rows.py "$folder/$part.json.new" "$folder/$part.json" || fail "bench_$part left no result"
done
say "$folder"
python3 scripts/bench_table.py "$folder"
exit $status
