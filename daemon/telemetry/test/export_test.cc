// SPDX-License-Identifier: Apache-2.0
#include "daemon/log/export_csv.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "daemon/log/log_info.h"
#include "daemon/telemetry/test/fixture.h"

namespace gaitd::daemon {
namespace {

std::unique_ptr<LogReader> small_log() {
  const SignalTable table = {{"time", "s", Kind::kReal, {}},
                             {"tick", "", Kind::kInteger, {}},
                             {"gait/phase", "", Kind::kEnumeration, {"stand", "swing"}},
                             {"toe_off/active", "", Kind::kBoolean, {}},
                             {"com/x", "m", Kind::kReal, {}}};
  const std::string path = test_path("log.mcap");
  std::string error;
  {
    LogWriter writer(table);
    EXPECT_TRUE(writer.open(path, {{"robot", "atlas"}}, {}, &error)) << error;
    const std::vector<std::vector<double>> rows = {{0.0, 0, 0, 0, 0.1},
                                                   {0.1, 1e15, 1, 1, 1.0 / 3.0},
                                                   {0.2, std::nan(""), 5, 3, std::nan("")},
                                                   {0.30000000000000004, -7, 0, 0, -0.0}};
    for (const auto& row : rows) writer.write_tick(0, row[0], row, nullptr);
    writer.write_event({.tick = 1, .time = 0.1, .kind = "command", .text = "{\"walk\":12}"});
    writer.write_event({.tick = 2, .time = 0.2, .kind = "note", .text = "no json"});
  }
  return LogReader::open(path, &error);
}

TEST(Csv, HasOneRowPerTickAndWordsForEnumerations) {
  const auto log = small_log();
  ASSERT_NE(log, nullptr);
  std::ostringstream out;
  std::string error;
  ASSERT_TRUE(export_csv(*log, {}, out, &error)) << error;
  EXPECT_EQ(out.str(),
            "time,tick,gait/phase,toe_off/active,com/x\n"
            "0,0,stand,0,0.1\n"
            "0.1,1000000000000000,swing,1,0.3333333333333333\n"
            "0.2,,,1,nan\n"
            "0.30000000000000004,-7,stand,0,-0\n");
}

TEST(Csv, ChoosesSignalsAndTimes) {
  const auto log = small_log();
  ASSERT_NE(log, nullptr);
  std::ostringstream out;
  std::string error;
  ASSERT_TRUE(export_csv(*log, {.signals = "com/*, tick", .start = 0.1, .end = 0.2}, out, &error));
  EXPECT_EQ(out.str(), "tick,com/x\n1000000000000000,0.3333333333333333\n,nan\n");
}

TEST(Csv, SaysWhenNothingMatches) {
  const auto log = small_log();
  ASSERT_NE(log, nullptr);
  std::ostringstream out;
  std::string error;
  EXPECT_FALSE(export_csv(*log, {.signals = "cmo/*"}, out, &error));
  EXPECT_NE(error.find("cmo/*"), std::string::npos);
  EXPECT_TRUE(out.str().empty());
}

TEST(Csv, ReportsAFullDisk) {
  const auto log = small_log();
  ASSERT_NE(log, nullptr);
  std::ofstream full("/dev/full");
  std::string error;
  EXPECT_FALSE(export_csv(*log, {}, full, &error));
  EXPECT_FALSE(error.empty());
}

TEST(LogInfo, TellsWhatIsInTheFile) {
  const auto log = small_log();
  ASSERT_NE(log, nullptr);
  const auto json = nlohmann::json::parse(log_info_json(*log));
  EXPECT_EQ(json["ticks"], 4);
  EXPECT_EQ(json["duration"], 0.30000000000000004);
  EXPECT_EQ(json["dropouts"], 0);
  EXPECT_EQ(json["finished"], true);
  EXPECT_EQ(json["metadata"]["robot"], "atlas");
  EXPECT_EQ(json["events"][0]["text"]["walk"], 12);
  EXPECT_EQ(json["events"][1]["text"], "no json");
  EXPECT_EQ(json["topics"]["/gaitd/signals"], 4);
  EXPECT_EQ(json["signals"].size(), 5u);
  const std::string text = log_info_text(*log);
  for (const char* part :
       {"finished", "4, 0 dropped", "robot: atlas", "{\"walk\":12}", "0.300 s"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
}

TEST(LogInfo, ShowsEveryFaultOfALogWithManyEvents) {
  const std::string path = test_path("log.mcap");
  const std::string why(300, 'w');
  std::string error;
  {
    LogWriter writer({{"time", "s", Kind::kReal, {}}});
    ASSERT_TRUE(writer.open(path, {}, {}, &error)) << error;
    for (int i = 0; i < 40; ++i) writer.write_event({.tick = i, .kind = "note", .text = "a note"});
    writer.write_event({.tick = 40, .kind = "fault", .text = why + "END"});
    writer.write_event({.tick = 41, .kind = "note", .text = "the last one"});
  }
  const auto log = LogReader::open(path, &error);
  ASSERT_NE(log, nullptr) << error;
  const std::string text = log_info_text(*log);
  EXPECT_NE(text.find(why + "END"), std::string::npos) << text;
  EXPECT_NE(text.find("... and 21 more"), std::string::npos) << text;
  EXPECT_EQ(text.find("the last one"), std::string::npos) << text;
}

}  // namespace
}  // namespace gaitd::daemon
