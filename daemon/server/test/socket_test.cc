// SPDX-License-Identifier: Apache-2.0
#include <grp.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "daemon/server/listening_socket.h"
#include "daemon/server/socket_path.h"
#include "daemon/server/test/raw_client.h"

namespace gaitd::daemon {
namespace {

class SocketPath : public ::testing::Test {
 protected:
  SocketPath() {
    std::filesystem::create_directory(directory_.file("run"));
    std::filesystem::create_directory(directory_.file("xdg"));
    places_ = {directory_.file("run"), directory_.file("xdg"), directory_.file("user")};
  }
  SocketDirectory directory_;
  SocketPlaces places_;
  std::string error_;
};

TEST_F(SocketPath, IsTheFirstPlaceThatCanBeWrittenTo) {
  EXPECT_EQ(listen_path("/a/b.sock", places_, &error_), "/a/b.sock");
  EXPECT_EQ(listen_path("", places_, &error_), directory_.file("run/gaitd.sock"));
  places_.system_directory = "/nowhere/gaitd";
  EXPECT_EQ(listen_path("", places_, &error_), directory_.file("xdg/gaitd.sock"));
  places_.runtime_directory = "";
  EXPECT_EQ(listen_path("", places_, &error_), directory_.file("user/gaitd.sock"));
  struct stat info {};
  ASSERT_EQ(stat(directory_.file("user").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0700u);
}

TEST_F(SocketPath, IsNotInADirectoryThatOthersCanWriteTo) {
  places_.system_directory = "/nowhere";
  places_.runtime_directory = "";
  std::filesystem::create_directory(places_.user_directory);
  std::filesystem::permissions(places_.user_directory, std::filesystem::perms::all);
  EXPECT_EQ(listen_path("", places_, &error_), "");
  EXPECT_NE(error_.find("only this user can write to"), std::string::npos) << error_;
  std::filesystem::remove(places_.user_directory);
  std::filesystem::create_symlink(directory_.file("xdg"), places_.user_directory);
  EXPECT_EQ(listen_path("", places_, &error_), "");
}

TEST_F(SocketPath, IsRefusedWhenTooLong) {
  EXPECT_EQ(listen_path("/" + std::string(200, 'a'), places_, &error_), "");
  EXPECT_NE(error_.find("201 bytes, a socket address holds 107"), std::string::npos) << error_;
}

TEST_F(SocketPath, OfAClientIsLookedForInTheSameOrder) {
  EXPECT_EQ(connect_paths("/a", places_), std::vector<std::string>{"/a"});
  EXPECT_EQ(connect_paths("", places_),
            (std::vector<std::string>{directory_.file("run/gaitd.sock"),
                                      directory_.file("xdg/gaitd.sock"),
                                      directory_.file("user/gaitd.sock")}));
}

TEST(Listening, HasMode0660AndGoesAwayWithItsOwner) {
  const SocketDirectory directory;
  std::string error;
  auto socket = ListeningSocket::open(directory.file(), &error);
  ASSERT_TRUE(socket) << error;
  struct stat info {};
  ASSERT_EQ(stat(directory.file().c_str(), &info), 0);
  EXPECT_TRUE(S_ISSOCK(info.st_mode));
  EXPECT_EQ(info.st_mode & 0777, 0660u);
  // Who can open the lock can hold it, and then no gaitd starts here.
  ASSERT_EQ(stat((directory.file() + ".lock").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0600u);
  socket.reset();
  EXPECT_FALSE(std::filesystem::exists(directory.file()));
}

TEST(Listening, BelongsToTheGroupWhereThereIsOne) {
  const SocketDirectory directory;
  std::string error;
  // Root may give it to any group, others to one of theirs.
  gid_t own[64];
  const int count = getgroups(64, own);
  const gid_t wanted = getuid() == 0 ? 1 : count > 0 ? own[count - 1] : getgid();
  const group* entry = getgrgid(wanted);
  ASSERT_NE(entry, nullptr);
  const std::string name = entry->gr_name;
  struct stat info {};
  auto socket = ListeningSocket::open(directory.file(), &error, name);
  ASSERT_TRUE(socket) << error;
  ASSERT_EQ(stat(directory.file().c_str(), &info), 0);
  EXPECT_EQ(info.st_gid, wanted);
  EXPECT_EQ(info.st_uid, geteuid());
  EXPECT_EQ(info.st_mode & 0777, 0660u);
  socket = nullptr;
  socket = ListeningSocket::open(directory.file(), &error, "no-such-group");
  ASSERT_TRUE(socket) << error;
  ASSERT_EQ(stat(directory.file().c_str(), &info), 0);
  EXPECT_EQ(info.st_gid, getegid());
}

TEST(Listening, FollowsNoSymbolicLink) {
  const SocketDirectory directory;
  std::string error;
  std::filesystem::create_symlink(directory.file("elsewhere"), directory.file());
  EXPECT_FALSE(ListeningSocket::open(directory.file(), &error));
  EXPECT_NE(error.find("no socket is there"), std::string::npos) << error;
  const auto elsewhere = ListeningSocket::open(directory.file("elsewhere"), &error);
  ASSERT_TRUE(elsewhere) << error;
  EXPECT_FALSE(ListeningSocket::open(directory.file(), &error));
  EXPECT_TRUE(std::filesystem::is_symlink(directory.file()));
  EXPECT_TRUE(RawClient(directory.file("elsewhere")).connected());
  // Nor for its lock.
  std::filesystem::create_symlink(directory.file("precious"), directory.file("other.lock"));
  EXPECT_FALSE(ListeningSocket::open(directory.file("other"), &error));
  EXPECT_NE(error.find("symbolic links"), std::string::npos) << error;
  EXPECT_FALSE(std::filesystem::exists(directory.file("precious")));
}

TEST(Listening, KeepsASecondDaemonOut) {
  const SocketDirectory directory;
  std::string error;
  const auto first = ListeningSocket::open(directory.file(), &error);
  ASSERT_TRUE(first) << error;
  EXPECT_FALSE(ListeningSocket::open(directory.file(), &error));
  EXPECT_NE(error.find("another gaitd listens there already"), std::string::npos) << error;
  EXPECT_TRUE(RawClient(directory.file()).connected());
  // Also without its lock file, as another program would be.
  std::filesystem::remove(directory.file("gaitd.sock.lock"));
  EXPECT_FALSE(ListeningSocket::open(directory.file(), &error));
  EXPECT_TRUE(RawClient(directory.file()).connected());
}

TEST(Listening, ReplacesASocketThatNobodyListensOn) {
  const SocketDirectory directory;
  std::string error;
  {
    auto crashed = ListeningSocket::open(directory.file(), &error);
    ASSERT_TRUE(crashed) << error;
    std::filesystem::rename(directory.file(), directory.file("kept"));
  }
  std::filesystem::rename(directory.file("kept"), directory.file());
  EXPECT_FALSE(RawClient(directory.file()).connected());
  EXPECT_TRUE(ListeningSocket::open(directory.file(), &error)) << error;
}

TEST(Listening, NeverRemovesSomethingElse) {
  const SocketDirectory directory;
  std::ofstream(directory.file()) << "precious";
  std::string error;
  EXPECT_FALSE(ListeningSocket::open(directory.file(), &error));
  EXPECT_NE(error.find("no socket is there"), std::string::npos) << error;
  EXPECT_TRUE(std::filesystem::exists(directory.file()));
  EXPECT_FALSE(ListeningSocket::open("/nowhere/gaitd.sock", &error));
  EXPECT_NE(error.find("No such file or directory"), std::string::npos) << error;
}

}  // namespace
}  // namespace gaitd::daemon
