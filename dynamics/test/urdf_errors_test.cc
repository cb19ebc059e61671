// SPDX-License-Identifier: Apache-2.0
// Every bad file is refused with its place and its reason, all of them at once.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "gaitd/dynamics/urdf.h"
#include "gaitd/sdk/bounds.h"

namespace gaitd::dynamics {
namespace {

const char kInertial[] = "<inertial><mass value='2'/><inertia ixx='1' iyy='1' izz='1'/></inertial>";
const char kBareLimit[] = "<limit lower='-1' upper='1' velocity='1' effort='1'/>";

std::string bare_link(const std::string& name, const std::string& inside = kInertial) {
  return "<link name='" + name + "'>" + inside + "</link>\n";
}

std::string bare_joint(const std::string& name, const std::string& parent, const std::string& child,
                       const std::string& inside = kBareLimit,
                       const std::string& type = "revolute") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/>" + inside + "</joint>\n";
}

std::vector<std::string> errors_of(const std::string& inside) {
  return load_urdf_text("<robot name='r'>\n" + inside + "</robot>", "bad.urdf").errors;
}

// Exactly one error; it starts with the place and holds all of `parts`.
void expect_one(const std::vector<std::string>& errors, const std::string& place,
                const std::vector<std::string>& parts) {
  ASSERT_EQ(errors.size(), 1u) << (errors.empty() ? "no error" : errors[0] + "\n" + errors[1]);
  EXPECT_EQ(errors[0].rfind(place, 0), 0u) << errors[0];
  for (const std::string& part : parts) {
    EXPECT_NE(errors[0].find(part), std::string::npos) << errors[0] << "\nlacks: " << part;
  }
}

void expect_joint_error(const std::string& inside, const std::string& type,
                        const std::vector<std::string>& parts) {
  expect_one(errors_of(bare_link("a") + bare_link("b") + bare_joint("j", "a", "b", inside, type)),
             "bad.urdf:4: ", parts);
}

void expect_link_error(const std::string& inside, const std::vector<std::string>& parts) {
  expect_one(errors_of(bare_link("a") + bare_link("b", inside) + bare_joint("j", "a", "b")),
             "bad.urdf:3: ", parts);
}

TEST(UrdfErrors, NoFile) {
  expect_one(load_urdf("/no/such/robot.urdf").errors,
             "/no/such/robot.urdf: ", {"cannot be read", "No such file", "give its path"});
  expect_one(load_urdf("/").errors, "/: ", {"cannot be read", "not a file"});
  expect_one(load_urdf("/dev/zero").errors, "/dev/zero: ", {"cannot be read", "not a file"});
}

TEST(UrdfErrors, FileTooLarge) {
  const std::string file = testing::TempDir() + "gaitd_large.urdf";
  std::ofstream(file) << "<robot name='r'>";
  std::filesystem::resize_file(file, bounds::kUrdfBytes + 1);  // a hole: nothing is written
  expect_one(load_urdf(file).errors, file + ": ", {"has 4194305 bytes, 4194304 at most"});
  std::filesystem::remove(file);
}

// TinyXML calls itself for each level and overflows its stack at some 40,000.
TEST(UrdfErrors, NestedTooDeep) {
  const auto nested = [](int depth, const std::string& open, const std::string& close) {
    std::string inside = bare_link("a");
    for (int i = 0; i < depth; ++i) inside += open;
    for (int i = 0; i < depth; ++i) inside += close;
    return inside;
  };
  EXPECT_TRUE(errors_of(nested(99, "<x>", "</x>")).empty());
  EXPECT_TRUE(errors_of(nested(1000, "<x y='>'/>", "")).empty());
  EXPECT_TRUE(errors_of(nested(1000, "<!-- <x> -->", "")).empty());
  EXPECT_TRUE(errors_of(nested(1000, "<gazebo><![CDATA[<x>]]></gazebo>", "")).empty());
  expect_one(errors_of(nested(200000, "<x>", "")), "bad.urdf:3: ", {"more than 100 deep"});
  expect_one(errors_of(nested(1000, "<x y='/>'>\n", "")), "bad.urdf:102: ", {"more than 100 deep"});
  expect_one(errors_of(nested(1000, "<x y=\"</x>\">", "")), "bad.urdf:3: ", {"100 deep"});
  expect_one(errors_of(nested(1000, "<!x><x>", "")), "bad.urdf:3: ", {"100 deep"});
  // Ends of what never began count for nothing.
  std::string ends;
  for (int i = 0; i < 60000; ++i) ends += "</>";
  expect_one(load_urdf_text(ends + nested(60000, "<a>", ""), "bad.urdf").errors, "bad.urdf",
             {"100 deep"});
}

// TinyXML compares the attributes of an element pairwise: 400,000 of them took hours.
TEST(UrdfErrors, TooManyAttributes) {
  const auto with = [](int count) {
    std::string attributes;
    for (int i = 0; i < count; ++i) attributes += " a" + std::to_string(i) + "='='";
    return bare_link("a") + "<x" + attributes + "/>";
  };
  EXPECT_TRUE(errors_of(with(100)).empty());
  expect_one(errors_of(with(400000)), "bad.urdf:3: ", {"more than 100 attributes"});
}

TEST(UrdfErrors, EntitiesAreNotExpanded) {
  std::string head = "<?xml version='1.0'?>\n<!DOCTYPE robot [\n<!ENTITY a 'aaaaaaaaaa'>\n";
  for (char c = 'b'; c <= 'z'; ++c) {
    const std::string before = std::string("&") + static_cast<char>(c - 1) + ";";
    head += std::string("<!ENTITY ") + c + " '";
    for (int i = 0; i < 10; ++i) head += before;
    head += "'>\n";
  }
  const UrdfResult bomb =
      load_urdf_text(head + "]>\n<robot name='r'>" + bare_link("&z;") + "</robot>", "bad.urdf");
  ASSERT_FALSE(bomb.links.empty() && bomb.errors.empty());
  for (const UrdfLink& link : bomb.links) EXPECT_LT(link.name.size(), 10u);
}

// Visuals are nothing that the dynamics need.
TEST(UrdfErrors, MissingMeshesAreNoError) {
  const std::string mesh =
      "<visual><geometry><mesh filename='package://no/such.dae'/></geometry></visual>"
      "<collision><geometry><mesh filename='/no/such.stl' scale='x'/></geometry></collision>";
  EXPECT_TRUE(errors_of(bare_link("a", std::string(kInertial) + mesh)).empty());
}

TEST(UrdfErrors, NotAUrdf) {
  expect_one(load_urdf_text("", "bad.urdf").errors, "bad.urdf", {"expected"});
  expect_one(load_urdf_text("<robot name='r'>\n<link name='a'>\n</robot>", "bad.urdf").errors,
             "bad.urdf:", {"not well-formed XML"});
  expect_one(load_urdf_text("<sdf/>", "bad.urdf").errors,
             "bad.urdf:1: ", {"<sdf>", "expected <robot>"});
  expect_one(load_urdf_text("just text", "bad.urdf").errors, "bad.urdf", {"expected"});
  expect_one(errors_of(""), "bad.urdf:1: ", {"no <link>"});
  expect_one(errors_of(bare_link("a") + "<xacro:macro name='x'/>"), "bad.urdf:3: ", {"xacro"});
  // One error, and not one for each thing that it leaves open.
  expect_one(errors_of("<xacro:macro name='x'/><joint name='${n}'/><xacro:x/>"),
             "bad.urdf:2: ", {"xacro"});
}

TEST(UrdfErrors, MovingBodyWithoutMass) {
  expect_link_error("", {"'b' moves but has no mass", "<inertial>", "fixed"});
  expect_one(errors_of("<link name='a'/>"), "bad.urdf:2: ", {"'a' moves but has no mass"});
}

TEST(UrdfErrors, WrongMass) {
  const std::string inertia = "<inertia ixx='1' iyy='1' izz='1'/></inertial>";
  expect_link_error("<inertial><mass value='two'/>" + inertia,
                    {"'b'", "mass [two]", "not a float"});
  expect_link_error("<inertial><mass value='-2'/>" + inertia, {"mass is -2 kg", "above 0"});
  expect_link_error("<inertial><mass value='0'/>" + inertia, {"moves but has no mass"});
  expect_link_error("<inertial><mass value='nan'/>" + inertia,
                    {"'b'", "mass [nan]", "not a float"});
  expect_link_error("<inertial><mass value='1e999'/>" + inertia,
                    {"'b'", "mass [1e999]", "not a float"});
  expect_link_error("<inertial><mass/>" + inertia, {"'b'", "<mass>", "must have value"});
  expect_link_error("<inertial>" + inertia, {"has no <mass>"});
}

TEST(UrdfErrors, NonPhysicalInertia) {
  const auto inertial = [](const std::string& inertia) {
    return "<inertial><mass value='1'/><inertia " + inertia + "/></inertial>";
  };
  expect_link_error(inertial("ixx='1' iyy='1' izz='-1'"), {"'b'", "not positive definite"});
  expect_link_error(inertial("ixx='1' iyy='1' izz='1' ixy='2'"), {"not positive definite"});
  expect_link_error(inertial("ixx='1' iyy='1' izz='3'"),
                    {"1, 1, 3", "sum of the two others", "nearest_inertias"});
  expect_link_error(inertial("ixx='1' iyy='1'"), {"'b'", "<inertia>", "missing izz"});
}

TEST(UrdfErrors, Loops) {
  expect_one(errors_of(bare_link("a") + bare_link("b") + bare_joint("j", "a", "b") +
                       bare_joint("k", "b", "a")),
             "bad.urdf:", {"loop", "'a'", "'b'", "remove one"});
  expect_one(errors_of(bare_link("r") + bare_link("a") + bare_link("b") +
                       bare_joint("j", "a", "b") + bare_joint("k", "b", "a")),
             "bad.urdf:", {"loop"});
  expect_one(errors_of(bare_link("a") + bare_link("b") + bare_joint("j", "a", "b") +
                       bare_joint("k", "b", "b")),
             "bad.urdf:5: ", {"'b' has two parents", "'j'", "'k'"});
  expect_one(
      errors_of(bare_link("a") + bare_link("b") + bare_link("c") + bare_joint("j", "a", "b") +
                bare_joint("k", "a", "c") + bare_joint("l", "b", "c")),
      "bad.urdf:7: ", {"'c' has two parents", "open the loop"});
}

TEST(UrdfErrors, SeveralRoots) {
  expect_one(
      errors_of(bare_link("a") + bare_link("b") + bare_link("c") + bare_joint("j", "a", "b")),
      "bad.urdf:4: ", {"2 roots ('a', 'c')", "expected one"});
}

TEST(UrdfErrors, TooManyJoints) {
  const auto link_name = [](int i) { return std::string("l").append(std::to_string(i)); };
  std::string inside = bare_link("l0");
  for (int i = 1; i <= GAITD_MAX_JOINTS; ++i) {
    const std::string child = link_name(i);
    inside += bare_link(child) + bare_joint(child, link_name(i - 1), child);
  }
  EXPECT_TRUE(errors_of(inside).empty());
  expect_one(errors_of(inside + bare_link("more") + bare_joint("j", "l0", "more")),
             "bad.urdf:129: ", {"65 moving joints", "64 at most", "fixed"});
}

TEST(UrdfErrors, Names) {
  const std::string longest(GAITD_NAME_SIZE - 1, 'x');
  EXPECT_TRUE(errors_of(bare_link(longest)).empty());
  expect_one(errors_of(bare_link(longest + "x")), "bad.urdf:2: ", {"48 characters", "47 at most"});
  // A frame that is merged has a name in the file only.
  EXPECT_TRUE(errors_of(bare_link("a") + bare_link(longest + "x", "") +
                        bare_joint(longest + "y", "a", longest + "x", "", "fixed"))
                  .empty());
  expect_one(errors_of(bare_link("")), "bad.urdf:2: ", {"'name'", "missing"});
  expect_one(errors_of(bare_link("a") + bare_link("a")), "bad.urdf:3: ", {"twice", "line 2"});
  expect_one(errors_of(bare_link("a") + bare_link("b") + bare_link("c") +
                       bare_joint("j", "a", "b") + bare_joint("j", "a", "c")),
             "bad.urdf:6: ", {"joint 'j' is there twice", "line 5"});
  expect_one(load_urdf_text("<robot>" + bare_link("a") + "</robot>").errors,
             "<text>:1: ", {"robot", "'name'"});
}

TEST(UrdfErrors, UnknownLinks) {
  expect_one(errors_of(bare_link("a") + bare_link("b") + bare_joint("j", "a", "c")),
             "bad.urdf:4: ", {"child link 'c' does not exist"});
  expect_one(errors_of(bare_link("a") + bare_link("b") + bare_joint("j", "c", "b")),
             "bad.urdf:4: ", {"parent link 'c' does not exist"});
  expect_one(errors_of(bare_link("a") + "<joint name='j' type='fixed'><child link='a'/></joint>"),
             "bad.urdf:3: ", {"no <parent>"});
}

TEST(UrdfErrors, Limits) {
  expect_joint_error("", "revolute", {"'j'", "no <limit>", "lower, upper, velocity and effort"});
  expect_joint_error("", "continuous", {"no <limit>", "velocity and effort"});
  expect_joint_error("<limit lower='-1' upper='1' effort='1'/>", "revolute",
                     {"'j'", "velocity limit is 0", "above 0"});
  expect_joint_error("<limit lower='-1' upper='1' effort='1' velocity='0'/>", "revolute",
                     {"velocity limit is 0", "above 0"});
  expect_joint_error("<limit lower='-1' upper='1' effort='0' velocity='1'/>", "prismatic",
                     {"effort limit is 0", "above 0"});
  expect_joint_error("<limit effort='1' velocity='1'/>", "revolute", {"lower < upper"});
  expect_joint_error("<limit lower='1' upper='-1' effort='1' velocity='1'/>", "revolute",
                     {"lower 1, upper -1", "lower < upper"});
  expect_joint_error("<limit lower='-inf' upper='1' effort='1' velocity='1'/>", "revolute",
                     {"'j'", "<limit>", "-inf"});
  expect_joint_error("<limit lower='-1' upper='1' effort='nan' velocity='1'/>", "revolute",
                     {"'j'", "<limit>", "nan"});
  expect_joint_error("<limit lower='x' upper='1' effort='1' velocity='1'/>", "revolute",
                     {"'j'", "<limit>", "lower value (x)"});
}

TEST(UrdfErrors, JointFigures) {
  const std::string limit = kBareLimit;
  expect_joint_error(limit + "<axis xyz='0 0 0'/>", "revolute", {"axis is zero"});
  expect_joint_error(limit + "<axis xyz='0 1'/>", "revolute",
                     {"'j'", "<axis>", "[0 1]", "3 expected"});
  expect_joint_error(limit + "<axis xyz='1-2-3'/>", "revolute", {"'j'", "<axis>", "[1-2-3]"});
  expect_joint_error(limit + "<axis xyz='0 1 0 0'/>", "revolute",
                     {"'j'", "<axis>", "[0 1 0 0]", "3 expected"});
  expect_joint_error(limit + "<origin xyz='0,1,2'/>", "revolute", {"'j'", "<origin>", "[0,1,2]"});
  expect_joint_error(limit + "<dynamics damping='-1'/>", "revolute", {"damping", "0 or above"});
}

// urdfdom would use some of these as format strings.
TEST(UrdfErrors, PercentSigns) {
  const std::string limit = kBareLimit;
  expect_joint_error(limit + "<origin xyz='%s%s%s%s%s%s 0 0'/>", "revolute", {"<origin>", "'%'"});
  expect_joint_error(limit + "<axis xyz='%n 0 0'/>", "revolute", {"<axis>", "'%'"});
  expect_joint_error(limit + "<dynamics damping='&#37;n'/>", "revolute", {"<dynamics>", "'%'"});
  expect_link_error("<inertial><mass value='%n%s'/><inertia ixx='1' iyy='1' izz='1'/></inertial>",
                    {"<mass>", "'%'"});
  EXPECT_TRUE(errors_of(bare_link("%s%n")).empty());
}

TEST(UrdfErrors, EachInItsLine) {
  const std::vector<std::string> errors = errors_of(
      "<link name='a'>\n<inertial>\n<origin xyz='0'/>\n<mass value='x'/>\n<inertia ixx='y'/>\n"
      "</inertial>\n</link>\n" +
      bare_link("b") +
      "<joint name='j' type='revolute'>\n<parent link='a'/>\n<child link='b'/>\n"
      "<origin xyz='0,1,2'/>\n<axis xyz='0 0 0'/>\n<limit lower='z'/>\n<dynamics damping='-1'/>\n"
      "</joint>\n");
  std::string places;
  for (const std::string& error : errors) places += error.substr(9, error.find(": ") - 9) + " ";
  EXPECT_EQ(places, "4 5 6 13 15 14 16 ");
}

TEST(UrdfErrors, JointTypes) {
  expect_joint_error(kBareLimit, "floating", {"'j'", "'floating'", "expected revolute"});
  expect_joint_error(kBareLimit, "planar", {"'planar'"});
  expect_joint_error(kBareLimit, "hinge", {"'hinge'"});
}

TEST(UrdfErrors, RootLink) {
  const std::string text = "<robot name='r'>\n" + bare_link("a") + bare_link("b") +
                           bare_joint("j", "a", "b") + "</robot>";
  UrdfOptions options;
  options.root_link = "c";
  expect_one(load_urdf_text(text, "bad.urdf", options).errors,
             "bad.urdf: ", {"'c' does not exist"});
}

TEST(UrdfErrors, RootLinkAboveTheRobotOrInALoop) {
  UrdfOptions options;
  options.root_link = "world";
  expect_one(load_urdf_text("<robot name='r'>\n" + bare_link("world", "") + bare_link("a") +
                                bare_joint("free", "world", "a", "", "floating") + "</robot>",
                            "bad.urdf", options)
                 .errors,
             "bad.urdf:2: ", {"'world' is the empty one", "expected 'a'"});
  options.root_link = "b";
  expect_one(load_urdf_text("<robot name='r'>\n" + bare_link("a") + bare_link("b") +
                                bare_joint("j", "b", "b", "", "fixed") + "</robot>",
                            "bad.urdf", options)
                 .errors,
             "bad.urdf:3: ", {"loop", "'b'"});
}

TEST(UrdfErrors, AllAtOnce) {
  const std::vector<std::string> errors =
      errors_of(bare_link("a", "") + bare_link("b", "<inertial><mass value='x'/></inertial>") +
                bare_link("c") + bare_joint("j", "a", "b", "") +
                bare_joint("k", "b", "c", kBareLimit, "planar"));
  std::string text;
  for (const std::string& error : errors) text += error + "\n";
  for (const char* part : {"'a' moves but has no mass", "<mass>", "has no <limit>", "'planar'"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " not in:\n" << text;
  }
}

}  // namespace
}  // namespace gaitd::dynamics
