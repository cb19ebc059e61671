// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/foot_sensors.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "gaitd/sim/rigid_body.h"
#include "vector_noise.h"

namespace gaitd::sim {
namespace {

// Of the weight: 5 and 50 N of Atlas.
constexpr double kUnloaded = 0.00291;
constexpr double kStruck = 0.0291;
constexpr double kDriftTime = 300;      // s, in which the drift reaches its figure
constexpr double kCrosstalkArm = 0.05;  // m, of the moments that count as much as a force

}  // namespace

FootWrench sum_foot_wrench(const GaitdModel& model, int side, const BodyMotion& sensor,
                           std::span<const Touch> touches) {
  const GaitdFrame& frame = model.feet[side].force_sensor;
  const Eigen::Vector3d origin = sensor.point(Eigen::Vector3d(frame.origin));
  const Eigen::Matrix3d R_WS = sensor.R_WB * rotation(frame);
  FootWrench sum;
  for (const Touch& touch : touches) {
    if (touch.foot != side) continue;
    sum.force += touch.force;
    sum.moment += (touch.p_W - origin).cross(touch.force);
  }
  sum.force = R_WS.transpose() * sum.force;
  sum.moment = R_WS.transpose() * sum.moment;
  return sum;
}

FootSensors::FootSensors(const GaitdModel& model, const SensorFigures& figures, double time_step,
                         const SensorSeed& seed)
    : model_(model),
      figures_(figures),
      time_step_(time_step),
      seed_(seed),
      noise_(seed.episode, RandomPurpose::kFootForce) {
  for (uint64_t side = 0; side < GAITD_MAX_FEET; ++side) {
    jumps_.emplace_back(seed.episode, RandomPurpose::kFootDrift, side);
  }
}

FootSensors::Matrix6 FootSensors::draw_distortion(RandomStream* stream, double crosstalk,
                                                  double pair, double scale) const {
  Matrix6 m;
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) m(row, column) = 2 * stream->uniform() - 1;
  }
  m *= crosstalk;
  const auto from = std::min(static_cast<int>(6 * stream->uniform()), 5);
  const auto step = std::min(static_cast<int>(5 * stream->uniform()), 4) + 1;
  const double sign = stream->uniform() < 0.5 ? -1 : 1;
  if (pair > 0) m((from + step) % 6, from) = sign * pair;
  for (int k = 0; k < 6; ++k) m(k, k) = 1 + scale * stream->normal();
  m.topRightCorner<3, 3>() /= kCrosstalkArm;
  m.bottomLeftCorner<3, 3>() *= kCrosstalkArm;
  return m;
}

void FootSensors::draw_errors(int side) {
  const auto index = static_cast<uint64_t>(side);
  RandomStream stream(seed_.robot, RandomPurpose::kFootErrors, index);
  Foot& foot = feet_[side];
  foot = Foot{};
  const double weight = model_.total_mass * model_.gravity;
  const double range =
      figures_.force_weight > 0 ? std::min(1.0, weight / figures_.force_weight) : 1.0;
  foot.force_noise = range * figures_.force_noise.sample(&stream);
  foot.moment_noise = range * figures_.moment_noise.sample(&stream);
  foot.jump = range * figures_.force_jump.sample(&stream);
  foot.jump_share = figures_.force_jump_share.sample(&stream);
  foot.inertia_share = figures_.foot_inertia.sample(&stream);
  const double offset = range * figures_.force_offset.sample(&stream);
  const double moment_offset = range * figures_.moment_offset.sample(&stream);
  const double drift = range * figures_.force_drift.sample(&stream);
  const double crosstalk = figures_.force_crosstalk.sample(&stream);
  const double pair = figures_.force_crosstalk_pair.sample(&stream);
  const double scale = figures_.force_scale.sample(&stream);
  foot.distorts = crosstalk > 0 || pair > 0 || scale > 0;
  foot.distortion = draw_distortion(&stream, crosstalk, pair, scale);
  stream = seed_.go_on(stream, RandomPurpose::kFootErrors, index);
  foot.offset.moment = noise(&stream, moment_offset);
  jumps_[index] = RandomStream(seed_.episode, RandomPurpose::kFootDrift, index);
  foot.drift = (drift / kDriftTime) * normal_vector(&jumps_[index]);
  // The stream of the biases gives those of the first IMU first.
  RandomStream biases(seed_.episode, RandomPurpose::kBias);
  for (int k = 0; k < 6 + 3 * side; ++k) biases.normal();
  foot.offset.force = noise(&biases, offset);
}

