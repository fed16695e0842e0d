#include <gtest/gtest.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "app/program.h"

namespace squall::app {
namespace {

Outcome run_tiny(std::vector<std::string> more) {
  // One width of vectors: each has kernels of its own to build.
  std::vector<std::string> arguments{"run",  k_tiny,     "--backend", "opencl", "--simd",
                                     "avx2", "--frames", "2",         "--json", "-"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return squall(arguments);
}

nlohmann::json row_of(const Outcome& outcome) {
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return nlohmann::json::parse(outcome.out).at("runs").at(0);
}

std::string hash_of(const Outcome& outcome) { return row_of(outcome).at("state_hash"); }

bool says(const Outcome& outcome, const std::string& text) { return outcome.err.find(text) != std::string::npos; }

TEST(TuneOption, MeasuresRemembersAndChangesNoBit) {
  const TemporaryFolder folder;
  const std::string table = folder / "deep/er/table.tsv";
  const Outcome plain = run_tiny({"--tuning", "none"});
  const Outcome before = run_tiny({"--tuning", table});
  const Outcome tuned = run_tiny({"--tune", "--tuning", table});
  const Outcome later = run_tiny({"--tuning", table});
  EXPECT_FALSE(says(plain, "tuned")) << plain.err;
  EXPECT_FALSE(says(before, "tuned")) << before.err;
  EXPECT_TRUE(says(before, table + " is no tuning table")) << before.err;
  EXPECT_TRUE(says(tuned, "tuned: ") && says(tuned, "ms per sub-step")) << tuned.err;
  EXPECT_TRUE(says(later, "with tuned work sizes: ")) << later.err;
  const nlohmann::json untuned = {{"group", 0}, {"parts", 0}, {"chunks", 0}};
  EXPECT_EQ(row_of(plain).at("work_sizes"), untuned);
  EXPECT_EQ(row_of(later).at("work_sizes"), row_of(tuned).at("work_sizes"));
  for (const Outcome* outcome : {&before, &tuned, &later}) EXPECT_EQ(hash_of(*outcome), hash_of(plain));
  const Outcome larger = run_tiny({"--tuning", table, "--particles", "500"});
  EXPECT_FALSE(says(larger, "tuned")) << "of another size class";
  EXPECT_TRUE(says(larger, "has no work sizes for it")) << larger.err;
  EXPECT_EQ(run_tiny({"--tune", "--tuning", table, "--json", folder / "deep/../deep/er/table.tsv"}).code, 2);
}

TEST(TuneOption, ADamagedTableHoldsNothing) {
  const TemporaryFolder folder;
  const std::string table = folder / "table.tsv";
  run_tiny({"--tune", "--tuning", table});
  const std::string good = text_of(table);
  ASSERT_NE(good.find("\tavx2 0 "), std::string::npos) << good;
  const auto with = [&](const std::string& text) {
    std::ofstream(table) << text;
    return run_tiny({"--tuning", table});
  };
  EXPECT_TRUE(says(with(good), "with tuned work sizes"));
  const std::string cut = good.substr(0, good.size() - 4), other_version = "squall tuning table 2" + good.substr(21);
  std::string too_many = good;
  too_many.replace(too_many.find("\tavx2 0 "), 8, "\tavx2 7 ");
  for (const std::string& bad : {cut, other_version, too_many, good + "?\n", std::string(), std::string(99, '\0')}) {
    const Outcome outcome = with(bad);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_FALSE(says(outcome, "tuned")) << bad;
  }
}

TEST(TuneOption, ATableThatCannotBeWrittenIsNoError) {
  const Outcome outcome = run_tiny({"--tune", "--tuning", "/dev/null/table.tsv"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome, "/dev/null/table.tsv: cannot write the tuning table")) << outcome.err;
}

TEST(TuneOption, NeverReplacesAnotherFile) {
  const TemporaryFolder folder;
  const std::string scene = folder / "mine.toml";
  std::ofstream(scene) << "schema = 1\n";
  const Outcome outcome = run_tiny({"--tune", "--tuning", scene});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome, "there is another file of this name")) << outcome.err;
  EXPECT_EQ(text_of(scene), "schema = 1\n");
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const Outcome piped = run_tiny({"--tune", "--tuning", pipe});
  EXPECT_EQ(piped.code, 0) << piped.err;
  EXPECT_TRUE(says(piped, "there is another file of this name")) << piped.err;
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST(TuneOption, BelongsToOpenCl) {
  const Outcome outcome = squall({"run", k_tiny, "--backend", "omp", "--tune"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(says(outcome, "--tune measures OpenCL devices")) << outcome.err;
  const Outcome table = squall({"run", k_tiny, "--backend", "omp", "--tuning", "none"});
  EXPECT_EQ(table.code, 2);
  EXPECT_TRUE(says(table, "--tuning names the work sizes of OpenCL devices")) << table.err;
  const Outcome variable = squall({"run", k_tiny, "--backend", "omp", "--frames", "1"}, {{"SQUALL_TUNE", "1"}});
  EXPECT_EQ(variable.code, 0) << variable.err;
  EXPECT_TRUE(says(variable, "SQUALL_TUNE is left out")) << variable.err;
}

}  // namespace
}  // namespace squall::app
