// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

#include "daemon/control/pipeline.h"

namespace gaitd::daemon {

// Texts (JSON) of events about what became of the robot, written to `text`. [rt]

// The state, the faults and what is behind them.
std::string_view state_text(const Pipeline& pipeline, char* text, std::size_t size);
// A joint that was dropped, and why.
std::string_view dropped_text(const SensorMonitor& monitor, int joint, char* text,
                              std::size_t size);

// Of an outcome of walking::Payload.
const char* outcome_text(int outcome);
// What a load was weighed at, or why it was not.
std::string_view payload_text(const PayloadData& payload, const char* link, char* text,
                              std::size_t size);

// That a robot is heavier than it is known to be, by `surplus` (kg) or more, or lighter.
std::string_view surplus_text(double surplus, char* text, std::size_t size);

// How much of its foothold a foot bears on.
std::string_view bearing_text(int side, double share, char* text, std::size_t size);

// What became of a handhold.
std::string_view handhold_text(int hand, walking::Handholds::Change change, char* text,
                               std::size_t size);

// How far a hand is from where its motion should have brought it.
std::string_view hand_text(int hand, const GaitdHandReference& reference, char* text,
                           std::size_t size);

}  // namespace gaitd::daemon
