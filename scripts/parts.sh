# shellcheck shell=bash
# Checks that come in parts; sourced by check.sh and nightly.sh.

# run_parts "KNOWN..." PART...: calls the function part_PART for each and says how long it took. All are run, whatever fails;
# the exit code is 1 if one did.
run_parts() {
  local known=$1 part status started table="" failed=0
  shift
  for part in "$@"; do
    [[ " $known " = *" $part "* ]] || fail "unknown part '$part'; there are: $known"
  done
  for part in "$@"; do
    say "$part"
    started=$SECONDS
    set +e
    (set -e && "part_$part")
    status=$?
    set -e
    [ "$status" = 0 ] || failed=1
    table+=$(printf '%-10s %6d s  %s' "$part" $((SECONDS - started)) "$([ "$status" = 0 ] && echo ok || echo "FAILED ($status)")")$'\n'
  done
  printf '\n%s' "$table"
  return $failed
}

# left_out WHAT WHY: nothing is skipped in silence.
left_out() { printf 'left out: %s: %s\n' "$1" "$2"; }

# What sanitizers are told; the files say why each suppression is there. Tests ask for more memory than there is: no error.
use_sanitizer_options() {
  local folder=$PWD/tests/sanitizers
  export ASAN_SYMBOLIZER_PATH=/usr/lib/llvm-14/bin/llvm-symbolizer
  export ASAN_OPTIONS=allocator_may_return_null=1:detect_stack_use_after_return=1:strict_string_checks=1
  export LSAN_OPTIONS=suppressions=$folder/lsan.supp:print_suppressions=0
  # LLVM 14's libomp keeps a team for the next region, and loses its buffers (t_disp_buffer) when that is to be larger: it
  # shall keep none. To suppress what has libomp on its stack would be to suppress all that a team allocates.
  export KMP_HOT_TEAMS_MAX_LEVEL=0
  export UBSAN_OPTIONS=print_stacktrace=1
  export TSAN_OPTIONS=halt_on_error=1:allocator_may_return_null=1:external_symbolizer_path=$ASAN_SYMBOLIZER_PATH:suppressions=$folder/tsan.supp:ignore_noninstrumented_modules=1:print_suppressions=0
}

# build_preset PRESET TARGET...: with clang, a warning being an error. What lies in the cache stays: a compiler launcher, say.
build_preset() {
  local preset=$1 jobs
  shift
  jobs=$(build_jobs)
  say "building build/$preset with $jobs jobs"
  cmake --preset "$preset" -DSQUALL_WARNINGS_AS_ERRORS=ON >&2
  cmake --build "build/$preset" -j "$jobs" --target "$@" >&2
}

# fuzz SECONDS: each fuzzer on its corpus in fuzz/corpus, what was found before included; two at once. What is new and of use
# goes to build/found, which may be kept from run to run.
fuzz() {
  local seconds=$1 name process failed=0
  local names=(scene checkpoint csv command_line) running=() words=()
  use_sanitizer_options
  for name in "${names[@]}"; do
    mkdir -p "build/found/$name"
    words=()
    [ ! -e "fuzz/$name.dict" ] || words=("-dict=fuzz/$name.dict")
    build/asan/fuzz/fuzz_"$name" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 "${words[@]}" -print_final_stats=1 \
      -artifact_prefix="build/found/$name-" "build/found/$name" "fuzz/corpus/$name" >"build/found/$name.log" 2>&1 &
    running+=($!)
    if [ ${#running[@]} = 2 ]; then
      for process in "${running[@]}"; do wait "$process" || failed=1; done
      running=()
    fi
  done
  for name in "${names[@]}"; do
    if grep -q '^stat::number_of_executed_units' "build/found/$name.log" && ! grep -q 'ERROR: ' "build/found/$name.log"; then
      echo "fuzz_$name: $(sed -n 's/^stat::number_of_executed_units: *//p' "build/found/$name.log") inputs," \
        "$(find "build/found/$name" -type f | wc -l) kept"
    else
      failed=1
      echo "fuzz_$name failed; its input: build/found/$name-*" >&2
      tail -n 60 "build/found/$name.log" >&2
    fi
  done
  return $failed
}
