// SPDX-License-Identifier: Apache-2.0
#include "joints.h"

namespace gaitd::unitree {
namespace {

constexpr uint64_t bits(std::initializer_list<int> indices) {
  uint64_t mask = 0;
  for (const int index : indices) mask |= uint64_t{1} << index;
  return mask;
}

constexpr uint64_t kWaist = bits({13, 14});
constexpr uint64_t kTwentyThree = bits({13, 14, 20, 21, 27, 28});
constexpr uint64_t kArmsOnly = (uint64_t{1} << 15) - 1;
constexpr const char* kStrongHip =
    "hip pitch geared 22.5, 139 N m and 20 rad/s in place of 88 and 32";
constexpr const char* kWrists = "wrist pitch and yaw of another motor, each hand 0.2 kg heavier";
constexpr const char* kBoth = "hip pitch geared 22.5, and heavier wrists";
constexpr const char* kOldBody = "the deprecated body: 1.8 kg heavier, hip roll 88 N m";

// g1_description of unitree_ros, the table of its README.
constexpr Variant kVariants[] = {
    {1, "23 joints", kTwentyThree, kOldBody},
    {2, "29 joints", 0, kOldBody},
    {3, "27 joints, waist locked", kWaist, kOldBody},
    {4, "23 joints", kTwentyThree, ""},
    {5, "29 joints", 0, ""},
    {6, "27 joints, waist locked", kWaist, ""},
    {9, "two arms", kArmsOnly, ""},
    {10, "23 joints", kTwentyThree, kStrongHip},
    {11, "29 joints", 0, kStrongHip},
    {12, "27 joints, waist locked", kWaist, kStrongHip},
    {13, "29 joints", 0, kWrists},
    {14, "27 joints, waist locked", kWaist, kWrists},
    {15, "29 joints", 0, kBoth},
    {16, "27 joints, waist locked", kWaist, kBoth},
};

}  // namespace

const std::array<const char*, kMotors> kJointNames = {
    "left_hip_pitch_joint",      "left_hip_roll_joint",        "left_hip_yaw_joint",
    "left_knee_joint",           "left_ankle_pitch_joint",     "left_ankle_roll_joint",
    "right_hip_pitch_joint",     "right_hip_roll_joint",       "right_hip_yaw_joint",
    "right_knee_joint",          "right_ankle_pitch_joint",    "right_ankle_roll_joint",
    "waist_yaw_joint",           "waist_roll_joint",           "waist_pitch_joint",
    "left_shoulder_pitch_joint", "left_shoulder_roll_joint",   "left_shoulder_yaw_joint",
    "left_elbow_joint",          "left_wrist_roll_joint",      "left_wrist_pitch_joint",
    "left_wrist_yaw_joint",      "right_shoulder_pitch_joint", "right_shoulder_roll_joint",
    "right_shoulder_yaw_joint",  "right_elbow_joint",          "right_wrist_roll_joint",
    "right_wrist_pitch_joint",   "right_wrist_yaw_joint"};

int wire_index(const std::string& name) {
  for (int i = 0; i < kMotors; ++i) {
    if (name == kJointNames[i]) return i;
  }
  return -1;
}

const Variant* find_variant(int mode_machine) {
  for (const Variant& variant : kVariants) {
    if (variant.number == mode_machine) return &variant;
  }
  return nullptr;
}

}  // namespace gaitd::unitree
