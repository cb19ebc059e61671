// SPDX-License-Identifier: Apache-2.0
// What gaitd and its link to the robot, a process of its own, tell each other: the newest command
// down, the newest state and the condition of the link up. Plain data in shared memory.
#pragma once

#include <cstdint>

#include "gaitd/abi/plugin.h"
#include "joints.h"
#include "mailbox.h"

namespace gaitd::unitree {

enum class Drive : uint32_t {
  kOff = 0,    // no torque
  kDamp = 1,   // damping alone
  kDrive = 2,  // torque + stiffness (position error) + damping (rate error)
};

struct MotorTarget {
  Drive drive;
  float position;   // rad
  float velocity;   // rad/s
  float torque;     // N m
  float stiffness;  // N m/rad
  float damping;    // N m s/rad
};

struct Command {
  uint64_t cycle;   // lockstep: of the state that it answers
  uint32_t driven;  // some motor is to be driven
  uint32_t reserved;
  MotorTarget motors[kMotors];  // by index on the wire
};

struct ImuReading {
  int64_t stamp_ns;   // monotonic clock
  uint32_t sequence;  // 0: none has come
  uint32_t reserved;
  float rate[3];            // rad/s, IMU frame
  float specific_force[3];  // m/s^2, IMU frame
};

struct FootReading {
  int64_t stamp_ns;
  uint32_t sequence;  // 0: none has come
  uint32_t reserved;
  float wrench[2][6];  // left, right; moment N m, force N, sensor frame
};

struct State {
  int64_t stamp_ns;   // monotonic clock, of the motors and the pelvis IMU
  uint64_t cycle;     // lockstep: counts the states; 0: a robot that waits for nobody
  uint32_t sequence;  // accepted states
  uint32_t mode_machine;
  uint32_t repeats;  // states in a row whose tick was that of the one before
  uint32_t reserved;
  float position[kMotors];  // rad, by index on the wire
  float velocity[kMotors];  // rad/s
  float torque[kMotors];    // N m, as the drive estimates it
  ImuReading pelvis, torso;
  FootReading feet;
};

// Why the link damps the robot whatever is commanded.
enum Hold : uint32_t {
  kHoldLate = 1 << 0,     // the controller drove and then fell silent
  kHoldGone = 1 << 1,     // its process is gone, or asked for the end
  kHoldEstop = 1 << 2,    // the remote asks for damping
  kHoldSilent = 1 << 3,   // no state of the robot
  kHoldWriter = 1 << 4,   // somebody else commands the robot
  kHoldVariant = 1 << 5,  // the robot is another one, or reads commands in another way
  kHoldTwin = 1 << 6,     // two send states
};

struct Status {
  uint32_t conditions;  // GAITD_HEALTH_*
  uint32_t holds;       // Hold
  uint32_t estops;      // times that the remote asked for damping
  uint32_t bad_crc;     // states with a wrong CRC, or figures that are none
  uint32_t repeated;    // states with the tick of the one before
  uint32_t lost;        // states that a newer one replaced before it was read
  uint32_t foreign;     // commands of somebody else
  uint32_t unsent;      // commands that DDS did not take
  uint32_t slow;        // writes of more than 10 ms
  uint32_t late;        // times that the controller was late
  char text[GAITD_DESCRIPTION_SIZE];
};

// All zero is the start. The link alone writes state and status, gaitd alone the command.
struct Exchange {
  Mailbox<Command> command;
  Bell commanded;
  Mailbox<State> state;
  Bell arrived;
  Mailbox<Status> status;
};

// File descriptors that the link finds open, and the datagrams on the second: a letter and a text.
inline constexpr int kExchangeFd = 3, kTalkFd = 4;
enum class Talk : char {
  kLog = 'l',    // link to gaitd: level as a digit, line
  kReady = 'r',  // link to gaitd: it has the robot
  kStop = 's',   // gaitd to link: damp and end
  kBye = 'b',    // link to gaitd: it damps, and needs nobody for it
};

}  // namespace gaitd::unitree
