// SPDX-License-Identifier: Apache-2.0
// A file in the place of the device.
#include "daemon/app/cpu_latency.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

namespace gaitd::daemon {
namespace {

namespace fs = std::filesystem;

class CpuLatencyTest : public ::testing::Test {
 protected:
  CpuLatencyTest() { std::ofstream(path).flush(); }
  ~CpuLatencyTest() override { fs::remove_all(path); }

  std::string content() const {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  // How often this process has the file open.
  int times_open() const {
    int count = 0;
    for (const auto& entry : fs::directory_iterator("/proc/self/fd")) {
      std::error_code gone;
      if (fs::read_symlink(entry.path(), gone) == path) ++count;
    }
    return count;
  }

  const std::string path = fs::canonical(::testing::TempDir()) / "gaitd_cpu_latency";
  std::string error;
};

TEST_F(CpuLatencyTest, AsksInMicrosecondsAsFourBytes) {
  for (const auto& [seconds, us] :
       {std::pair{0.0, 0}, {20e-6, 20}, {1.5e-6, 2}, {2000.0, 2000000000}}) {
    CpuLatency latency(path);
    EXPECT_TRUE(latency.hold(seconds, &error)) << error;
    const std::string written = content();
    ASSERT_EQ(written.size(), sizeof(std::int32_t));
    std::int32_t value = -1;
    std::memcpy(&value, written.data(), sizeof(value));
    EXPECT_EQ(value, us);
  }
}

TEST_F(CpuLatencyTest, TheRequestLastsAsLongAsTheObject) {
  {
    CpuLatency latency(path);
    EXPECT_FALSE(latency.held());
    EXPECT_EQ(times_open(), 0);
    ASSERT_TRUE(latency.hold(0.0, &error)) << error;
    EXPECT_TRUE(latency.held());
    EXPECT_EQ(times_open(), 1);
  }
  EXPECT_EQ(times_open(), 0);
}

TEST_F(CpuLatencyTest, AKernelWithoutIdleStatesIsNoError) {
  CpuLatency latency(path + "_none");
  EXPECT_TRUE(latency.hold(0.0, &error));
  EXPECT_FALSE(latency.held());
  EXPECT_EQ(error, "");
}

TEST_F(CpuLatencyTest, ADeviceThatCannotBeOpenedIsToldWithWhatToDo) {
  fs::remove(path);
  fs::create_directory(path);
  CpuLatency latency(path);
  EXPECT_FALSE(latency.hold(0.0, &error));
  EXPECT_FALSE(latency.held());
  EXPECT_NE(error.find(path + ": Is a directory; "), std::string::npos) << error;
  EXPECT_NE(error.find("udev rule"), std::string::npos) << error;
}

TEST(CpuLatencyDevice, ThatTakesNothingIsClosedAgain) {
  CpuLatency latency("/dev/full");
  std::string error;
  EXPECT_FALSE(latency.hold(0.0, &error));
  EXPECT_FALSE(latency.held());
  EXPECT_NE(error.find("No space left on device"), std::string::npos) << error;
}

}  // namespace
}  // namespace gaitd::daemon
