// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/sensor_monitor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "walking/test/atlas.h"
#include "walking/test/tick.h"

namespace gaitd::daemon {
namespace {

using testing::kDt;

using testing::atlas;
using Suspicion = SensorMonitor::Suspicion;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Sensors that never say the same twice.
class MonitorBench {
 public:
  MonitorBench() : monitor(atlas()), data(std::make_unique<TickData>()) {
    GaitdSensors& s = data->readings;
    s.joint_count = atlas().joint_count;
    s.imu_count = 1;
    s.foot_count = GAITD_MAX_FEET;
    for (auto& foothold : data->gait.footholds) foothold.contact = GAITD_CONTACT_FULL;
    data->gait.phase = GAITD_PHASE_SWING;
    data->safety = SafetyState::kWalking;
    next();
  }
  // New readings of everything, not looked at yet.
  void next() {
    ++count_;
    const double wobble = 1e-4 * (count_ % 7);
    GaitdSensors& s = data->readings;
    for (int i = 0; i < s.joint_count; ++i) {
      s.joints[i] = {{}, 0.3 + wobble, wobble, 10.0, {}};
      s.joints[i].info.sequence = static_cast<std::uint32_t>(count_);
      s.joints[i].info.valid = 1;
    }
    s.imus[0] = {};
    s.imus[0].info.valid = 1;
    s.imus[0].info.sequence = static_cast<std::uint32_t>(count_);
    s.imus[0].orientation[3] = 1.0;
    s.imus[0].angular_rate[1] = 0.1 + wobble;
    s.imus[0].specific_force[2] = 9.8 + wobble;
    for (auto& foot : s.feet) {
      foot = {};
      foot.info.valid = 1;
      foot.info.sequence = static_cast<std::uint32_t>(count_);
      foot.force[2] = 800.0 + wobble;
    }
  }
  int joint(const std::string& name) const {
    for (int i = 0; i < atlas().joint_count; ++i) {
      if (name == atlas().joints[i].name) return i;
    }
    ADD_FAILURE() << name;
    return 0;
  }
  const GaitdJointSensor& passed(int joint) const { return data->sensors.joints[joint]; }
  bool dropped(int joint) const { return (data->dropped >> joint & 1u) != 0; }
  // Ticks in which every reading of a foot is zero while the other one carries `other` of the
  // weight.
  void lift(int side, double other, int ticks) {
    const double weight = atlas().total_mass * atlas().gravity;
    for (int i = 0; i < ticks; ++i) {
      next();
      for (double& force : data->readings.feet[side].force) force = 0.0;
      data->readings.feet[1 - side].force[2] = other * weight + 0.1 * (i % 3);
      check();
    }
  }
  void check() { monitor.check(kDt, parameters, *data); }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      next();
      check();
    }
  }

  SensorMonitor monitor;
  std::unique_ptr<TickData> data;
  sdk::Parameters<SafetyParameter> parameters{kSafetyParameters};

 private:
  int count_ = 0;
};

TEST(SensorMonitor, PassesOnWhatIsCredible) {
  MonitorBench b;
  for (int i = 0; i < 200; ++i) {
    b.run(1);
    EXPECT_EQ(b.data->sensors.joints[3].position, b.data->readings.joints[3].position);
    EXPECT_EQ(b.data->sensors.imus[0].angular_rate[1], b.data->readings.imus[0].angular_rate[1]);
    EXPECT_EQ(b.data->sensors.feet[1].force[2], b.data->readings.feet[1].force[2]);
    EXPECT_EQ(b.data->sensors.imus[0].info.age, 0.0);
    EXPECT_EQ(b.monitor.suspect().suspicion, Suspicion::kNone);
  }
}

TEST(SensorMonitor, HoldsTheLastReadingThroughASpike) {
  MonitorBench b;
  b.run(20);
  const double before = b.data->sensors.imus[0].angular_rate[1];
  b.next();
  b.data->readings.imus[0].angular_rate[1] = 30.0;
  b.data->readings.joints[4].position = kNan;
  b.data->readings.feet[0].force[2] = 1e6;
  b.check();
  EXPECT_EQ(b.data->sensors.imus[0].angular_rate[1], before);
  EXPECT_LT(b.data->sensors.joints[4].position, 0.4);
  EXPECT_LT(b.data->sensors.feet[0].force[2], 900.0);
  EXPECT_NEAR(b.data->sensors.imus[0].info.age, kDt, 1e-9);
  EXPECT_EQ(b.monitor.suspect().suspicion, Suspicion::kUntrue);
  b.run(1);
  EXPECT_EQ(b.data->sensors.imus[0].info.age, 0.0);
  EXPECT_EQ(b.data->sensors.joints[4].position, b.data->readings.joints[4].position);
}

