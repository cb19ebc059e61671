// SPDX-License-Identifier: Apache-2.0
#include "cli/private_directory.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

class PrivateDirectories : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "gaitd-test-XXXXXX";
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    parent_ = name;
  }
  void TearDown() override { fs::remove_all(parent_); }
  std::ptrdiff_t count() const {
    return std::distance(fs::directory_iterator(parent_), fs::directory_iterator());
  }

  std::string parent_;
};

TEST_F(PrivateDirectories, GoAwayWithTheirObject) {
  auto first = std::make_unique<PrivateDirectory>(parent_);
  const PrivateDirectory second(parent_);
  EXPECT_TRUE(fs::is_directory(first->path()));
  EXPECT_TRUE(fs::is_directory(second.path()));
  std::ofstream(first->path() + "/file") << "x";
  first.reset();
  EXPECT_EQ(count(), 1);
}

TEST_F(PrivateDirectories, OfAKilledProcessGoAwayWithTheNextOne) {
  const pid_t child = fork();
  if (child == 0) {
    const PrivateDirectory directory(parent_);
    std::ofstream(directory.path() + "/gaitd.sock") << "x";
    raise(SIGKILL);
  }
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
  EXPECT_EQ(count(), 1);
  const PrivateDirectory next(parent_);
  EXPECT_EQ(count(), 1);
  EXPECT_TRUE(fs::is_empty(next.path()));
}

}  // namespace
}  // namespace gaitd::cli
