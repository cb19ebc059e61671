// SPDX-License-Identifier: Apache-2.0
// The Atlas of the tests: its URDF with feet, IMU and a slightly bent standing posture.
#ifndef GAITD_SIM_TEST_ATLAS_MODEL_H_
#define GAITD_SIM_TEST_ATLAS_MODEL_H_

#include <string>

#include "gaitd/abi/types.h"
#include "gaitd/sim/config.h"

namespace gaitd::sim::test {

GaitdModel atlas_model();

// Index of the joint (or body) called `name`; throws std::out_of_range if there is none.
int joint_index(const GaitdModel& model, const std::string& name);
int body_index(const GaitdModel& model, const std::string& name);

// Flat ground, ideal sensors and drives.
Config flat_config(const GaitdModel& model);

// Every joint held at its position in `model.nominal_position`: `stiffness` and damping scaled by
// the effort limit (1/rad), no feed-forward.
GaitdJointCommands hold_posture(const GaitdModel& model, double stiffness = 20);

// Every joint off.
GaitdJointCommands limp(const GaitdModel& model);

}  // namespace gaitd::sim::test

#endif  // GAITD_SIM_TEST_ATLAS_MODEL_H_
