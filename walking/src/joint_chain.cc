// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/joint_chain.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "gaitd/sdk/chain.h"
#include "gaitd/sdk/views.h"

namespace gaitd::walking {
namespace {

// In heights of the CoM: what makes of a turn a distance to weigh, and the damping of the search
// against the levers of the joints.
constexpr double kLever = 0.17;
constexpr double kDamping = 0.0085;
constexpr double kResidualDamping = 0.5;  // of the squared error, added to it
constexpr double kSearchStep = 0.3;       // rad, of a search
constexpr double kConverged = 1e-6;       // rad, a step that changes nothing

}  // namespace

JointChain::JointChain(const GaitdModel& model, int from, const GaitdFrame& frame, Counts counts)
    : frame_{sdk::view(frame.origin), sdk::quaternion(frame.orientation)},
      length_weight_(counts == Counts::kPose ? 1.0 : 0.0),
      lever_(kLever * model.nominal_com_height),
      damping_(std::pow(kDamping * model.nominal_com_height, 2)) {
  const sdk::Chain chain = sdk::chain_of(model, from, frame.body);
  size_ = chain.count;
  joints_ = chain.joints;
  for (Joints* values : {&nominal_, &least_, &most_, &rate_}) values->resize(size_);
  for (int i = 0; i < size_; ++i) {
    const GaitdJoint& joint = model.joints[joints_[i]];
    links_[i] = {sdk::quaternion(joint.orientation).toRotationMatrix(), sdk::view(joint.origin),
                 sdk::view(joint.axis), joint.type == GAITD_JOINT_PRISMATIC};
    nominal_[i] = model.nominal_position[joints_[i]];
    least_[i] = joint.position_min;
    most_[i] = joint.position_max;
    rate_[i] = joint.velocity_limit;
  }
}

JointChain JointChain::arm(const GaitdModel& model, int hand) {
  // A hand on body 0 is none: a chain from there to itself.
  const GaitdFrame& frame = model.hands[hand];
  return {model, frame.body > 0 ? model.chest_body : 0, frame, Counts::kPose};
}

JointChain JointChain::spine(const GaitdModel& model) {
  GaitdFrame chest{};
  chest.body = model.chest_body;
  chest.orientation[3] = 1.0;
  return {model, 0, chest, Counts::kTurn};
}

JointChain::Joints JointChain::of(const double (&all)[GAITD_MAX_JOINTS]) const {
  Joints q(size_);
  for (int i = 0; i < size_; ++i) q[i] = all[joints_[i]];
  return q;
}

template <class Each>
JointChain::Pose JointChain::along(const Joints& q, Each&& each) const {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (int i = 0; i < size_; ++i) {
    const Link& link = links_[i];
    position += rotation * link.origin;
    rotation = rotation * link.rotation;
    each(i, position, Eigen::Vector3d(rotation * link.axis));
    if (link.prismatic) {
      position += rotation * link.axis * q[i];
    } else {
      rotation = rotation * Eigen::AngleAxisd(q[i], link.axis);
    }
  }
  return {position + rotation * frame_.position,
          (Eigen::Quaterniond(rotation) * frame_.orientation).normalized()};
}

JointChain::Pose JointChain::pose(const Joints& q) const {
  return along(q, [](int, const Eigen::Vector3d&, const Eigen::Vector3d&) {});
}

JointChain::Jacobian JointChain::jacobian(const Joints& q) const {
  Jacobian columns(6, size_);
  std::array<Eigen::Vector3d, kMaxJoints> origins;
  const Eigen::Vector3d end =
      along(q, [&](int i, const Eigen::Vector3d& origin, const Eigen::Vector3d& axis) {
        origins[i] = origin;
        columns.col(i).head<3>() = axis;
      }).position;
  for (int i = 0; i < size_; ++i) {
    const Eigen::Vector3d axis = columns.col(i).head<3>();
    if (links_[i].prismatic) {
      columns.col(i) << Eigen::Vector3d::Zero(), axis;
    } else {
      columns.col(i).tail<3>() = axis.cross(end - origins[i]);
    }
  }
  return columns;
}

JointChain::Joints JointChain::solve(const Jacobian& jacobian, const Twist& error,
                                     const Joints& lower, const Joints& upper, Joints* free) const {
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxJoints, kMaxJoints>;
  Jacobian levers = jacobian;
  levers.topRows<3>() *= lever_;
  levers.bottomRows<3>() *= length_weight_;
  Twist rest = error;
  rest.head<3>() *= lever_;
  rest.tail<3>() *= length_weight_;
  // Grows with what remains (Sugihara 2011): a goal out of reach is come to, not circled around.
  const double damping = damping_ + kResidualDamping * rest.squaredNorm();
  Joints step = Joints::Zero(size_);
  free->setOnes(size_);
  // A joint whose step would leave its bounds stops there, the worst one first; the others make up
  // for it.
  for (int round = 0; round <= size_; ++round) {
    const Jacobian moving = levers * free->asDiagonal();
    Square normal = moving.transpose() * moving;
    normal.diagonal().array() += damping;
    const Joints by_error = moving.transpose() * rest;
    const Joints found = normal.ldlt().solve(by_error);
    int worst = -1;
    double beyond = 1e-12;
    for (int i = 0; i < size_; ++i) {
      if ((*free)[i] == 0.0) continue;
      step[i] = found[i];
      const double out = std::max(found[i] - upper[i], lower[i] - found[i]);
      if (out > beyond) {
        beyond = out;
        worst = i;
      }
    }
    if (worst < 0) break;
    step[worst] = std::clamp(step[worst], lower[worst], upper[worst]);
    (*free)[worst] = 0.0;
    rest -= levers.col(worst) * step[worst];
  }
  return step;
}

void JointChain::step(const Pose& goal, const Joints& largest, double pull, Joints& q) const {
  const Pose now = pose(q);
  Twist error;
  error.head<3>() = sdk::log_so3(goal.orientation * now.orientation.conjugate());
  error.tail<3>() = goal.position - now.position;
  const Jacobian columns = jacobian(q);
  const Joints lower = (least_ - q).cwiseMin(0.0).cwiseMax(-largest);
  const Joints upper = (most_ - q).cwiseMax(0.0).cwiseMin(largest);
  Joints free(size_);
  Joints by = solve(columns, error, lower, upper, &free);
  if (pull > 0.0) {
    // The pull less what the hand would feel of it.
    Joints spare = pull * (nominal_ - q).cwiseProduct(free);
    Joints ignored(size_);
    const Joints wide = Joints::Constant(size_, 1e3);
    const Jacobian moving = columns * free.asDiagonal();
    spare -= solve(moving, columns * spare, -wide, wide, &ignored);
    by += spare;
  }
  q = (q + by.cwiseMax(lower).cwiseMin(upper)).eval();
}

JointChain::Joints JointChain::rates(const Joints& q, const Twist& twist) const {
  constexpr double kAtLimit = 1e-9;  // rad
  constexpr double kTime = 1e-6;  // s, in which the motion is so short that nothing remains of it
  Joints lower(size_), upper(size_), free(size_);
  for (int i = 0; i < size_; ++i) {
    lower[i] = q[i] <= least_[i] + kAtLimit ? 0.0 : -1.0;
    upper[i] = q[i] >= most_[i] - kAtLimit ? 0.0 : 1.0;
  }
  return solve(jacobian(q), kTime * twist, lower, upper, &free) / kTime;
}

JointChain::Miss JointChain::reach(const Pose& goal, int iterations, Joints& q) const {
  for (int i = 0; i < iterations; ++i) {
    const Joints before = q;
    step(goal, Joints::Constant(size_, kSearchStep), 0.0, q);
    if ((q - before).cwiseAbs().maxCoeff() < kConverged) break;
  }
  return miss(goal, pose(q));
}

JointChain::Miss JointChain::miss(const Pose& goal, const Pose& now) {
  return {(goal.position - now.position).norm(),
          sdk::log_so3(goal.orientation * now.orientation.conjugate()).norm()};
}

}  // namespace gaitd::walking
