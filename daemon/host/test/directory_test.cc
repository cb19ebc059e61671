// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <thread>

#include "daemon/host/layers.h"
#include "daemon/host/plugin_directory.h"
#include "daemon/host/plugin_json.h"
#include "daemon/host/test/test_files.h"

namespace gaitd::daemon {
namespace {

TEST(Layers, HaveNamesBothWays) {
  EXPECT_EQ(layer_name(GAITD_LAYER_STEP_ADJUSTER), "step_adjuster");
  EXPECT_EQ(layer_name(99), "unknown");
  EXPECT_EQ(layer_from_name("backend"), GAITD_LAYER_BACKEND);
  EXPECT_FALSE(layer_from_name("unknown"));
}

TEST(Directory, FindsVariantsAndPathsAndNamesWhatThereIs) {
  const PluginDirectory plugins({"/nowhere", GAITD_TEST_PLUGINS});
  std::string error;
  EXPECT_EQ(plugins.find(GAITD_LAYER_TOE_OFF, "good", &error), plugin_path("good"));
  EXPECT_EQ(plugins.find(GAITD_LAYER_TOE_OFF, plugin_path("newer"), &error), plugin_path("newer"));
  EXPECT_FALSE(plugins.find(GAITD_LAYER_TOE_OFF, "goood", &error));
  EXPECT_NE(error.find("no variant 'goood' of toe_off in /nowhere"), std::string::npos) << error;
  EXPECT_NE(error.find(" good"), std::string::npos) << error;
  EXPECT_FALSE(plugins.find(GAITD_LAYER_TOE_OFF, "/nowhere/x.so", &error));
  EXPECT_FALSE(plugins.find(GAITD_LAYER_ICP_PLANNER, "good", &error));
  EXPECT_NE(error.find("there is: none"), std::string::npos) << error;
}

TEST(Directory, AnEarlierRootWins) {
  const TemporaryDirectory first;
  std::filesystem::create_directory(first.path() / "toe_off");
  std::filesystem::copy_file(plugin_path("good"), first.path() / "toe_off" / "good.so");
  const PluginDirectory plugins({first.path(), GAITD_TEST_PLUGINS});
  std::string error;
  EXPECT_EQ(plugins.find(GAITD_LAYER_TOE_OFF, "good", &error),
            first.path() / "toe_off" / "good.so");
}

TEST(Directory, ListsEveryLibraryWithoutLoadingIt) {
  const std::vector<PluginEntry> entries = PluginDirectory({GAITD_TEST_PLUGINS}).list();
  const auto entry = [&](const std::string& name) {
    return *std::find_if(entries.begin(), entries.end(),
                         [&](const PluginEntry& e) { return e.variant == name; });
  };
  EXPECT_GT(entries.size(), 15u);  // hang_at_load and exit_at_load among them
  ASSERT_TRUE(entry("good").descriptor);
  EXPECT_TRUE(entry("good").refusal.empty());
  EXPECT_FALSE(entry("wrong_major").descriptor);
  EXPECT_NE(entry("wrong_major").refusal.text().find("abi"), std::string::npos);
  // Its descriptor says "good": a variant is found by the name of its file.
  EXPECT_FALSE(entry("crash_at_load").descriptor);
}

// Long enough after the last change of a file that it counts as settled.
void wait_until_settled(const std::filesystem::path& file) {
  struct stat info {};
  ASSERT_EQ(stat(file.c_str(), &info), 0);
  while (time(nullptr) < info.st_ctim.tv_sec + 4) usleep(100'000);
}

TEST(Directory, ReadsAFileAgainOnlyAfterItHasChanged) {
  const TemporaryDirectory folder;
  std::filesystem::create_directory(folder.path() / "toe_off");
  const auto path = folder.path() / "toe_off" / "good.so";
  std::filesystem::copy_file(plugin_path("good"), path);
  wait_until_settled(path);
  const PluginDirectory plugins({folder.path()});
  for (int i = 0; i < 5; ++i) {
    const auto entries = plugins.list();
    ASSERT_EQ(entries.size(), 1u);
    EXPECT_TRUE(entries[0].descriptor);
  }
  EXPECT_EQ(plugins.files_read(), 1u);

  // Replaced by another one of the same size and time of modification.
  const auto modified = std::filesystem::last_write_time(path);
  std::vector<char> bytes = contents(path);
  const std::string version = "1.2.3";
  const auto at = std::search(bytes.begin(), bytes.end(), version.begin(), version.end());
  ASSERT_NE(at, bytes.end());
  *at = '7';
  write_file(path, bytes);
  std::filesystem::last_write_time(path, modified);
  EXPECT_STREQ(plugins.list()[0].descriptor->version, "7.2.3");
  EXPECT_EQ(plugins.files_read(), 2u);

  std::filesystem::remove(path);
  EXPECT_TRUE(plugins.list().empty());
}

// Two changes within the same step of the file system's clock have the same stamp.
TEST(Directory, ReadsAFileThatHasJustChangedEachTime) {
  const TemporaryDirectory folder;
  std::filesystem::create_directory(folder.path() / "toe_off");
  std::filesystem::copy_file(plugin_path("good"), folder.path() / "toe_off" / "good.so");
  const PluginDirectory plugins({folder.path()});
  plugins.list();
  plugins.list();
  EXPECT_GE(plugins.files_read(), 1u);
  write_file(folder.path() / "toe_off" / "good.so", {'n', 'o'});
  EXPECT_FALSE(plugins.list()[0].descriptor);
}

TEST(Directory, IsListedByTwoThreads) {
  const PluginDirectory plugins({GAITD_TEST_PLUGINS});
  const std::size_t count = plugins.list().size();
  std::thread other([&] {
    for (int i = 0; i < 20; ++i) EXPECT_EQ(plugins.list().size(), count);
  });
  for (int i = 0; i < 20; ++i) EXPECT_EQ(plugins.list().size(), count);
  other.join();
}

TEST(Directory, IsShownAsJson) {
  const PluginDirectory directory({GAITD_TEST_PLUGINS});
  std::string error;
  const nlohmann::json list =
      plugin_list_json(directory.list(),
                       {{"toe_off", directory.find(GAITD_LAYER_TOE_OFF, "newer", &error).value()}});
  int active = 0;
  for (const nlohmann::json& plugin : list["plugins"]) {
    EXPECT_EQ(plugin["layer"], "toe_off");
    if (plugin.value("active", false)) {
      ++active;
      EXPECT_EQ(plugin["variant"], "newer");
      EXPECT_EQ(plugin["parameters"][0]["unit"], "1/s");
    }
  }
  EXPECT_EQ(active, 1);
}

}  // namespace
}  // namespace gaitd::daemon
