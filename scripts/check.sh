#!/usr/bin/env bash
# check.sh [PART...]: the checks behind the tests, half an hour on 2 cores (docs/limits.md); all of them, or these:
#   format     clang-format of every source file
#   kernels    the OpenCL kernels' syntax, for devices that are not here
#   oclgrind   every kernel in a simulated device that reports out-of-bounds accesses, data races and uninitialised values
#   asan       the command, the libraries and all tests built by clang, warnings being errors, and run under AddressSanitizer,
#              UndefinedBehaviorSanitizer and LeakSanitizer
#   property   random scenes, under the same
#   fuzz       what reads files and command lines, 30 s each, under the same
#   tsan       the omp backend under ThreadSanitizer
# Every part is run, whatever fails; the exit code is 1 if one did. scripts/nightly.sh has what takes longer.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/packages.sh
source scripts/parts.sh

parts="format kernels oclgrind asan property fuzz tsan"

part_format() {
  # Without git, too: a release's archive has none.
  local folders=(bench examples fuzz kernels src tests) file sources=()
  while IFS= read -r -d '' file; do sources+=("$file"); done < \
    <(find "${folders[@]}" -type f \( -name '*.cpp' -o -name '*.h' -o -name '*.cl' \) -print0)
  [ ${#sources[@]} -gt 0 ] || fail "there are no sources to look at"
  printf '%s\0' "${sources[@]}" | xargs -0 clang-format-14 --dry-run --Werror
  echo "${#sources[@]} files are formatted"
}

part_kernels() { scripts/check_kernels.sh; }

# Optimised, for a simulator is slow enough: the build that test.sh makes.
part_oclgrind() {
  configure_tests
  build_release squall_app
  scripts/check_oclgrind.sh build/release/src/app/squall tests/scenes/tiny.toml
}

part_asan() {
  build_preset asan all
  left_out kernels.opencl_syntax "a part of its own"
  left_out properties "a part of its own"
  left_out "bench and its tests" "they measure, and test.sh builds and runs them"
  left_out package.embed "a user's project is built without sanitizers, and test.sh does so"
  left_out "a million particles, but for one test" "they take minutes and go the way of a thousand (tests/squall_tests.cmake)"
  left_out "same bits at full size, far into their scenes" "they take minutes, test.sh runs them, and smaller ones are run here"
  use_sanitizer_options
  ctest --test-dir build/asan --output-on-failure --no-tests=error -j 2 \
    -E '^(kernels\.opencl_syntax|properties|package\.embed)$'
}

part_property() {
  build_preset asan properties_tests
  use_sanitizer_options
  RC_PARAMS="seed=1 max_success=60" build/asan/tests/properties_tests
}

part_fuzz() {
  build_preset asan fuzz_scene fuzz_checkpoint fuzz_csv fuzz_command_line
  fuzz 30
}

part_tsan() {
  local archer=/usr/lib/llvm-14/lib/libarcher.so
  [ -e "$archer" ] || fail "there is no $archer, which tells ThreadSanitizer what OpenMP orders (Debian: libomp-14-dev)"
  build_preset tsan backend_omp_tests solver_tests
  use_sanitizer_options
  export OMP_TOOL_LIBRARIES=$archer
  left_out "a million particles, but for one test" "they take minutes and go the way of a thousand"
  left_out "solver tests with one thread, with two, and with each instruction set" "three threads meet wherever two do; asan runs all"
  watch_threads backend_omp_tests '-*/1048577_on_1:*/1048577_on_2:*/1048577_on_3'
  watch_threads solver_tests '*/omp_3_threads*'
  watch_threads solver_tests '*GoldenHash*/omp*'
}

# watch_threads PROGRAM FILTER. A filter that matches nothing would pass.
watch_threads() {
  local program=(build/tsan/tests/"$1" --gtest_filter="$2")
  # Its shadow memory has fixed places, which addresses drawn at random may take.
  ! setarch -R true 2>/dev/null || program=(setarch -R "${program[@]}")
  "${program[@]}" --gtest_list_tests | grep -c '^  ' >/dev/null || fail "no test of $1 is called $2"
  "${program[@]}" --gtest_brief=1
}

install_packages "${check_packages[@]}"
# shellcheck disable=SC2086 # a list of words
[ $# -gt 0 ] || set -- $parts
run_parts "$parts" "$@"
