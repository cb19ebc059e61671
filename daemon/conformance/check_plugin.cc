// SPDX-License-Identifier: Apache-2.0
#include "daemon/conformance/check_plugin.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <sstream>
#include <string_view>

#include "daemon/conformance/check_child.h"
#include "daemon/host/child_process.h"
#include "daemon/host/layers.h"
#include "daemon/host/plugin_file.h"

namespace gaitd::daemon {
namespace {

// Every program that can check can be the child as well, whatever its main() does. It stands beside
// check_plugin(), so that no program gets the one without the other.
__attribute__((constructor)) void become_check_child(int argc, char** argv, char**) {
  if (argc == 4 && std::strcmp(argv[1], kCheckArgument) == 0) {
    _exit(run_check_child(argv[2], argv[3]));
  }
}

enum class Of { kAll, kLayers, kSimulations };

struct Demand {
  const char* name;
  Of of;
  const char* demands;
};

// The suite, in the order of the report. docs/plugins.md explains each.
constexpr Demand kSuite[] = {
    {"file", Of::kAll, "a complete shared library for this machine"},
    {"descriptor", Of::kAll, "a descriptor of this ABI with sound names and parameters"},
    {"symbols", Of::kAll, "the entry function exported"},
    {"thread_local", Of::kAll, "no thread-local storage in a layer"},
    {"sharing", Of::kAll, "no unique symbols, which all copies of the library share"},
    {"binding", Of::kAll, "linked with -z now"},
    {"load", Of::kAll, "loads with every symbol resolved"},
    {"create", Of::kAll, "makes instances, and none for a host of another ABI"},
    {"init", Of::kLayers, "takes the robot and its parameters"},
    {"destroy", Of::kAll, "ends an instance cleanly"},
    {"unload", Of::kLayers, "leaves memory after its last user"},
    {"process", Of::kLayers, "answers every tick of a walk with a sound output"},
    {"time", Of::kLayers, "within its declared worst case"},
    {"allocation", Of::kLayers, "no heap in process() after warm-up"},
    {"repeatable", Of::kLayers, "the same inputs give the same bits"},
    {"state", Of::kLayers, "hands its state over to another instance"},
    {"parameters", Of::kLayers, "parameters change live, bad values are refused"},
    {"sizes", Of::kLayers, "too short inputs are refused, longer ones taken"},
    {"bad_numbers", Of::kLayers, "survives numbers that are none, recovers by reset()"},
    {"world", Of::kSimulations, "takes a world, and says what is wrong with a bad one"},
    {"reading", Of::kSimulations,
     "shows the robot at rest, its soles loaded, before the first tick"},
    {"standing", Of::kSimulations, "a robot that is held in its posture stands for a minute"},
    {"truth", Of::kSimulations, "truth and sensors are of the same robot"},
    {"push", Of::kSimulations, "a push moves the robot, a bad one is refused"},
    {"carry", Of::kSimulations, "a load weighs, where masses can be changed"},
    {"reset", Of::kSimulations, "starts over, and the same commands give the same bits"}};

// The check that a reason of the host belongs to.
std::string_view check_of(const std::string& what) {
  if (what == "symbols") return "symbols";
  if (what == "thread-local storage") return "thread_local";
  for (const char* part : {"descriptor", "magic", "abi", "struct_size", "layer", "id", "version",
                           "build", "worst_case_us", "capabilities", "parameter"}) {
    if (what.starts_with(part)) return "descriptor";
  }
  return "file";
}

CheckResult& find(PluginReport& report, std::string_view name) {
  return *std::find_if(report.checks.begin(), report.checks.end(),
                       [&](const CheckResult& c) { return c.name == name; });
}

void set(PluginReport& report, std::string_view name, CheckVerdict verdict,
         const std::string& detail) {
  CheckResult& check = find(report, name);
  check.verdict = verdict;
  check.detail += (check.detail.empty() ? "" : "; ") + detail;
}

// What the file says without being loaded. True if it may be loaded.
bool check_file(PluginReport& report) {
  Refusal refusal;
  const auto file = read_plugin_file(report.file, std::nullopt, &refusal);
  for (CheckResult& check : report.checks) check.detail.clear();
  for (const Refusal::Reason& reason : refusal.reasons) {
    set(report, check_of(reason.what), CheckVerdict::kFail,
        reason.what + ": has " + reason.has + ", needs " + reason.needed + "; " + reason.remedy);
  }
  if (!file) {
    const bool readable = find(report, "file").verdict != CheckVerdict::kFail;
    if (readable) set(report, "file", CheckVerdict::kPass, "");
    return false;
  }
  report.descriptor = file->descriptor;
  for (const char* name : {"file", "descriptor", "symbols", "thread_local"}) {
    set(report, name, CheckVerdict::kPass, "");
  }
  const bool layer = file->descriptor.layer != GAITD_LAYER_BACKEND;
  find(report, "descriptor").detail = std::string(layer_name(file->descriptor.layer)) + "/" +
                                      file->descriptor.id + " " + file->descriptor.version + ", " +
                                      std::to_string(file->descriptor.parameter_count) +
                                      " parameters";
  if (file->unique.empty()) {
    set(report, "sharing", CheckVerdict::kPass, "");
  } else {
    set(report, "sharing", layer ? CheckVerdict::kFail : CheckVerdict::kWarning,
        std::to_string(file->unique.size()) + " unique symbols, among them " + file->unique[0] +
            "; compile with -fno-gnu-unique -fvisibility=hidden");
  }
  if (file->binds_now) {
    set(report, "binding", CheckVerdict::kPass, "");
  } else {
    set(report, "binding", CheckVerdict::kWarning,
        "a symbol may be resolved at its first use, in a tick; link with -Wl,-z,now");
  }
  return true;
}

// Takes the lines of a child into the report.
void collect(const ChildEnd& end, PluginReport& report) {
  std::string running = "load";
  std::istringstream lines(end.report);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string first, name, detail;
    words >> first >> name;
    std::getline(words >> std::ws, detail);
    if (first == "begin") running = name;
    if (first.size() != 1 || first[0] < '0' || first[0] > '3') continue;
    CheckResult& check = find(report, name);
    check.verdict = static_cast<CheckVerdict>(first[0] - '0');
    check.detail = detail;
    if (running == name) running.clear();
  }
  std::string what = end.start_error.empty() ? end.abnormal_end() : end.start_error;
  if (what.empty()) what = end.last("error ");
  if (what.empty()) return;
  if (running.empty()) {
    const bool loaded = find(report, "load").verdict == CheckVerdict::kPass;
    running = loaded ? report.checks.back().name : "load";
  }
  CheckResult& check = find(report, running);
  check.verdict = CheckVerdict::kFail;
  check.detail = what;
}

}  // namespace

