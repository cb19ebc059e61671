// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/model_error.h"

namespace gaitd::sim {
namespace {

void check_frame(const GaitdModel& model, const std::string& where, const GaitdFrame& frame,
                 std::vector<std::string>* errors) {
  if (frame.body < 0 || frame.body >= model.body_count) {
    errors->push_back(where + ": expected a body index from 0 to " +
                      std::to_string(model.body_count - 1) + ", got " + std::to_string(frame.body));
  }
  double norm = 0;
  for (const double x : frame.orientation) norm += x * x;
  if (!(norm > 0.99 && norm < 1.01)) {
    errors->push_back(where + ": expected a unit quaternion, got one of squared length " +
                      std::to_string(norm));
  }
}

void check_outline(const std::string& where, const GaitdFoot& foot,
                   std::vector<std::string>* errors) {
  if (foot.point_count < 3 || foot.point_count > GAITD_MAX_FOOT_POINTS) {
    errors->push_back(where + ": expected an outline of 3 to " +
                      std::to_string(GAITD_MAX_FOOT_POINTS) + " points, got " +
                      std::to_string(foot.point_count));
    return;
  }
  for (int i = 0; i < foot.point_count; ++i) {
    const double* a = foot.points[i];
    const double* b = foot.points[(i + 1) % foot.point_count];
    const double* c = foot.points[(i + 2) % foot.point_count];
    const double turn = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
    if (!(turn > 0)) {
      errors->push_back(where + ": expected a convex counter-clockwise outline, got one that " +
                        "turns the other way at point " +
                        std::to_string((i + 1) % foot.point_count));
    }
  }
}

}  // namespace

GaitdModel apply_model_error(const GaitdModel& model, const std::vector<BodyError>& errors) {
  GaitdModel simulated = model;
  simulated.total_mass = 0;
  for (int i = 0; i < model.body_count; ++i) {
    GaitdBody& body = simulated.bodies[i];
    const BodyError& error = errors[static_cast<size_t>(i)];
    body.mass *= error.mass_scale;
    for (double& moment : body.inertia) moment *= error.mass_scale * error.inertia_scale;
    for (int k = 0; k < 3; ++k) body.com[k] += error.com_offset[k];
    simulated.total_mass += body.mass;
  }
  return simulated;
}

std::vector<std::string> check_simulated_model(const GaitdModel& model) {
  std::vector<std::string> errors;
  if (model.joint_count < 0 || model.joint_count > GAITD_MAX_JOINTS ||
      model.body_count != model.joint_count + 1) {
    errors.push_back("model: expected 0 to " + std::to_string(GAITD_MAX_JOINTS) +
                     " joints and one body more, got " + std::to_string(model.joint_count) +
                     " joints and " + std::to_string(model.body_count) + " bodies");
    return errors;
  }
  if (model.imu_count < 0 || model.imu_count > GAITD_MAX_IMUS) {
    errors.push_back("model: expected 0 to " + std::to_string(GAITD_MAX_IMUS) + " IMUs, got " +
                     std::to_string(model.imu_count));
    return errors;
  }
  for (int i = 0; i < model.body_count; ++i) {
    const GaitdBody& body = model.bodies[i];
    const std::string where = "model body " + std::string(body.name);
    if (!(body.mass > 0)) {
      errors.push_back(where + ": expected a mass > 0, got " + std::to_string(body.mass));
    }
    const bool placed =
        i == 0 ? body.parent < 0 : body.joint == i - 1 && body.parent >= 0 && body.parent < i;
    if (!placed) {
      errors.push_back(where + ": expected joint " + std::to_string(i - 1) +
                       " and a parent before it, got joint " + std::to_string(body.joint) +
                       " and parent " + std::to_string(body.parent));
    }
  }
  for (int i = 0; i < model.imu_count; ++i) {
    check_frame(model, "model IMU " + std::to_string(i), model.imus[i], &errors);
  }
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdFoot& foot = model.feet[side];
    const std::string where = side == GAITD_LEFT ? "model left foot" : "model right foot";
    check_outline(where, foot, &errors);
    check_frame(model, where + " sole", foot.sole, &errors);
    if (foot.force_sensor.body >= 0) {
      check_frame(model, where + " force sensor", foot.force_sensor, &errors);
    }
    if (foot.body < 0 || foot.body >= model.body_count) {
      errors.push_back(where + ": expected a body of the robot, got index " +
                       std::to_string(foot.body));
    }
  }
  return errors;
}

}  // namespace gaitd::sim
