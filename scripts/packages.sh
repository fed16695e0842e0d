# shellcheck shell=bash disable=SC2034
# What squall needs of Debian 12, in one place; sourced by the scripts beside it.

# To build and run the command; PoCL is the OpenCL device of machines that have no other.
run_packages=(
  g++ cmake ninja-build pkg-config git ca-certificates
  libeigen3-dev libtomlplusplus-dev libhwy-dev
  opencl-clhpp-headers opencl-c-headers ocl-icd-opencl-dev pocl-opencl-icd
  nlohmann-json3-dev libcli11-dev libfmt-dev gnuplot-nox
)
# To test it: clang-15 checks the kernels' syntax for devices that are not here, Oclgrind simulates one.
test_packages=("${run_packages[@]}" libgtest-dev libgmock-dev librapidcheck-dev libbenchmark-dev clang-15 oclgrind python3)

# For scripts/check.sh: clang with its sanitizers, its fuzzer and its OpenMP, whose archer tells ThreadSanitizer what OpenMP
# orders. clang-tidy is nightly.sh's.
check_packages=("${test_packages[@]}" clang-14 clang-format-14 libclang-rt-14-dev llvm-14 libomp-14-dev)
nightly_packages=("${check_packages[@]}" clang-tidy-14)

# To measure it: Google Benchmark, and python3 for the table.
bench_packages=("${run_packages[@]}" libbenchmark-dev python3)

say() { printf '== %s\n' "$*" >&2; }
fail() {
  printf 'error: %s\n' "$*" >&2
  exit 1
}

is_installed() { [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

# Installs what is missing of the packages named; asks the network only then.
install_packages() {
  local package
  local missing=()
  type -P apt-get dpkg-query >/dev/null ||
    fail "this script installs packages with apt-get (Debian 12), which is not here. Install the likes of: $*;" \
      "then: cmake --preset release && cmake --build build/release"
  for package in "$@"; do
    is_installed "$package" || missing+=("$package")
  done
  [ "${#missing[@]}" -gt 0 ] || { say "all $# packages are installed" && return; }

  local as_root=()
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || fail "not root and no sudo; as root: apt-get install ${missing[*]}"
    as_root=(sudo)
  fi
  as_root+=(env DEBIAN_FRONTEND=noninteractive)
  say "installing ${missing[*]}"
  # One unreachable extra source must not stop what the others can give; the installation decides.
  "${as_root[@]}" apt-get update -qq || say "apt-get update failed; trying with the package lists that are here"
  "${as_root[@]}" apt-get install -y -qq -o Dpkg::Use-Pty=0 --no-install-recommends "${missing[@]}" >&2 ||
    fail "apt-get could not install: ${missing[*]} (no network, or not Debian 12?)"
}

# As many compile jobs as there are cores and memory for, at 1.5 GiB each; at least one.
build_jobs() {
  local cores memory_kib jobs
  cores=$(nproc)
  memory_kib=$(awk '/^MemAvailable:/ { print $2 }' /proc/meminfo)
  jobs=$((${memory_kib:-1572864} / 1572864))
  [ "$jobs" -lt "$cores" ] || jobs=$cores
  [ "$jobs" -ge 1 ] || jobs=1
  echo "$jobs"
}

# PoCL keeps the kernels it has built below HOME, and offers no device where it cannot.
if [ ! -w "${HOME:-/nowhere}" ]; then
  export POCL_CACHE_DIR=${POCL_CACHE_DIR:-$PWD/build/pocl-cache}
  mkdir -p "$POCL_CACHE_DIR"
fi

configure_release() {
  say "configuring build/release"
  cmake --preset release "$@" >&2
}

# As configure_release for all tests; with CI set, a compiler warning is an error.
configure_tests() {
  configure_release -DSQUALL_BUILD_TESTS=ON -DSQUALL_BUILD_BENCH=ON -DSQUALL_WARNINGS_AS_ERRORS="$([ -z "${CI:-}" ] && echo OFF || echo ON)"
}

# Builds what was configured: everything, or the targets named.
build_release() {
  local jobs targets=()
  jobs=$(build_jobs)
  [ $# = 0 ] || targets=(--target "$@")
  say "building with $jobs jobs"
  cmake --build build/release -j "$jobs" "${targets[@]}" >&2
}
