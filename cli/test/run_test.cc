// SPDX-License-Identifier: Apache-2.0
// `gaitctl run` with programs of the test in the place of gaitd: a copy of gaitctl in a folder of
// its own takes the gaitd beside it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/test/cli_process.h"
#include "cli/test/sample_log.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

class Run : public ::testing::Test {
 protected:
  Run() {
    fs::copy_file(GAITCTL, workspace_.file("gaitctl"));
    write_sample_log(workspace_.file("sample.mcap"));
    scenario("stand", "  checks: [{signal: com/z, stat: max, max: 2.0}]\n");
    // What most tests need of gaitd: it writes the log that it was asked for.
    gaitd("while [ $# -gt 0 ]; do [ \"$1\" = --log ] && cp " + workspace_.file("sample.mcap") +
          " \"$2\"; shift; done; echo all is well");
  }
  void scenario(const std::string& name, const std::string& expect) {
    workspace_.write(name + ".yaml", "schema: gaitd.scenario/1\nname: " + name +
                                         "\nrobot: atlas\nduration: 5.0\nexpect:\n" + expect);
  }
  void gaitd(const std::string& script) {
    workspace_.write("gaitd", "#!/bin/sh\n" + script + "\n");
    fs::permissions(workspace_.file("gaitd"), fs::perms::owner_all);
  }
  Outcome run(const std::string& arguments) {
    return run_shell(workspace_, "XDG_STATE_HOME=" + workspace_.file("state") + " " +
                                     workspace_.file("gaitctl") + " run " + arguments);
  }

  Workspace workspace_;
};

TEST_F(Run, PassesWhenEveryExpectationHolds) {
  const Outcome outcome = run(workspace_.file("stand.yaml"));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_HAS(outcome.out, "stand.yaml: PASS");
  EXPECT_HAS(outcome.out, "log: " + workspace_.file("state") + "/gaitd/logs/stand-");
}

TEST_F(Run, TheVerdictIsTheLastLineAndFiguresAreForV) {
  const Outcome brief = run(workspace_.file("stand.yaml"));
  EXPECT_TRUE(brief.out.ends_with("stand.yaml: PASS\n")) << brief.out;
  EXPECT_EQ(brief.out.find("realtime_factor"), std::string::npos) << brief.out;
  const Outcome verbose = run("-v " + workspace_.file("stand.yaml"));
  EXPECT_TRUE(verbose.out.ends_with("stand.yaml: PASS\n")) << verbose.out;
  EXPECT_HAS(verbose.out, "figures\n");
  EXPECT_HAS(verbose.out, "realtime_factor");
}

TEST_F(Run, TwoAtOnceHaveTwoLogs) {
  gaitd("log=$(echo \"$@\" | sed 's/.*--log \\([^ ]*\\).*/\\1/'); sleep 0.5; cp " +
        workspace_.file("sample.mcap") + " \"$log\"");
  const std::string one = "XDG_STATE_HOME=" + workspace_.file("state") + " " +
                          workspace_.file("gaitctl") + " run " + workspace_.file("stand.yaml");
  const Outcome outcome = run_shell(workspace_, one + " & " + one + "; wait");
  int logs = 0;
  for (const auto& entry : fs::directory_iterator(workspace_.file("state") + "/gaitd/logs")) {
    logs += entry.path().extension() == ".mcap" ? 1 : 0;
  }
  EXPECT_EQ(logs, 2) << outcome.out << outcome.err;
}

TEST_F(Run, SeveralEndWithATableOfWhatFailed) {
  scenario("low", "  checks: [{signal: com/z, stat: max, max: 0.5}]\n");
  const Outcome outcome = run(workspace_.file("stand.yaml") + " " + workspace_.file("low.yaml"));
  EXPECT_EQ(outcome.exit_code, 1);
  const std::string table = outcome.out.substr(outcome.out.find("\nscenario"));
  EXPECT_HAS(table, "stand.yaml  PASS\n");
  EXPECT_HAS(table, "low.yaml    FAIL     com/z max");
  EXPECT_TRUE(table.ends_with("1 of 2 FAILED\n")) << table;
}

