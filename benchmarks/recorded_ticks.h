// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "gaitd/abi/types.h"

namespace gaitd::benchmarks {

// What the layers read in one tick of a recorded walk, as plain structs.
struct RecordedTick {
  GaitdRobotState robot;
  GaitdGaitState gait;
  GaitdIcpPlan plan;
  GaitdToeOff toe_off;
  GaitdObjectives objectives;
};

// The recorded walks in data/, ticks of windows of 1 ms steps (data/README.md).
inline constexpr const char* kRecordedWalks[] = {"flat", "stairs", "push"};

// Empty when the file is missing or malformed.
std::vector<RecordedTick> read_ticks(const std::string& file);
std::vector<RecordedTick> read_walk(const std::string& name);
// False when the file cannot be written.
bool write_ticks(const std::string& file, const std::vector<RecordedTick>& ticks);

}  // namespace gaitd::benchmarks