TEST(SensorMonitor, ALastingFaultGrowsOldUnderItsName) {
  MonitorBench b;
  const int knee = b.joint("l_leg_kny");
  b.run(20);
  for (int i = 0; i < 30; ++i) {
    b.next();
    b.data->readings.joints[knee].velocity = kNan;
    b.check();
  }
  EXPECT_NEAR(b.passed(knee).info.age, 0.03, 1e-9);
  EXPECT_STREQ(b.monitor.suspect().sensor, "l_leg_kny");
}

TEST(SensorMonitor, AJumpThatStaysBecomesTheFaultBeforeItIsBelieved) {
  MonitorBench b;
  b.run(20);
  const double timeout = b.parameters[SafetyParameter::kSensorTimeout];
  const auto age = [&] { return b.data->sensors.imus[0].info.age; };
  for (int i = 0; age() <= timeout && i < 1000; ++i) {
    b.next();
    b.data->readings.imus[0].angular_rate[1] = 12.0 + 1e-3 * i;
    b.check();
    ASSERT_LT(b.data->sensors.imus[0].angular_rate[1], 1.0);
  }
  EXPECT_GT(age(), timeout);
  // Not for ever: a robot that was turned over meanwhile is armed again.
  for (int i = 0; i < 100; ++i) {
    b.next();
    b.data->readings.imus[0].angular_rate[1] = 12.0 + 1e-3 * i;
    b.check();
  }
  EXPECT_GT(b.data->sensors.imus[0].angular_rate[1], 11.0);
}

TEST(SensorMonitor, NamesASensorThatIsSilent) {
  MonitorBench b;
  b.run(20);
  b.next();
  b.data->readings.feet[1].info.age = 0.05;
  b.check();
  EXPECT_EQ(b.monitor.suspect().suspicion, Suspicion::kSilent);
  EXPECT_EQ(std::string(b.monitor.suspect().sensor), "right foot force");
}

TEST(SensorMonitor, AnOldImuIsLeftForABetterOne) {
  MonitorBench b;
  b.run(20);
  const auto silent_for = [&b](double second) {
    b.next();
    GaitdImuSensor* imus = b.data->readings.imus;
    b.data->readings.imu_count = 2;
    imus[1] = imus[0];
    imus[0].info.age = 0.05;
    imus[1].info.age = second;
    b.check();
  };
  silent_for(0.0);
  EXPECT_EQ(b.data->sensors.imus[0].info.valid, 0);
  EXPECT_EQ(b.data->sensors.imus[1].info.valid, 1);
  // With none that is better it goes on, until its age is the fault.
  silent_for(0.06);
  EXPECT_EQ(b.data->sensors.imus[0].info.valid, 1);
  EXPECT_EQ(b.data->sensors.imus[1].info.valid, 1);
}

TEST(SensorMonitor, ReadingsThatWereNeverCredibleAreNotValid) {
  MonitorBench b;
  b.data->readings.imus[0].angular_rate[0] = kNan;
  b.check();
  EXPECT_EQ(b.data->sensors.imus[0].info.valid, 0u);
}

TEST(SensorMonitor, FindsAnImuThatFreezesOnlyByNewFrames) {
  MonitorBench b;
  b.run(20);
  const GaitdImuSensor frozen = b.data->readings.imus[0];
  for (int i = 0; i < 50; ++i) {  // no new frames: late, not frozen
    b.next();
    b.data->readings.imus[0] = frozen;
    b.check();
  }
  EXPECT_EQ(b.monitor.suspect().suspicion, Suspicion::kNone);
  for (int i = 0; i < 30; ++i) {
    b.next();
    const GaitdSignalInfo info = b.data->readings.imus[0].info;
    b.data->readings.imus[0] = frozen;
    b.data->readings.imus[0].info = info;
    b.check();
  }
  EXPECT_GT(b.data->sensors.imus[0].info.age, 0.02);
  EXPECT_EQ(b.monitor.suspect().suspicion, Suspicion::kFrozen);
}

