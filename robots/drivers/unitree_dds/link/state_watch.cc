// SPDX-License-Identifier: Apache-2.0
#include "state_watch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "crc.h"
#include "gaitd/abi/backend.h"
#include "motor_errors.h"
#include "remote.h"

namespace gaitd::unitree {
namespace {

constexpr int64_t kTickNs = 1'000'000;
constexpr uint8_t kSwitchOnStates = 100;  // until a motor has to say that it is on

}  // namespace

bool StateWatch::take(const LowState& message, int64_t now_ns) {
  if (message.crc != message_crc(message) || !all_finite(message, options_.motors)) {
    ++bad_crc_;
    return false;
  }
  const uint64_t cycle = cycle_of(message);
  if (heard() && cycle != 0 && cycle == state_.cycle) return false;  // sent again
  if (!heard()) {
    first_machine_ = message.mode_machine;
    tick_since_ns_ = now_ns;
  } else if (message.tick != tick_) {
    if (static_cast<int32_t>(message.tick - tick_) < 0) restarted_ = true;
    state_.repeats = 0;
    tick_since_ns_ = now_ns;
  } else {
    ++repeated_;
    ++state_.repeats;
  }
  tick_ = message.tick;
  machine_now_ = message.mode_machine;
  other_machine_ = message.mode_machine != first_machine_;
  motor_frame_ = message.mode_pr != 0;
  unpack(message, &state_);
  state_.mode_machine = first_machine_;
  state_.cycle = cycle;
  ++state_.sequence;
  // The robot's clock has ticks of a millisecond: a state with the tick of the one before is no
  // younger than that tick, so that a robot whose clock stands still grows old.
  state_.stamp_ns = std::min(now_ns, tick_since_ns_ + kTickNs);
  state_.pelvis.sequence = state_.sequence;
  state_.pelvis.stamp_ns = state_.stamp_ns;
  look_at_motors(message);
  look_at_remote(message);
  return true;
}

void StateWatch::take_torso(const ImuState& message, int64_t now_ns) {
  if (!all_finite(message)) {
    ++bad_crc_;
    return;
  }
  unpack(message, &state_.torso);
  ++state_.torso.sequence;
  state_.torso.stamp_ns = now_ns;
}

void StateWatch::take_feet(const FootWrenches& message, int64_t now_ns) {
  const auto finite = [](float value) { return std::isfinite(value); };
  if (!std::all_of(message.left, message.left + 6, finite) ||
      !std::all_of(message.right, message.right + 6, finite) ||
      message.counter == state_.feet.sequence) {
    return;  // one whose counter stands still is silent
  }
  std::copy_n(message.left, 6, state_.feet.wrench[GAITD_LEFT]);
  std::copy_n(message.right, 6, state_.feet.wrench[GAITD_RIGHT]);
  state_.feet.sequence = message.counter;
  state_.feet.stamp_ns = now_ns;
}

void StateWatch::look_at_motors(const LowState& message) {
  bad_motor_ = -1;
  for (int i = 0; i < kMotors; ++i) {
    if ((options_.motors >> i & 1) == 0) continue;
    const MotorState& motor = message.motor_state[i];
    const uint64_t bit = uint64_t{1} << i;
    uint8_t& states = on_states_[i];
    states = (on_ & bit) == 0 ? 0 : std::min<uint8_t>(states + 1, kSwitchOnStates);
    if (motor.mode != 0) {
      was_on_ |= bit;
      fell_off_ &= ~bit;
    } else if ((was_on_ & bit) != 0 && states == kSwitchOnStates) {
      fell_off_ |= bit;  // also once it is no longer on for that
    }
    const char* text = motor_error_text(motor.motorstate);
    if (text[0] != '\0') {
      std::snprintf(bad_text_, sizeof(bad_text_), "%s (0x%X)", text, motor.motorstate);
    } else if (motor.temperature[0] > kHottestCase) {
      std::snprintf(bad_text_, sizeof(bad_text_), "case at %d °C", motor.temperature[0]);
    } else if (motor.temperature[1] > kHottestWinding) {
      std::snprintf(bad_text_, sizeof(bad_text_), "winding at %d °C", motor.temperature[1]);
    } else if ((fell_off_ & bit) != 0) {
      std::snprintf(bad_text_, sizeof(bad_text_), "it switched itself off");
    } else {
      continue;
    }
    bad_motor_ = i;
    return;
  }
}

void StateWatch::look_at_remote(const LowState& message) {
  const char* keys = estop_keys(keys_of(message.wireless_remote));
  if (keys != nullptr && estop_keys_ == nullptr) ++estops_;
  estop_keys_ = keys;
  if (keys != nullptr) last_keys_ = keys;
}

uint32_t StateWatch::causes(int64_t now_ns) const {
  uint32_t causes = 0;
  const auto timeout = static_cast<int64_t>(1e9 * options_.state_timeout);
  if (!heard() || now_ns - state_.stamp_ns > timeout) causes |= kHoldSilent;
  if (estop_keys_ != nullptr) causes |= kHoldEstop;
  if (other_machine_ || motor_frame_ || restarted_) causes |= kHoldVariant;
  return causes;
}

void StateWatch::report(uint32_t holds, Status* status) const {
  status->holds = holds;
  status->estops = estops_;
  status->bad_crc = bad_crc_;
  status->repeated = repeated_;
  const bool charge_low = charge_ >= 0 && charge_ < options_.lowest_charge;
  status->conditions = 0;
  if (bad_motor_ >= 0) status->conditions |= GAITD_HEALTH_MOTOR;
  if ((holds & ~uint32_t{kHoldEstop}) != 0) status->conditions |= GAITD_HEALTH_BUS;
  if ((holds & kHoldEstop) != 0) status->conditions |= GAITD_HEALTH_ESTOP;
  if (charge_low) status->conditions |= GAITD_HEALTH_WARNING;

  char* text = status->text;
  constexpr size_t kSize = sizeof(status->text);
  text[0] = '\0';
  if ((holds & kHoldGone) != 0) {
    std::snprintf(text, kSize, "the link to the robot died, another one damps: restart gaitd");
  } else if (bad_motor_ >= 0) {
    std::snprintf(text, kSize, "motor of %s: %s", kJointNames[bad_motor_], bad_text_);
  } else if ((holds & kHoldWriter) != 0) {
    std::snprintf(text, kSize, "somebody else commands the robot");
  } else if ((holds & kHoldTwin) != 0) {
    std::snprintf(text, kSize, "two writers of %s: another robot or a simulator", kLowState);
  } else if (other_machine_) {
    std::snprintf(text, kSize, "mode_machine changed from %u to %u", first_machine_, machine_now_);
  } else if (motor_frame_) {
    std::snprintf(text, kSize, "mode_pr is not 0: the robot takes ankles and waist for motors");
  } else if (restarted_) {
    std::snprintf(text, kSize, "the robot was started again: restart gaitd, to take control");
  } else if ((holds & kHoldSilent) != 0) {
    std::snprintf(text, kSize, "the robot is silent: no state on %s", kLowState);
  } else if ((holds & kHoldLate) != 0) {
    std::snprintf(text, kSize, "the controller was late, and the robot damped");
  } else if ((holds & kHoldEstop) != 0) {
    std::snprintf(text, kSize, "the remote asks for damping (%s)", last_keys_);
  } else if (charge_low) {
    std::snprintf(text, kSize, "charge %d %%, at least %.0f %% are wanted", charge_,
                  options_.lowest_charge);
  }
}

}  // namespace gaitd::unitree
