#!/usr/bin/env bash
# Installs what is missing, builds squall with its tests and runs all of them; ctest's summary comes last.
# Arguments go to ctest, e.g. scripts/test.sh -R kernels. With CI set, a compiler warning is an error.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/packages.sh

install_packages "${test_packages[@]}"
configure_tests
build_release
say "ctest"
exec ctest --test-dir build/release --output-on-failure --no-tests=error "$@"
