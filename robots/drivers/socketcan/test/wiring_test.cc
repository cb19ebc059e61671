// SPDX-License-Identifier: Apache-2.0
#include "wiring.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

namespace gaitd::can {
namespace {

using nlohmann::json;

GaitdModel make_model(int joints) {
  GaitdModel model{};
  model.size = sizeof(model);
  model.joint_count = joints;
  for (int i = 0; i < joints; ++i) {
    std::snprintf(model.joints[i].name, GAITD_NAME_SIZE, "j%d", i);
    model.joints[i].position_min = -1;
    model.joints[i].position_max = 2;
    model.joints[i].velocity_limit = 12;
    model.joints[i].effort_limit = 80;
  }
  return model;
}

json make_wiring(int joints, double data_bitrate) {
  json wiring = {{"schema", "gaitd.can/1"},
                 {"defaults", {{"gear", 8}, {"ranges", {{"position", 20}, {"velocity", 100}}}}},
                 {"buses", {{"one", {{"interface", "can0"}}}}},
                 {"feet",
                  {{"left", {{"bus", "one"}, {"id", "0x300"}}},
                   {"right", {{"bus", "one"}, {"id", "0x310"}}}}}};
  if (data_bitrate > 0) wiring["buses"]["one"]["data_bitrate"] = data_bitrate;
  for (int i = 0; i < joints; ++i) {
    wiring["joints"]["j" + std::to_string(i)] = {
        {"bus", "one"}, {"id", 1 + i}, {"reply_id", 0x40 + i}};
  }
  return wiring;
}

std::string errors_of_wiring(const json& wiring, int joints, double period,
                             Wiring* result = nullptr) {
  std::vector<std::string> errors;
  const Wiring read = parse_wiring(wiring.dump(), make_model(joints), period, &errors);
  if (result != nullptr) *result = read;
  std::string text;
  for (const std::string& error : errors) text += error + "\n";
  return text;
}

TEST(BusLoad, MatchesTheMeasuredPairs) {
  const auto pair = [](double nominal, double data) {
    return 1e6 * 2 * frame_time({nominal, data}, 8);
  };
  EXPECT_NEAR(270, pair(1e6, 0), 0.01);
  EXPECT_NEAR(112, pair(1e6, 5e6), 0.5);
  EXPECT_NEAR(95, pair(1e6, 8e6), 0.6);
  // Twenty bits more, of which one in four is stuffed after.
  EXPECT_NEAR(160, 1e6 * frame_time({1e6, 0}, 8, true), 0.01);
}

TEST(BusLoad, RefusesMoreJointsThanABusCanCarry) {
  const struct {
    double data_bitrate, period;
    int joints;
  } rows[] = {{0, 0.001, 2},   {0, 0.002, 5},    {0, 0.004, 11},
              {5e6, 0.001, 7}, {5e6, 0.002, 14}, {5e6, 0.004, 28}};
  for (const auto& row : rows) {
    for (const int joints : {row.joints, row.joints + 1}) {
      Wiring wiring;
      json text = make_wiring(joints, row.data_bitrate);
      // The feet on a bus of their own.
      text["buses"]["feet"] = {{"interface", "can1"}};
      text["feet"]["left"]["bus"] = text["feet"]["right"]["bus"] = "feet";
      const std::string errors = errors_of_wiring(text, joints, row.period, &wiring);
      const bool refused = errors.find("expected a load of at most 80 %") != std::string::npos &&
                           errors.find("can.buses.one") != std::string::npos;
      EXPECT_EQ(joints > row.joints, refused) << joints << " joints: " << errors;
    }
  }
}

TEST(Wiring, MapsJointsToMotorsAndBack) {
  Motor motor;
  motor.sign = -1;
  motor.gear = 8;
  motor.offset = 0.25;
  EXPECT_DOUBLE_EQ(0.25, motor.joint_position(0));
  EXPECT_DOUBLE_EQ(0.0, motor.joint_position(2.0));
  for (const double q : {-1.0, 0.3, 2.0}) {
    EXPECT_NEAR(q, motor.joint_position(motor.motor_position(q)), 1e-12);
    EXPECT_NEAR(q, motor.joint_velocity(motor.motor_velocity(q)), 1e-12);
    EXPECT_NEAR(q, motor.joint_torque(motor.motor_torque(q)), 1e-12);
  }
  // The same power on both sides, and the same torque of a spring.
  EXPECT_DOUBLE_EQ(3.0 * 2.0, motor.motor_torque(3.0) * motor.motor_velocity(2.0));
  const double spring =
      motor.motor_gain(640.0) * (motor.motor_position(0.5) - motor.motor_position(0.4));
  EXPECT_NEAR(640.0 * 0.1, motor.joint_torque(spring), 1e-9);
}

TEST(Wiring, ReadsDefaultsAndWhatAJointSaysOtherwise) {
  json text = make_wiring(2, 5e6);
  text["joints"]["j1"].update({{"sign", -1},
                               {"offset", 0.1},
                               {"gear", 9.0},
                               {"ranges", {{"torque", 33}, {"velocity", 110}}},
                               {"limits", {{"torque", 40}}}});
  Wiring wiring;
  EXPECT_EQ("", errors_of_wiring(text, 2, 0.001, &wiring));
  ASSERT_EQ(2u, wiring.motors.size());
  EXPECT_EQ(0x41u, wiring.motors[1].reply_id);
  EXPECT_EQ(8.0, wiring.motors[0].gear);
  EXPECT_EQ(80.0, wiring.motors[0].torque_limit);
  EXPECT_EQ(9.0, wiring.motors[1].gear);
  EXPECT_EQ(33.0, wiring.motors[1].ranges.torque);
  EXPECT_EQ(20.0, wiring.motors[1].ranges.position);
  EXPECT_EQ(40.0, wiring.motors[1].torque_limit);
  EXPECT_EQ(0x300u, wiring.feet[0].id);
}

TEST(Wiring, ReportsEveryMistakeAtOnce) {
  json text = make_wiring(3, 5e6);
  text["typo"] = 1;
  text["joints"]["j0"]["bus"] = "two";
  text["joints"]["j1"]["id"] = 3;  // that of j2
  text["joints"]["j2"]["sign"] = 0;
  text["joints"]["j9"] = text["joints"]["j2"];
  text["feet"].erase("left");
  const std::string errors = errors_of_wiring(text, 3, 0.001);
  for (const char* expected :
       {"can.typo", "can.joints.j0.bus: expected one of the buses one",
        "0x003, which is can.joints.j1.id", "can.joints.j2.sign: expected 1 or -1",
        "can.joints.j9: expected a joint of the model", "can.feet.left"}) {
    EXPECT_NE(std::string::npos, errors.find(expected)) << expected << " in\n" << errors;
  }
}

TEST(Wiring, RefusesAJointThatItsMotorCannotShow) {
  for (const auto& [key, value] :
       std::map<std::string, double>{{"position", 15.0}, {"velocity", 95.0}, {"torque", 9.0}}) {
    json text = make_wiring(1, 5e6);
    text["defaults"]["ranges"][key] = value;
    EXPECT_NE(std::string::npos, errors_of_wiring(text, 1, 0.001).find("ranges." + key)) << key;
  }
  json text = make_wiring(1, 5e6);
  text["joints"].erase("j0");
  EXPECT_NE(std::string::npos, errors_of_wiring(text, 1, 0.001).find("a motor for every joint"));
}

TEST(Wiring, RefusesLimitsThatLeaveNoRange) {
  json text = make_wiring(1, 5e6);
  text["joints"]["j0"]["limits"] = {{"position_min", 1.0}, {"position_max", -0.5}};
  EXPECT_NE(std::string::npos,
            errors_of_wiring(text, 1, 0.001)
                .find("can.joints.j0.limits.position_min: expected less than position_max"));
}

TEST(Wiring, RefusesIdentifiersThatRepliesOfOthersHave) {
  json text = make_wiring(1, 5e6);
  text["joints"]["j0"]["reply_id"] = 0;  // of every mini-cheetah motor
  text["feet"]["left"]["id"] = "0x0";
  const std::string errors = errors_of_wiring(text, 1, 0.001);
  EXPECT_NE(std::string::npos, errors.find("can.joints.j0.reply_id: expected an identifier 0x001"))
      << errors;
  EXPECT_NE(std::string::npos, errors.find("can.feet.left.id: expected an identifier 0x001"))
      << errors;
  text = make_wiring(1, 5e6);
  text["joints"]["j0"]["dialect"] = "mini_cheetah";
  text["joints"]["j0"]["id"] = "0x101";  // its reply would say 0x01
  EXPECT_NE(std::string::npos, errors_of_wiring(text, 1, 0.001).find("an identifier 0x001..0x0FF"));
}

TEST(Wiring, RobStrideMotorsHaveIdentifiersOfTheirOwnAndNoCanFd) {
  json text = make_wiring(2, 0);
  text["buses"]["feet"] = {{"interface", "can1"}};
  text["feet"]["left"]["bus"] = text["feet"]["right"]["bus"] = "feet";
  text["defaults"]["dialect"] = "robstride";
  EXPECT_NE(
      std::string::npos,
      errors_of_wiring(text, 2, 0.004).find("j0.ranges.stiffness: expected that of the motor"));
  text["defaults"]["ranges"] = {
      {"position", 20}, {"velocity", 100}, {"torque", 60}, {"stiffness", 5000}, {"damping", 100}};
  text["joints"]["j0"].erase("reply_id");
  text["joints"]["j1"]["reply_id"] = "0xFC";
  text["estop"] = {{"bus", "one"}, {"id", 1}};  // 11 bits: not that of j0
  Wiring wiring;
  EXPECT_EQ("", errors_of_wiring(text, 2, 0.004, &wiring));
  EXPECT_EQ(&kRobStride, wiring.motors[0].dialect);
  EXPECT_EQ(0xFDu, wiring.motors[0].reply_id);
  EXPECT_EQ(0xFCu, wiring.motors[1].reply_id);
  EXPECT_NEAR(4 * 160e-6 / 0.004, bus_load(wiring, 1, 0.004), 1e-9);
  text["joints"]["j1"] = {{"bus", "one"}, {"id", "0x80"}, {"reply_id", 3}};
  std::string errors = errors_of_wiring(text, 2, 0.004);
  EXPECT_NE(std::string::npos, errors.find("j1.id: expected an identifier 0x001..0x07F")) << errors;
  EXPECT_NE(std::string::npos, errors.find("j1.reply_id: expected an identifier 0x080..0x0FD"))
      << errors;
  text["joints"]["j1"] = {{"bus", "one"}, {"id", 1}};
  text["buses"]["one"]["data_bitrate"] = 5e6;
  errors = errors_of_wiring(text, 2, 0.004);
  EXPECT_NE(std::string::npos, errors.find("0x001, which is can.joints.j0.id")) << errors;
  EXPECT_NE(std::string::npos, errors.find("j0.bus: expected a bus without data_bitrate"))
      << errors;
  text["buses"] = json::object();
  EXPECT_NE(std::string::npos, errors_of_wiring(text, 2, 0.004).find("can.buses: expected 1 to"));
}

TEST(Wiring, AnEstopIsAlwaysWatched) {
  json text = make_wiring(1, 5e6);
  text["estop"] = {{"bus", "one"}, {"id", "0x80"}};
  Wiring wiring;
  EXPECT_EQ("", errors_of_wiring(text, 1, 0.001, &wiring));
  EXPECT_EQ(0.1, wiring.heartbeat);
  text["estop"]["heartbeat"] = 0;
  EXPECT_NE(std::string::npos, errors_of_wiring(text, 1, 0.001).find("can.estop.heartbeat"));
}

}  // namespace
}  // namespace gaitd::can
