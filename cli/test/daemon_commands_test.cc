// SPDX-License-Identifier: Apache-2.0
// The gaitctl program against a server with methods of the test.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "cli/test/cli_process.h"
#include "daemon/server/command_server.h"

namespace gaitd::cli {
namespace {

using daemon::RpcError;
using daemon::RpcResult;
using nlohmann::json;

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

class Gaitctl : public ::testing::Test {
 protected:
  Gaitctl() {
    daemon::Methods methods;
    for (const char* name : {"arm", "disarm", "reset", "mode", "walk", "footsteps", "pause",
                             "resume", "stop", "abort", "sim.push", "sim.reset"}) {
      methods.add(name, [this, name](const json& params) -> RpcResult {
        if (params.is_object() && params.value("mode", "") == "stand") {
          return RpcError{daemon::rpc_code::kInvalidParams,
                          "mode.mode: expected a word\nmode: other"};
        }
        const std::lock_guard lock(mutex_);
        method_ = name;
        params_ = params;
        return json{{"accepted", true}, {"tick", 42}};
      });
    }
    methods.add("drive", [this](const json& params) -> RpcResult {
      const std::lock_guard lock(mutex_);
      drives_.push_back(params);
      stopped_ = params.contains("end");
      if (drives_.size() > 2 && params.value("forward", 0.0) == 3.0) {
        return RpcError{daemon::rpc_code::kRefused, "drive: taken over", {{"tick", 7}}};
      }
      return json{{"accepted", true}, {"tick", 42}, {"note", "slower than asked: 0.7 m/s"}};
    });
    methods.add("resume", [](const json&) -> RpcResult {
      return RpcError{daemon::rpc_code::kRefused, "not paused; nothing to resume", {{"tick", 7}}};
    });
    methods.add_snapshot("version", [] { return json{{"version", "9.9"}}; });
    methods.add_snapshot("status", [this] {
      return json{
          {"state", stopped_ ? "standing" : "walking"},
          {"time", 12.5},
          {"faults", json::array()},
          {"layers", {{{"layer", "icp_planner"}, {"variant", "heel_to_toe"}, {"p99_us", 3.25}}}}};
    });
    methods.add_snapshot("plugin.list", [] {
      return json{{"plugins",
                   {{{"layer", "toe_off"},
                     {"variant", "never"},
                     {"active", true},
                     {"version", "1.0.0"},
                     {"worst_case_us", 1.0},
                     {"path", "/p/never.so"}},
                    {{"layer", "toe_off"},
                     {"variant", "old"},
                     {"path", "/p/old.so"},
                     {"refused", "/p/old.so: refused\n  abi: has 0.1"}}}}};
    });
    std::string error;
    daemon::ServerOptions options;
    options.socket_path = workspace_.file("gaitd.sock");
    server_ = daemon::CommandServer::start(options, std::move(methods), nullptr, &estop_, &error);
    EXPECT_TRUE(server_) << error;
  }

