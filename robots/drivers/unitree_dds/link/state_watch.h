// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "exchange.h"
#include "packing.h"

namespace gaitd::unitree {

struct WatchOptions {
  uint64_t motors = 0;        // bit i: index i moves a joint of the model
  double state_timeout = 0;   // s, without a state
  double lowest_charge = 20;  // %
};

// Judges what comes from the robot: which states are taken, how old they are, what is wrong.
class StateWatch {
 public:
  explicit StateWatch(const WatchOptions& options) : options_(options) {}

  // False: the message is not used. Its CRC is wrong, a figure is none, or it was here before.
  bool take(const LowState& message, int64_t now_ns);
  void take_torso(const ImuState& message, int64_t now_ns);
  void take_battery(const BmsState& message) { charge_ = message.soc; }
  void take_feet(const FootWrenches& message, int64_t now_ns);
  // Bit i: motor i is commanded to be on. One that then says it is off switched itself off.
  void set_on(uint64_t motors) { on_ = motors; }

  const State& state() const { return state_; }
  bool heard() const { return state_.sequence != 0; }
  // What the gate has to hold for, now.
  uint32_t causes(int64_t now_ns) const;
  // Conditions, counters of states and the text; `holds` are those of the gate.
  void report(uint32_t holds, Status* status) const;
  uint32_t estops() const { return estops_; }

 private:
  void look_at_motors(const LowState& message);
  void look_at_remote(const LowState& message);

  WatchOptions options_;
  State state_{};
  uint32_t tick_ = 0;
  int64_t tick_since_ns_ = 0;
  uint8_t first_machine_ = 0;
  bool other_machine_ = false, motor_frame_ = false, restarted_ = false;
  uint32_t machine_now_ = 0;
  uint64_t on_ = 0;
  std::array<uint8_t, kMotors> on_states_{};  // in a row
  uint64_t was_on_ = 0;                       // motors that have said so
  uint64_t fell_off_ = 0;                     // and then switched themselves off
  int bad_motor_ = -1;
  char bad_text_[64] = "";
  const char* estop_keys_ = nullptr;  // pressed now
  const char* last_keys_ = "";
  uint32_t estops_ = 0, bad_crc_ = 0, repeated_ = 0;
  int charge_ = -1;  // %, -1: nobody said
};

}  // namespace gaitd::unitree
