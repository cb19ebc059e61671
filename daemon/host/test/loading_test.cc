// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>

#include "daemon/host/loaded_plugin.h"
#include "daemon/host/test/test_files.h"
#include "gaitd/sdk/bounds.h"

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
    request.probe_options.cancel = &cancel_;
    request.log = [this](int level, std::string_view plugin, std::string_view message) {
      log_ += std::to_string(level) + " " + std::string(plugin) + ": " + std::string(message);
    };
    refusal_ = {};
    return LoadedLayer::load(request, &refusal_);
  }
  // Lines in the memory map of this process that name a library.
  static int maps_of(const std::string& file) {
    std::ifstream maps("/proc/self/maps");
    int count = 0;
    for (std::string line; std::getline(maps, line);) {
      count += line.find(":" + file + " ") != std::string::npos ? 1 : 0;
    }
    return count;
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
  std::atomic<bool> cancel_ = false;
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

TEST_F(Loading, WritesNothingIntoAFileSystem) {
  const TemporaryDirectory directory;
  setenv("XDG_RUNTIME_DIR", directory.path().c_str(), 1);
  std::filesystem::permissions(directory.path(), std::filesystem::perms::none);
  EXPECT_TRUE(load(plugin_path("good"))) << refusal_.text();
  std::filesystem::permissions(directory.path(), std::filesystem::perms::owner_all);
  EXPECT_FALSE(load(plugin_path("crash_at_load")));
  EXPECT_TRUE(std::filesystem::is_empty(directory.path()));
  unsetenv("XDG_RUNTIME_DIR");
  for (const auto& entry : std::filesystem::directory_iterator("/tmp")) {
    EXPECT_FALSE(entry.path().filename().string().starts_with("gaitd-plugin-")) << entry;
  }
}

TEST_F(Loading, ACopyCannotBeChangedAfterItWasChecked) {
  const auto file = read_plugin_file(plugin_path("good"), GAITD_LAYER_TOE_OFF, &refusal_);
  ASSERT_TRUE(file);
  const auto copy = StagedCopy::create(*file, &refusal_);
  ASSERT_TRUE(copy) << refusal_.text();
  EXPECT_TRUE(copy->holds(file->bytes));
  EXPECT_LT(pwrite(copy->fd(), "x", 1, 0), 0);
  EXPECT_NE(ftruncate(copy->fd(), 1), 0);
  std::vector<std::byte> other = file->bytes;
  other.back() ^= std::byte{1};
  EXPECT_FALSE(copy->holds(other));
}

TEST_F(Loading, ALayerIsUnmappedWithItsLastUser) {
  const int before = maps_of("good.so");
  {
    const auto layer = load(plugin_path("good"));
    ASSERT_TRUE(layer) << refusal_.text();
    EXPECT_GT(maps_of("good.so"), before);
  }
  EXPECT_EQ(maps_of("good.so"), before);
}

TEST_F(Loading, WhatIsRefusedIsUnmapped) {
  for (const char* name : {"error_in_init", "throw_in_create", "no_destroy", "unresolved"}) {
    for (int i = 0; i < 20; ++i) {
      LoadedLayer::Request request;
      request.path = plugin_path(name);
      request.layer = GAITD_LAYER_TOE_OFF;
      request.model = model_.get();
      request.probe = false;  // so that it comes into this process
      Refusal refusal;
      EXPECT_FALSE(LoadedLayer::load(request, &refusal)) << name;
    }
    EXPECT_EQ(maps_of(std::string(name) + ".so"), 0) << name;
  }
}

TEST_F(Loading, ALibraryThatStaysInMemoryIsUsedAgain) {
  int mapped = 0;
  for (int i = 0; i < 3; ++i) {
    const auto layer = load(plugin_path("stays"));
    ASSERT_TRUE(layer) << refusal_.text();
    EXPECT_EQ(run(layer.get()).side, i + 1);  // the variables of the same mapping
    if (i == 0) mapped = maps_of("stays.so");
    EXPECT_EQ(maps_of("stays.so"), mapped);
  }
  // While somebody uses it, the next one gets a mapping of its own.
  const auto first = load(plugin_path("stays"));
  const auto second = load(plugin_path("stays"));
  ASSERT_TRUE(first && second);
  EXPECT_EQ(run(second.get()).side, 1);
}

TEST_F(Loading, ThereIsRoomForSoManyThatStayInMemory) {
  const auto fill = [this] {
    const TemporaryDirectory directory;
    std::vector<char> bytes = contents(plugin_path("stays"));
    std::size_t taken = 0;
    for (;; ++taken) {
      bytes.push_back('x');  // another file, the same code
      write_file(directory.path() / "stays.so", bytes);
      if (load(directory.path() / "stays.so") == nullptr) break;
    }
    const bool said = refusal_.text().find("cannot be unloaded") != std::string::npos;
    bytes.pop_back();  // one that is there
    write_file(directory.path() / "stays.so", bytes);
    const bool again = load(directory.path() / "stays.so") != nullptr;
    _exit(said && again && taken > 0 && taken <= bounds::kIdleLibraries ? 0 : 1);
  };
  EXPECT_EXIT(fill(), ::testing::ExitedWithCode(0), "");
}

TEST_F(Loading, ATryIsEndedAtOnceWhenItIsCancelled) {
  cancel_ = true;
  EXPECT_HAS(reason("hang_at_load"), "was ended, since gaitd stops");
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
  EXPECT_HAS(reason("exit_at_load"), "load: has ended the process with exit code 0");
  EXPECT_HAS(reason("exit_at_unload"), "unload: has ended the process with exit code 0");
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

TEST_F(Loading, LibrariesThatSurviveOneChildTogetherAreProven) {
  const auto holds = [](const ProvenLibraries& proven, const std::string& name) {
    Refusal unused;
    const auto file = read_plugin_file(plugin_path(name), GAITD_LAYER_TOE_OFF, &unused);
    return file && proven.hold(*file);
  };
  const ProvenLibraries good({plugin_path("good"), "/nowhere/plugin.so"}, *model_);
  EXPECT_TRUE(holds(good, "good"));
  EXPECT_FALSE(holds(good, "crash_in_init"));
  const ProvenLibraries bad({plugin_path("good"), plugin_path("crash_in_init")}, *model_);
  EXPECT_FALSE(holds(bad, "good"));

  // Of a proven one no child is started; of others it is.
  LoadedLayer::Request request;
  request.path = plugin_path("good");
  request.layer = GAITD_LAYER_TOE_OFF;
  request.model = model_.get();
  request.probe_options.executable = "/nowhere/gaitd";
  request.probe_options.proven = &good;
  EXPECT_TRUE(LoadedLayer::load(request, &refusal_)) << refusal_.text();
  request.probe_options.proven = &bad;
  EXPECT_FALSE(LoadedLayer::load(request, &refusal_));
}

}  // namespace
}  // namespace gaitd::daemon