const char* check_verdict_text(CheckVerdict verdict) {
  constexpr std::array<const char*, 4> kTexts = {"pass", "warning", "FAIL", "skipped"};
  return kTexts[static_cast<std::size_t>(verdict)];
}

int PluginReport::count(CheckVerdict verdict) const {
  return static_cast<int>(std::count_if(
      checks.begin(), checks.end(), [&](const CheckResult& c) { return c.verdict == verdict; }));
}

PluginReport check_plugin(const std::filesystem::path& file, const GaitdModel& model,
                          const CheckOptions& options) {
  PluginReport report;
  report.file = file.string();
  report.descriptor.layer = -1;
  for (const Demand& demand : kSuite) {
    report.checks.push_back({demand.name, demand.demands, CheckVerdict::kSkipped, ""});
  }
  const bool loadable = check_file(report);
  const bool backend = report.descriptor.layer == GAITD_LAYER_BACKEND;
  const bool simulation =
      backend && (report.descriptor.capabilities & GAITD_CAPABILITY_SIMULATION) != 0;
  // What is not of this kind of plugin is not in its report.
  for (const Demand& demand : kSuite) {
    const bool foreign = demand.of == (simulation ? Of::kLayers : Of::kSimulations);
    if (!loadable || !foreign) continue;
    std::erase_if(report.checks,
                  [&](const CheckResult& check) { return check.name == demand.name; });
  }
  for (CheckResult& check : report.checks) {
    if (check.verdict != CheckVerdict::kSkipped) continue;
    check.detail = loadable && backend && !simulation
                       ? "nothing of a backend is called that may touch hardware"
                       : "not tried after the failure above";
  }
  const auto run = [&](const char* group) {
    const int before = report.count(CheckVerdict::kFail);
    const std::string path = std::filesystem::absolute(file).string();
    collect(run_child({.executable = options.executable,
                       .arguments = {kCheckArgument, group, path},
                       .model = &model,
                       .timeout = options.timeout}),
            report);
    return report.count(CheckVerdict::kFail) == before;
  };
  if (!loadable) return report;
  if (backend) {
    if (run("backend") && simulation) run("simulation");
  } else if (run("load")) {
    for (const char* group : {"walk", "repeat", "parameters", "inputs"}) run(group);
  }
  return report;
}

}  // namespace gaitd::daemon
