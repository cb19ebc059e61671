// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/output_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>

#include "daemon/telemetry/test/fixture.h"

namespace gaitd::daemon {
namespace {

class WrittenLog : public testing::Test {
 protected:
  void SetUp() override {
    path_ = test_path("log.mcap");
    std::string error;
    ASSERT_TRUE(writer_.open(path_, {}, {}, &error)) << error;
    write();
    ASSERT_TRUE(writer_.ok()) << writer_.error();
  }
  void write() {
    writer_.write_tick(tick_, 0.001 * tick_, sample_values(sample_table(), tick_), nullptr);
    ++tick_;
    writer_.flush();
  }
  // The log has ended, and says why.
  void expect_end(const std::string& part) {
    write();
    EXPECT_FALSE(writer_.ok());
    EXPECT_FALSE(writer_.is_open());
    EXPECT_NE(writer_.error().find(part), std::string::npos) << writer_.error();
    EXPECT_EQ(writer_.error().rfind(path_, 0), 0u) << writer_.error();
    EXPECT_FALSE(writer_.close());
  }

  std::string path_;
  LogWriter writer_{sample_table()};
  int tick_ = 0;
};

TEST_F(WrittenLog, ThatIsLeftAloneIsComplete) {
  write();
  EXPECT_TRUE(writer_.is_open());
  EXPECT_TRUE(writer_.close()) << writer_.error();
}

TEST_F(WrittenLog, ThatIsRemovedIsAnError) {
  std::remove(path_.c_str());
  expect_end("removed or renamed");
}

TEST_F(WrittenLog, ThatIsReplacedIsAnError) {
  const std::string other = path_ + ".other";
  write_file(other, "something else");
  ASSERT_EQ(std::rename(other.c_str(), path_.c_str()), 0);
  expect_end("another file took the place");
  EXPECT_EQ(read_file(path_), "something else");
}

TEST_F(WrittenLog, ThatIsCutOffIsAnError) {
  ASSERT_EQ(truncate(path_.c_str(), 100), 0);
  expect_end("cut off by somebody else");
}

TEST_F(WrittenLog, ThatIsRemovedBeforeItsEndIsAnErrorThen) {
  std::remove(path_.c_str());
  EXPECT_FALSE(writer_.close());
  EXPECT_NE(writer_.error().find("removed"), std::string::npos) << writer_.error();
}

TEST(OutputFile, WaitsForNobodyToReadAPipe) {
  const std::string path = test_path("pipe");
  std::remove(path.c_str());
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  OutputFile file;
  EXPECT_FALSE(file.open(path));
  EXPECT_NE(file.error().find("let somebody read the pipe"), std::string::npos) << file.error();
  // With a reader it is written, and waits while the pipe is full.
  const int reader = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(reader, 0);
  EXPECT_TRUE(file.open(path)) << file.error();
  std::thread late([reader] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    char buffer[65536];
    for (std::size_t left = 300000; left > 0;) {
      const ssize_t n = read(reader, buffer, std::min(left, sizeof(buffer)));
      if (n > 0) left -= static_cast<std::size_t>(n);
    }
  });
  EXPECT_TRUE(file.write(std::string(300000, 'x'))) << file.error();
  late.join();
  close(reader);
}

TEST(OutputFile, IsNotOpenAfterAFailure) {
  OutputFile file;
  ASSERT_TRUE(file.open("/dev/full"));
  EXPECT_FALSE(file.write("a"));
  EXPECT_FALSE(file.is_open());
  EXPECT_NE(file.error().find("free some space"), std::string::npos) << file.error();
  EXPECT_FALSE(file.write("b"));
}

}  // namespace
}  // namespace gaitd::daemon
