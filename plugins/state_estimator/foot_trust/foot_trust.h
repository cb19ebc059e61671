// SPDX-License-Identifier: Apache-2.0
// What every state estimator takes a foot for, by the force on it, and what a pull makes of that.
#pragma once

#include <algorithm>
#include <cmath>

#include "gaitd/abi/plugin.h"
#include "gaitd/sdk/parameter.h"
#include "gaitd/sdk/views.h"

namespace gaitd::plugins {

// Parameters that every variant has.
inline constexpr GaitdParameter kContactOnParameter = sdk::porting(sdk::real_parameter(
    "contact_on", "weight", 0.001, 1, 0.05,
    "force of a contact; low: sensor offsets are contacts, high: one is seen late"));
inline constexpr GaitdParameter kForceFilterParameter = sdk::porting(sdk::real_parameter(
    "force_filter", "Hz", 5, 500, 80,
    "low-pass of the foot forces; low: contacts come late, high: they chatter"));

// Of the force that makes a contact: less is none. Between the two a foot stays what it is.
inline constexpr double kContactOff = 0.6;
// Share of the load below which a trusted foot is so no more, and the time (s) for which a foot
// must carry its share before it is: the ring of the landing is over.
inline constexpr double kTrustOff = 0.30;
inline constexpr double kTrustDelay = 0.02;
// s, after which a trusted foot has come to rest, and holds the heading too.
inline constexpr double kRestDelay = 0.1;

// Somebody pulls at the robot, or has put something on it: CoM and CoP do not tell where gravity
// points.
inline bool pulled(const GaitdStateEstimatorInput& in) {
  return !sdk::view(in.external_wrench).tail<3>().isZero(0.0);
}

// What drives and their play feign on a foot in the air where there is no force sensor. It changes
// with the swing, a contact comes at once: in the air its mean over the last moments is no load.
class SwingTare {
 public:
  // The wrench of a foot, moment first, less what is none. `in_air`: it swings and touched nothing.
  sdk::Vector6d less(const sdk::Vector6d& wrench, bool in_air, const GaitdModel& model, double dt) {
    constexpr double kMemory = 0.19;  // sqrt(h/g)
    const double time = kMemory * std::sqrt(model.nominal_com_height / model.gravity);
    const double force = std::max(0.0, wrench[5]);
    tare_ += -std::expm1(-dt / time) * ((in_air ? force : 0.0) - tare_);
    return force > 0.0 ? sdk::Vector6d(std::max(0.0, 1.0 - tare_ / force) * wrench) : wrench;
  }

 private:
  double tare_ = 0.0;  // N
};

// Whether the gait lifts this foot.
inline bool swings(const GaitdGaitState& gait, int side) {
  return gait.phase == GAITD_PHASE_SWING && gait.next_side == side;
}

}  // namespace gaitd::plugins
