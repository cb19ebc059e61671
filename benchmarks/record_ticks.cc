// SPDX-License-Identifier: Apache-2.0
// record_ticks LOG OUT FROM:COUNT...: replays a log of gaitd and keeps what the layers read in some
// windows of ticks. So the files in data/ were made; see data/README.md.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "daemon/config/paths.h"
#include "daemon/replay/replay.h"
#include "recorded_ticks.h"

int main(int argc, char** argv) {
  using namespace gaitd;
  if (argc < 4) {
    std::fprintf(stderr, "usage: record_ticks LOG OUT FROM:COUNT...\n");
    return 2;
  }
  std::vector<std::pair<std::int64_t, std::int64_t>> windows;  // first tick, one past the last
  for (int i = 3; i < argc; ++i) {
    char* end = nullptr;
    const std::int64_t from = std::strtoll(argv[i], &end, 10);
    const std::int64_t count = *end == ':' ? std::strtoll(end + 1, nullptr, 10) : 0;
    windows.emplace_back(from, from + count);
  }
  std::string error;
  const auto log = daemon::LogReader::open(argv[1], &error);
  std::vector<benchmarks::RecordedTick> ticks;
  daemon::ReplayOptions options;
  options.plugin_folders = daemon::Paths::detect().plugin_folders();
  options.after_tick = [&](const daemon::TickData& d) {
    for (const auto& [from, to] : windows) {
      if (d.time.tick < from || d.time.tick >= to) continue;
      ticks.push_back({d.robot, d.gait, d.plan, d.toe_off, d.objectives});
      return;
    }
  };
  const auto report = log ? daemon::replay(*log, options, &error) : std::nullopt;
  if (!report) {
    std::fprintf(stderr, "record_ticks: %s\n", error.c_str());
    return 1;
  }
  if (!benchmarks::write_ticks(argv[2], ticks)) {
    std::fprintf(stderr, "record_ticks: %s cannot be written\n", argv[2]);
    return 1;
  }
  std::printf("%zu ticks\n", ticks.size());
  return 0;
}