TEST(SensorMonitor, AFootSensorMayRepeatNothingInTheAirButNotUnderLoad) {
  for (const bool carries : {false, true}) {
    MonitorBench b;
    b.run(20);
    b.data->gait.footholds[0].contact = carries ? GAITD_CONTACT_FULL : GAITD_CONTACT_NONE;
    const auto zeros = [&](int ticks) {
      for (int i = 0; i < ticks; ++i) {
        b.next();
        for (double& force : b.data->readings.feet[0].force) force = 0.0;
        b.check();
      }
    };
    zeros(100);  // as long as a bounce
    EXPECT_EQ(b.data->sensors.feet[0].info.age, 0.0);
    zeros(100);
    EXPECT_EQ(b.data->sensors.feet[0].info.age > 0.02, carries);
  }
}

TEST(SensorMonitor, AFootThatComesDownLateAndSoftlyHasADeadSensorOnlyIfItStaysThere) {
  MonitorBench b;
  b.run(20);
  b.data->gait.footholds[0].contact = GAITD_CONTACT_NONE;
  b.data->gait.next_side = 0;
  b.data->gait.late_contact = 1;  // and the foot does not move
  const auto zeros = [&](int ticks) {
    for (int i = 0; i < ticks; ++i) {
      b.next();
      for (double& force : b.data->readings.feet[0].force) force = 0.0;
      b.check();
    }
  };
  zeros(45);
  EXPECT_EQ(b.data->sensors.feet[0].info.age, 0.0);
  zeros(15);
  EXPECT_GT(b.data->sensors.feet[0].info.age, 0.02);
  EXPECT_EQ(b.monitor.suspect().suspicion, Suspicion::kFrozen);
}

TEST(SensorMonitor, AJointThatIsToldToMoveAndDoesNotIsStuck) {
  for (const bool commanded : {false, true}) {
    MonitorBench b;
    const int knee = b.joint("l_leg_kny");
    b.run(20);
    const double position = b.data->readings.joints[knee].position;
    b.data->commands.joints[knee].velocity = commanded ? 1.0 : 0.0;
    for (int i = 0; i < 80; ++i) {
      b.next();
      b.data->readings.joints[knee].position = position;
      b.check();
    }
    EXPECT_EQ(b.data->sensors.joints[knee].info.age > 0.05, commanded);
    EXPECT_EQ(b.monitor.suspect().suspicion, commanded ? Suspicion::kStuck : Suspicion::kNone);
  }
}

// The gait of a robot that tips over one foot still believes in the other one.
TEST(SensorMonitor, AFootInTheAirIsNotFrozenWhateverTheGaitBelieves) {
  MonitorBench b;
  b.run(20);
  b.lift(GAITD_RIGHT, 0.9, 1000);
  EXPECT_EQ(b.data->sensors.feet[GAITD_RIGHT].info.age, 0.0);
  EXPECT_EQ(b.monitor.suspect().suspicion, Suspicion::kNone);
}

TEST(SensorMonitor, AFootThatHasToCarryAndShowsNothingIsFrozen) {
  MonitorBench b;
  b.run(20);
  b.lift(GAITD_RIGHT, 0.0, 160);
  EXPECT_GT(b.data->sensors.feet[GAITD_RIGHT].info.age, 0.02);
  EXPECT_EQ(b.monitor.suspect().suspicion, Suspicion::kFrozen);
  EXPECT_STREQ(b.monitor.suspect().sensor, "right foot force");
}

TEST(SensorMonitor, ARobotThatHangsOrLiesHasNoFrozenFeet) {
  for (const SafetyState state : {SafetyState::kDisarmed, SafetyState::kReadying,
                                  SafetyState::kTesting, SafetyState::kFault}) {
    MonitorBench b;
    b.data->safety = state;
    b.run(20);
    b.lift(GAITD_RIGHT, 0.0, 1000);
    EXPECT_EQ(b.data->sensors.feet[GAITD_RIGHT].info.age, 0.0) << static_cast<int>(state);
  }
}

