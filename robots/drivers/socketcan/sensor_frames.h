// SPDX-License-Identifier: Apache-2.0
// Our own frames for IMUs, foot force sensors and the e-stop: classic CAN, eight bytes, integers
// little-endian. docs/can.md describes them.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "frame.h"

namespace gaitd::can {

inline constexpr double kRateUnit = 0.001;          // rad/s
inline constexpr double kAccelerationUnit = 0.005;  // m/s^2
inline constexpr double kForceUnit = 0.2;           // N
inline constexpr double kMomentUnit = 0.02;         // N m

// Frames of one sensor have consecutive ids.
inline constexpr int kImuFrames = 2;   // angular rate, specific force
inline constexpr int kFootFrames = 2;  // force, moment

inline Frame encode_vector(uint32_t id, const double (&value)[3], double unit, uint16_t counter) {
  Frame frame;
  frame.id = id;
  const auto put = [&frame](int at, uint16_t word) {
    frame.data[at] = static_cast<uint8_t>(word);
    frame.data[at + 1] = static_cast<uint8_t>(word >> 8);
  };
  for (int i = 0; i < 3; ++i) {
    const double code = std::fmin(32767.0, std::fmax(-32767.0, std::nearbyint(value[i] / unit)));
    put(2 * i, static_cast<uint16_t>(static_cast<int16_t>(code)));
  }
  put(6, counter);
  return frame;
}

// The counter of the frame. Nothing: of another length.
inline std::optional<uint16_t> decode_vector(const Frame& frame, double unit, double (&value)[3]) {
  if (frame.length != 8) return std::nullopt;
  const auto get = [&frame](int at) {
    return static_cast<uint16_t>(frame.data[at] | frame.data[at + 1] << 8);
  };
  for (int i = 0; i < 3; ++i) value[i] = unit * static_cast<int16_t>(get(2 * i));
  return get(6);
}

// A simulated robot says on every bus when it has answered all it will: what is missing then is
// silent, and gaitd in lockstep does not wait for it. No real robot sends it.
inline constexpr uint32_t kEndOfCycleId = 0x7F0;
inline Frame encode_end_of_cycle() {
  Frame frame;
  frame.id = kEndOfCycleId;
  frame.length = 0;
  return frame;
}

// D0: 1 pressed, 0 released; D1 counts. Also the heartbeat of the e-stop.
inline constexpr uint8_t kEstopLength = 2;
inline Frame encode_estop(uint32_t id, bool pressed, uint8_t counter) {
  Frame frame;
  frame.id = id;
  frame.length = kEstopLength;
  frame.data[0] = pressed ? 1 : 0;
  frame.data[1] = counter;
  return frame;
}

}  // namespace gaitd::can
