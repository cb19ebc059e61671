// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "daemon/host/loaded_plugin.h"
#include "daemon/host/test/test_files.h"

namespace gaitd::daemon {
namespace {

class Loading : public ::testing::Test {
 protected:
  std::unique_ptr<LoadedLayer> load(const std::filesystem::path& path,
                                    std::vector<double> parameters = {}) {
    LoadedLayer::Request request;
    request.path = path;
    request.layer = GAITD_LAYER_TOE_OFF;
    request.model = model_.get();
    request.parameters = std::move(parameters);
    request.probe_options.timeout = std::chrono::milliseconds(timeout_ms_);
    request.log = [this](int level, std::string_view plugin, std::string_view message) {
      log_ += std::to_string(level) + " " + std::string(plugin) + ": " + std::string(message);
    };
    refusal_ = {};
    return LoadedLayer::load(request, &refusal_);
  }
  // The reason why a test plugin was refused, "" if it was not.
  std::string reason(const std::string& name) {
    const auto layer = load(plugin_path(name));
    return layer != nullptr ? "" : refusal_.text();
  }
  static GaitdToeOff run(LoadedLayer* layer) {
    GaitdToeOff output{};
    EXPECT_EQ(layer->process(nullptr, &output), GAITD_OK);
    return output;
  }

