#include "core/checkpoint_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "core/checkpoint_layout.h"
#include "core/errors.h"

namespace squall {

namespace {

std::string error_text(int error) { return std::generic_category().message(error); }

/// 0, or the error that stopped it.
int write_all(int descriptor, std::string_view bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    constexpr std::size_t k_most_at_once = std::size_t{1} << 30;
    const ssize_t written = pwrite(descriptor, bytes.data() + done, std::min(bytes.size() - done, k_most_at_once),
                                   static_cast<off_t>(done));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    done += static_cast<std::size_t>(written);
  }
  return ftruncate(descriptor, static_cast<off_t>(bytes.size())) == 0 ? 0 : errno;
}

/// A rename is on the disk when its folder is. File systems that cannot say so have nothing to wait for.
void sync_folder_of(const std::string& path) {
  const auto folder = std::filesystem::absolute(path).parent_path();
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  static_cast<void>(fsync(descriptor));
  close(descriptor);
}

/// Whether the name still stands for the file that is open: another process may have renamed it in between.
bool is_still(int descriptor, const std::string& path) {
  struct stat open_file {
  }, named_file{};
  return fstat(descriptor, &open_file) == 0 && stat(path.c_str(), &named_file) == 0 &&
         open_file.st_dev == named_file.st_dev && open_file.st_ino == named_file.st_ino;
}

}  // namespace

Checkpoint read_checkpoint(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(path + ": cannot be read: " + error_text(ENOENT));
  if (!std::filesystem::is_regular_file(status)) throw InputError(path + ": cannot be read: it is no file");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  if (error || !file) throw InputError(path + ": cannot be read: " + error_text(errno));

  std::string bytes(checkpoint_layout::k_preamble_bytes, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  // A large file that is something else is refused by its beginning.
  if (!bytes.starts_with(checkpoint_layout::k_magic) || size <= bytes.size()) return decode_checkpoint(bytes, path);
  const std::size_t begun = bytes.size();
  bytes.resize(static_cast<std::size_t>(size));
  file.read(bytes.data() + begun, static_cast<std::streamsize>(bytes.size() - begun));
  if (file.bad()) throw InputError(path + ": cannot be read to its end: " + error_text(EIO));
  bytes.resize(begun + static_cast<std::size_t>(file.gcount()));
  return decode_checkpoint(bytes, path);
}

CheckpointFile::CheckpointFile(std::string path) : path_(std::move(path)) {
  // Through a link its target is replaced: the link keeps pointing where it did.
  std::error_code error;
  const auto target = std::filesystem::canonical(path_, error);
  if (!error && std::filesystem::is_symlink(path_, error)) path_ = target.string();
  part_ = path_ + ".part";
}

CheckpointFile::~CheckpointFile() { drop(); }

void CheckpointFile::reserve(std::uint64_t bytes) {
  open();
  // Only file systems that can claim space are asked to: writing zeros instead would take as long as the checkpoint.
  while (fallocate(descriptor_, 0, 0, static_cast<off_t>(bytes)) != 0) {
    if (errno == EINTR) continue;
    if (errno == EOPNOTSUPP || errno == ENOSYS) return;
    fail("cannot claim " + std::to_string(bytes) + " bytes for a checkpoint", errno);
  }
}

void CheckpointFile::write(std::string_view bytes) {
  open();
  if (const int error = write_all(descriptor_, bytes); error != 0) fail("cannot be written", error);
  if (fsync(descriptor_) != 0) fail("cannot be brought to the disk", errno);
  if (std::rename(part_.c_str(), path_.c_str()) != 0) fail("cannot be replaced", errno);
  close(std::exchange(descriptor_, -1));
  sync_folder_of(path_);
}

void CheckpointFile::open() {
  if (descriptor_ >= 0) return;
  std::error_code error;
  const auto status = std::filesystem::status(path_, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw InputError(path_ + ": cannot be a checkpoint: it is no file");
  constexpr int k_tries = 100;
  for (int tries = 0; tries < k_tries; ++tries) {
    const int descriptor = ::open(part_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0)
      throw InputError(part_ + ": cannot be made: " + error_text(errno) + "; check the folder and its rights");
    if (flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
      close(descriptor);
      throw InputError(path_ + ": another run writes its checkpoints here; name another file");
    }
    if (is_still(descriptor, part_)) {
      descriptor_ = descriptor;
      return;
    }
    close(descriptor);
  }
  throw InputError(path_ + ": another run writes its checkpoints here; name another file");
}

void CheckpointFile::drop() {
  if (descriptor_ < 0) return;
  unlink(part_.c_str());
  close(std::exchange(descriptor_, -1));
}

void CheckpointFile::fail(const std::string& doing, int error) {
  drop();
  throw InputError(path_ + ": " + doing + ": " + error_text(error) +
                   "; check the folder, its rights and free space. What was there before is unchanged");
}

}  // namespace squall
