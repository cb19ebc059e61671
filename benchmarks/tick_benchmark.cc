// SPDX-License-Identifier: Apache-2.0
// A whole tick and the speed in lockstep, from five runs of gaitd: the runs are alike to the bit,
// so the least time of each tick counts.
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "daemon/log/log_reader.h"
#include "measure.h"

namespace gaitd::benchmarks {
namespace {

namespace fs = std::filesystem;
constexpr const char* kTimes[] = {"total", "estimator", "planner", "adjuster", "toe_off", "wbc"};
constexpr const char* kWalk = "straight-0.35";
constexpr double kPeriod = 1000.0;  // us

// Keeps this process and its children on one processor.
class OneProcessor {
 public:
  OneProcessor() {
    sched_getaffinity(0, sizeof(before_), &before_);
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(sched_getcpu(), &one);
    sched_setaffinity(0, sizeof(one), &one);
  }
  ~OneProcessor() { sched_setaffinity(0, sizeof(before_), &before_); }
  OneProcessor(const OneProcessor&) = delete;
  OneProcessor& operator=(const OneProcessor&) = delete;

 private:
  cpu_set_t before_;
};

double processor_seconds_of_children() {
  rusage usage;
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

struct Runs {
  bool ok = false;
  std::map<std::string, std::vector<double>> least_us;  // of each tick from the first step on
  double simulated = 0.0;                               // s
  double least_wall = 1e9;                              // s
  double least_processor = 1e9;                         // s, of all threads, with the verdict
  double calibration = 0.0;
};

bool read_times(const std::string& file, Runs* runs) {
  std::string error;
  const auto log = daemon::LogReader::open(file, &error);
  if (!log) return false;
  const std::vector<double> step = log->column("gait/step_index");
  const std::vector<double> phase = log->column("gait/phase");
  for (const char* name : kTimes) {
    const std::vector<double> all = log->column(std::string("tick/") + name + "_us");
    std::vector<double> walking;
    for (std::size_t t = 0; t < all.size(); ++t) {
      if (step[t] > 0.0 && phase[t] > 0.0) walking.push_back(all[t]);
    }
    std::vector<double>& least = runs->least_us[name];
    if (least.empty()) least = walking;
    if (least.size() != walking.size() || walking.empty()) return false;
    for (std::size_t t = 0; t < walking.size(); ++t) least[t] = std::min(least[t], walking[t]);
  }
  runs->simulated = 0.001 * static_cast<double>(log->tick_count());
  const auto wall = log->metadata_value("wall_seconds");
  if (wall) runs->least_wall = std::min(runs->least_wall, std::atof(wall->c_str()));
  return true;
}

Runs run_five_times(const std::string& scenario) {
  Runs runs;
  std::string folder = (fs::temp_directory_path() / "gaitd-benchmark-XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr) return runs;
  const fs::path gaitctl = fs::read_symlink("/proc/self/exe").parent_path() / "../bin/gaitctl";
  const std::string log = folder + "/walk.mcap";
  const std::string command =
      gaitctl.string() + " run " + scenario + " --log " + log + " >/dev/null 2>&1";
  runs.calibration = calibration();
  runs.ok = true;
  for (int repeat = 0; repeat < 5 && runs.ok; ++repeat) {
    const OneProcessor one;
    const double before = processor_seconds_of_children();
    runs.ok = std::system(command.c_str()) == 0 && read_times(log, &runs);
    runs.least_processor = std::min(runs.least_processor, processor_seconds_of_children() - before);
    runs.calibration = std::min(runs.calibration, calibration());
  }
  fs::remove_all(folder);
  return runs;
}

const Runs& runs(const std::string& scenario) {
  static std::map<std::string, Runs> all;
  const auto found = all.find(scenario);
  return found != all.end() ? found->second
                            : all.emplace(scenario, run_five_times(scenario)).first->second;
}

void tick(benchmark::State& state, const std::string& scenario, const std::string& name) {
  const Runs& r = runs(scenario);
  if (!r.ok) return state.SkipWithError("gaitctl run failed");
  const std::vector<double>& times = r.least_us.at(name);
  for (auto _ : state) show(state, distribution(times), r.calibration);
  state.counters["overruns"] = static_cast<double>(
      std::count_if(times.begin(), times.end(), [](double us) { return us > kPeriod; }));
}

// Seconds of the walk over seconds that it took: of the clock, and of the processor.
void lockstep(benchmark::State& state) {
  const Runs& r = runs(kWalk);
  if (!r.ok) return state.SkipWithError("gaitctl run failed");
  for (auto _ : state) state.SetIterationTime(r.least_wall);
  state.counters["times_real_time"] = r.simulated / r.least_wall;
  state.counters["by_processor_time"] = r.simulated / r.least_processor;
}

}  // namespace

void add_tick_benchmarks() {
  for (const char* name : kTimes) {
    add(std::string("tick/") + name, [name](benchmark::State& state) { tick(state, kWalk, name); });
  }
  add("tick/swaps", [](benchmark::State& state) { tick(state, "swaps", "total"); });
  add("lockstep", lockstep);
}

}  // namespace gaitd::benchmarks
