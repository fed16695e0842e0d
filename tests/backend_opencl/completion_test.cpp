#include "backend_opencl/completion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "backend_opencl/device.h"
#include "backend_opencl/errors.h"
#include "backend_opencl/overlap.h"

namespace squall::opencl {
namespace {

// A command that depends on one that failed fails, too, and whoever waits for it is told as a DeviceError.
TEST(Completion, AFailedTransferIsADeviceError) {
  Machine machine = open_machine(Settings{});
  const cl::Buffer buffer(machine.context, CL_MEM_READ_WRITE, 64);
  cl::UserEvent cause(machine.context);
  const std::vector<cl::Event> after{cause};
  std::array<char, 64> memory{};
  cl::Event delivered;
  machine.queue.enqueueReadBuffer(buffer, CL_FALSE, 0, 64, memory.data(), &after, &delivered);
  machine.queue.flush();
  cause.setStatus(CL_OUT_OF_RESOURCES);
  const auto wait = [&] { translate_errors("this device", [&] { wait_for(delivered, "delivering positions"); }); };
  using testing::HasSubstr, testing::Not, testing::AllOf;
  EXPECT_THAT(wait, testing::ThrowsMessage<DeviceError>(AllOf(HasSubstr("delivering positions failed with CL_"),
                                                              HasSubstr(" on this device"),
                                                              Not(HasSubstr("CL_DEVICE_NOT_FOUND")))));
}

TEST(Completion, WaitingForWhatIsDoneIsNoError) {
  Machine machine = open_machine(Settings{});
  cl::Event done;
  machine.queue.enqueueMarkerWithWaitList(nullptr, &done);
  const Completion completion(done);
  EXPECT_NO_THROW(wait_for(done, "a marker"));
  const Completion::Time never{};
  EXPECT_GT(completion.time(never), never);
}

TEST(Overlap, CountsWhatRanBesideOthers) {
  EXPECT_EQ(total({}), 0.0);
  EXPECT_EQ(hidden({}, {{0, 1}}), 0.0);
  EXPECT_EQ(hidden({{0, 1}}, {}), 0.0);
  EXPECT_EQ(total({{0, 1}, {0.5, 2.5}}), 3.0) << "each for itself";
  EXPECT_EQ(hidden({{1, 4}}, {{0, 2}, {3, 5}}), 2.0);
  EXPECT_EQ(hidden({{1, 4}}, {{3, 5}, {0, 2}, {1, 2}, {1.5, 2.5}}), 2.5) << "others that overlap count once";
  EXPECT_EQ(hidden({{0, 1}, {2, 3}}, {{0.5, 2.5}}), 1.0);
  EXPECT_EQ(hidden({{0, 1}}, {{1, 2}}), 0.0) << "one after the other";
}

}  // namespace
}  // namespace squall::opencl
