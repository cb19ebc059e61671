// SPDX-License-Identifier: Apache-2.0
// A zoo of plugins, each with one thing wrong: the suite names it, and survives.
#include "daemon/conformance/check_plugin.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "daemon/conformance/allocation_guard.h"
#include "walking/test/atlas.h"

namespace gaitd::daemon {
namespace {

std::string zoo(const std::string& name) { return std::string(GAITD_ZOO) + "/" + name + ".so"; }
std::string host_plugin(const std::string& name) {
  return std::string(GAITD_TEST_PLUGINS) + "/toe_off/" + name + ".so";
}

PluginReport report_of(const std::string& file, int timeout_ms = 120000) {
  CheckOptions options;
  options.timeout = std::chrono::milliseconds(timeout_ms);
  return check_plugin(file, testing::atlas(), options);
}

std::string text(const PluginReport& report) {
  std::string out;
  for (const CheckResult& c : report.checks) {
    out += std::string(check_verdict_text(c.verdict)) + " " + c.name + " " + c.detail + "\n";
  }
  return out;
}

const CheckResult& check(const PluginReport& report, const std::string& name) {
  return *std::find_if(report.checks.begin(), report.checks.end(),
                       [&](const CheckResult& c) { return c.name == name; });
}

struct Fault {
  std::string plugin;
  std::string check;    // the only one that fails
  std::string message;  // that its detail has
  int timeout_ms = 120000;
};
std::ostream& operator<<(std::ostream& out, const Fault& fault) { return out << fault.plugin; }

class Zoo : public ::testing::TestWithParam<Fault> {};

TEST_P(Zoo, IsNamedByTheSuite) {
  const Fault& fault = GetParam();
  if (fault.check == "allocation" && !allocations_are_counted()) GTEST_SKIP() << "sanitizer";
  const PluginReport report =
      report_of(fault.plugin.find('/') == std::string::npos ? zoo(fault.plugin) : fault.plugin,
                fault.timeout_ms);
  EXPECT_FALSE(report.pass());
  const CheckResult& c = check(report, fault.check);
  EXPECT_EQ(c.verdict, CheckVerdict::kFail) << text(report);
  EXPECT_NE(c.detail.find(fault.message), std::string::npos) << text(report);
}

INSTANTIATE_TEST_SUITE_P(
    AtRunTime, Zoo,
    ::testing::Values(Fault{"throw_in_create", "create",
                            "threw an exception across the C boundary"},
                      Fault{"accept_any_abi", "create", "accepts a host of another ABI major"},
                      Fault{"crash_in_create", "create", "crashed with SIGSEGV"},
                      Fault{"no_process", "create", "no function in the vtable for: process"},
                      Fault{"null_vtable", "create", "left the vtable null"},
                      Fault{"throw_in_init", "init", "no such luck"},
                      Fault{"error_in_init", "init", "it logged: this robot has no toes"},
                      Fault{"crash_in_init", "init", "crashed with SIGSEGV"},
                      Fault{"any_model", "init", "model of a smaller size"},
                      Fault{"crash_in_destroy", "destroy", "crashed with SIGSEGV"},
                      Fault{"crash_at_exit", "unload", "crashed with SIGSEGV"},
                      Fault{"nan_output", "process", "criterion: is not finite (tick 700, "},
                      Fault{"error_status", "process", "process() returned GAITD_ERROR (tick 700"},
                      Fault{"throw_in_process", "process", "GAITD_EXCEPTION"},
                      Fault{"crash_in_process", "process", "crashed with SIGSEGV"},
                      Fault{"hang_in_process", "process", "hung: not done after 1500 ms", 1500},
                      Fault{"exit_in_process", "process", "ended the process with exit code 0"},
                      Fault{"wrong_output_size", "process", "size: is not that of the struct"},
                      Fault{"no_such_side", "process", "side: is no foot"},
                      Fault{"slower", "time", "declared worst case 0.5 us"},
                      Fault{"allocate", "allocation", "1 allocations in"},
                      Fault{"random", "repeatable", "differ at tick 0"},
                      Fault{"shared_counter", "repeatable", "differ at tick 0"},
                      Fault{"forget_in_reset", "repeatable", "reset() must leave nothing"},
                      Fault{"throw_in_reset", "init", "GAITD_EXCEPTION"},
                      Fault{"state_size", "state", "left size 0"},
                      Fault{"state_lost", "state", "gives another state"},
                      Fault{"any_state", "state", "accepts a state of size 0"},
                      Fault{"any_index", "parameters", "an index beyond its table"},
                      Fault{"any_value", "parameters", "accepts nan for gain"},
                      Fault{"crash_on_limit", "parameters", "crashed with SIGFPE"},
                      Fault{"any_input", "sizes", "accepts an input of 0 bytes"},
                      Fault{"refuse_longer", "sizes", "fields appended"},
                      Fault{"crash_on_nan", "bad_numbers", "crashed with SIGFPE"},
                      Fault{"stuck_on_nan", "bad_numbers", "reset() must clear"},
                      Fault{"unique", "sharing", "-fno-gnu-unique"}),
    [](const auto& info) { return info.param.plugin; });

std::vector<Fault> host_faults() {
  std::vector<Fault> faults = {{"wrong_magic", "descriptor", "magic: has 42"},
                               {"wrong_major", "descriptor", "abi: has 7.0"},
                               {"wrong_minor", "descriptor", "abi: has 1.9"},
                               {"wrong_size", "descriptor", "struct_size: has 64"},
                               {"unknown_layer", "descriptor", "layer: has 77"},
                               {"ill_named", "descriptor", "Bad-Name"},
                               {"bad_range", "descriptor", "default"},
                               {"twice_named", "descriptor", "the name of an earlier parameter"},
                               {"bad_version", "descriptor", "a semantic version"},
                               {"no_section", "descriptor", "no section"},
                               {"no_create", "symbols", "no exported gaitd_create"},
                               {"thread_local", "thread_local", "PT_TLS"},
                               {"unresolved", "load", "gaitd_test_function_that_nobody_has"},
                               {"crash_at_load", "load", "crashed with SIGSEGV"},
                               {"exit_at_load", "load", "ended the process with exit code 0"},
                               {"hang_at_load", "load", "hung: not done after 1000 ms", 1000}};
  for (Fault& fault : faults) fault.plugin = host_plugin(fault.plugin);
  return faults;
}
INSTANTIATE_TEST_SUITE_P(InTheFileOrAtLoad, Zoo, ::testing::ValuesIn(host_faults()),
                         [](const auto& info) {
                           return std::filesystem::path(info.param.plugin).stem().string();
                         });

TEST(Conformance, ASoundPluginPassesEverything) {
  const PluginReport report = report_of(zoo("sound"));
  EXPECT_TRUE(report.pass()) << text(report);
  EXPECT_EQ(report.count(CheckVerdict::kPass) + (allocations_are_counted() ? 0 : 1),
            static_cast<int>(report.checks.size()))
      << text(report);
  EXPECT_STREQ(report.descriptor.id, "sound");
}

TEST(Conformance, WhatIsOnlyWorthALookIsAWarning) {
  const PluginReport slow = report_of(zoo("slow"));
  EXPECT_EQ(check(slow, "time").verdict, CheckVerdict::kWarning) << text(slow);
  EXPECT_TRUE(slow.pass()) << text(slow);
  const PluginReport lazy = report_of(zoo("lazy"));
  EXPECT_EQ(check(lazy, "binding").verdict, CheckVerdict::kWarning) << text(lazy);
  EXPECT_TRUE(lazy.pass()) << text(lazy);
}

TEST(Conformance, AfterAFailureOfTheFileNothingIsLoaded) {
  const PluginReport report = report_of(host_plugin("wrong_major"));
  for (const char* name : {"load", "create", "process"}) {
    EXPECT_EQ(check(report, name).verdict, CheckVerdict::kSkipped) << text(report);
  }
}

TEST(Conformance, FilesThatAreNoPluginFailTheFirstCheck) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / "gaitd-conformance";
  std::filesystem::create_directories(folder);
  const auto write = [&](const std::string& name, const std::string& bytes) {
    std::ofstream(folder / name, std::ios::binary) << bytes;
    return (folder / name).string();
  };
  std::ifstream in(zoo("sound"), std::ios::binary);
  std::string sound((std::istreambuf_iterator<char>(in)), {});
  std::string other = sound;
  other[18] = static_cast<char>(183);  // e_machine: AArch64
  const std::string files[] = {write("empty.so", ""),
                               write("script.so", "#!/bin/sh\nexit 0\n"),
                               write("truncated.so", sound.substr(0, sound.size() / 2)),
                               write("other_machine.so", other),
                               folder.string(),
                               (folder / "none.so").string()};
  const char* needs[] = {"no ELF file", "no ELF file",     "cut off or damaged",
                         "machine 183", "no regular file", "needs a readable shared library"};
  for (std::size_t i = 0; i < std::size(files); ++i) {
    const PluginReport report = report_of(files[i]);
    EXPECT_EQ(check(report, "file").verdict, CheckVerdict::kFail) << text(report);
    EXPECT_NE(check(report, "file").detail.find(needs[i]), std::string::npos) << text(report);
    EXPECT_EQ(report.count(CheckVerdict::kPass), 0) << text(report);
  }
  std::filesystem::remove_all(folder);
}

TEST(Conformance, ABackendIsMadeButNotStarted) {
  const PluginReport report = report_of(host_plugin("backend"));
  EXPECT_EQ(check(report, "destroy").verdict, CheckVerdict::kPass) << text(report);
  EXPECT_EQ(check(report, "process").verdict, CheckVerdict::kSkipped);
}

}  // namespace
}  // namespace gaitd::daemon
