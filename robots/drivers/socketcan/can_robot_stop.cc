// SPDX-License-Identifier: Apache-2.0
// The end of a robot on CAN: its motors off before anything else.
#include "can_robot.h"

namespace gaitd::can {
namespace {

constexpr size_t kTimes = 3;                    // frames to each motor, against a lost one
constexpr double kPause = 0.002;                // s between them
constexpr int64_t kStopPatience = 100'000'000;  // ns with a bus that does not take them

}  // namespace

// Whatever is known of a bus or a motor: who can hear is switched off. Nothing is allocated.
void CanRobot::switch_off() {
  std::array<size_t, kMaxBuses> sent{};
  for (BusState& bus : buses_) bus.frames.clear();
  for (const Motor& motor : wiring_.motors) {
    buses_[motor.bus].frames.push_back(motor.dialect->special(motor.address(), Special::kDisable));
  }
  const int64_t end = clocks_.monotonic_ns() + kStopPatience;
  for (;;) {
    bool done = true;
    for (size_t i = 0; i < buses_.size(); ++i) {
      BusState& bus = buses_[i];
      const size_t count = bus.frames.size();
      if (bus.bus == nullptr || sent[i] == kTimes * count) continue;
      // What a full queue did not take comes first the next time.
      const size_t next = sent[i] % count;
      bool down = false;
      sent[i] += bus.bus->send(&bus.frames[next], static_cast<int>(count - next), &down);
      done = done && sent[i] == kTimes * count;
    }
    if (done || clocks_.monotonic_ns() >= end) break;
    clocks_.sleep(kPause);
  }
  for (size_t i = 0; i < buses_.size(); ++i) {
    if (buses_[i].bus == nullptr || sent[i] >= buses_[i].frames.size()) continue;
    log_(GAITD_LOG_ERROR, "bus " + wiring_.buses[i].name + " (" + wiring_.buses[i].interface +
                              ") does not take the frames that switch its motors off: they "
                              "switch off by themselves after their TIMEOUT");
  }
}

void CanRobot::stop() {
  switch_off();
  bool open = false;
  for (BusState& bus : buses_) {
    open = open || bus.bus != nullptr;
    bus.bus.reset();
    bus.claim = BusClaim();
  }
  for (size_t i = 0; open && i < senders_.size(); ++i) {
    const Counters& c = counters_[i];
    if (c.late + c.missing + c.duplicate + c.stale == 0) continue;
    log_(GAITD_LOG_INFO, senders_[i] + ": frames late " + std::to_string(c.late) + ", missing " +
                             std::to_string(c.missing) + ", duplicate " +
                             std::to_string(c.duplicate) + ", stale " + std::to_string(c.stale));
  }
}

}  // namespace gaitd::can
