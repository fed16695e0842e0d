#include "app/standard_streams.h"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <iostream>

#include "core/errors.h"

namespace squall::app {

void reserve_standard_streams() {
  // A limit on file sizes shall be an error of the write, which can be told, and not the end of the process.
  std::signal(SIGXFSZ, SIG_IGN);
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) != -1) continue;
    // The lowest free number is this one. Nobody misses what goes to stderr; what goes to stdout must fail.
    if (open("/dev/null", descriptor == STDERR_FILENO ? O_WRONLY : O_RDONLY) == -1) return;
  }
}

void finish_stdout() {
  std::cout.flush();
  if (!std::cout) throw InputError("stdout did not take the whole output; check its free space and that it is open");
}

}  // namespace squall::app
