// SPDX-License-Identifier: Apache-2.0
#include "daemon/host/library_folders.h"

#include <gtest/gtest.h>

#include "daemon/host/test/test_files.h"

namespace gaitd::daemon {
namespace {

namespace fs = std::filesystem;

class Folders : public ::testing::Test {
 protected:
  void SetUp() override {
    top_ = fs::canonical(directory_.path());
    fs::create_directories(top_ / "allowed" / "deep");
    fs::create_directory(top_ / "allowed-too");
    for (const char* file : {"allowed/a.so", "allowed/deep/b.so", "allowed-too/c.so", "d.so"}) {
      write_file(top_ / file, {'x'});
    }
    fs::create_symlink(top_ / "d.so", top_ / "allowed" / "out.so");
    fs::create_symlink(top_, top_ / "allowed" / "up");
    fs::create_symlink("a.so", top_ / "allowed" / "in.so");
    fs::create_directory_symlink(top_ / "allowed", top_ / "alias");
  }
  std::optional<fs::path> admit(const LibraryFolders& folders, const fs::path& file) {
    error_.clear();
    return folders.admit(file.string(), &error_);
  }

  TemporaryDirectory directory_;
  fs::path top_;
  std::string error_;
};

TEST_F(Folders, AdmitsWhatLiesInThem) {
  const LibraryFolders folders({top_ / "allowed/"});
  EXPECT_EQ(admit(folders, top_ / "allowed/a.so"), top_ / "allowed/a.so");
  EXPECT_EQ(admit(folders, top_ / "allowed/deep/b.so"), top_ / "allowed/deep/b.so");
  EXPECT_EQ(admit(folders, top_ / "allowed/deep/../a.so"), top_ / "allowed/a.so");
  EXPECT_EQ(admit(folders, top_ / "allowed/in.so"), top_ / "allowed/a.so");
}

TEST_F(Folders, RefusesWhatLiesElsewhere) {
  const LibraryFolders folders({top_ / "allowed"});
  for (const char* file : {"d.so", "allowed-too/c.so", "allowed/../d.so", "allowed/out.so",
                           "allowed/up/d.so", "allowed/up/allowed/../d.so", "none.so"}) {
    EXPECT_FALSE(admit(folders, top_ / file)) << file;
    EXPECT_NE(error_.find("plugins.folders"), std::string::npos) << error_;
  }
  EXPECT_FALSE(admit(folders, "a.so"));
  EXPECT_FALSE(admit(folders, ""));
  EXPECT_FALSE(admit(LibraryFolders(), top_ / "allowed/a.so"));
}

TEST_F(Folders, RefusesWhatEverybodyMayChange) {
  const LibraryFolders folders({top_ / "allowed"});
  for (const char* open : {"allowed", "allowed/deep", "allowed/deep/b.so"}) {
    fs::permissions(top_ / open, fs::perms::others_write, fs::perm_options::add);
    EXPECT_FALSE(admit(folders, top_ / "allowed/deep/b.so")) << open;
    EXPECT_NE(error_.find((top_ / open).string() + " is writable by all"), std::string::npos)
        << error_;
    fs::permissions(top_ / open, fs::perms::others_write, fs::perm_options::remove);
    EXPECT_TRUE(admit(folders, top_ / "allowed/deep/b.so")) << error_;
  }
}

TEST_F(Folders, SaysWhatIsNotThere) {
  EXPECT_FALSE(admit(LibraryFolders({top_ / "allowed"}), top_ / "allowed/none.so"));
  EXPECT_NE(error_.find("No such file"), std::string::npos) << error_;
}

TEST_F(Folders, MayBeNamedThroughALink) {
  const LibraryFolders folders({top_ / "alias"});
  EXPECT_EQ(admit(folders, top_ / "alias/a.so"), top_ / "allowed/a.so");
  EXPECT_EQ(admit(folders, top_ / "allowed/a.so"), top_ / "allowed/a.so");
}

}  // namespace
}  // namespace gaitd::daemon