// In a simulation without noise nothing changes any more once it lies still.
TEST(SensorMonitor, ARobotAtPerfectRestHasNoFrozenSensors) {
  for (const bool controlled : {false, true}) {
    MonitorBench b;
    b.data->safety = controlled ? SafetyState::kStanding : SafetyState::kDisarmed;
    b.run(20);
    const GaitdSensors rest = b.data->readings;
    for (int i = 0; i < 100; ++i) {
      b.next();
      const std::uint32_t sequence = b.data->readings.imus[0].info.sequence;
      b.data->readings = rest;
      b.data->readings.imus[0].info.sequence = sequence;
      for (auto& foot : b.data->readings.feet) foot.info.sequence = sequence;
      b.check();
    }
    // Nobody who balances is at rest: then it is the sensors.
    EXPECT_EQ(b.data->sensors.imus[0].info.age > 0.02, controlled);
    EXPECT_EQ(b.data->sensors.feet[0].info.age > 0.02, controlled);
  }
}

TEST(SensorMonitor, ALightSlowJointMayBeFlung) {
  MonitorBench b;
  const int neck = b.joint("neck_ay");
  ASSERT_LT(3.0 * atlas().joints[neck].velocity_limit, 28.0);
  b.run(20);
  for (int i = 0; i < 50; ++i) {
    b.next();
    b.data->readings.joints[neck].velocity = 28.0 + 1e-3 * i;
    b.check();
  }
  EXPECT_EQ(b.passed(neck).velocity, b.data->readings.joints[neck].velocity);
  EXPECT_FALSE(b.dropped(neck));
}

TEST(SensorMonitor, AJointThatBalanceDoesNotNeedIsDroppedAndStopsNobody) {
  for (const Suspicion how : {Suspicion::kUntrue, Suspicion::kSilent, Suspicion::kStuck}) {
    MonitorBench b;
    const int neck = b.joint("neck_ay");
    b.run(20);
    const double last = b.passed(neck).position;
    b.data->commands.joints[neck].velocity = how == Suspicion::kStuck ? 10.0 : 0.0;
    const auto fail = [&](int ticks) {
      for (int i = 0; i < ticks; ++i) {
        b.next();
        GaitdJointSensor& joint = b.data->readings.joints[neck];
        if (how == Suspicion::kUntrue) joint.velocity = kNan;
        if (how == Suspicion::kSilent) joint.info = {0, 1e-3 * i, 0, i < 18 ? 1u : 0u};
        if (how == Suspicion::kStuck) joint.position = last;
        b.check();
        EXPECT_EQ(b.monitor.suspect().suspicion, Suspicion::kNone);
      }
    };
    fail(18);
    EXPECT_FALSE(b.dropped(neck));
    fail(30);
    EXPECT_TRUE(b.dropped(neck));
    EXPECT_EQ(b.monitor.dropped(neck).suspicion, how);
    EXPECT_STREQ(b.monitor.dropped(neck).sensor, "neck_ay");
    EXPECT_EQ(b.passed(neck).velocity, 0.0);
    EXPECT_EQ(b.passed(neck).info.valid, 1u);
    EXPECT_NEAR(b.passed(neck).position, last, 1e-3);
    b.data->commands.joints[neck].velocity = 0.0;
    b.run(100);  // it reads well again, but its drive may be anywhere
    EXPECT_TRUE(b.dropped(neck));
    EXPECT_EQ(b.passed(neck).position, b.data->readings.joints[neck].position);
    b.data->safety = SafetyState::kReadying;  // armed again
    b.run(1);
    EXPECT_FALSE(b.dropped(neck));
  }
}

TEST(SensorMonitor, WhoComesUpNeedsEveryJoint) {
  MonitorBench b;
  b.data->safety = SafetyState::kReadying;
  const int neck = b.joint("neck_ay");
  b.run(20);
  for (int i = 0; i < 30; ++i) {
    b.next();
    b.data->readings.joints[neck].velocity = kNan;
    b.check();
  }
  EXPECT_FALSE(b.dropped(neck));
  EXPECT_STREQ(b.monitor.suspect().sensor, "neck_ay");
}

TEST(BalanceJoints, AreTheLegsAndTheSpine) {
  const JointMask balance = balance_joints(atlas());
  for (int i = 0; i < atlas().joint_count; ++i) {
    const std::string name = atlas().joints[i].name;
    const bool needed = name.find("_leg_") != std::string::npos || name.starts_with("back_");
    EXPECT_EQ((balance >> i & 1u) != 0, needed) << name;
  }
}

}  // namespace
}  // namespace gaitd::daemon
