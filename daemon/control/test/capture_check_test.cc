// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/capture_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "daemon/control/test/safety_bench.h"

namespace gaitd::daemon {
namespace {

using P = SafetyParameter;
constexpr double kOmega = 3.0;  // 1/s, of that gait

// The robot stands on both feet, its ICP `ahead` of the toes.
struct Scene {
  Scene() : gait(std::make_unique<GaitdGaitState>()), robot(testing::standing_state(atlas())) {
    stand_on_soles(robot, *gait);
    for (int i = 0; i < atlas().feet[0].point_count; ++i) {
      toes = std::max(toes, robot.feet[0].position[0] + atlas().feet[0].points[i][0]);
    }
    robot.icp[1] = robot.feet[0].position[1];
  }
  // How many ticks until it is lost, at most `ticks`.
  int ticks_until_lost(double ahead, int ticks) {
    robot.icp[0] = toes + ahead;
    for (int i = 1; i <= ticks; ++i) {
      if (check.lost(kPeriod, robot, *gait, parameters)) return i;
    }
    return ticks;
  }

  std::unique_ptr<GaitdGaitState> gait;
  GaitdRobotState robot;
  double toes = -1e9;
  sdk::Parameters<SafetyParameter> parameters{kSafetyParameters};
  CaptureCheck check{atlas()};
};

// Whether steps of at most `reach`, `time` apart, the first one at once, catch an ICP so far ahead.
bool steps_catch(double ahead, double reach, double time) {
  for (int step = 0; step < 200; ++step) {
    ahead = std::max(0.0, ahead - reach) * std::exp(kOmega * time);
    if (ahead == 0.0) return true;
  }
  return false;
}

TEST(CaptureCheck, ItsLimitIsWhereStepsBeginToFail) {
  Scene scene;
  scene.ticks_until_lost(0.1, 1);
  const double reach = safety_parameter(P::kCaptureReach) * atlas().nominal_com_height;
  const double time =
      CaptureCheck::kStepTime * std::sqrt(atlas().nominal_com_height / atlas().gravity);
  EXPECT_NEAR(time, 0.5, 0.01);
  EXPECT_TRUE(steps_catch(0.99 * scene.check.limit(), reach, time));
  EXPECT_FALSE(steps_catch(1.01 * scene.check.limit(), reach, time));
  EXPECT_NEAR(scene.check.distance(), 0.1, 1e-9);
}

TEST(CaptureCheck, IsLostBeyondTheLimitForItsTime) {
  Scene scene;
  scene.ticks_until_lost(0.0, 1);
  const double limit = scene.check.limit();
  const int time = static_cast<int>(std::lround(CaptureCheck::kPatience / kPeriod));
  EXPECT_EQ(scene.ticks_until_lost(0.99 * limit, 1000), 1000);
  EXPECT_EQ(scene.ticks_until_lost(1.01 * limit, time - 1), time - 1);
  EXPECT_EQ(scene.ticks_until_lost(0.99 * limit, 1), 1);  // once inside, it begins anew
  EXPECT_NEAR(scene.ticks_until_lost(1.01 * limit, 1000), time + 1, 1);
}

TEST(CaptureCheck, ASwingThatHasToEndFirstLeavesLess) {
  Scene scene;
  scene.ticks_until_lost(0.0, 1);
  const double limit = scene.check.limit();
  scene.gait->phase = GAITD_PHASE_SWING;
  scene.gait->time_remaining = 0.2;
  scene.ticks_until_lost(0.0, 1);
  EXPECT_NEAR(scene.check.limit(), limit * std::exp(-kOmega * 0.2), 1e-9);
}

TEST(CaptureCheck, JudgesNothingWithoutFeetOrAFrequency) {
  Scene begins;
  begins.gait->omega = 0.0;
  EXPECT_EQ(begins.ticks_until_lost(50.0, 100), 100);
  Scene flies;
  for (GaitdFoothold& foothold : flies.gait->footholds) foothold.contact = GAITD_CONTACT_NONE;
  EXPECT_EQ(flies.ticks_until_lost(50.0, 100), 100);
}

}  // namespace
}  // namespace gaitd::daemon
