// SPDX-License-Identifier: Apache-2.0
// The robot that is simulated: the controller's model with deliberate errors.
#ifndef GAITD_SIM_MODEL_ERROR_H_
#define GAITD_SIM_MODEL_ERROR_H_

#include <string>
#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/sim/config.h"

namespace gaitd::sim {

// `model` with the errors of each body (one per body) applied and total_mass summed up anew.
GaitdModel apply_model_error(const GaitdModel& model, const std::vector<BodyError>& errors);

// Everything that keeps `model` from being simulated; empty if nothing does: a mass that is not
// positive, a foot without an outline, a frame on a body that does not exist and the like.
std::vector<std::string> check_simulated_model(const GaitdModel& model);

}  // namespace gaitd::sim

#endif  // GAITD_SIM_MODEL_ERROR_H_
