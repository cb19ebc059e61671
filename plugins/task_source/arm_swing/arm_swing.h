// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "gaitd/dynamics/dynamics.h"
#include "gaitd/sdk/layer.h"
#include "trajectory_player.h"

namespace gaitd::plugins {

// Plays motions as trajectory_player does, and lets arms that nobody moves swing in a walk: they
// take a share of the angular momentum about the vertical that legs and trunk have, so that the
// stance foot has less to hold. Which joints swing, and which way, comes from the centroidal
// momentum matrix, and the arms come back to their posture meanwhile.
class ArmSwing {
 public:
  enum class P { kShare, kCount };
  static constexpr std::array<GaitdParameter, static_cast<int>(P::kCount)> kParameters = {
      sdk::real_parameter(
          "share", "", 0, 1, 0.5,
          "of the yaw momentum of legs and trunk that the arms take; low: the stance "
          "foot holds it, high: arms swing far")};

  explicit ArmSwing(const GaitdModel& model);
  void set_parameter(int index, double value) { p_.set(index, value); }
  GaitdStatus process(const GaitdTaskSourceInput& in, GaitdTaskReferences& out);
  void reset();
  void get_state(GaitdTaskSourceState& state) const;
  void set_state(const GaitdTaskSourceState& state);

 private:
  // A joint of an arm.
  struct Swing {
    int joint = 0;
    int part = GAITD_PART_LEFT_ARM;
    double least = 0.0, most = 0.0;  // rad
    double fastest = 0.0;            // rad/s
    double nominal = 0.0;            // rad
    double offset = 0.0;             // rad, beside what the player asks for
    double rate = 0.0;               // rad/s
  };

  // kg m^2/s, of everything but the arms.
  double yaw_momentum(const GaitdRobotState& robot);

  const GaitdModel model_;
  TrajectoryPlayer player_;
  dynamics::Dynamics dynamics_;
  Eigen::VectorXd velocity_;  // nv
  std::array<Swing, GAITD_MAX_JOINTS> swings_;
  int count_ = 0;
  double momentum_ = 0.0;  // kg m^2/s, low-passed
  sdk::Parameters<P> p_{kParameters};
};

}  // namespace gaitd::plugins
