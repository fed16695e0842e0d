#include "core/checkpoint_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "core/errors.h"
#include "core/text_file.h"

namespace squall::test {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class CheckpointFiles : public testing::Test {
 protected:
  CheckpointFiles() {
    std::string name = (fs::temp_directory_path() / "squall_test_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a temporary folder");
    folder_ = name;
  }
  ~CheckpointFiles() override { fs::remove_all(folder_); }

  std::string in_folder(const std::string& name) const { return (folder_ / name).string(); }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

 private:
  fs::path folder_;
};

template <class Function>
std::string refusal(Function&& function) {
  try {
    function();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

/// A limit on the size of files, as a full disk is one; put back when it goes.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

TEST_F(CheckpointFiles, WhatIsWrittenIsThereAndNothingElse) {
  CheckpointFile file(in_folder("run.sqc"));
  for (const std::string& text : {std::string(100000, 'a'), std::string("short"), std::string()}) {
    file.reserve(200000);
    file.write(text);
    EXPECT_EQ(read_text_file(in_folder("run.sqc")), text) << "no more than was written, whatever was claimed";
    EXPECT_EQ(files(), 1u);
  }
}

TEST_F(CheckpointFiles, SpaceThatWasClaimedInVainIsGivenBack) {
  { CheckpointFile(in_folder("run.sqc")).reserve(1000); }
  EXPECT_EQ(files(), 0u);
}

TEST_F(CheckpointFiles, AFullDiskLeavesTheFileBefore) {
  CheckpointFile file(in_folder("run.sqc"));
  file.write("before");
  {
    const FileSizeLimit limit(1000);
    EXPECT_THAT(refusal([&] { file.write(std::string(2000, 'x')); }), HasSubstr("run.sqc: cannot be written: "));
    EXPECT_THAT(refusal([&] { file.reserve(2000); }), HasSubstr("cannot claim 2000 bytes"));
    EXPECT_EQ(read_text_file(in_folder("run.sqc")), "before");
    EXPECT_EQ(files(), 1u) << "no half of a file stays";
  }
  file.write("after");
  EXPECT_EQ(read_text_file(in_folder("run.sqc")), "after");
}

TEST_F(CheckpointFiles, PlacesThatTakeNoFileAreNamed) {
  EXPECT_THAT(refusal([&] { CheckpointFile(in_folder("no/run.sqc")).reserve(1); }),
              HasSubstr("no/run.sqc.part: cannot be made: No such file or directory"));
  EXPECT_THAT(refusal([&] { CheckpointFile(in_folder("")).reserve(1); }), HasSubstr("is no file"));
  EXPECT_THAT(refusal([&] { CheckpointFile("/dev/null").reserve(1); }), HasSubstr("/dev/null: cannot be a checkpoint"));
  EXPECT_THAT(refusal([&] { CheckpointFile("/proc/run.sqc").reserve(1); }), HasSubstr("cannot be made"));
}

TEST_F(CheckpointFiles, AFolderThatTakesItsPlaceStays) {
  CheckpointFile file(in_folder("run.sqc"));
  file.reserve(10);
  fs::create_directory(in_folder("run.sqc"));
  EXPECT_THAT(refusal([&] { file.write("water"); }), HasSubstr("cannot be replaced"));
  EXPECT_TRUE(fs::is_directory(in_folder("run.sqc")));
  EXPECT_EQ(files(), 1u);
}

TEST_F(CheckpointFiles, OneWriterAtATime) {
  CheckpointFile first(in_folder("run.sqc")), second(in_folder("run.sqc"));
  first.reserve(10);
  EXPECT_THAT(refusal([&] { second.write("other"); }), HasSubstr("another run writes"));
  first.write("mine");
  EXPECT_EQ(read_text_file(in_folder("run.sqc")), "mine");
  second.write("other");
  EXPECT_EQ(read_text_file(in_folder("run.sqc")), "other");
}

TEST_F(CheckpointFiles, WhatAKilledWriterLeftIsNoObstacle) {
  std::ofstream(in_folder("run.sqc.part")) << std::string(5000, 'x');
  CheckpointFile(in_folder("run.sqc")).write("water");
  EXPECT_EQ(read_text_file(in_folder("run.sqc")), "water");
  EXPECT_EQ(files(), 1u);
}

// Killed anywhere: the name stands for one whole content or the other.
TEST_F(CheckpointFiles, AKilledWriterLeavesAWholeFile) {
  const std::string path = in_folder("run.sqc");
  CheckpointFile(path).write(std::string(50000, 'a'));
  for (int round = 0; round < 30; ++round) {
    const pid_t child = fork();
    if (child == 0) {
      CheckpointFile file(path);
      for (std::size_t i = 0;; ++i) file.write(std::string(50000 + i % 7, static_cast<char>('a' + i % 26)));
    }
    usleep(static_cast<useconds_t>(500 + 331 * round));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    const std::string text = read_text_file(path);
    ASSERT_GE(text.size(), 50000u);
    ASSERT_EQ(text.find_first_not_of(text[0]), std::string::npos) << "two contents in one file";
  }
}

TEST_F(CheckpointFiles, AreReadOnlyWhereTheyAreOnes) {
  EXPECT_THAT(refusal([&] { read_checkpoint(in_folder("none.sqc")); }), HasSubstr("No such file"));
  EXPECT_THAT(refusal([&] { read_checkpoint(in_folder("")); }), HasSubstr("is no file"));
  EXPECT_THAT(refusal([&] { read_checkpoint("/dev/zero"); }), HasSubstr("is no file"));
  std::ofstream(in_folder("scene.toml")) << "schema = 1\n" << std::string(100, '#');
  EXPECT_THAT(refusal([&] { read_checkpoint(in_folder("scene.toml")); }), HasSubstr("is no squall checkpoint"));
  std::ofstream(in_folder("empty.sqc")) << "";
  EXPECT_THAT(refusal([&] { read_checkpoint(in_folder("empty.sqc")); }), HasSubstr("is empty"));

  Checkpoint checkpoint;
  checkpoint.scene_text = "schema = 1\n";
  CheckpointFile(in_folder("run.sqc")).write(encode_checkpoint(checkpoint));
  EXPECT_EQ(read_checkpoint(in_folder("run.sqc")).scene_text, checkpoint.scene_text);
  fs::resize_file(in_folder("run.sqc"), fs::file_size(in_folder("run.sqc")) - 1);
  EXPECT_THAT(refusal([&] { read_checkpoint(in_folder("run.sqc")); }), HasSubstr("is cut off"));
}

}  // namespace
}  // namespace squall::test
