#!/usr/bin/env bash
# check_package.sh BUILD: installs the build into an empty prefix and builds and runs examples/embed against it, as a user's
# project would.
set -euo pipefail
build=$1
example="$(cd "$(dirname "${BASH_SOURCE[0]}")/../examples/embed" && pwd)"
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cmake --install "$build" --prefix "$out/prefix" >/dev/null
cmake -G Ninja -S "$example" -B "$out/build" -DCMAKE_PREFIX_PATH="$out/prefix" -DCMAKE_BUILD_TYPE=Release >"$out/log" 2>&1 &&
  cmake --build "$out/build" >>"$out/log" 2>&1 || {
  cat "$out/log" >&2
  exit 1
}
for backend in reference omp opencl; do
  echo "$backend:"
  "$out/build/embed" "$backend"
done