TEST_F(Run, ColoursAreForATerminalThatWantsThem) {
  const std::string green = "\033[32m" + workspace_.file("stand.yaml") + ": PASS\033[0m";
  const auto on_terminal = [&](const std::string& environment) {
    return run_shell(workspace_, environment + " XDG_STATE_HOME=" + workspace_.file("state") +
                                     " script -qec '" + workspace_.file("gaitctl") + " run " +
                                     workspace_.file("stand.yaml") + "' /dev/null </dev/null");
  };
  EXPECT_HAS(on_terminal("env -u NO_COLOR TERM=xterm").out, green);
  EXPECT_EQ(on_terminal("NO_COLOR=1 TERM=xterm").out.find("\033[32m"), std::string::npos);
  EXPECT_EQ(on_terminal("env -u NO_COLOR TERM=dumb").out.find("\033[32m"), std::string::npos);
  EXPECT_EQ(run(workspace_.file("stand.yaml")).out.find('\033'), std::string::npos);
}

TEST_F(Run, AMistypedScenarioGetsASuggestion) {
  const Outcome outcome = run_shell(workspace_, "GAITD_PATH=" GAITD_SOURCE_DIR "/sim " +
                                                    workspace_.file("gaitctl") + " run falt-0.35");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_HAS(outcome.out, "did you mean 'flat-0.35'?");
}

TEST_F(Run, FailsWhenOneExpectationDoesNot) {
  scenario("low", "  checks: [{signal: com/z, stat: max, max: 0.5}]\n");
  const Outcome outcome =
      run(workspace_.file("stand.yaml") + " " + workspace_.file("low.yaml") + " --json");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  const json result = json::parse(outcome.out);
  EXPECT_EQ(result["pass"], false);
  EXPECT_EQ(result["scenarios"][0]["pass"], true);
  EXPECT_EQ(result["scenarios"][1]["pass"], false);
  EXPECT_TRUE(result["scenarios"][1]["verdict"].is_object());
}

TEST_F(Run, PassesScenarioClockSocketLogAndSettingsOn) {
  gaitd("echo \"$@\"");
  const Outcome outcome = run(workspace_.file("stand.yaml") + " --set duration=3.0 --set seed=4" +
                              " --log " + workspace_.file("my.mcap"));
  EXPECT_EQ(outcome.exit_code, 1);
  const std::string arguments = workspace_.read("my.mcap.txt");
  EXPECT_HAS(arguments, "--scenario " + workspace_.file("stand.yaml") + " --clock lockstep");
  EXPECT_HAS(arguments, "--socket /");
  EXPECT_HAS(arguments, "--log " + workspace_.file("my.mcap"));
  EXPECT_HAS(arguments, "--set duration=3.0 --set seed=4");
  EXPECT_HAS(outcome.out, "no log to judge");
}

TEST_F(Run, AnOldLogIsNeverJudged) {
  fs::copy_file(workspace_.file("sample.mcap"), workspace_.file("old.mcap"));
  gaitd("exit 0");
  EXPECT_EQ(run(workspace_.file("stand.yaml") + " --log " + workspace_.file("old.mcap")).exit_code,
            1);
}

TEST_F(Run, ReportsACrashWithTheOutputAndStillJudges) {
  gaitd("while [ $# -gt 0 ]; do [ \"$1\" = --log ] && cp " + workspace_.file("sample.mcap") +
        " \"$2\"; shift; done; echo the last words >&2; kill -SEGV $$");
  const Outcome outcome = run(workspace_.file("stand.yaml"));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_HAS(outcome.out, "gaitd crashed with SIGSEGV");
  EXPECT_HAS(outcome.out, "the last words");
  EXPECT_HAS(outcome.out, "com/z");
}

