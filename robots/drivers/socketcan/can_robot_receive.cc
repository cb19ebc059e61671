// SPDX-License-Identifier: Apache-2.0
// What comes in from the buses of a robot.
#include <poll.h>

#include <algorithm>
#include <cmath>

#include "can_robot.h"
#include "routes.h"
#include "sensor_frames.h"

namespace gaitd::can {
namespace {

constexpr int64_t kClockStep = 1'000'000'000;  // ns back: the clock was set, the reply is not old

}  // namespace

void CanRobot::wait_and_receive(double seconds) {
  std::array<pollfd, kMaxBuses> descriptors;
  const size_t count = buses_.size();
  for (size_t i = 0; i < count; ++i) descriptors[i] = {buses_[i].bus->descriptor(), POLLIN, 0};
  const double left = std::max(0.0, seconds);
  const timespec wait{static_cast<time_t>(left),
                      static_cast<long>(1e9 * (left - std::floor(left)))};
  if (ppoll(descriptors.data(), count, &wait, nullptr) <= 0) return;
  for (size_t i = 0; i < count; ++i) {
    if (descriptors[i].revents != 0) receive(static_cast<int>(i));
  }
}

void CanRobot::receive() {
  for (size_t i = 0; i < buses_.size(); ++i) receive(static_cast<int>(i));
}

void CanRobot::receive(int bus) {
  BusState& state = buses_[bus];
  BusEvents events;
  bool heard = false;
  for (;;) {
    const int count = state.bus->receive(received_.data(), &events);
    for (int i = 0; i < count; ++i) take(bus, received_[i]);
    heard = heard || count > 0;
    if (count < CanBus::kBatch) break;
  }
  if (events.lost > 0) lost_ += events.lost;
  if (events.passive) state.passive = true;
  if (events.active || events.restarted) state.passive = false;
  if (events.bus_off || events.interface_down) {
    switch_off_bus(bus);
  } else if (heard) {
    state.down = false;  // somebody answers again; its motors stay off
  }
}

void CanRobot::take(int bus, const Received& received) {
  const int16_t route = buses_[bus].routes[received.frame.id & 0x7FF];
  const int index = route & kIndex;
  switch (route & kKind) {
    case kMotor:
      take_reply(index, received);
      return;
    case kImu:
      take_sensor(&imus_[index / kImuFrames], index % kImuFrames,
                  index % kImuFrames == 0 ? kRateUnit : kAccelerationUnit, received);
      return;
    case kFoot:
      take_sensor(&feet_[index / kFootFrames], index % kFootFrames,
                  index % kFootFrames == 0 ? kForceUnit : kMomentUnit, received);
      return;
    case kEstop:
      estop_pressed_ = decode_estop(received.frame);
      estop_cycle_ = cycle_;
      return;
    case kCycleOver:
      if (buses_[bus].ends_owed > 0) {
        --buses_[bus].ends_owed;
      } else {
        buses_[bus].cycle_over = true;
      }
      return;
    default:
      break;
  }
  if (received.frame.id != 0) return;
  const int16_t cheetah = buses_[bus].cheetahs[received.frame.data[0]];
  if (cheetah != kNobody) take_reply(cheetah & kIndex, received);
}

void CanRobot::take_reply(int index, const Received& received) {
  const Motor& motor = wiring_.motors[index];
  MotorState& state = motors_[index];
  const auto reply = decode_reply(received.frame, motor.dialect, motor.ranges);
  const uint32_t mask = motor.dialect == Dialect::kDamiao ? 0xF : 0xFF;
  if (!reply || reply->motor != (motor.id & mask)) {
    ++counters_[index].stale;  // of another motor, or of a register request
    return;
  }
  if (state.awaiting) {
    state.awaiting = false;
  } else if (state.owed > 0) {
    --state.owed;
    ++counters_[index].late;
  } else {
    ++counters_[index].duplicate;
  }
  const int64_t older = state.stamp_ns - received.stamp_ns;
  if (older > 0 && older < kClockStep) {
    ++counters_[index].stale;
    return;
  }
  state.position = motor.joint_position(reply->position);
  state.velocity = motor.joint_velocity(reply->velocity);
  state.torque = motor.joint_torque(reply->torque);
  state.error = reply->error;
  state.stamp_ns = received.stamp_ns;
  state.cycle = cycle_;
  ++state.sequence;
  state.valid = true;
}

void CanRobot::take_sensor(SenderState* sender, int frame, double unit, const Received& received) {
  double value[3];
  sender->counter[frame] = decode_vector(received.frame, unit, value);
  std::copy(value, value + 3, sender->value[frame].begin());
  if (frame != 1 || sender->counter[0] != sender->counter[1]) return;
  sender->valid = true;
  ++sender->sequence;
  sender->stamp_ns = received.stamp_ns;
  sender->cycle = cycle_;
}

}  // namespace gaitd::can
