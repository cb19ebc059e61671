// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "daemon/config/daemon_config.h"
#include "daemon/config/paths.h"
#include "daemon/config/test/temporary_folder.h"
#include "daemon/parameters/safety_parameters.h"

namespace gaitd::daemon {
namespace {

TEST(DaemonConfig, TheShippedFileSaysWhatTheDefaultsAre) {
  Settings settings;
  Issues issues;
  const auto file = Paths::detect().config();
  ASSERT_TRUE(file);
  ASSERT_TRUE(load_config_file(file->string(), &settings, &issues)) << issues.error_text();
  const DaemonConfig config = read_daemon_config(&settings, &issues);
  const std::vector<double> limits = settings.resolve("limits", kLimitParameters, &issues);
  settings.report_unknown(&issues);
  EXPECT_TRUE(issues.ok()) << issues.error_text();
  for (std::size_t i = 0; i < limits.size(); ++i) {
    EXPECT_EQ(limits[i], kLimitParameters[i].default_value) << kLimitParameters[i].name;
  }

  const DaemonConfig defaults;
  EXPECT_EQ(config.backend, defaults.backend);
  EXPECT_EQ(config.robot, defaults.robot);
  EXPECT_EQ(config.clock, defaults.clock);
  EXPECT_EQ(config.period, defaults.period);
  EXPECT_EQ(config.profile, defaults.profile);
  EXPECT_EQ(config.variants, defaults.variants);
  EXPECT_EQ(config.realtime.priority, defaults.realtime.priority);
  EXPECT_EQ(config.realtime.affinity, defaults.realtime.affinity);
  EXPECT_EQ(config.realtime.lock_memory, defaults.realtime.lock_memory);
  EXPECT_EQ(config.realtime.require, defaults.realtime.require);
  EXPECT_EQ(config.realtime.overrun, defaults.realtime.overrun);
  EXPECT_EQ(config.realtime.overrun_run, defaults.realtime.overrun_run);
  EXPECT_EQ(config.log.enabled, defaults.log.enabled);
  EXPECT_EQ(config.log.compression, defaults.log.compression);
  EXPECT_EQ(config.socket, defaults.socket);
}

TEST(DaemonConfig, ReadsWhatDiffersFromTheDefaults) {
  TemporaryFolder folder;
  const std::string file =
      folder.write("gaitd.yaml",
                   "schema: gaitd.config/1\nbackend: socketcan\nclock: lockstep\nperiod: 0.004\n"
                   "toe_off: {variant: icp_criteria}\nstep_adjuster/step_plan: {dead_band: 0.02}\n"
                   "realtime: {affinity: [2, 3], overrun: stop}\nlog: {compression: none}\n");
  Settings settings;
  Issues issues;
  ASSERT_TRUE(load_config_file(file, &settings, &issues)) << issues.error_text();
  ASSERT_TRUE(settings.set_assignment("period=0.002", &issues));
  const DaemonConfig config = read_daemon_config(&settings, &issues);
  settings.declare_variant("step_adjuster", "step_plan");
  settings.report_unknown(&issues);
  EXPECT_TRUE(issues.ok()) << issues.error_text();
  EXPECT_FALSE(config.profile);  // that of the backend
  EXPECT_EQ(config.clock, GAITD_CLOCK_LOCKSTEP);
  EXPECT_EQ(config.period, 0.002);
  EXPECT_EQ(config.variants[GAITD_LAYER_TOE_OFF], "icp_criteria");
  EXPECT_EQ(config.realtime.affinity, (std::vector<int>{2, 3}));
  EXPECT_EQ(config.realtime.overrun, OverrunPolicy::kStop);
  EXPECT_EQ(config.log.compression, LogCompression::kNone);
}

TEST(DaemonConfig, ReportsEveryErrorWithItsLine) {
  TemporaryFolder folder;
  const std::string file = folder.write("gaitd.yaml",
                                        "schema: gaitd.config/1\n"           // 1
                                        "backend: simbodi\n"                 // 2
                                        "period: 1\n"                        // 3
                                        "realtime: {priority: 100,\n"        // 4
                                        "           affinity: [a, 5000],\n"  // 5
                                        "           lock_memori: true}\n"    // 6
                                        "toe_off:\n"                         // 7
                                        "  variant:\n"                       // 8
                                        "log: {compression: gzip}\n");       // 9
  Settings settings;
  Issues issues;
  load_config_file(file, &settings, &issues);
  read_daemon_config(&settings, &issues);
  settings.report_unknown(&issues);
  const std::string errors = issues.error_text();
  for (const char* part :
       {":3: period: expected a number in 0.0002..0.02 s, got 1",
        ":4: realtime.priority: expected a whole number in 1..99, got 100",
        ":5: realtime.affinity: expected numbers of processors in 0..1023, got 'a' (text)",
        ":5: realtime.affinity: expected numbers of processors in 0..1023, got 5000",
        ":6: realtime.lock_memori: unknown key; did you mean 'realtime.lock_memory'?",
        "toe_off.variant: expected a value, got nothing",
        ":9: log.compression: expected one of none, zstd"}) {
    EXPECT_NE(errors.find(part), std::string::npos) << part << "\nin:\n" << errors;
  }
}

TEST(DaemonConfig, TakesFoldersOfPluginsByTheirAbsolutePath) {
  const TemporaryFolder folder;
  const std::string there = folder.path().string();
  const auto read = [](const std::string& value, Issues* issues) {
    Settings settings;
    settings.set_assignment("plugins.folders=" + value, issues);
    const DaemonConfig config = read_daemon_config(&settings, issues);
    settings.report_unknown(issues);
    return config.plugin_folders;
  };
  Issues good;
  EXPECT_EQ(read("[" + there + "]", &good), std::vector<std::string>{there});
  EXPECT_TRUE(good.ok()) << good.error_text();
  for (const char* bad :
       {"[relative]", "[/nowhere/at/all]", "[1]", "[[/tmp]]", "/tmp", "[{a: b}]"}) {
    Issues issues;
    EXPECT_TRUE(read(bad, &issues).empty()) << bad;
    EXPECT_FALSE(issues.ok()) << bad;
  }
}

TEST(DaemonConfig, WhereGaitdWritesIsNotForScenariosAndRobotsToSay) {
  for (const char* key : {"log.file", "log.directory", "socket", "plugins.folders"}) {
    EXPECT_TRUE(is_own_key(key)) << key;
    for (const SettingSource source :
         {SettingSource::kRobot, SettingSource::kProfile, SettingSource::kScenario}) {
      Settings settings;
      Issues issues;
      settings.set(source, key, make_scalar("/tmp/x", {"foreign.yaml", 3}));
      read_daemon_config(&settings, &issues);
      settings.report_unknown(&issues);
      EXPECT_NE(issues.error_text().find("only gaitd.yaml and the command line may set this key"),
                std::string::npos)
          << key << issues.error_text();
    }
  }
  EXPECT_FALSE(is_own_key("log.enabled"));
}

TEST(DaemonConfig, RefusesAFileOfAnotherSchema) {
  TemporaryFolder folder;
  for (const char* text : {"backend: simbody\n", "schema: gaitd.robot/1\n", "[1, 2]\n", ""}) {
    Settings settings;
    Issues issues;
    EXPECT_FALSE(load_config_file(folder.write("x.yaml", text), &settings, &issues)) << text;
    EXPECT_FALSE(issues.ok());
  }
}

}  // namespace
}  // namespace gaitd::daemon
