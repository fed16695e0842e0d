// The reader alone, on records made up here: sizes around a work group, coordinates at and beyond the range, and a
// device treated as one that shares no memory.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "backend_opencl/program.h"
#include "backend_opencl/readback.h"

namespace squall::opencl {
namespace {

struct Record {
  Eigen::Vector3f x = Eigen::Vector3f::Zero();
  float spare = 77;
  float velocity[4] = {7, 7, 7, 7};
};
static_assert(sizeof(Record) == 32);

Params<double> tank(bool lid) {
  Params<double> p{};
  p.size_x = 0.7f;
  p.size_y = 0.3f;
  p.size_z = 1.9f;
  p.lid = lid ? 1.0f : 0.0f;
  p.lost_distance = 3.0f;
  return p;
}

cl::Program delivery_kernels(const Machine& machine) {
  std::vector<KernelSource> sources;
  for (const auto& source : embedded_kernels())
    if (std::string(source.file).find("_positions.cl") != std::string::npos) sources.push_back(source);
  EXPECT_EQ(sources.size(), 2u);
  return build_program(machine.context, machine.device, sources, "-cl-std=CL1.2");
}

/// A reader, the records it reads, and a place for the view to be copied to.
class Bench {
 public:
  Bench(Readback mode, std::vector<Record> records, bool lid = true) : records_(std::move(records)) {
    layout_.params = tank(lid);
    layout_.capacity = records_.size();
    layout_.readback = mode;
    shape_ = make_shape(machine_, layout_);
    const std::size_t bytes = std::max<std::size_t>(records_.size(), 1) * sizeof(Record);
    buffers_.records = cl::Buffer(machine_.context, CL_MEM_READ_WRITE, bytes);
    if (!records_.empty())
      machine_.queue.enqueueWriteBuffer(buffers_.records, CL_TRUE, 0, records_.size() * sizeof(Record),
                                        records_.data());
    reader_.emplace(machine_, delivery_kernels(machine_), buffers_, layout_, shape_, false);
  }

  PositionsView deliver(std::size_t count) {
    const auto size = static_cast<int>(count);
    reader_->withdraw();
    reader_->before_frame(launcher_, size);
    cl::Event computed;
    machine_.queue.enqueueMarkerWithWaitList(nullptr, &computed);
    const Completion completion(computed);
    reader_->after_substep(launcher_, size);
    reader_->after_frame(launcher_, size);
    machine_.queue.finish();
    EXPECT_GE(reader_->finish(launcher_, completion), 0.0);
    return reader_->view();
  }

  const Record& record(std::size_t i) const { return records_[i]; }
  const PositionReader& reader() const { return *reader_; }

 private:
  Machine machine_ = open_machine(Settings{});
  Launcher launcher_{machine_.queue, false};
  Layout layout_;
  WorkShape shape_;
  Buffers buffers_;
  std::vector<Record> records_;
  std::optional<PositionReader> reader_;
};

std::vector<Record> random_records(std::size_t count, float top) {
  std::mt19937 random(static_cast<unsigned>(count) + 3);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  std::vector<Record> records(count);
  for (auto& record : records) record.x = {0.7f * unit(random), top * unit(random), 1.9f * unit(random)};
  return records;
}

class ReaderModes : public testing::TestWithParam<Readback> {};

TEST_P(ReaderModes, DeliverAnyNumberWithoutSharedMemory) {
  Bench bench(GetParam(), random_records(1000, 0.3f));
  for (const std::size_t count : {0u, 1u, 2u, 63u, 64u, 65u, 1000u, 3u}) {
    const PositionsView view = bench.deliver(count);
    ASSERT_EQ(view.count, count);
    for (std::size_t i = 0; i < count; ++i)
      ASSERT_TRUE(((view.position(i) - bench.record(i).x).cwiseAbs().array() <= view.error_bound().array()).all())
          << "particle " << i << " of " << count;
    const std::uint64_t each = GetParam() == Readback::quantized ? 12 : 32;
    EXPECT_EQ(bench.reader().copied_bytes(), each * count) << "nothing is shared: everything is counted";
  }
}

INSTANTIATE_TEST_SUITE_P(Opencl, ReaderModes,
                         testing::Values(Readback::blocking, Readback::pinned, Readback::mapped, Readback::async,
                                         Readback::quantized),
                         [](const auto& mode) { return std::string(to_string(mode.param)); });

TEST(Quantized, ErrorStaysWithinTheBoundAndReachesIt) {
  Bench bench(Readback::quantized, random_records(20'001, 3.3f), false);
  const PositionsView view = bench.deliver(20'001);
  Eigen::Array3f largest = Eigen::Array3f::Zero();
  for (std::size_t i = 0; i < view.count; ++i)
    largest = largest.max((view.position(i) - bench.record(i).x).cwiseAbs().array());
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LE(largest[axis], view.error_bound()[axis]);
    // Half a code is the bound's one large part; of 20,001 even errors none above 0.49 has probability 1e-176.
    EXPECT_GE(largest[axis], 0.49f * view.scale[axis]);
  }
}

TEST(Quantized, ShowsWhatIsOutsideAtTheEndsOfTheRange) {
  std::vector<Record> records(5);
  records[0].x = {-0.1f, -5.0f, -1e-9f};
  records[1].x = {0.8f, 0.31f, 1e20f};
  records[2].x = {0.7f, 0.3f, 1.9f};
  records[3].x = {0.0f, 0.0f, 0.0f};
  records[4].x = {1e30f, 1e30f, 1e30f};
  Bench bench(Readback::quantized, records);
  const PositionsView view = bench.deliver(5);
  const auto code = [&](std::size_t i, std::size_t axis) {
    return static_cast<const std::uint16_t*>(view.data)[3 * i + axis];
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(code(0, axis), 0);
    EXPECT_EQ(code(1, axis), 65534);
    EXPECT_EQ(code(2, axis), 65534);
    EXPECT_EQ(code(3, axis), 0);
    EXPECT_EQ(code(4, axis), 65535);
  }
  EXPECT_FALSE(view.lost(1));
  EXPECT_TRUE(view.lost(4));
}

}  // namespace
}  // namespace squall::opencl
