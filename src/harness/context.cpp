#include "harness/context.h"

#include <unistd.h>

#include <ctime>
#include <fstream>
#include <set>
#include <thread>
#include <utility>

#include "build_info.h"

namespace squall::harness {

namespace {

std::string utc_date() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  return {text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

std::string host_name() {
  char name[256] = {};
  return gethostname(name, sizeof name - 1) == 0 ? name : "";
}

/// /proc/cpuinfo as Linux writes it: "key<tab>: value".
void read_processor(Context& context) {
  std::ifstream file("/proc/cpuinfo");
  std::set<std::pair<std::string, std::string>> cores;
  std::string line, package;
  while (std::getline(file, line)) {
    const auto colon = line.find(':');
    if (colon == std::string::npos) continue;
    const std::string key = line.substr(0, line.find_last_not_of(" \t", colon - 1) + 1);
    const std::string value = colon + 2 <= line.size() ? line.substr(colon + 2) : "";
    if (key == "model name") context.cpu = value;
    if (key == "physical id") package = value;
    if (key == "core id") cores.emplace(package, value);
  }
  context.cores = cores.empty() ? context.threads : static_cast<int>(cores.size());
}

}  // namespace

Context collect_context() {
  Context context;
  context.squall_version = k_squall_version;
  context.git_revision = k_git_revision;
  context.compiler = k_compiler;
  context.flags = k_compiler_flags;
  context.date = utc_date();
  context.host = host_name();
  context.threads = static_cast<int>(std::thread::hardware_concurrency());
  read_processor(context);
  return context;
}

}  // namespace squall::harness
