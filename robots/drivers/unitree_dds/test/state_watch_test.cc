// SPDX-License-Identifier: Apache-2.0
#include "state_watch.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "crc.h"
#include "gaitd/abi/backend.h"
#include "remote.h"

namespace gaitd::unitree {
namespace {

constexpr int64_t kMillisecond = 1'000'000;
constexpr uint64_t kAllMotors = (uint64_t{1} << kMotors) - 1;

struct Bench {
  StateWatch watch{{kAllMotors, 0.05, 20}};
  LowState message;
  int64_t now = 1000 * kMillisecond;

  Bench() {
    std::memset(&message, 0, sizeof(message));
    message.mode_machine = 5;
    message.tick = 500;
    for (int i = 0; i < kMotors; ++i) message.motor_state[i].mode = 1;
  }
  bool send() {
    message.crc = message_crc(message);
    return watch.take(message, now);
  }
  // A millisecond later.
  bool next() {
    now += kMillisecond;
    ++message.tick;
    return send();
  }
  void keys(uint16_t keys) {
    message.wireless_remote[2] = static_cast<uint8_t>(keys & 0xFF);
    message.wireless_remote[3] = static_cast<uint8_t>(keys >> 8);
  }
  uint32_t causes() const { return watch.causes(now); }
  Status status(uint32_t holds = 0) const {
    Status status{};
    watch.report(holds | causes(), &status);
    return status;
  }
};

TEST(StateWatch, TakesMotorsAndPelvis) {
  Bench b;
  EXPECT_EQ(uint32_t{kHoldSilent}, b.causes());
  b.message.motor_state[3].q = 0.3f;
  b.message.motor_state[3].dq = -1;
  b.message.motor_state[3].tau_est = 7;
  b.message.imu_state.gyroscope[1] = 0.5f;
  b.message.imu_state.accelerometer[2] = 9.8f;
  ASSERT_TRUE(b.send());
  EXPECT_EQ(0.3f, b.watch.state().position[3]);
  EXPECT_EQ(-1.0f, b.watch.state().velocity[3]);
  EXPECT_EQ(7.0f, b.watch.state().torque[3]);
  EXPECT_EQ(0.5f, b.watch.state().pelvis.rate[1]);
  EXPECT_EQ(9.8f, b.watch.state().pelvis.specific_force[2]);
  EXPECT_EQ(5u, b.watch.state().mode_machine);
  EXPECT_EQ(0u, b.causes());
  EXPECT_EQ(0u, b.status().conditions);
}

TEST(StateWatch, LeavesOutWhatIsDamaged) {
  Bench b;
  ASSERT_TRUE(b.send());
  b.message.crc ^= 4;
  EXPECT_FALSE(b.watch.take(b.message, b.now));
  b.message.motor_state[2].q = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(b.next());
  EXPECT_EQ(2u, b.status().bad_crc);
  EXPECT_EQ(1u, b.watch.state().sequence);
  // Nobody reads what is in the unused slots.
  b.message.motor_state[2].q = 0;
  b.message.motor_state[33].q = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(b.next());
}

TEST(StateWatch, ARepeatedTickIsNoYoungerThanItsTick) {
  Bench b;
  ASSERT_TRUE(b.send());
  const int64_t first = b.now;
  b.now += kMillisecond / 2;
  EXPECT_TRUE(b.send());  // as one in 24 does
  EXPECT_EQ(b.now, b.watch.state().stamp_ns);
  for (int i = 0; i < 60; ++i) {
    b.now += kMillisecond;
    b.send();
  }
  EXPECT_EQ(first + kMillisecond, b.watch.state().stamp_ns);
  EXPECT_EQ(uint32_t{kHoldSilent}, b.causes());
  EXPECT_EQ(61u, b.status().repeated);
  EXPECT_TRUE(b.next());
  EXPECT_EQ(b.now, b.watch.state().stamp_ns);
  EXPECT_EQ(0u, b.causes());
}

TEST(StateWatch, SilenceIsAFaultOfTheBus) {
  Bench b;
  b.send();
  b.now += 50 * kMillisecond;
  EXPECT_EQ(0u, b.causes());
  b.now += kMillisecond;
  EXPECT_EQ(uint32_t{kHoldSilent}, b.causes());
  EXPECT_EQ(uint32_t{GAITD_HEALTH_BUS}, b.status().conditions);
  EXPECT_STREQ("the robot is silent: no state on rt/lowstate", b.status().text);
}

TEST(StateWatch, AnotherVariantOrFrameOrANewStartIsAFaultThatStays) {
  const auto after = [](auto&& change) {
    Bench b;
    b.send();
    change(b);
    EXPECT_EQ(uint32_t{kHoldVariant}, b.causes());
    EXPECT_EQ(uint32_t{GAITD_HEALTH_BUS}, b.status().conditions);
    EXPECT_EQ(5u, b.watch.state().mode_machine);  // what commands go on saying
    return std::string(b.status().text);
  };
  EXPECT_EQ("mode_machine changed from 5 to 6", after([](Bench& b) {
              b.message.mode_machine = 6;
              b.next();
            }));
  EXPECT_EQ("mode_pr is not 0: the robot takes ankles and waist for motors", after([](Bench& b) {
              b.message.mode_pr = 1;
              b.next();
            }));
  EXPECT_EQ("the robot was started again: restart gaitd, to take control", after([](Bench& b) {
              b.message.tick = 3;
              b.next();
              for (int i = 0; i < 2000; ++i) b.next();
            }));
}

TEST(StateWatch, ATickThatOverflowsIsNoNewStart) {
  Bench b;
  b.message.tick = 0xFFFFFFFFu;
  b.send();
  b.next();
  EXPECT_EQ(0u, b.message.tick);
  EXPECT_EQ(0u, b.causes());
}

TEST(StateWatch, TheRemoteAsksForDampingHoweverShortly) {
  Bench b;
  b.send();
  b.keys(kL2 | kB);
  b.next();
  EXPECT_EQ(uint32_t{kHoldEstop}, b.causes());
  EXPECT_EQ(uint32_t{GAITD_HEALTH_ESTOP}, b.status().conditions);
  EXPECT_STREQ("the remote asks for damping (L2+B)", b.status().text);
  b.next();
  EXPECT_EQ(1u, b.watch.estops());
  b.keys(0);
  b.next();
  EXPECT_EQ(0u, b.causes());
  EXPECT_EQ(1u, b.status().estops);
  // The gate still holds: the condition stands until the controller knows.
  EXPECT_EQ(uint32_t{GAITD_HEALTH_ESTOP}, b.status(kHoldEstop).conditions);
  b.keys(kL2);
  b.next();
  EXPECT_EQ(1u, b.watch.estops());
  b.keys(kSelect);
  b.next();
  EXPECT_EQ(2u, b.watch.estops());
}

TEST(StateWatch, TellsWhichMotorHasWhat) {
  Bench b;
  b.message.motor_state[9].motorstate = 0x200;
  b.send();
  EXPECT_EQ(uint32_t{GAITD_HEALTH_MOTOR}, b.status().conditions);
  EXPECT_STREQ("motor of right_knee_joint: winding too hot (0x200)", b.status().text);
  b.message.motor_state[9].motorstate = 0;
  b.message.motor_state[9].temperature[1] = 121;
  b.next();
  EXPECT_STREQ("motor of right_knee_joint: winding at 121 °C", b.status().text);
  b.message.motor_state[9].temperature[1] = 120;
  b.next();
  EXPECT_EQ(0u, b.status().conditions);
}

TEST(StateWatch, AMotorThatIsOffWhileDrivenSwitchedItselfOff) {
  Bench b;
  b.send();
  b.message.motor_state[3].mode = 0;
  for (int i = 0; i < 200; ++i) b.next();
  EXPECT_EQ(0u, b.status().conditions);  // nobody drives
  // A test of another joint: this one is commanded off.
  b.watch.set_on(kAllMotors & ~(uint64_t{1} << 3));
  for (int i = 0; i < 200; ++i) b.next();
  EXPECT_EQ(0u, b.status().conditions);
  b.watch.set_on(kAllMotors);
  for (int i = 0; i < 99; ++i) b.next();
  EXPECT_EQ(0u, b.status().conditions);
  b.next();
  EXPECT_STREQ("motor of left_knee_joint: it switched itself off", b.status().text);
  b.watch.set_on(0);  // gaitd has heard of it
  b.next();
  EXPECT_EQ(uint32_t{GAITD_HEALTH_MOTOR}, b.status().conditions);
  b.message.motor_state[3].mode = 1;
  b.next();
  EXPECT_EQ(0u, b.status().conditions);
}

TEST(StateWatch, SimulatorsThatNeverSayOnAreBelievedToBeOn) {
  Bench b;
  for (int i = 0; i < kMotors; ++i) b.message.motor_state[i].mode = 0;
  b.watch.set_on(kAllMotors);
  for (int i = 0; i < 200; ++i) b.next();
  EXPECT_EQ(0u, b.status().conditions);
}

TEST(StateWatch, LowChargeIsAWarning) {
  Bench b;
  b.send();
  BmsState battery{};
  battery.soc = 20;
  b.watch.take_battery(battery);
  EXPECT_EQ(0u, b.status().conditions);
  battery.soc = 19;
  b.watch.take_battery(battery);
  EXPECT_EQ(uint32_t{GAITD_HEALTH_WARNING}, b.status().conditions);
  EXPECT_STREQ("charge 19 %, at least 20 % are wanted", b.status().text);
}

TEST(StateWatch, FeetWhoseCounterStandsStillAreSilent) {
  Bench b;
  b.send();
  FootWrenches feet{};
  feet.counter = 8;
  feet.left[5] = 160;
  feet.right[0] = 2;
  b.watch.take_feet(feet, b.now);
  EXPECT_EQ(160.0f, b.watch.state().feet.wrench[GAITD_LEFT][5]);
  EXPECT_EQ(2.0f, b.watch.state().feet.wrench[GAITD_RIGHT][0]);
  const int64_t before = b.now;
  b.next();
  feet.left[5] = 170;
  b.watch.take_feet(feet, b.now);
  EXPECT_EQ(before, b.watch.state().feet.stamp_ns);
  EXPECT_EQ(160.0f, b.watch.state().feet.wrench[GAITD_LEFT][5]);
}

TEST(StateWatch, InLockstepAStateThatIsSentAgainIsTakenOnce) {
  Bench b;
  set_cycle(4, &b.message);
  EXPECT_TRUE(b.send());
  EXPECT_EQ(4u, b.watch.state().cycle);
  EXPECT_FALSE(b.send());
  set_cycle(5, &b.message);
  EXPECT_TRUE(b.next());
}

}  // namespace
}  // namespace gaitd::unitree
