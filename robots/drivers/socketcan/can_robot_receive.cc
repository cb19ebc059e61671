// SPDX-License-Identifier: Apache-2.0
// What comes in from the buses of a robot.
#include <poll.h>

#include <algorithm>
#include <cmath>

#include "can_robot.h"
#include "routes.h"
#include "sensor_frames.h"

namespace gaitd::can {

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
  state.bus->receive(&events, [&](const Received& received) {
    heard = true;
    take(bus, received);
  });
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
  if ((received.frame.id & kExtended) != 0) {
    const int16_t motor = buses_[bus].extended[received.frame.id >> 8 & 0xFF];
    if (motor != kNobody) take_reply(motor & kIndex, received);
    return;
  }
  const int16_t route = buses_[bus].routes[received.frame.id & 0x7FF];
  const int index = route & kIndex;
  switch (route & kKind) {
    case kMotor:
      take_reply(index, received);
      return;
    case kImu:
      take_sensor(&imus_[index / kImuFrames], index % kImuFrames,
                  index % kImuFrames == 0 ? kRateUnit : kAccelerationUnit, received,
                  &counters_[motors_.size() + index / kImuFrames]);
      return;
    case kFoot:
      take_sensor(&feet_[index / kFootFrames], index % kFootFrames,
                  index % kFootFrames == 0 ? kForceUnit : kMomentUnit, received,
                  &counters_[motors_.size() + imus_.size() + index / kFootFrames]);
      return;
    case kEstop:
      if (!estop_.take(received.frame, {received.stamp_ns, cycle_})) {
        ++counters_[senders_.size() - 1].stale;
      }
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
  const int16_t motor = buses_[bus].shared[received.frame.data[0]];
  if (motor != kNobody) take_reply(motor & kIndex, received);
}

void CanRobot::take_reply(int index, const Received& received) {
  const Motor& motor = wiring_.motors[index];
  MotorState& state = motors_[index];
  const Dialect& dialect = *motor.dialect;
  const auto reply = dialect.read_reply(received.frame, motor.address(), motor.ranges);
  if (!reply) {
    const auto fault = dialect.read_fault == nullptr
                           ? std::nullopt
                           : dialect.read_fault(received.frame, motor.address());
    if (!fault) {
      ++counters_[index].stale;
    } else if (*fault != MotorError::kOn) {
      state.told = static_cast<uint8_t>(*fault);
    }
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
  state.position = motor.joint_position(reply->position);
  state.velocity = motor.joint_velocity(reply->velocity);
  state.torque = motor.joint_torque(reply->torque);
  state.error = reply->error;
  state.moment = {received.stamp_ns, cycle_};
  ++state.sequence;
  state.valid = true;
}

void CanRobot::take_sensor(SensorSample* sample, int part, double unit, const Received& received,
                           Counters* counters) {
  switch (sample->take(part, received.frame, unit, {received.stamp_ns, cycle_})) {
    case SensorSample::Taken::kMalformed:
      ++counters->stale;
      break;
    case SensorSample::Taken::kRepeated:
      ++counters->duplicate;
      break;
    case SensorSample::Taken::kPart:
    case SensorSample::Taken::kSample:
      break;
  }
}

}  // namespace gaitd::can
