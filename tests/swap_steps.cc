// SPDX-License-Identifier: Apache-2.0
// swap_steps LOG: for every hot swap in a log of gaitd, how far the joint torques of the tick at
// which it took place are from those that the layer before would have commanded in that tick. A
// replay of the log comes to the tick before; a copy of the process then refuses the swap and goes
// on. Prints a line for each: tick, layer, phase of the gait, joint, step over the effort limit.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "daemon/config/paths.h"
#include "daemon/host/layers.h"
#include "daemon/replay/replay.h"

namespace gaitd::daemon {
namespace {

using Torques = std::array<double, GAITD_MAX_JOINTS>;

Torques torques_of(const TickData& data) {
  Torques torques;
  for (int i = 0; i < GAITD_MAX_JOINTS; ++i) torques[i] = data.commands.joints[i].torque;
  return torques;
}

// Layers by the tick in which they are in use for the first time.
std::map<std::int64_t, std::vector<int>> switches(const LogReader& log) {
  std::map<std::int64_t, std::vector<int>> all;
  for (const Event& event : log.events()) {
    if (event.kind != event_kind_name(EventKind::kSwap)) continue;
    const auto text = nlohmann::json::parse(event.text, nullptr, false);
    if (!text.is_object() || text.value("step", "") != "switched") continue;
    if (const auto layer = layer_from_name(text.value("layer", ""))) {
      all[event.tick].push_back(*layer);
    }
  }
  return all;
}

// Runs the ticks up to `tick` without the swaps of `layers`, in a process of its own.
class WithoutSwap {
 public:
  WithoutSwap(std::int64_t tick, int layer, Pipeline& pipeline) : tick_(tick), layer_(layer) {
    int ends[2];
    if (pipe(ends) != 0) std::exit(1);
    std::fflush(stdout);
    child_ = fork();
    if (child_ == 0) {
      close(ends[0]);
      out_ = ends[1];
      pipeline.begin_swap({.layer = layer});  // without a candidate: the swap is taken back
      return;
    }
    close(ends[1]);
    in_ = ends[0];
  }
  bool child() const { return child_ == 0; }
  std::int64_t tick() const { return tick_; }
  int layer() const { return layer_; }

  // In the copy, after `tick`.
  [[noreturn]] void answer(const Torques& torques) const {
    const bool written = write(out_, torques.data(), sizeof(torques)) == sizeof(torques);
    _exit(written ? 0 : 1);
  }
  Torques result() const {
    Torques torques{};
    std::size_t size = 0;
    while (size < sizeof(torques)) {
      const ssize_t count =
          read(in_, reinterpret_cast<char*>(torques.data()) + size, sizeof(torques) - size);
      if (count <= 0) std::exit(1);
      size += static_cast<std::size_t>(count);
    }
    close(in_);
    waitpid(child_, nullptr, 0);
    return torques;
  }

 private:
  std::int64_t tick_;
  int layer_;
  pid_t child_ = -1;
  int in_ = -1;
  int out_ = -1;
};

int run(const char* file) {
  std::string error;
  const auto log = LogReader::open(file, &error);
  if (log == nullptr) {
    std::fprintf(stderr, "swap_steps: %s\n", error.c_str());
    return 1;
  }
  const auto planned = switches(*log);
  std::vector<WithoutSwap> copies;
  const GaitdModel* robot = nullptr;
  bool is_copy = false;
  ReplayOptions options{Paths::detect().plugin_folders(), {}, {}, {}};
  options.before_tick = [&](const GaitdModel& model, std::int64_t tick, Pipeline& pipeline) {
    robot = &model;
    const auto found = planned.find(tick + 1);
    if (is_copy || found == planned.end()) return;
    for (const int layer : found->second) {
      copies.emplace_back(tick + 1, layer, pipeline);
      is_copy = copies.back().child();
      if (is_copy) return;
    }
  };
  options.after_tick = [&](const TickData& data) {
    if (copies.empty() || copies.back().tick() != data.time.tick) return;
    const Torques torques = torques_of(data);
    if (is_copy) copies.back().answer(torques);
    for (const WithoutSwap& copy : copies) {
      const Torques without = copy.result();
      int worst = 0;
      double largest = 0.0;
      for (int i = 0; i < robot->joint_count; ++i) {
        const double step = std::abs(torques[i] - without[i]) / robot->joints[i].effort_limit;
        if (step <= largest) continue;
        largest = step;
        worst = i;
      }
      const char* phase = data.gait.phase == GAITD_PHASE_SWING      ? "swing"
                          : data.gait.phase == GAITD_PHASE_TRANSFER ? "transfer"
                                                                    : "stand";
      std::printf("%lld %s %s %s %.6f\n", static_cast<long long>(copy.tick()),
                  std::string(layer_name(copy.layer())).c_str(), phase, robot->joints[worst].name,
                  largest);
    }
    copies.clear();
  };
  const auto report = replay(*log, options, &error);
  if (!report || !report->differences.empty()) {
    std::fprintf(stderr, "swap_steps: %s\n",
                 report ? "the replay is not what was recorded" : error.c_str());
    return 1;
  }
  return 0;
}

}  // namespace
}  // namespace gaitd::daemon

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: swap_steps LOG\n");
    return 2;
  }
  return gaitd::daemon::run(argv[1]);
}
