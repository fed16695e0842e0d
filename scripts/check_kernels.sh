#!/usr/bin/env bash
# Checks every kernels/*.cl with clang as OpenCL C 1.2 for a 64-bit device that need not exist here, for each precision,
# lane width and pressure solver.
# A missing compiler is a failure. SQUALL_OPENCL_CLANG names another clang.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
clang=${SQUALL_OPENCL_CLANG:-clang-15}
command -v "$clang" >/dev/null || {
  echo "error: $clang is missing (Debian: apt-get install clang-15)" >&2
  exit 1
}

shopt -s nullglob
kernels=(kernels/*.cl)
[ "${#kernels[@]}" -gt 0 ] || {
  echo "error: there is no kernels/*.cl" >&2
  exit 1
}
failed=0
for kernel in "${kernels[@]}"; do
  for switches in "-DSQUALL_"{"LANES=1","LANES=8","LANES=16","DOUBLE=1 -DSQUALL_LANES=1","DOUBLE=1 -DSQUALL_LANES=4","DOUBLE=1 -DSQUALL_LANES=8"}" -DSQUALL_"{WCSPH=0,WCSPH=1,DFSPH=1,"DFSPH=1 -DSQUALL_WEIGHTS=0"}; do
    # shellcheck disable=SC2086 # several options
    "$clang" -x cl -cl-std=CL1.2 -target spir64 -fsyntax-only -Xclang -finclude-default-header -Ikernels \
      -Wall -Wextra -Wno-unused-parameter -Werror $switches "$kernel" || { echo "$kernel with $switches: failed" >&2 && failed=1; }
  done
done
echo "${#kernels[@]} kernels checked with $clang"
exit $failed
