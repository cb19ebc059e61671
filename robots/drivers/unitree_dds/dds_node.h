// SPDX-License-Identifier: Apache-2.0
// The little of DDS that the robot's topics need.
#pragma once

#include <dds/dds.h>

#include <memory>
#include <string>
#include <utility>

#include "gaitd_feet.h"
#include "unitree_api.h"
#include "unitree_hg.h"

namespace gaitd::unitree {

using LowCmd = unitree_hg_msg_dds__LowCmd_;
using LowState = unitree_hg_msg_dds__LowState_;
using ImuState = unitree_hg_msg_dds__IMUState_;
using BmsState = unitree_hg_msg_dds__BmsState_;
using MotorCmd = unitree_hg_msg_dds__MotorCmd_;
using MotorState = unitree_hg_msg_dds__MotorState_;
using Request = unitree_api_msg_dds__Request_;
using Response = unitree_api_msg_dds__Response_;
using FootWrenches = gaitd_msg_dds__FootWrenches_;

inline constexpr char kLowState[] = "rt/lowstate";
inline constexpr char kLowCmd[] = "rt/lowcmd";
inline constexpr char kUserLowCmd[] = "rt/user_lowcmd";
inline constexpr char kTorsoImu[] = "rt/secondary_imu";
inline constexpr char kBattery[] = "rt/lf/bmsstate";

// Reliable writers, best-effort readers, the last sample, volatile: it matches every peer but a
// reader that demands stored data.
class DdsNode {
 public:
  // On one network interface and nothing else; CYCLONEDDS_URI is not looked at. Throws
  // std::runtime_error with the reason.
  DdsNode(int domain, const std::string& interface);
  ~DdsNode();
  DdsNode(const DdsNode&) = delete;
  DdsNode& operator=(const DdsNode&) = delete;

  // `depth`: samples kept. `others`: a reader that our own writers do not match. Entities live as
  // long as the node.
  dds_entity_t reader(const char* topic, const dds_topic_descriptor_t& type, int depth = 1,
                      bool others = false);
  dds_entity_t writer(const char* topic, const dds_topic_descriptor_t& type);
  // Wakes `waitset` when the reader has something.
  void attach(dds_entity_t waitset, dds_entity_t reader);
  dds_entity_t waitset();

 private:
  dds_entity_t topic(const char* name, const dds_topic_descriptor_t& type);

  dds_entity_t domain_ = 0, participant_ = 0;
};

// Takes the newest sample into `sample`, which was all zero when it was first used: so the padding
// stays 0, which a CRC needs. Only for types without pointers.
bool take_sample(dds_entity_t reader, void* sample);

int matched_writers(dds_entity_t reader);
int matched_readers(dds_entity_t writer);

}  // namespace gaitd::unitree
