#pragma once

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace squall::app {

/// So viscous that no pressure solver has room for the sub-steps at 64 particles, and all have at 8.
inline constexpr const char* k_pitch = R"(schema = 1
[time]
duration_s = 1.0
[fluid]
spacing_m = 0.05
viscosity_m2_s = 65
[container]
min_m = [0.0, 0.0, 0.0]
max_m = [0.4, 0.4, 0.4]
[[block]]
min_m = [0.0, 0.0, 0.0]
max_m = [0.2, 0.2, 0.2]
)";

/// A folder that goes away with its object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "squall_test_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

inline std::string text_of(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

struct Outcome {
  int code = -1;
  std::string out, err;
};

using Environment = std::vector<std::pair<std::string, std::string>>;

/// The command squall as a process of its own, its output in files; stdout goes to `stdout_to`, or is closed, if said.
/// `file_limit`: files take so many bytes and no more, as on a full disk; 0: no limit. `address_limit`: bytes of
/// address space, as ulimit -v sets them; 0: no limit.
class Program {
 public:
  static constexpr const char* k_closed = "closed";

  explicit Program(const std::vector<std::string>& arguments, const Environment& environment = {},
                   const std::string& stdout_to = "", rlim_t file_limit = 0, rlim_t address_limit = 0) {
    std::fflush(nullptr);  // what is buffered here would be written by the child, too
    child_ = fork();
    if (child_ != 0) return;
    setenv("SQUALL_TUNING", "none", 1);  // what its user has tuned is no part of a test
    for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
    const std::string place = stdout_to.empty() || stdout_to == k_closed ? out() : stdout_to;
    if (std::freopen(place.c_str(), "w", stdout) == nullptr || std::freopen(err().c_str(), "w", stderr) == nullptr)
      _exit(126);
    if (stdout_to == k_closed) close(STDOUT_FILENO);
    if (const rlimit limit{file_limit, file_limit}; file_limit > 0) setrlimit(RLIMIT_FSIZE, &limit);
    if (const rlimit limit{address_limit, address_limit}; address_limit > 0) setrlimit(RLIMIT_AS, &limit);
    std::vector<std::string> texts{SQUALL_PROGRAM};
    texts.insert(texts.end(), arguments.begin(), arguments.end());
    std::vector<char*> words;
    for (auto& text : texts) words.push_back(text.data());
    words.push_back(nullptr);
    execv(SQUALL_PROGRAM, words.data());
    _exit(127);
  }

  void interrupt() const { kill(child_, SIGINT); }
  /// It has a handler for SIGINT by now (proc(5): SigCgt, a bit per signal from 1 on).
  bool catches_interrupts() const {
    std::istringstream status(text_of("/proc/" + std::to_string(child_) + "/status"));
    for (std::string line; std::getline(status, line);)
      if (line.rfind("SigCgt:", 0) == 0) return (std::stoull(line.substr(7), nullptr, 16) >> (SIGINT - 1) & 1) != 0;
    return false;
  }
  void terminate() const { kill(child_, SIGTERM); }
  void kill_now() const { kill(child_, SIGKILL); }
  void stop() const { kill(child_, SIGSTOP); }
  void go_on() const { kill(child_, SIGCONT); }

  Outcome wait() {
    int status = 0;
    waitpid(child_, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), text_of(out()), text_of(err())};
  }

 private:
  std::string out() const { return folder_ / "out"; }
  std::string err() const { return folder_ / "err"; }
  TemporaryFolder folder_;
  pid_t child_ = -1;
};

inline Outcome squall(const std::vector<std::string>& arguments, const Environment& environment = {}) {
  return Program(arguments, environment).wait();
}

inline const std::string k_tiny = SQUALL_TEST_SCENES_DIR "/tiny.toml";

}  // namespace squall::app
