// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/balance_joints.h"

namespace gaitd::daemon {
namespace {

JointMask from_pelvis_to(const GaitdModel& model, int body) {
  JointMask joints = 0;
  for (; body > 0; body = model.bodies[body].parent) {
    joints |= JointMask{1} << model.bodies[body].joint;
  }
  return joints;
}

}  // namespace

JointMask balance_joints(const GaitdModel& model) {
  JointMask joints = from_pelvis_to(model, model.chest_body);
  for (int i = 0; i < model.imu_count; ++i) joints |= from_pelvis_to(model, model.imus[i].body);
  for (const GaitdFoot& foot : model.feet) joints |= from_pelvis_to(model, foot.body);
  return joints;
}

}  // namespace gaitd::daemon
