// SPDX-License-Identifier: Apache-2.0
// What every state estimator takes a foot for, by the force on it, and what a pull makes of that.
#pragma once

#include <algorithm>
#include <cmath>

#include "gaitd/abi/plugin.h"
#include "gaitd/sdk/parameter.h"
#include "gaitd/sdk/sensors.h"
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
// with the swing, a contact comes at once: in the air its mean over the last moments is no load,
// and neither is what lies within its noise.
class SwingTare {
 public:
  // The wrench of a foot, moment first, less what is none. `in_air`: it swings and touched nothing.
  // least: N, of which less is no contact.
  sdk::Vector6d less(const sdk::Vector6d& wrench, bool in_air, double least,
                     const GaitdModel& model, double dt) {
    constexpr double kMean = 0.19, kNoise = 1.1;  // sqrt(h/g), of which it remembers
    constexpr double kBeyond = 6.0;               // standard deviations: a contact
    constexpr double kMost = 0.12;                // weights: a contact however noisy it is
    const double scale = std::sqrt(model.nominal_com_height / model.gravity);
    const double most = std::max(least, kMost * model.total_mass * model.gravity);
    const double force = std::max(0.0, wrench[5]);
    // A soft contact must not pass for noise before it is one.
    contact_ = std::clamp(contact_, least, most);
    const double off = std::clamp(force - mean_, -0.5 * contact_, 0.5 * contact_);
    mean_ += -std::expm1(-dt / (kMean * scale)) * (in_air ? off : -mean_);
    if (in_air) variance_ += -std::expm1(-dt / (kNoise * scale)) * (off * off - variance_);
    contact_ = std::clamp(kBeyond * std::sqrt(variance_), least, most);
    const double left = force - mean_;
    const bool none = left <= (in_air ? contact_ : 0.0);
    return none ? sdk::Vector6d(sdk::Vector6d::Zero()) : sdk::Vector6d(left / force * wrench);
  }
  double contact() const { return contact_; }  // N

 private:
  double mean_ = 0.0;      // N
  double variance_ = 0.0;  // N^2
  double contact_ = 0.0;   // N
};

// Whether the gait lifts this foot.
inline bool swings(const GaitdGaitState& gait, int side) {
  return gait.phase == GAITD_PHASE_SWING && gait.next_side == side;
}

// What a foot carries, and whether it touches anything.
struct FootLoad {
  int contact = GAITD_CONTACT_NONE;
  double normal_force = 0.0;  // N, filtered
  SwingTare tare;

  // Writes wrench, force, contact and the CoP in the sole. `computed`: the wrench of a foot without
  // force sensor. least: N, of which less is no contact. filter: share of the force sensor's
  // reading that a tick takes over. weight: N.
  void read(const GaitdStateEstimatorInput& in, const GaitdModel& model, int side,
            const sdk::Vector6d& computed, double least, double filter, double weight,
            GaitdFootState& state) {
    const bool sensed = sdk::has_force_sensor(model.feet[side]);
    const bool in_air = contact == GAITD_CONTACT_NONE && swings(*in.gait, side);
    const sdk::Vector6d wrench = sensed ? sdk::sole_wrench(model.feet[side], in.sensors->feet[side])
                                        : tare.less(computed, in_air, least, model, in.time.period);
    sdk::view(state.wrench) = wrench;
    normal_force += (sensed ? filter : 1.0) * (std::max(0.0, wrench[5]) - normal_force);
    const double held = contact == GAITD_CONTACT_NONE ? 1.0 : kContactOff;
    const double enough = sensed ? least : tare.contact();
    contact = normal_force > held * enough ? GAITD_CONTACT_FULL : GAITD_CONTACT_NONE;
    state.contact = contact;
    state.normal_force = normal_force;
    state.cop_valid = contact != GAITD_CONTACT_NONE && wrench[5] > 0.01 * weight ? 1 : 0;
    if (state.cop_valid != 0) {
      state.cop[0] = -wrench[1] / wrench[5];
      state.cop[1] = wrench[0] / wrench[5];
    }
  }
};

}  // namespace gaitd::plugins
