// SPDX-License-Identifier: Apache-2.0
// The process between gaitd and the robot.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "command_gate.h"
#include "control.h"
#include "dds_node.h"
#include "exchange.h"
#include "settings.h"
#include "state_watch.h"

namespace gaitd::unitree {

// One thread reads the robot and judges it, one writes to it. The writer sends what gaitd commands
// at once, repeats it until the next, and damps by itself when gaitd is late, gone, or something
// stands that it must not be driven with.
class Link {
 public:
  // `rescue`: another link died; take nothing over, damp and go on damping. Throws
  // std::runtime_error if DDS does not start.
  Link(const Settings& settings, bool lockstep, bool rescue, Exchange* exchange);

  // Until gaitd asks for the end or is gone, and the robot has been damped for damp_time since. The
  // exit code of the process.
  int run();
  // Signal-safe: as if gaitd were gone.
  void stop() { gone_ = true; }

 private:
  void log(int level, const std::string& line) const;
  std::string wait_for_robot();
  std::string check_robot() const;
  void poll(int64_t nanoseconds);
  void listen_to_gaitd();
  int take_foreign();
  void publish();
  void write_loop();
  void write(const Command* command, const State& state);
  void damp_until_over();

  Settings settings_;
  bool lockstep_, rescue_;
  Exchange& exchange_;
  DdsNode node_;
  dds_entity_t states_, torso_, battery_, feet_ = 0, others_, commands_, waitset_;
  LowState message_;  // all zero to begin with, padding too
  ImuState torso_message_{};
  BmsState battery_message_{};
  FootWrenches feet_message_{};
  LowCmd foreign_message_{};

  StateWatch watch_;
  uint64_t motors_ = (uint64_t{1} << kMotors) - 1;  // that this variant has
  std::atomic<bool> gone_{false}, over_{false};
  std::atomic<uint32_t> causes_{0};
  int64_t foreign_ns_ = 0;  // of the last foreign command, 0: none
  uint32_t foreign_ = 0;
  int64_t counted_ns_ = 0;
  bool twins_ = false;  // somebody else sends states, too
  // By the writer, for the reader.
  std::atomic<uint32_t> holds_{0}, late_{0}, unsent_{0}, slow_{0}, damped_{0};
  std::atomic<uint64_t> on_{0};  // motors that are commanded to be
};

}  // namespace gaitd::unitree
