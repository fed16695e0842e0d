#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/checkpoint.h"

namespace squall {

/// Reads a checkpoint file. Throws InputError that begins with the path for what cannot be read, and as
/// decode_checkpoint() does; reads no more than the beginning of a file that is none.
Checkpoint read_checkpoint(const std::string& path);

/// A file that is replaced as a whole: at every moment, also if the process or the machine dies, its name stands for
/// what was written last, all of it, or for what was there before. Written to PATH.part in the same folder, brought to
/// the disk, and renamed. One process at a time.
class CheckpointFile {
 public:
  explicit CheckpointFile(std::string path);
  ~CheckpointFile();
  CheckpointFile(const CheckpointFile&) = delete;
  CheckpointFile& operator=(const CheckpointFile&) = delete;

  const std::string& path() const { return path_; }

  /// Claims disk space for the next write(), so that a full disk is met now and not when there is something to lose.
  /// Where the file system cannot claim space, only tries to make the file. Throws InputError: a folder or disk that
  /// takes nothing, a path that is no file, another process that writes here.
  void reserve(std::uint64_t bytes);

  /// Replaces the file. Throws InputError if it cannot be written; what was there before then still is.
  void write(std::string_view bytes);

 private:
  void open();
  void drop();
  [[noreturn]] void fail(const std::string& doing, int error);

  std::string path_, part_;
  int descriptor_ = -1;
};

}  // namespace squall
