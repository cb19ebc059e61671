// SPDX-License-Identifier: Apache-2.0
// What goes wrong with the fake robot, from its start on.
#include <linux/can/error.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "cli/fake_robot/fake_robot.h"

namespace gaitd::cli {

bool FakeRobot::start(std::string* error) {
  for (size_t i = 0; i < buses_.size(); ++i) {
    std::vector<can::IdFilter> filters = {can::IdFilter::exactly(can::kDamiaoRegisterId)};
    for (const can::Motor& motor : wiring_.motors) {
      if (motor.bus != static_cast<int>(i)) continue;
      filters.push_back(motor.dialect->extended()
                            ? can::IdFilter{can::kExtended | motor.id, can::kExtended | 0xFF}
                            : can::IdFilter::exactly(motor.id));
    }
    const can::Bus& bus = wiring_.buses[i];
    buses_[i].bus = can::CanBus::open(bus.interface, bus.fd(), filters, error);
    if (buses_[i].bus == nullptr) return false;
  }
  // Every fault needs a target that is there.
  std::vector<std::string> joints, imus;
  for (int j = 0; j < model_.joint_count; ++j) joints.emplace_back(model_.joints[j].name);
  for (const can::Sender& imu : wiring_.imus) imus.emplace_back(model_.imus[imu.index].name);
  for (const Fault& fault : options_.faults) {
    const auto has = [&](auto&& names) {
      return std::find(names.begin(), names.end(), fault.target) != names.end();
    };
    std::vector<std::string> names;
    switch (fault.kind) {
      case FaultKind::kImu:
      case FaultKind::kImuStuck:
        names = imus;
        break;
      case FaultKind::kFoot:
      case FaultKind::kFootStuck:
        names = {"left", "right"};
        break;
      case FaultKind::kShort:
        names = joints;
        names.insert(names.end(), imus.begin(), imus.end());
        names.insert(names.end(), {"left", "right"});
        break;
      case FaultKind::kEstop:
      case FaultKind::kEstopStuck:
      case FaultKind::kHeartbeat:
        names = {""};
        break;
      case FaultKind::kDown:
      case FaultKind::kBusOff:
        for (const can::Bus& bus : wiring_.buses) names.push_back(bus.name);
        break;
      default:
        names = joints;
        break;
    }
    if (!has(names)) {
      *error = "fault: no target '" + fault.target + "'";
      return false;
    }
    if (fault.time == 0 && !apply(fault, error)) return false;
  }
  std::erase_if(pending_, [](const Fault& fault) { return fault.time == 0; });
  return true;
}

bool FakeRobot::apply(const Fault& fault, std::string* error) {
  int joint = -1;
  for (size_t i = 0; i < motors_.size(); ++i) {
    if (fault.target == model_.joints[wiring_.motors[i].joint].name) joint = static_cast<int>(i);
  }
  MotorState* motor = joint < 0 ? nullptr : &motors_[joint];
  SenderState* sender = nullptr;
  for (size_t i = 0; i < imus_.size(); ++i) {
    if (fault.target == model_.imus[wiring_.imus[i].index].name) sender = &imus_[i];
  }
  for (size_t i = 0; i < feet_.size(); ++i) {
    const bool left = wiring_.feet[i].index == GAITD_LEFT;
    if (fault.target == (left ? "left" : "right")) sender = &feet_[i];
  }
  switch (fault.kind) {
    case FaultKind::kSilent:
      motor->silent = true;
      break;
    case FaultKind::kError:
      motor->error = static_cast<uint8_t>(fault.value);
      motor->enabled = false;
      break;
    case FaultKind::kOff:
      motor->enabled = false;
      break;
    case FaultKind::kLose:
      motor->lose = std::max(1, static_cast<int>(fault.value));
      break;
    case FaultKind::kDuplicate:
      motor->duplicate = true;
      break;
    case FaultKind::kImu:
    case FaultKind::kFoot:
      sender->silent = true;
      break;
    case FaultKind::kImuStuck:
    case FaultKind::kFootStuck:
      sender->stuck = true;
      break;
    case FaultKind::kShort:
      (sender != nullptr ? sender->shortened : motor->shortened) = true;
      break;
    case FaultKind::kEstop:
      estop_pressed_ = true;
      estop_release_ = fault.value > 0 ? now_ + fault.value : 0;
      break;
    case FaultKind::kHeartbeat:
      estop_.silent = true;
      break;
    case FaultKind::kEstopStuck:
      estop_.stuck = true;
      break;
    case FaultKind::kDown:
    case FaultKind::kBusOff:
      for (size_t i = 0; i < buses_.size(); ++i) {
        if (wiring_.buses[i].name != fault.target) continue;
        if (fault.kind == FaultKind::kBusOff) {
          set_bus_off(static_cast<int>(i), true);
        } else {
          set_interface(static_cast<int>(i), false);
        }
        buses_[i].heard = false;  // no cycle waits for it
        buses_[i].up_again = fault.value > 0 ? now_ + fault.value : 0;
      }
      break;
    case FaultKind::kRange:
      motor->range = fault.value;
      break;
    case FaultKind::kNanRange:
      motor->range = std::numeric_limits<double>::quiet_NaN();
      break;
    case FaultKind::kTimeout:
      motor->timeout = fault.value;
      break;
  }
  return error->empty();
}

void FakeRobot::set_interface(int bus, bool up) {
  const int socket = ::socket(AF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW);
  ifreq request{};
  std::strncpy(request.ifr_name, wiring_.buses[bus].interface.c_str(), IFNAMSIZ - 1);
  bool done = ioctl(socket, SIOCGIFFLAGS, &request) == 0;
  if (up) {
    request.ifr_flags |= IFF_UP;
  } else {
    request.ifr_flags &= static_cast<short>(~IFF_UP);
  }
  done = done && ioctl(socket, SIOCSIFFLAGS, &request) == 0;
  close(socket);
  event(wiring_.buses[bus].interface + (up ? " up" : " down") + (done ? "" : " failed"));
}

// A virtual bus has no controller that could go off. What its driver would tell everybody on this
// machine is an error frame, and a socket may send one.
void FakeRobot::set_bus_off(int bus, bool off) {
  buses_[bus].off = off;
  can::Frame error;
  error.id = CAN_ERR_FLAG | (off ? CAN_ERR_BUSOFF : CAN_ERR_RESTARTED);
  error.length = CAN_ERR_DLC;
  bool down = false;
  const bool done = buses_[bus].bus->send(&error, 1, &down) == 1;
  event(wiring_.buses[bus].interface + (off ? " bus-off" : " restarted") + (done ? "" : " failed"));
}

// A drive that hears nothing for its TIMEOUT switches off by itself.
void FakeRobot::watch_stalls() {
  for (size_t i = 0; i < motors_.size(); ++i) {
    MotorState& motor = motors_[i];
    if (!motor.enabled || now_ < motor.last_command + options_.stall_time) continue;
    motor.enabled = false;
    motor.error = static_cast<uint8_t>(can::MotorError::kCommunicationLost);
    event(std::string(model_.joints[wiring_.motors[i].joint].name) + " communication lost");
  }
  for (size_t i = 0; i < buses_.size(); ++i) {
    if (buses_[i].up_again == 0 || now_ < buses_[i].up_again) continue;
    buses_[i].up_again = 0;
    if (buses_[i].off) {
      set_bus_off(static_cast<int>(i), false);
    } else {
      set_interface(static_cast<int>(i), true);
    }
  }
  if (estop_release_ > 0 && now_ > estop_release_) {
    estop_release_ = 0;
    estop_pressed_ = false;
  }
}

}  // namespace gaitd::cli