void FootSensors::reset(Bodies bodies, const FootWrench (&contact)[GAITD_MAX_FEET]) {
  noise_ = RandomStream(seed_.episode, RandomPurpose::kFootForce);
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    draw_errors(side);
    own_wrench(side, bodies);
    feet_[side].unloaded =
        contact[side].force.norm() < kUnloaded * model_.total_mass * model_.gravity;
  }
}

FootWrench FootSensors::own_wrench(int side, Bodies bodies) {
  Foot& foot = feet_[side];
  const GaitdBody& body = model_.bodies[model_.feet[side].body];
  const BodyMotion& motion = bodies[model_.feet[side].body];
  const Eigen::Vector3d com = motion.point(Eigen::Vector3d(body.com));
  const Eigen::Vector3d velocity = motion.velocity(com);
  const Eigen::Vector3d momentum =
      motion.R_WB * (central_inertia(body) * (motion.R_WB.transpose() * motion.w_W));
  const Eigen::Vector3d gravity(0, 0, -model_.gravity);
  const double share = foot.inertia_share;
  const Eigen::Vector3d force =
      share * body.mass * (gravity - (velocity - foot.velocity) / time_step_);
  const Eigen::Vector3d spin = share * (momentum - foot.momentum) / time_step_;
  foot.velocity = velocity;
  foot.momentum = momentum;

  const GaitdFrame& frame = model_.feet[side].force_sensor;
  const BodyMotion& sensor = bodies[sensor_body(model_.feet[side])];
  const Eigen::Matrix3d R_SW = (sensor.R_WB * rotation(frame)).transpose();
  const Eigen::Vector3d arm = com - sensor.point(Eigen::Vector3d(frame.origin));
  return {R_SW * force, R_SW * (arm.cross(force) - spin)};
}

void FootSensors::update_strike(int side, Bodies bodies, double force) {
  Foot& foot = feet_[side];
  foot.strike = 0;
  const double weight = model_.total_mass * model_.gravity;
  if (force < kUnloaded * weight) {
    const GaitdFrame& sole = model_.feet[side].sole;
    const BodyMotion& motion = bodies[sole.body];
    const Eigen::Vector3d normal = motion.R_WB * rotation(sole).col(2);
    const Eigen::Vector3d velocity = motion.velocity(motion.point(Eigen::Vector3d(sole.origin)));
    foot.approach = std::max(0.0, -velocity.dot(normal));
    foot.unloaded = true;
  } else if (foot.unloaded && force > kStruck * weight) {
    foot.unloaded = false;
    foot.strike = foot.approach;
    RandomStream& stream = jumps_[static_cast<size_t>(side)];
    const bool jumps = stream.uniform() <= foot.jump_share;
    const Eigen::Vector3d direction = normal_vector(&stream).normalized();
    if (jumps) foot.offset.force += foot.jump * direction;
  }
}

void FootSensors::sample(Bodies bodies, const FootWrench (&contact)[GAITD_MAX_FEET]) {
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    Foot& foot = feet_[side];
    update_strike(side, bodies, contact[side].force.norm());
    foot.offset.force += foot.drift * time_step_;
    FootWrench wrench = contact[side];
    if (foot.inertia_share > 0) {
      const FootWrench own = own_wrench(side, bodies);
      wrench.force += own.force;
      wrench.moment += own.moment;
    }
    if (foot.distorts) {
      Vector6 w;
      w << wrench.force, wrench.moment;
      w = foot.distortion * w;
      wrench = {w.head<3>(), w.tail<3>()};
    }
    foot.reading.force = wrench.force + foot.offset.force + noise(&noise_, foot.force_noise);
    foot.reading.moment = wrench.moment + foot.offset.moment + noise(&noise_, foot.moment_noise);
  }
}

}  // namespace gaitd::sim
