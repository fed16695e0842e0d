#include "core/address_space.h"

#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

namespace squall {

namespace {

std::string mebibytes(std::uint64_t bytes) { return std::to_string(bytes >> 20) + " MiB"; }

}  // namespace

std::optional<std::uint64_t> address_space_left() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return std::nullopt;
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const std::uint64_t used = pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  return used < limit.rlim_cur ? limit.rlim_cur - used : 0;
}

std::string address_space_problem(const std::string& what, std::uint64_t bytes) {
  const auto left = address_space_left();
  if (!left || *left >= bytes) return "";
  return what + " needs " + mebibytes(bytes) + " of address space and the limit leaves " + mebibytes(*left) +
         "; raise it with ulimit -v";
}

}  // namespace squall
