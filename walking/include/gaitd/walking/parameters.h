// SPDX-License-Identifier: Apache-2.0
// Parameters of the scopes that live in walking/. One table per scope, declared here only.
#pragma once

#include "gaitd/sdk/parameter.h"

namespace gaitd::walking {

using sdk::boolean_parameter;
using sdk::expert;
using sdk::porting;
using sdk::real_parameter;

enum class Gait {
  kSwingDuration,
  kTransferDuration,
  kSwingHeight,
  kTouchdownForce,
  kLongestStep,
  kWidestStep,
  kHighestStep,
  kMaxStepTurn,
  kStepTiming,
  kRecovery,
  kCount
};
inline constexpr std::array<GaitdParameter, 10> kGaitParameters = {
    real_parameter(
        "swing_duration", "s", 0.2, 10, 0.6,
        "of footsteps that give none; short: drives saturate, long: the robot falls inwards"),
    real_parameter(
        "transfer_duration", "s", 0.05, 10, 0.25,
        "of footsteps that give none; short: the CMP jumps, long: the robot almost stops"),
    real_parameter("swing_height", "m", 0.01, 0.5, 0.13,
                   "apex of a swing above both footholds; low: toes stub, high: drives saturate"),
    porting(real_parameter(
        "touchdown_force", "weight", 0.005, 0.5, 0.06,
        "force that ends a swing; low: a shaken foot has landed, high: landings are late")),
    porting(real_parameter(
        "longest_step", "com heights", 0.05, 2.5, 0.85,
        "accepted forwards, 0.6 of it backwards; low: more steps, high: legs too short")),
    porting(real_parameter("widest_step", "com heights", 0.1, 1.7, 0.72,
                           "accepted distance sideways; low: more steps, high: legs too short")),
    porting(real_parameter("highest_step", "com heights", 0, 1.7, 0.385,
                           "accepted up or down; low: stairs are refused, high: legs too short")),
    porting(real_parameter(
        "max_step_turn", "rad", 0, 3, 0.8,
        "accepted turn of a step; low: more steps for a turn, high: hips at their limits")),
    expert(boolean_parameter(
        "step_timing", true,
        "walk-straight: durations change where the legs are too short; false: they bend")),
    boolean_parameter(
        "recovery", true,
        "a standing robot steps by itself; false: it falls when its feet cannot hold it"),
};

enum class Drive { kTimeout, kAcceleration, kMaxForward, kMaxLateral, kMaxTurn, kCount };
inline constexpr std::array<GaitdParameter, 5> kDriveParameters = {
    porting(real_parameter(
        "timeout", "s", 0.1, 5, 0.5,
        "to a stand without a renewal; short: a busy network stops it, long: it walks on")),
    real_parameter(
        "acceleration", "g", 0.002, 0.1, 0.03,
        "of a walk, of a turn h away; low: it reacts late, high: steps come out of reach"),
    real_parameter("max_forward", "sqrt(g h)", 0.01, 0.5, 0.23,
                   "speed forwards, half of it backwards; low: slow, high: steps end in refusals"),
    real_parameter("max_lateral", "sqrt(g h)", 0.01, 0.2, 0.075,
                   "speed sideways; low: slow, high: legs cross or reach too far"),
    real_parameter("max_turn", "sqrt(g / h)", 0.01, 0.5, 0.15,
                   "speed of a turn; low: slow, high: hips at their limits"),
};

enum class Swing { kLandingSpeed, kCount };
inline constexpr std::array<GaitdParameter, 1> kSwingParameters = {
    real_parameter(
        "landing_speed", "sqrt(g h)", 0, 0.6, 0.08828,
        "downwards at the end of the swing; low: landings are late, high: they are hard"),
};

enum class Legs { kBentKnee, kStraightKnee, kCollapsedKnee, kSwingKnee, kCount };
inline constexpr std::array<GaitdParameter, 4> kLegParameters = {
    real_parameter("bent_knee", "rad", 0, 2.5, 0.9,
                   "wanted in walk-bent; small: near singular, large: torque and heat"),
    real_parameter("straight_knee", "rad", 0, 1, 0.2,
                   "wanted in walk-straight; small: no room to correct, large: torque and heat"),
    expert(real_parameter(
        "collapsed_knee", "rad", 0, 2, 0.3,
        "wanted of a trailing leg; small: it pushes too long, large: the pelvis sinks")),
    real_parameter("swing_knee", "rad", 0, 2.5, 1.1,
                   "wanted early in swing; small: the toe drags, large: the leg swings too much"),
};

enum class Objective {
  kFriction,
  kComHeight,
  kHeightStiffness,
  kMomentumWeight,
  kRhoWeight,
  kRhoRateWeight,
  kPelvisStiffness,
  kPelvisWeight,
  kChestStiffness,
  kChestWeight,
  kPostureStiffness,
  kPostureWeight,
  kSwingStiffness,
  kSwingWeight,
  kCount
};
inline constexpr std::array<GaitdParameter, 14> kObjectiveParameters = {
    porting(real_parameter("friction", "", 0.05, 2, 0.7,
                           "coefficient counted on; low: pushes are not held, high: feet slip")),
    real_parameter("com_height", "", 0.75, 1.2, 1.0,
                   "when standing, over the nominal one, as straight legs are at most; low: "
                   "torque, high: short steps"),
    real_parameter("height_stiffness", "1/s^2", 0, 500, 80,
                   "of the CoM height; low: it sags, high: forces ring"),
    expert(real_parameter(
        "momentum_weight", "", 50, 1e6, 2000,
        "of balance against all else; low: pushes are not held, high: the body flails")),
    expert(real_parameter("rho_weight", "", 1e-6, 3000, 30,
                          "of small contact forces; low: edges carry all, high: balance gives in")),
    expert(real_parameter(
        "rho_rate_weight", "s", 0, 1200, 12,
        "of even contact forces; low: torques jump with noise, high: balance comes late")),
    real_parameter("pelvis_stiffness", "1/s^2", 0, 1000, 80,
                   "of the pelvis orientation; low: it tilts, high: it shakes"),
    expert(
        real_parameter("pelvis_weight", "", 0, 1e4, 5,
                       "of the pelvis orientation; low: it gives in, high: knees and balance do")),
    real_parameter("chest_stiffness", "1/s^2", 0, 1000, 40,
                   "of the chest orientation; low: it sways, high: it shakes"),
    expert(
        real_parameter("chest_weight", "", 0, 1e4, 10,
                       "of the chest orientation; low: it gives in, high: balance cannot use it")),
    real_parameter("posture_stiffness", "1/s^2", 0, 1000, 80,
                   "of arms, neck and the like; low: they hang, high: they shake"),
    expert(real_parameter(
        "posture_weight", "", 0, 1e4, 1,
        "of arms, neck and the like; low: they drift, high: balance cannot use them")),
    real_parameter("swing_stiffness", "1/s^2", 25, 1500, 150,
                   "of the swing foot; low: it lands beside its foothold, high: it shakes"),
    expert(
        real_parameter("swing_weight", "", 3, 1e6, 105,
                       "of the swing foot's place; low: it strikes the ground, high: knees bend")),
};

}  // namespace gaitd::walking
