#include "harness/report/gnuplot.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "core/errors.h"

namespace squall::harness {

namespace {

/// A file without a name; unlike a pipe it never makes the other side wait.
class ScratchFile {
 public:
  ScratchFile() : file_(std::tmpfile(), &std::fclose) {
    if (!file_) throw DeviceError(fmt::format("no temporary file can be made: {}", std::strerror(errno)));
  }
  void write(const std::string& text) {
    const bool written = std::fwrite(text.data(), 1, text.size(), file_.get()) == text.size();
    if (!written || std::fflush(file_.get()) != 0) throw DeviceError("a temporary file cannot be written: disk full?");
    std::rewind(file_.get());
  }
  std::string read() {
    std::rewind(file_.get());
    std::string text;
    std::array<char, 4096> part{};
    while (const std::size_t count = std::fread(part.data(), 1, part.size(), file_.get()))
      text.append(part.data(), count);
    return text;
  }
  int descriptor() const { return fileno(file_.get()); }

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

struct SpawnActions {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  SpawnActions() {
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    // A group of its own: Ctrl-C ends the measurement, not the drawing of what was measured.
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  }
  ~SpawnActions() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnActions(const SpawnActions&) = delete;
  SpawnActions& operator=(const SpawnActions&) = delete;
};

struct Finished {
  bool fine = false;
  std::string out, err;
};

DeviceError not_started(int error) {
  return DeviceError(fmt::format(
      "gnuplot, which draws the plots, cannot be started: {}; install it (Debian: apt-get install gnuplot-nox) or ask "
      "for no report",
      std::strerror(error)));
}

Finished run_gnuplot(const std::string& argument, const std::string& input) {
  ScratchFile in, out, err;
  in.write(input);
  SpawnActions spawn;
  posix_spawn_file_actions_adddup2(&spawn.actions, in.descriptor(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&spawn.actions, out.descriptor(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&spawn.actions, err.descriptor(), STDERR_FILENO);
  // Without -d a user's own start-up file would decide how the plots look.
  std::vector<std::string> words{"gnuplot", "-d", argument};
  std::vector<char*> pointers;
  for (auto& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  pid_t child = 0;
  const int error = posix_spawnp(&child, "gnuplot", &spawn.actions, &spawn.attributes, pointers.data(), environ);
  if (error != 0) throw not_started(error);
  int status = 0;
  while (waitpid(child, &status, 0) == -1)
    if (errno != EINTR) throw not_started(errno);
  return {WIFEXITED(status) && WEXITSTATUS(status) == 0, out.read(), err.read()};
}

}  // namespace

void require_gnuplot() {
  const Finished finished = run_gnuplot("--version", "");
  if (finished.fine) return;
  throw DeviceError("gnuplot, which draws the plots, does not run: " + finished.out + finished.err);
}

std::string draw_svg(const Plot& plot) {
  const Finished finished = run_gnuplot("-", gnuplot_script(plot));
  const bool whole = finished.out.find("</svg>") != std::string::npos;
  if (!finished.fine || !whole)
    throw DeviceError(fmt::format("gnuplot did not draw '{}': {}", plot.name,
                                  finished.err.empty() ? "it gave no picture and no reason" : finished.err));
  return finished.out;
}

}  // namespace squall::harness
