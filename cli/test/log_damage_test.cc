// SPDX-License-Identifier: Apache-2.0
// gaitctl with logs that are damaged or that hold what would command a terminal.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "cli/test/cli_process.h"
#include "cli/test/sample_log.h"
#include "daemon/telemetry/log_writer.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

class DamagedLog : public ::testing::Test {
 protected:
  DamagedLog() {
    write_sample_log(workspace_.file("whole.mcap"));
    whole_ = workspace_.read("whole.mcap");
  }
  Outcome gaitctl(const std::string& arguments) {
    return run_shell(workspace_, std::string(GAITCTL) + " " + arguments);
  }
  Outcome export_of(const std::string& bytes) {
    workspace_.write("log.mcap", bytes);
    return gaitctl("log export " + workspace_.file("log.mcap"));
  }

  Workspace workspace_;
  std::string whole_;
};

TEST_F(DamagedLog, IsExportedWithAnExitCodeOfItsOwn) {
  const Outcome sound = export_of(whole_);
  ASSERT_EQ(sound.exit_code, 0) << sound.err;
  EXPECT_EQ(sound.err, "");
  std::mt19937 random(4);
  int told = 0;
  for (int trial = 0; trial < 25; ++trial) {
    std::string bytes = whole_;
    const std::size_t at = random() % bytes.size();
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
    const Outcome outcome = export_of(bytes);
    ASSERT_TRUE(outcome.exit_code == 1 || outcome.exit_code == 4)
        << "a flipped bit at byte " << at << ": exit code " << outcome.exit_code;
    EXPECT_FALSE(outcome.err.empty());
    if (outcome.exit_code != 4) continue;
    ++told;
    EXPECT_HAS(outcome.err, "gaitctl: log export: " + workspace_.file("log.mcap") + ": damaged: ");
    if (outcome.out != sound.out) {
      EXPECT_HAS(outcome.err, "ticks are missing");
    }
  }
  EXPECT_GT(told, 15);
}

TEST_F(DamagedLog, IsCutOffAtTheByteThatIsSaid) {
  const std::string cut = whole_.substr(0, whole_.size() - 40);
  const Outcome outcome = export_of(cut);
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_HAS(outcome.err, "cut off");
  const Outcome info = gaitctl("--json log info " + workspace_.file("log.mcap"));
  EXPECT_EQ(info.exit_code, 4);
  const json document = json::parse(info.out);
  EXPECT_EQ(document["finished"], false);
  EXPECT_EQ(document["checksums"], "all");
  EXPECT_EQ(document["damage"].size(), 1u) << document["damage"];
  EXPECT_EQ(document["lost_ticks"], 0);
}

TEST_F(DamagedLog, OfWhichNothingIsLeftIsAnError) {
  EXPECT_EQ(export_of(whole_.substr(0, 60)).exit_code, 1);
  EXPECT_EQ(export_of("").exit_code, 1);
}

TEST_F(DamagedLog, ThatIsSoundCommandsNoTerminal) {
  const std::string file = workspace_.file("escape\x1b[31m.mcap");
  {
    daemon::LogWriter writer({{"time", "s", daemon::SignalDescription::Kind::kReal, {}}});
    std::string error;
    ASSERT_TRUE(writer.open(file, {{"scenario", "\x1b]0;title\x07"}}, {}, &error)) << error;
    const double time = 0.0;
    writer.write_tick(0, time, std::span(&time, 1), nullptr);
    writer.write_event({.kind = "note",
                        .text = "\x1b[2J\x9b"
                                "1m\r\xE2\x80\xAE"});
    ASSERT_TRUE(writer.close({{"end", "\x1b[0m"}}));
  }
  for (const char* command : {"log info ", "--json log info ", "log export ", "log replay "}) {
    const Outcome outcome = gaitctl(std::string(command) + "'" + file + "'");
    for (const char c : outcome.out + outcome.err) {
      const bool plain = (c >= ' ' && c < 127) || c == '\n';
      ASSERT_TRUE(plain) << command << ": byte " << static_cast<int>(c) << " in\n" << outcome.out;
    }
    if (command[0] == '-') {
      EXPECT_TRUE(json::accept(outcome.out)) << outcome.out;
      EXPECT_EQ(json::parse(outcome.out)["metadata"]["scenario"], "\x1b]0;title\x07");
    }
  }
  EXPECT_HAS(gaitctl("log info '" + file + "'").out, "\\u001b[2J");
}

}  // namespace
}  // namespace gaitd::cli
