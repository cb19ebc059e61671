// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/paths.h"

#include <gtest/gtest.h>

#include "daemon/config/test/temporary_folder.h"

namespace gaitd::daemon {
namespace {

TEST(Paths, FindsTheSourceTreeAboveABuildTree) {
  TemporaryFolder folder;
  folder.write("robots/tiny/robot.yaml", "");
  folder.write("sim/scenarios/walk.yaml", "");
  folder.write("etc/gaitd.yaml", "");
  folder.write("build/release/lib/gaitd/plugins/toe_off/never.so", "");
  const Paths paths(folder.path() / "build/release/bin/gaitd", "");
  EXPECT_EQ(paths.robot("tiny"), folder.path() / "robots/tiny/robot.yaml");
  EXPECT_EQ(paths.scenario("walk"), folder.path() / "sim/scenarios/walk.yaml");
  EXPECT_EQ(paths.config(), folder.path() / "etc/gaitd.yaml");
  ASSERT_EQ(paths.plugin_folders().size(), 1u);
  EXPECT_EQ(paths.plugin_folders()[0], folder.path() / "build/release/lib/gaitd/plugins");
  EXPECT_EQ(paths.robots(), std::vector<std::string>{"tiny"});
  EXPECT_EQ(paths.scenarios(), std::vector<std::string>{"walk"});
  EXPECT_FALSE(paths.robot("huge"));
  EXPECT_FALSE(paths.scenario("run"));
}

TEST(Paths, FindsTheSourceTreeOfABuildTreeElsewhere) {
  TemporaryFolder source;
  TemporaryFolder build;
  source.write("robots/tiny/robot.yaml", "");
  build.write("gaitd-source-tree", source.path().string() + "\n");
  const Paths paths(build.path() / "bin/gaitd", "");
  EXPECT_EQ(paths.robot("tiny"), source.path() / "robots/tiny/robot.yaml");
}

TEST(Paths, FindsWhatIsInstalledBesideTheProgram) {
  TemporaryFolder prefix;
  prefix.write("share/gaitd/robots/tiny/robot.yaml", "");
  prefix.write("share/gaitd/scenarios/walk.yaml", "");
  prefix.write("lib/gaitd/plugins/toe_off/never.so", "");
  prefix.write("etc/gaitd/gaitd.yaml", "");
  const Paths paths(prefix.path() / "bin/gaitd", "");
  EXPECT_EQ(paths.robot("tiny"), prefix.path() / "share/gaitd/robots/tiny/robot.yaml");
  EXPECT_EQ(paths.scenario("walk"), prefix.path() / "share/gaitd/scenarios/walk.yaml");
  EXPECT_EQ(paths.config(), prefix.path() / "etc/gaitd/gaitd.yaml");
  ASSERT_EQ(paths.plugin_folders().size(), 1u);
}

TEST(Paths, TheSearchPathComesFirst) {
  TemporaryFolder prefix;
  TemporaryFolder mine;
  prefix.write("share/gaitd/robots/tiny/robot.yaml", "");
  mine.write("robots/tiny/robot.yaml", "");
  mine.write("plugins/toe_off/mine.so", "");
  const Paths paths(prefix.path() / "bin/gaitd", ":/nowhere:" + mine.path().string());
  EXPECT_EQ(paths.robot("tiny"), mine.path() / "robots/tiny/robot.yaml");
  ASSERT_EQ(paths.plugin_folders().size(), 1u);
  EXPECT_EQ(paths.robots().size(), 1u);
}

TEST(Paths, TakesAPathAsItIs) {
  TemporaryFolder folder;
  const std::string file = folder.write("my-robot.yaml", "");
  const Paths paths("/nowhere/bin/gaitd", "");
  EXPECT_EQ(paths.robot(file), file);
  EXPECT_FALSE(paths.robot(file + ".yaml"));
}

TEST(Paths, ThisProgramFindsAtlas) {
  const Paths paths = Paths::detect();
  EXPECT_TRUE(paths.robot("atlas"));
  EXPECT_TRUE(paths.scenario("stand"));
  EXPECT_TRUE(paths.config());
}

}  // namespace
}  // namespace gaitd::daemon
