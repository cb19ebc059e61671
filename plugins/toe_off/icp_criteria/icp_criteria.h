// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "gaitd/sdk/layer.h"
#include "gaitd/walking/leg_geometry.h"
#include "gaitd/walking/polygon.h"

namespace gaitd::plugins {

// Decides when the trailing foot rolls over its toe (Griffin et al. 2018, section IV; theory
// section 6). Toe-off starts when the leading foot is far enough ahead, clearly higher or lower,
// and all four criteria hold for a moment, or when the trailing ankle has no dorsiflexion left and
// the first one holds, unless the plan still has its CMP behind the toe, where only the heel
// carries. It then lasts until the foot is lifted. Values in the output:
//   icp           m, how far the worse of measured and desired ICP is inside the predicted support
//                 polygon (toe point and leading foothold); at least 0 expected
//   icp_distance  the larger distance of the two to the leading foothold over the distance of the
//                 toe point to it; at most kIcpDistance expected
//   cop           m, from the CoP of the trailing foot to its toe point
//   cmp           m, from the desired CMP to the predicted polygon
//   ankle         rad, dorsiflexion of the trailing ankle that is left
// Late in a swing that needs the reach the stance foot may roll likewise; its polygon is the toe
// point and the coming foothold.
class IcpCriteria {
 public:
  enum class P { kMinForward, kAnkleLimit, kCount };
  static constexpr std::array<GaitdParameter, 2> kParameters = {
      sdk::real_parameter("min_forward", "foot lengths", 0, 10, 0.75,
                          "step that has toe-off; low: short steps have one too, high: none has"),
      sdk::porting(sdk::real_parameter(
          "ankle_limit", "rad", 0, 1.5, 0.4,
          "dorsiflexion that starts toe-off; low: too soon, high: the stop is met")),
  };

  explicit IcpCriteria(const GaitdModel& model);
  void set_parameter(int index, double value) { p_.set(index, value); }
  GaitdStatus process(const GaitdToeOffInput& in, GaitdToeOff& out);
  void reset();
  void get_state(GaitdToeOffState& s) const { s = state_; }
  void set_state(const GaitdToeOffState& s) { state_ = s; }

 private:
  // The foot that may roll, and where the other one stands or is about to.
  struct Candidate {
    int side = GAITD_BOTH;  // GAITD_BOTH: none
    GaitdFoothold leading{};
  };
  Candidate candidate(const GaitdGaitState& gait) const;
  bool rolling_on(const GaitdRobotState& robot, const GaitdGaitState& gait) const;
  bool far_enough(const GaitdFoothold& trailing, const GaitdFoothold& leading) const;
  // Whether the CMP of the plan can do without the heel.
  bool evaluate(const GaitdToeOffInput& in, const Candidate& c, GaitdToeOff& out) const;
  // m, at most: by how much the ICP misses its plan at the end of the transfer when the CMP is held
  // at the edge of `support` where the plan wants it behind. The way to that CMP only gets shorter
  // in a transfer, so it counts as it is now; at its end it counts itself.
  double heel_cost(const GaitdToeOffInput& in, const walking::ConvexPolygon& support) const;

  const GaitdModel model_;
  sdk::Parameters<P> p_{kParameters};
  GaitdToeOffState state_{};
  double foot_length_;  // m
  double leg_length_;   // m, hip to ankle, joints of the leg straight
  std::array<walking::LegGeometry, GAITD_MAX_FEET> legs_;
};

}  // namespace gaitd::plugins