  std::unique_ptr<GaitdModel> model_ = some_model();
  int timeout_ms_ = 20000;
  std::string log_;
  Refusal refusal_;
};

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST_F(Loading, MakesAnActiveInstanceWithItsDefaults) {
  const auto layer = load(plugin_path("good"));
  ASSERT_TRUE(layer) << refusal_.text();
  EXPECT_EQ(run(layer.get()).criterion[0], 2.0);
  EXPECT_EQ(layer->library().path(), plugin_path("good"));
  EXPECT_EQ(layer->get_extension("anything"), nullptr);
  EXPECT_EQ(log_, "1 toe_off/good: some robot");
}

TEST_F(Loading, PassesParametersAndRefusesBadOnes) {
  const auto layer = load(plugin_path("good"), {4.5, 1.0});
  ASSERT_TRUE(layer) << refusal_.text();
  EXPECT_EQ(run(layer.get()).criterion[0], 4.5);
  EXPECT_EQ(layer->set_parameter(0, 6.0), GAITD_OK);
  EXPECT_EQ(run(layer.get()).criterion[0], 6.0);

  EXPECT_FALSE(load(plugin_path("good"), {11.0, 1.5}));
  EXPECT_EQ(refusal_.reasons.size(), 2u) << refusal_.text();
  EXPECT_FALSE(load(plugin_path("good"), {1.0}));
  EXPECT_HAS(refusal_.text(), "one for each of its 2");
}

TEST_F(Loading, RunsTheNewCodeAfterTheFileWasReplaced) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "plugin.so";
  std::filesystem::copy_file(plugin_path("good"), path);
  const auto first = load(path);
  ASSERT_TRUE(first) << refusal_.text();
  write_file(path, contents(plugin_path("newer")));
  const auto second = load(path);
  ASSERT_TRUE(second) << refusal_.text();
  EXPECT_EQ(run(first.get()).active, 1);
  EXPECT_EQ(run(second.get()).active, 2);
  EXPECT_GT(second->library().generation(), first->library().generation());
  EXPECT_NE(second->library().hash(), first->library().hash());
}

TEST_F(Loading, GivesEachInstanceOfTheSameFileItsOwnVariables) {
  const auto first = load(plugin_path("good"));
  const auto second = load(plugin_path("good"));
  ASSERT_TRUE(first && second);
  EXPECT_EQ(run(first.get()).side, 1);
  EXPECT_EQ(run(first.get()).side, 2);
  EXPECT_EQ(run(second.get()).side, 1);
}

TEST_F(Loading, LeavesNoStagedCopyBehind) {
  const TemporaryDirectory directory;
  setenv("XDG_RUNTIME_DIR", directory.path().c_str(), 1);
  EXPECT_TRUE(load(plugin_path("good")));
  EXPECT_FALSE(load(plugin_path("crash_at_load")));
  EXPECT_TRUE(std::filesystem::is_empty(directory.path()));
  unsetenv("XDG_RUNTIME_DIR");
}

TEST_F(Loading, ACrashIsCaughtInTheChildAndNamed) {
  const std::string at_load = reason("crash_at_load");
  EXPECT_HAS(at_load, "load: has crashed with SIG");
  EXPECT_HAS(reason("crash_in_init"), "init: has crashed with SIG");
}

TEST_F(Loading, AHangIsEndedAfterTheTimeout) {
  timeout_ms_ = 500;
  EXPECT_HAS(reason("hang_at_load"), "load: has hung: not done after 500 ms");
}

TEST_F(Loading, ALibraryThatEndsTheProcessIsRefused) {
  EXPECT_HAS(reason("exit_at_load"), "ended the process with exit code 0");
}

TEST_F(Loading, AnUnresolvedSymbolIsNamed) {
  EXPECT_HAS(reason("unresolved"), "gaitd_test_function_that_nobody_has");
}

TEST_F(Loading, AChildStartsNoChildOfItsOwn) {
  setenv("GAITD_CHILD_PROCESS", "1", 1);
  EXPECT_HAS(reason("good"), "a child process starts no child");
  unsetenv("GAITD_CHILD_PROCESS");
}

TEST_F(Loading, AFailedInitIsReportedWithWhatThePluginLogged) {
  const std::string text = reason("error_in_init");
  EXPECT_HAS(text, "init() returned GAITD_ERROR (-1)");
  EXPECT_HAS(text, "this robot has no toes");
}

TEST_F(Loading, AnExceptionAcrossTheBoundaryIsARefusal) {
  EXPECT_HAS(reason("throw_in_init"), "no such luck");
  EXPECT_HAS(reason("throw_in_create"), "out of order");
}

TEST_F(Loading, AnExceptionOutOfProcessIsAStatus) {
  const auto layer = load(plugin_path("throw_in_process"));
  ASSERT_TRUE(layer) << refusal_.text();
  GaitdToeOff output{};
  EXPECT_EQ(layer->process(nullptr, &output), GAITD_EXCEPTION);
}

TEST_F(Loading, ABackendIsNoLayer) {
  EXPECT_HAS(reason("backend"), "layer: has backend, needs toe_off");
}

TEST_F(Loading, AMissingFunctionIsNamed) {
  EXPECT_HAS(reason("no_destroy"), "no function in the vtable for: destroy");
}

TEST_F(Loading, AChildThatCannotStartIsReported) {
  LoadedLayer::Request request;
  request.path = plugin_path("good");
  request.layer = GAITD_LAYER_TOE_OFF;
  request.model = model_.get();
  request.probe_options.executable = "/nowhere/gaitd";
  Refusal refusal;
  EXPECT_FALSE(LoadedLayer::load(request, &refusal));
  EXPECT_HAS(refusal.text(), "start of /nowhere/gaitd");
}

TEST_F(Loading, MakesABackendAndPassesOnItsErrors) {
  LoadedBackend::Request request;
  request.path = plugin_path("backend");
  request.model = model_.get();
  Refusal refusal;
  const auto backend = LoadedBackend::load(request, &refusal);
  ASSERT_TRUE(backend) << refusal.text();
  EXPECT_EQ(backend->init(*model_, "{}", 0.001, GAITD_CLOCK_LOCKSTEP), "");
  EXPECT_EQ(backend->init(*model_, "[]", 0.001, GAITD_CLOCK_LOCKSTEP),
            "backend backend: init: can0: no such key\ncan1: out of range");
  EXPECT_NE(backend->instance().vtable->health, nullptr);
  request.path = plugin_path("good");
  EXPECT_FALSE(LoadedBackend::load(request, &refusal));
}

TEST_F(Loading, ABackendBuiltBeforeHealthWasAddedHasNone) {
  LoadedBackend::Request request;
  request.path = plugin_path("old_backend");
  request.model = model_.get();
  Refusal refusal;
  const auto backend = LoadedBackend::load(request, &refusal);
  ASSERT_TRUE(backend) << refusal.text();
  EXPECT_EQ(backend->init(*model_, "{}", 0.001, GAITD_CLOCK_LOCKSTEP), "");
  EXPECT_EQ(backend->instance().vtable->health, nullptr);
}

}  // namespace
}  // namespace gaitd::daemon