TEST_F(Run, AFailureOfGaitdFailsEvenWithAGoodLog) {
  gaitd("while [ $# -gt 0 ]; do [ \"$1\" = --log ] && cp " + workspace_.file("sample.mcap") +
        " \"$2\"; shift; done; exit 4");
  const Outcome outcome = run(workspace_.file("stand.yaml"));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_HAS(outcome.out, "exit code 4");
}

TEST_F(Run, SeveralLogsGoIntoAFolder) {
  scenario("other", "  checks: [{signal: com/z, stat: max, max: 2.0}]\n");
  const Outcome outcome = run(workspace_.file("stand.yaml") + " " + workspace_.file("other.yaml") +
                              " --log " + workspace_.file("logs/"));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_TRUE(fs::exists(workspace_.file("logs/stand.mcap")));
  EXPECT_TRUE(fs::exists(workspace_.file("logs/other.mcap")));
}

TEST_F(Run, NamesWhatIsWrongBeforeAnythingIsStarted) {
  gaitd("touch " + workspace_.file("started"));
  Outcome outcome = run("no-such-scenario");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_HAS(outcome.out, "no scenario 'no-such-scenario'");
  scenario("broken", "  no_fall: maybe\n");
  outcome = run(workspace_.file("broken.yaml"));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_HAS(outcome.out, "broken.yaml:6");
  EXPECT_FALSE(fs::exists(workspace_.file("started")));
}

TEST_F(Run, AMissingGaitdIsReported) {
  fs::remove(workspace_.file("gaitd"));
  const Outcome outcome = run(workspace_.file("stand.yaml"));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_HAS(outcome.out, "cannot start " + workspace_.file("gaitd"));
}

TEST_F(Run, AnInterruptEndsGaitdToo) {
  gaitd("echo $$ >" + workspace_.file("pid") + "; exec sleep 60");
  const Outcome outcome = run_shell(
      workspace_, "XDG_STATE_HOME=" + workspace_.file("state") + " timeout --signal=INT 1 " +
                      workspace_.file("gaitctl") + " run " + workspace_.file("stand.yaml"));
  EXPECT_HAS(outcome.out, "interrupted");
  const std::string pid = workspace_.read("pid");
  ASSERT_NE(pid, "");
  EXPECT_FALSE(fs::exists("/proc/" + pid.substr(0, pid.find('\n'))));
}

TEST_F(Run, LogCommandsReadItsLog) {
  const std::string gaitctl = workspace_.file("gaitctl");
  const std::string log = workspace_.file("sample.mcap");
  EXPECT_EQ(run_shell(workspace_, gaitctl + " log info " + log).exit_code, 0);
  const Outcome info = run_shell(workspace_, gaitctl + " log info --json " + log);
  EXPECT_TRUE(json::accept(info.out)) << info.out;
  const Outcome csv = run_shell(workspace_, gaitctl + " log export --signals time,com/z " + log);
  EXPECT_EQ(csv.exit_code, 0) << csv.err;
  EXPECT_EQ(csv.out.substr(0, csv.out.find('\n')), "time,com/z");
  EXPECT_EQ(run_shell(workspace_, gaitctl + " log export --signals time,com/z " + log + " -o " +
                                      workspace_.file("x.csv"))
                .exit_code,
            0);
  EXPECT_EQ(workspace_.read("x.csv"), csv.out);
  EXPECT_EQ(run_shell(workspace_, gaitctl + " log info /nowhere.mcap").exit_code, 1);
  EXPECT_EQ(run_shell(workspace_, gaitctl + " log export --signals nothing/* " + log).exit_code, 1);
  EXPECT_EQ(run_shell(workspace_, gaitctl + " log export " + log + " -o /nowhere/x.csv").exit_code,
            1);
}

}  // namespace
}  // namespace gaitd::cli
