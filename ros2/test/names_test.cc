// SPDX-License-Identifier: Apache-2.0
#include "ros2/names.h"

#include <gtest/gtest.h>

#include "diagnostic_msgs.h"
#include "geometry_msgs.h"
#include "nav_msgs.h"
#include "rosgraph_msgs.h"
#include "sensor_msgs.h"
#include "std_msgs.h"
#include "tf2_msgs.h"

namespace gaitd::ros2 {
namespace {

TEST(Names, TopicsAreMangledAsRosDoes) {
  EXPECT_EQ(topic_on_wire("", "odom"), "rt/odom");
  EXPECT_EQ(topic_on_wire("/robots/one", "foot/left/wrench"), "rt/robots/one/foot/left/wrench");
  EXPECT_EQ(topic_on_wire("/robots/one", "/tf"), "rt/tf");
}

TEST(Names, NamespacesAreThoseOfRos) {
  EXPECT_EQ(normalised_namespace(""), "");
  EXPECT_EQ(normalised_namespace("/"), "");
  EXPECT_EQ(normalised_namespace("atlas"), "/atlas");
  EXPECT_EQ(normalised_namespace("/robots/one_2"), "/robots/one_2");
  for (const char* wrong : {"/a//b", "a/", "1st", "a b", "a-b", "~", "rt/../x", "ä"}) {
    EXPECT_FALSE(normalised_namespace(wrong)) << wrong;
  }
  EXPECT_FALSE(normalised_namespace(std::string(1000, 'a')));
}

TEST(Names, TypesAreThoseOfRos) {
  EXPECT_STREQ(sensor_msgs_msg_dds__JointState__desc.m_typename,
               "sensor_msgs::msg::dds_::JointState_");
  EXPECT_STREQ(tf2_msgs_msg_dds__TFMessage__desc.m_typename, "tf2_msgs::msg::dds_::TFMessage_");
  EXPECT_STREQ(nav_msgs_msg_dds__Odometry__desc.m_typename, "nav_msgs::msg::dds_::Odometry_");
  EXPECT_STREQ(std_msgs_msg_dds__String__desc.m_typename, "std_msgs::msg::dds_::String_");
  EXPECT_STREQ(std_msgs_msg_dds__Bool__desc.m_typename, "std_msgs::msg::dds_::Bool_");
  EXPECT_STREQ(rosgraph_msgs_msg_dds__Clock__desc.m_typename, "rosgraph_msgs::msg::dds_::Clock_");
  EXPECT_STREQ(diagnostic_msgs_msg_dds__DiagnosticArray__desc.m_typename,
               "diagnostic_msgs::msg::dds_::DiagnosticArray_");
  EXPECT_STREQ(geometry_msgs_msg_dds__WrenchStamped__desc.m_typename,
               "geometry_msgs::msg::dds_::WrenchStamped_");
  EXPECT_STREQ(geometry_msgs_msg_dds__Twist__desc.m_typename, "geometry_msgs::msg::dds_::Twist_");
  EXPECT_STREQ(geometry_msgs_msg_dds__TwistStamped__desc.m_typename,
               "geometry_msgs::msg::dds_::TwistStamped_");
}

}  // namespace
}  // namespace gaitd::ros2