  Outcome gaitctl(const std::string& arguments) {
    return run_shell(workspace_, std::string(GAITCTL) + " --socket " +
                                     workspace_.file("gaitd.sock") + " " + arguments);
  }
  // What the daemon got for a command that must succeed.
  json sent(const std::string& arguments) {
    {
      const std::lock_guard lock(mutex_);
      method_ = "";
    }
    const Outcome outcome = gaitctl(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.err;
    const std::lock_guard lock(mutex_);
    return {{"method", method_}, {"params", params_}};
  }

  Workspace workspace_;
  std::mutex mutex_;
  std::vector<json> drives_;
  std::atomic<bool> stopped_{false};
  std::string method_;
  json params_;
  daemon::EstopFlag estop_;
  std::unique_ptr<daemon::CommandServer> server_;
};

TEST_F(Gaitctl, SendsEachPlainCommand) {
  for (const char* name : {"arm", "disarm", "reset", "pause", "stop", "abort"}) {
    EXPECT_EQ(sent(name), (json{{"method", name}, {"params", nullptr}}));
  }
  EXPECT_EQ(sent("sim reset")["method"], "sim.reset");
}

TEST_F(Gaitctl, RaisesTheEstop) {
  std::atomic<bool> done{false};
  std::thread control([&] {
    for (std::int64_t tick = 0; !done; ++tick) {
      estop_.take(tick);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  EXPECT_EQ(gaitctl("estop").exit_code, 0);
  EXPECT_TRUE(estop_.acted_on(1));
  done = true;
  control.join();
}

TEST_F(Gaitctl, SendsOnlyTheOptionsOfWalkThatWereGiven) {
  EXPECT_EQ(sent("walk --steps 4")["params"], (json{{"steps", 4}}));
  EXPECT_EQ(sent("walk --steps 4 --length -0.3 --lateral 0.05 --width 0.25 --turn -0.1 "
                 "--swing 0.6 --transfer 0.2 --first left")["params"],
            (json{{"steps", 4},
                  {"length", -0.3},
                  {"lateral", 0.05},
                  {"width", 0.25},
                  {"turn", -0.1},
                  {"swing", 0.6},
                  {"transfer", 0.2},
                  {"first", "left"}}));
}

TEST_F(Gaitctl, DriveRenewsItsVelocityAndEndsWithAStand) {
  EXPECT_EQ(gaitctl("drive").exit_code, 2);
  const Outcome outcome = gaitctl("drive --forward 2 --turn -0.1 --for 0.5");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_HAS(outcome.out, "slower than asked");
  EXPECT_EQ(outcome.out.find("slower"), outcome.out.rfind("slower")) << "told more than once";
  const std::lock_guard lock(mutex_);
  ASSERT_GE(drives_.size(), 4u);
  EXPECT_FALSE(drives_[0].contains("renew"));
  for (std::size_t i = 1; i + 1 < drives_.size(); ++i) {
    EXPECT_EQ(drives_[i]["renew"], true);
    EXPECT_EQ(drives_[i]["session"], drives_[0]["session"]);
    EXPECT_EQ(drives_[i]["forward"], 2.0);
  }
  EXPECT_EQ(drives_.back(), (json{{"session", drives_[0]["session"]}, {"end", true}}));
}

TEST_F(Gaitctl, ADriveThatIsTakenOverEndsWithTheReason) {
  const Outcome outcome = gaitctl("drive --forward 3 --for 60");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_HAS(outcome.err, "taken over");
}

TEST_F(Gaitctl, SendsModesAndPushes) {
  EXPECT_EQ(sent("mode walk-bent")["params"]["mode"], "walk-bent");
  EXPECT_EQ(sent("sim push --link utorso --force -444,0,1e1 --duration 0.1 --point 0,0,0.3"),
            json::parse(R"({"method": "sim.push", "params": {"link": "utorso",
                            "force": [-444.0, 0.0, 10.0], "duration": 0.1,
                            "point": [0.0, 0.0, 0.3]}})"));
}

TEST_F(Gaitctl, SendsFootstepsFromYamlJsonAndStandardInput) {
  const json expected = json::parse(R"([{"side": "left", "x": 0.3, "y": 0.1},
                                        {"side": "right", "x": 0.6, "y": -0.1}])");
  workspace_.write("steps.yaml",
                   "footsteps:\n  - {side: left, x: 0.3, y: 0.1}\n"
                   "  - side: right\n    x: 0.6\n    y: -0.1\n");
  workspace_.write("steps.json", expected.dump());
  EXPECT_EQ(sent("steps " + workspace_.file("steps.yaml"))["params"],
            (json{{"footsteps", expected}, {"replace", false}}));
  EXPECT_EQ(sent("steps --replace " + workspace_.file("steps.json"))["params"],
            (json{{"footsteps", expected}, {"replace", true}}));
  EXPECT_EQ(sent("steps - <" + workspace_.file("steps.json"))["params"]["footsteps"], expected);
}

TEST_F(Gaitctl, NamesFileAndLineOfABadStepsFile) {
  workspace_.write("bad.yaml", "footsteps: 3\nother: 4\n");
  const Outcome outcome = gaitctl("steps " + workspace_.file("bad.yaml"));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_HAS(outcome.err, "bad.yaml:1");
  EXPECT_HAS(outcome.err, "bad.yaml:2");
  workspace_.write("key.yaml", "- {side: left, x: 0.2, y: 0.1}\n- {side: right, xx: 0.2, y: 0}\n");
  EXPECT_HAS(gaitctl("steps " + workspace_.file("key.yaml")).err, "key.yaml:2: footsteps[1].xx");
  EXPECT_EQ(gaitctl("steps /nowhere.yaml").exit_code, 1);
}

TEST_F(Gaitctl, ShowsResultsForPeopleAndAsJson) {
  EXPECT_EQ(gaitctl("arm").out, "arm: accepted at tick 42\n");
  EXPECT_EQ(json::parse(gaitctl("arm --json").out), (json{{"accepted", true}, {"tick", 42}}));
  EXPECT_EQ(gaitctl("status").out,
            "state   walking\n"
            "time    12.5\n"
            "faults  none\n"
            "\n"
            "layers\n"
            "layer        variant      p99_us\n"
            "icp_planner  heel_to_toe  3.25\n");
  EXPECT_EQ(json::parse(gaitctl("--json status").out)["state"], "walking");
  EXPECT_EQ(gaitctl("plugin list").out,
            "   layer    variant  version  worst case µs  file\n"
            "*  toe_off  never    1.0.0    1              /p/never.so\n"
            "* in use\n"
            "\n"
            "/p/old.so: refused\n"
            "  abi: has 0.1\n");
}

TEST_F(Gaitctl, ARefusalIsExitCode1WithItsReason) {
  const Outcome outcome = gaitctl("resume");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, "gaitctl: resume: not paused; nothing to resume\n");
  const json error = json::parse(gaitctl("resume --json").out)["error"];
  EXPECT_EQ(error["code"], -32000);
  EXPECT_EQ(error["data"]["tick"], 7);
}

TEST_F(Gaitctl, NamesTheCommandOnceAndADaemonOfAnotherVersion) {
  const Outcome outcome = gaitctl("mode stand");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_HAS(outcome.err, "gaitctl: mode:\n  mode: expected a word\n  other\n  this gaitd is ");
  EXPECT_HAS(outcome.err, "this gaitd is version 9.9, gaitctl is ");
}

TEST_F(Gaitctl, ErrorsAsJsonHaveTheSameMembersWhoeverFoundThem) {
  for (const auto& [arguments, kind] : std::vector<std::pair<std::string, std::string>>{
           {"resume", "refused"}, {"walk", "usage"}, {"log info /nowhere.mcap", "failed"}}) {
    const Outcome outcome = gaitctl("--json " + arguments);
    const json error = json::parse(outcome.out).at("error");
    for (const char* member : {"command", "exit_code", "kind", "message", "code", "data"}) {
      EXPECT_TRUE(error.contains(member)) << arguments << ": " << member;
    }
    EXPECT_EQ(error["kind"], kind);
    EXPECT_EQ(error["exit_code"], outcome.exit_code);
  }
  server_.reset();
  EXPECT_EQ(json::parse(gaitctl("--json status").out)["error"]["kind"], "no_daemon");
}

TEST_F(Gaitctl, NamesUnknownCommandsAndOptionsWithNearOnes) {
  EXPECT_HAS(gaitctl("wlak").err, "no command 'wlak'; did you mean 'walk'?");
  EXPECT_HAS(gaitctl("fly").err, "no command 'fly'; known: ");
  EXPECT_HAS(gaitctl("plugin lits").err,
             "gaitctl: plugin: no command 'lits'; did you mean 'list'?");
  EXPECT_HAS(gaitctl("walk --stepz 3").err, "no option '--stepz'; did you mean '--steps'?");
  const std::string error = gaitctl("walk --steps 0").err;
  EXPECT_HAS(error, "expected a whole number from 1 up, got 0");
}

TEST_F(Gaitctl, WatchPrintsLinesWhereThereIsNoTerminal) {
  const Outcome outcome = gaitctl("watch --once");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_HAS(outcome.out, "12.50 s  walking");
  EXPECT_EQ(json::parse(gaitctl("watch --once --json").out)["state"], "walking");
}

TEST_F(Gaitctl, AWrongCommandLineIsExitCode2AndSendsNothing) {
  for (const char* arguments :
       {"", "fly", "mode", "mode run", "walk", "walk --steps 0", "walk --steps x",
        "walk --steps 2 --first both", "arm now", "sim", "sim push --link a --duration 1",
        "sim push --link a --force 1,2 --duration 1",
        "sim push --link a --force 1,2,3,4 --duration 1",
        "sim push --link a --force 1,2,3 --duration -1", "plugin", "log export", "run", "--nothing",
        "run a b --log one.mcap"}) {
    const Outcome outcome = gaitctl(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_NE(outcome.err, "") << arguments;
  }
  EXPECT_EQ(method_, "");
}

TEST_F(Gaitctl, EveryHelpSaysUnitsAndEndsWell) {
  for (const char* arguments :
       {"--help", "status --help", "mode --help", "steps --help", "plugin --help", "sim --help",
        "sim push --help", "run --help", "log --help", "log export --help", "--version"}) {
    EXPECT_EQ(gaitctl(arguments).exit_code, 0) << arguments;
  }
  const std::string help = gaitctl("walk --help").out;
  for (const char* unit : {", m", ", rad", ", s"}) EXPECT_HAS(help, unit);
  EXPECT_HAS(gaitctl("--version").out, "gaitctl ");
}

TEST_F(Gaitctl, NoDaemonIsExitCode3AndSaysHowToStartOne) {
  server_.reset();
  Outcome outcome = gaitctl("status");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_HAS(outcome.err, "gaitd --backend simbody");
  EXPECT_HAS(outcome.err, workspace_.file("gaitd.sock"));
  outcome =
      run_shell(workspace_, "XDG_RUNTIME_DIR=" + workspace_.file("none") + " " GAITCTL " status");
  // A daemon of this machine's own may run, but not in that folder.
  if (outcome.exit_code != 0) {
    EXPECT_HAS(outcome.err, workspace_.file("none") + "/gaitd.sock");
  }
}

TEST_F(Gaitctl, FindsTheDaemonOfTheUser) {
  const Outcome outcome = run_shell(
      workspace_, "XDG_RUNTIME_DIR=" + workspace_.file("") + " " GAITCTL " --json status");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
}

}  // namespace
}  // namespace gaitd::cli
