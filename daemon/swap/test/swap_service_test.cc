// SPDX-License-Identifier: Apache-2.0
// What SwapService does before the control thread sees anything; that one is played by the test.
#include "daemon/swap/swap_service.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>

#include "daemon/host/test/test_files.h"
#include "daemon/telemetry/test/fixture.h"
#include "gaitd/sdk/bounds.h"

namespace gaitd::daemon {
namespace {

using nlohmann::json;
using std::chrono::steady_clock;

// Tells whether anybody has opened or read a file or looked into a folder.
class Watched {
 public:
  explicit Watched(const std::filesystem::path& path) : fd_(inotify_init1(IN_NONBLOCK)) {
    EXPECT_GE(inotify_add_watch(fd_, path.c_str(), IN_OPEN | IN_ACCESS), 0);
  }
  ~Watched() { close(fd_); }
  bool touched() const {
    char events[4096];
    return read(fd_, events, sizeof(events)) > 0;
  }

 private:
  int fd_;
};

class Swaps : public ::testing::Test {
 protected:
  using Answer = std::shared_ptr<std::optional<RpcResult>>;

  void start(bool any_file) {
    SwapService::Parts parts{.model = model_.get(),
                             .directory = &plugins_,
                             .folders = LibraryFolders({allowed_.path()}),
                             .any_file_for_clients = any_file,
                             .settings = &settings_,
                             .parameters = &parameters_,
                             .telemetry = &telemetry_,
                             .bridge = bridge_.get(),
                             .log = {},
                             .words = {},
                             .in_use = {}};
    parts.words.fill({"good", "other"});
    service_ = std::make_unique<SwapService>(std::move(parts));
    service_->add_methods(&methods_);
    service_->start();
  }
  Answer call(const char* method, const json& params) {
    auto answer = std::make_shared<std::optional<RpcResult>>();
    (*methods_.find(method))(params, Caller{}, [answer](RpcResult r) { *answer = std::move(r); });
    return answer;
  }
  Answer swap(const std::string& to, const char* layer = "toe_off") {
    return call("plugin.swap", {{"layer", layer}, {"to", to}});
  }
  // Its error, when there is one.
  RpcError error(const Answer& answer) {
    while (!answer->has_value()) {
      bridge_->poll(CommandBridge::Clock::now());
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const auto* error = std::get_if<RpcError>(&answer->value());
    return error == nullptr ? RpcError{0, "no error"} : *error;
  }
  SwapOrder next_order() {
    SwapOrder order;
    while (!service_->port().next_order(order)) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return order;
  }
  static int maps() {
    std::ifstream maps("/proc/self/maps");
    int count = 0;
    for (std::string line; std::getline(maps, line);) count += line.find(".so") != line.npos;
    return count;
  }

  std::unique_ptr<GaitdModel> model_ = some_model();
  PluginDirectory plugins_{{GAITD_TEST_PLUGINS}};
  TemporaryDirectory allowed_;
  Settings settings_;
  LiveParameters parameters_;
  Telemetry telemetry_{sample_table(), {}};
  std::unique_ptr<CommandBridge> bridge_ = std::make_unique<CommandBridge>();
  Methods methods_;
  std::unique_ptr<SwapService> service_;
};

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST_F(Swaps, TouchNothingBeforeTheyMayBegin) {
  start(true);
  const auto file = allowed_.path() / "good.so";
  std::filesystem::copy_file(plugin_path("good"), file);
  const Watched library(file);
  const Watched folder(allowed_.path());
  EXPECT_HAS(error(swap(file)).message, "has not made its first tick");
  service_->port().publish(SwapRight::kNotOnHardware);
  EXPECT_HAS(error(swap(file)).message, "swap.on_hardware is false");
  EXPECT_HAS(error(swap("/nowhere/x.so")).message, "swap.on_hardware is false");
  EXPECT_HAS(error(call("plugin.rollback", {{"layer", "toe_off"}})).message, "swap.on_hardware");
  service_->port().publish(SwapRight::kNotAtRest);
  EXPECT_HAS(error(swap(file)).message, "only swapped while standing");
  EXPECT_FALSE(library.touched());
  EXPECT_FALSE(folder.touched());
  service_->port().publish(SwapRight::kAllowed);
  swap(file);
  delete next_order().candidate;
  EXPECT_TRUE(library.touched());
}

TEST_F(Swaps, TouchNoFileOutsideOfTheFolders) {
  start(false);
  service_->port().publish(SwapRight::kAllowed);
  const TemporaryDirectory elsewhere;
  const auto file = elsewhere.path() / "good.so";
  std::filesystem::copy_file(plugin_path("good"), file);
  std::filesystem::create_symlink(file, allowed_.path() / "link.so");
  const Watched library(file);
  EXPECT_HAS(error(swap(file)).message, "plugins.folders");
  EXPECT_HAS(
      error(swap(allowed_.path() / ".." / file.parent_path().filename() / "good.so")).message,
      "plugins.folders");
  EXPECT_HAS(error(swap(allowed_.path() / "link.so")).message, "a link to elsewhere");
  EXPECT_FALSE(library.touched());
}

TEST_F(Swaps, LoadVariantsByNameAndFilesInTheFolders) {
  start(false);
  service_->port().publish(SwapRight::kAllowed);
  std::filesystem::copy_file(plugin_path("newer"), allowed_.path() / "mine.so");
  for (const std::string& to : {std::string("good"), (allowed_.path() / "mine.so").string()}) {
    const auto answer = swap(to);
    const SwapOrder order = next_order();
    ASSERT_NE(order.candidate, nullptr);
    EXPECT_EQ(order.layer, GAITD_LAYER_TOE_OFF);
    service_->port().report({.request = order.request,
                             .layer = order.layer,
                             .step = SwapStep::kRefused,
                             .why = "not today",
                             .retired = order.candidate});
    EXPECT_EQ(error(answer).message, "not today");
  }
}

TEST_F(Swaps, AreRefusedAtOnceWhileTheSameLayerIsUnderWay) {
  start(true);
  service_->port().publish(SwapRight::kAllowed);
  const auto first = swap("good");
  const auto second = swap("newer");  // answered by the call
  ASSERT_TRUE(second->has_value());
  EXPECT_EQ(error(second).code, rpc_code::kBusy);
  EXPECT_HAS(error(second).message, "busy: a swap of toe_off is under way; wait until it is done");
  const SwapOrder order = next_order();
  EXPECT_EQ(error(swap("newer")).code, rpc_code::kBusy);
  service_->port().report({.request = order.request,
                           .layer = order.layer,
                           .step = SwapStep::kRefused,
                           .why = "not today",
                           .retired = order.candidate});
  error(first);
  const auto third = swap("no_such_variant");
  EXPECT_FALSE(third->has_value());
  EXPECT_EQ(error(third).code, rpc_code::kRefused);
}

// After a swap that went well and one that had to go again, a rollback leads to the first.
TEST_F(Swaps, KnowWhatRunsAfterOneThatFailed) {
  start(true);
  service_->port().publish(SwapRight::kAllowed);
  const auto report = [this](const SwapOrder& order, SwapStep step, LoadedLayer* retired) {
    service_->port().report({.request = order.request,
                             .layer = GAITD_LAYER_TOE_OFF,
                             .step = step,
                             .why = "as the test wants it",
                             .rollback = order.candidate == nullptr,
                             .retired = retired});
  };
  const auto play = [&](const Answer& answer, std::initializer_list<SwapStep> steps) {
    const SwapOrder order = next_order();
    for (const SwapStep step : steps) {
      report(order, step, step == SwapStep::kSwitched ? nullptr : order.candidate);
    }
    error(answer);
    return service_->variant(GAITD_LAYER_TOE_OFF);
  };
  const std::string first = service_->variant(GAITD_LAYER_TOE_OFF);
  const std::string good = play(swap("good"), {SwapStep::kSwitched, SwapStep::kDone});
  EXPECT_NE(good, first);
  EXPECT_EQ(play(swap("newer"), {SwapStep::kSwitched, SwapStep::kRolledBack}), good);
  const auto rollback = [this] { return call("plugin.rollback", {{"layer", "toe_off"}}); };
  EXPECT_EQ(play(rollback(), {SwapStep::kRolledBack}), first);
  EXPECT_EQ(play(rollback(), {SwapStep::kRolledBack}), good);
}

TEST_F(Swaps, HaveRoomForSoManyAtATime) {
  start(true);
  service_->port().publish(SwapRight::kAllowed);
  std::vector<Answer> answers;
  for (int i = 0; i < 100'000; ++i) {
    answers.push_back(call("plugin.rollback", {{"layer", "toe_off"}}));
  }
  const auto waiting = std::count_if(answers.begin(), answers.end(),
                                     [](const Answer& answer) { return !answer->has_value(); });
  EXPECT_EQ(waiting, bounds::kOpenSwaps);
  EXPECT_HAS(error(answers.back()).message, "busy: 8 swaps are under way; wait");
}

TEST_F(Swaps, ThatAreRefusedLeaveNothing) {
  start(true);
  service_->port().publish(SwapRight::kAllowed);
  const auto try_all = [this] {
    for (const char* name : {"crash_in_init", "error_in_init", "bad_version", "no_destroy"}) {
      EXPECT_EQ(error(swap(plugin_path(name))).code, rpc_code::kRefused);
    }
    const auto answer = swap("good");
    const SwapOrder order = next_order();
    service_->port().report({.request = order.request,
                             .layer = order.layer,
                             .step = SwapStep::kRefused,
                             .why = "not today",
                             .retired = order.candidate});
    error(answer);
  };
  try_all();
  const int before = maps();
  const int rows = parameters_.size();
  for (int i = 0; i < 5; ++i) try_all();
  EXPECT_EQ(maps(), before);
  EXPECT_EQ(parameters_.size(), rows);
}

TEST_F(Swaps, DoNotDelayTheEnd) {
  start(true);
  service_->port().publish(SwapRight::kAllowed);
  const auto hangs = swap(plugin_path("hang_at_load"));  // for the 10 s that a try may take
  const auto waits = swap("good", "icp_planner");
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const auto began = steady_clock::now();
  service_->stop();
  EXPECT_LT(steady_clock::now() - began, std::chrono::seconds(5));
  EXPECT_HAS(error(hangs).message, "gaitd");
  EXPECT_EQ(error(waits).code, rpc_code::kStopping);
  EXPECT_EQ(error(swap("good")).code, rpc_code::kStopping);
}

}  // namespace
}  // namespace gaitd::daemon
