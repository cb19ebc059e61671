// SPDX-License-Identifier: Apache-2.0
// The robot and the ground as an MJCF document.
#pragma once

#include <span>
#include <string>

#include "gaitd/abi/types.h"
#include "gaitd/sim/body_spheres.h"
#include "gaitd/sim/terrain.h"

namespace gaitd::sim {

// Bodies and joints are named by their indices in `model`, the soles "sole.left" and "sole.right".
// No joint has damping, friction or limits: JointLaw has them. `spheres` are what else than the
// soles touches the ground: those of the model without loads.
std::string mujoco_document(const GaitdModel& model, std::span<const BodySphere> spheres,
                            const Terrain& terrain, double time_step);

}  // namespace gaitd::sim
