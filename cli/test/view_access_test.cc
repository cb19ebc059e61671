// SPDX-License-Identifier: Apache-2.0
#include "cli/view/access.h"

#include <gtest/gtest.h>

#include <set>

namespace gaitd::cli {
namespace {

using daemon::Role;

TEST(Access, EachRoleUpToTheHighestHasASecretOfItsOwn) {
  const Access access(Role::kCommand, {});
  std::set<std::string> tokens;
  for (const Role role : {Role::kObserve, Role::kCommand}) {
    EXPECT_EQ(access.token(role).size(), 32u);
    EXPECT_EQ(access.role_of(access.token(role)), role);
    tokens.insert(access.token(role));
  }
  EXPECT_EQ(tokens.size(), 2u);
  EXPECT_EQ(access.token(Role::kAdminister), "");
  EXPECT_EQ(access.role_of(""), std::nullopt);
  EXPECT_EQ(access.role_of(std::string(32, '0')), std::nullopt);
  EXPECT_EQ(access.role_of(access.token(Role::kCommand).substr(1)), std::nullopt);
  EXPECT_NE(Access(Role::kObserve, {}).token(Role::kObserve), access.token(Role::kObserve));
}

TEST(Access, OnlyNamesOfThisMachineAreItsHosts) {
  for (const char* own :
       {"127.0.0.1:8765", "[::1]:8765", "localhost", "LOCALHOST:80", "10.0.0.7:1"}) {
    EXPECT_TRUE(Access::is_own_host(own)) << own;
  }
  for (const char* foreign : {"", "evil.example", "evil.example:8765", "127.0.0.1.evil.example",
                              "localhost.evil.example:80", "[::1", ":8765"}) {
    EXPECT_FALSE(Access::is_own_host(foreign)) << foreign;
  }
}

TEST(Access, APageConnectsToWhereItCameFrom) {
  const Access access(Role::kCommand, {"https://app.foxglove.dev"});
  EXPECT_TRUE(access.allows_origin("", "127.0.0.1:8765", false));
  EXPECT_TRUE(access.allows_origin("http://127.0.0.1:8765", "127.0.0.1:8765", false));
  EXPECT_TRUE(access.allows_origin("https://Robot:8765", "robot:8765", true));
  EXPECT_TRUE(access.allows_origin("https://app.foxglove.dev", "127.0.0.1:8765", false));
  EXPECT_FALSE(access.allows_origin("http://127.0.0.1:9000", "127.0.0.1:8765", false));
  EXPECT_FALSE(access.allows_origin("http://127.0.0.1:8765", "127.0.0.1:8765", true));
  EXPECT_TRUE(access.allows_origin("file://", "127.0.0.1:8765", false));
  EXPECT_FALSE(access.allows_origin("null", "127.0.0.1:8765", false));
  EXPECT_FALSE(access.allows_origin("file://evil.example", "127.0.0.1:8765", false));
  EXPECT_FALSE(
      access.allows_origin("https://app.foxglove.dev.evil.example", "127.0.0.1:8765", false));
}

TEST(ListenAddress, IsReadOrSaidWhyNot) {
  std::string error;
  const auto read = [&](const std::string& text) { return parse_listen_address(text, &error); };
  EXPECT_EQ(read("127.0.0.1:8765")->port, 8765);
  EXPECT_EQ(read("9000")->address, "127.0.0.1");
  EXPECT_EQ(read("localhost:1")->address, "127.0.0.1");
  EXPECT_TRUE(read("[::1]:8765")->loopback);
  EXPECT_EQ(read("[::1]:8765")->address, "::1");
  EXPECT_FALSE(read("0.0.0.0:8765")->loopback);
  for (const char* wrong :
       {"", ":", "robot:8765", "127.0.0.1:", "127.0.0.1:99999", "1.2.3:80", "::1:x"}) {
    error.clear();
    EXPECT_FALSE(read(wrong)) << wrong;
    EXPECT_NE(error.find("127.0.0.1:8765"), std::string::npos) << wrong;
  }
}

}  // namespace
}  // namespace gaitd::cli
