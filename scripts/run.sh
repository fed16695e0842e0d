#!/usr/bin/env bash
# Installs what is missing, builds squall and compares every backend and device on the rain scene.
# Arguments go to `squall compare`, e.g. scripts/run.sh --frames 20
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/packages.sh

install_packages "${run_packages[@]}"
configure_release -DSQUALL_BUILD_TESTS=OFF
build_release
say "squall compare scenes/rain.toml $*"
exec build/release/src/app/squall compare scenes/rain.toml "$@"
