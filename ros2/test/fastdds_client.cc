// SPDX-License-Identifier: Apache-2.0
// Looks at gaitd-ros2 as a node of ROS 2 on Fast DDS would: names, types, qualities of service,
// values; then walks the robot by /cmd_vel and stops it by /e_stop. DOMAIN NAMESPACE ["silent"]:
// with a gaitd that answers nothing, it is only told to stop.
#include <Eigen/Geometry>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <thread>

#include "ros_node.h"

namespace {

using ros_node::Node;
using ros_node::Subscription;
using namespace ros_types;  // NOLINT(google-build-using-namespace): of this test
using Steady = std::chrono::steady_clock;
using std::chrono::milliseconds;

[[noreturn]] void fail(const std::string& text) { throw std::runtime_error(text); }
void check(bool good, const std::string& text) {
  if (!good) fail(text);
}

void wait_until(const std::function<bool()>& condition, double seconds, const std::string& what) {
  const auto end = Steady::now() + std::chrono::duration<double>(seconds);
  while (!condition()) {
    if (Steady::now() > end) fail("not within " + std::to_string(seconds) + " s: " + what);
    std::this_thread::sleep_for(milliseconds(20));
  }
}

struct Expected {
  std::string topic, type;
  bool transient_local = false;
};

// As `ros2 topic info -v` and its middlewares have them.
void check_names(const Node& node, const std::string& ns) {
  const Expected published[] = {
      {"rt" + ns + "/joint_states", "sensor_msgs::msg::dds_::JointState_"},
      {"rt/tf", "tf2_msgs::msg::dds_::TFMessage_"},
      {"rt/tf_static", "tf2_msgs::msg::dds_::TFMessage_", true},
      {"rt" + ns + "/odom", "nav_msgs::msg::dds_::Odometry_"},
      {"rt" + ns + "/robot_description", "std_msgs::msg::dds_::String_", true},
      {"rt/diagnostics", "diagnostic_msgs::msg::dds_::DiagnosticArray_"},
      {"rt" + ns + "/foot/left/wrench", "geometry_msgs::msg::dds_::WrenchStamped_"},
      {"rt" + ns + "/foot/right/wrench", "geometry_msgs::msg::dds_::WrenchStamped_"}};
  const Expected taken[] = {{"rt" + ns + "/cmd_vel", "geometry_msgs::msg::dds_::Twist_"},
                            {"rt" + ns + "/e_stop", "std_msgs::msg::dds_::Bool_"}};
  const auto all = [&] {
    for (const Expected& one : published) {
      if (!node.publishers().contains(one.topic)) return false;
    }
    for (const Expected& one : taken) {
      if (!node.subscribers().contains(one.topic)) return false;
    }
    return true;
  };
  wait_until(all, 20.0, "every topic of gaitd-ros2");
  for (const Expected& one : published) {
    const auto found = node.publishers().at(one.topic);
    check(found.type == one.type, one.topic + " is " + found.type);
    check(found.reliable, one.topic + " is not reliable");
    check(found.transient_local == one.transient_local, one.topic + ": wrong durability");
  }
  for (const Expected& one : taken) {
    const auto found = node.subscribers().at(one.topic);
    check(found.type == one.type, one.topic + " is " + found.type);
  }
  std::printf("names and types of %zu topics are those of ROS 2\n",
              std::size(published) + std::size(taken));
}

// The frames of two messages put together: each has one parent, up to odom.
class Tree {
 public:
  explicit Tree(const TFMessage& moving, const TFMessage& fixed) {
    for (const TFMessage* message : {&moving, &fixed}) {
      for (const TransformStamped& one : message->transforms) {
        check(!parents_.contains(one.child_frame_id), one.child_frame_id + " has two parents");
        const Eigen::Quaterniond R(one.rotation.w, one.rotation.x, one.rotation.y, one.rotation.z);
        check(std::abs(R.norm() - 1.0) < 1e-6, one.child_frame_id + ": no unit quaternion");
        Eigen::Isometry3d X(R);
        X.translation() = Eigen::Vector3d(one.translation.x, one.translation.y, one.translation.z);
        parents_[one.child_frame_id] = {one.header.frame_id, X};
      }
    }
  }
  std::size_t size() const { return parents_.size(); }
  Eigen::Isometry3d in_odom(const std::string& frame) const {
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    std::string name = frame;
    for (std::size_t i = 0; i <= parents_.size(); ++i) {
      if (name == "odom") return X;
      const auto found = parents_.find(name);
      check(found != parents_.end(), frame + " hangs on " + name + ", which has no parent");
      X = found->second.second * X;
      name = found->second.first;
    }
    fail(frame + ": a circle of frames");
  }
  void check_all() const {
    for (const auto& [name, parent] : parents_) in_odom(name);
  }

 private:
  std::map<std::string, std::pair<std::string, Eigen::Isometry3d>> parents_;
};

class Client {
 public:
  Client(unsigned domain, const std::string& ns)
      : node_(domain),
        names_checked_((check_names(node_, ns), true)),
        joints_(&node_, "rt" + ns + "/joint_states"),
        odometry_(&node_, "rt" + ns + "/odom"),
        tf_(&node_, "rt/tf"),
        tf_static_(&node_, "rt/tf_static", true),
        description_(&node_, "rt" + ns + "/robot_description", true),
        diagnostics_(&node_, "rt/diagnostics"),
        left_(&node_, "rt" + ns + "/foot/left/wrench"),
        right_(&node_, "rt" + ns + "/foot/right/wrench"),
        velocity_(node_.advertise<Twist>("rt" + ns + "/cmd_vel")),
        estop_(node_.advertise<Bool>("rt" + ns + "/e_stop")) {}

  void check_values();
  void walk();
  void stop();
  void stop_silent();

 private:
  double x() const { return odometry_.newest().position.x; }
  bool told(const std::string& name, int level, const std::string& text) const {
    for (const DiagnosticStatus& status : diagnostics_.newest().status) {
      if (status.name == name && status.level == level &&
          status.message.find(text) != std::string::npos) {
        return true;
      }
    }
    return false;
  }
  void send(double forward, double seconds) {
    Twist twist;
    twist.linear.x = forward;
    for (const auto end = Steady::now() + std::chrono::duration<double>(seconds);
         Steady::now() < end;) {
      velocity_->write(&twist);
      std::this_thread::sleep_for(milliseconds(50));
    }
  }

  Node node_;
  bool names_checked_;
  Subscription<JointState> joints_;
  Subscription<Odometry> odometry_;
  Subscription<TFMessage> tf_, tf_static_;
  Subscription<String> description_;
  Subscription<DiagnosticArray> diagnostics_;
  Subscription<WrenchStamped> left_, right_;
  ros_node::dds::DataWriter* velocity_;
  ros_node::dds::DataWriter* estop_;
};

void Client::check_values() {
  wait_until(
      [&] {
        return joints_.count() > 0 && odometry_.count() > 0 && tf_.count() > 0 &&
               tf_static_.count() > 0 && description_.count() > 0 && diagnostics_.count() > 0 &&
               left_.count() > 0 && right_.count() > 0;
      },
      20.0, "a message on every topic");
  wait_until([&] { return told("gaitd: robot", 0, "standing"); }, 20.0, "a robot that stands");
  const int before = joints_.count();
  std::this_thread::sleep_for(std::chrono::seconds(1));
  const int rate = joints_.count() - before;
  check(rate >= 20 && rate <= 130, "joint states come " + std::to_string(rate) + " times a second");

  const JointState joints = joints_.newest();
  check(joints.name.size() >= 30, "only " + std::to_string(joints.name.size()) + " joints");
  check(std::set<std::string>(joints.name.begin(), joints.name.end()).size() == joints.name.size(),
        "a joint is there twice");
  check(joints.position.size() == joints.name.size() &&
            joints.velocity.size() == joints.name.size() &&
            joints.effort.size() == joints.name.size(),
        "not as many values as joints");
  for (std::size_t i = 0; i < joints.name.size(); ++i) {
    check(std::isfinite(joints.position[i]) && std::abs(joints.position[i]) < 7.0 &&
              std::isfinite(joints.velocity[i]) && std::isfinite(joints.effort[i]),
          joints.name[i] + " has no sensible values");
  }
  const auto wall = std::chrono::duration_cast<std::chrono::seconds>(
                        std::chrono::system_clock::now().time_since_epoch())
                        .count();
  check(std::abs(static_cast<double>(wall - joints.header.stamp.sec)) <= 5.0,
        "the stamp is not of now");

  const Tree tree(tf_.newest(), tf_static_.newest());
  tree.check_all();
  check(tree.size() >= 33, "only " + std::to_string(tree.size()) + " frames");
  const Odometry odometry = odometry_.newest();
  check(odometry.header.frame_id == "odom" && odometry.child_frame_id == "pelvis",
        "odometry of " + odometry.child_frame_id + " in " + odometry.header.frame_id);
  const Eigen::Vector3d pelvis = tree.in_odom("pelvis").translation();
  check((pelvis - Eigen::Vector3d(odometry.position.x, odometry.position.y, odometry.position.z))
                .norm() < 0.01,
        "odometry and transforms differ");
  for (const char* sole : {"left_sole", "right_sole"}) {
    const double height = tree.in_odom(sole).translation().z();
    check(std::abs(height) < 0.02, std::string(sole) + " is at " + std::to_string(height) + " m");
  }
  const double load = left_.newest().force.z + right_.newest().force.z;
  check(std::abs(load - 175.118 * 9.81) < 350.0, "the feet bear " + std::to_string(load) + " N");
  check(left_.newest().header.frame_id == "left_sole", "the wrench has another frame");
  check(description_.newest().data.find("<robot") != std::string::npos, "no URDF");
  check(told("gaitd: connection", 0, "connected"), "no connection in the diagnostics");
  std::printf("%d messages a second, %zu joints, %zu frames, %.0f N on the feet\n", rate,
              joints.name.size(), tree.size(), load);
}

void Client::walk() {
  const double start = x();
  send(std::numeric_limits<double>::quiet_NaN(), 1.5);
  check(std::abs(x() - start) < 0.05, "NaN made the robot walk");
  wait_until([&] { return told("gaitd: cmd_vel", 1, "no finite number"); }, 3.0,
             "a warning of the NaN");
  const auto begin = Steady::now();
  while (x() - start < 0.4) {
    check(Steady::now() - begin < std::chrono::seconds(25),
          "only " + std::to_string(x() - start) + " m after 25 s of cmd_vel");
    send(0.3, 0.2);
  }
  const std::chrono::duration<double> took = Steady::now() - begin;
  check(told("gaitd: robot", 0, "walking"), "the diagnostics do not say that it walks");
  const auto silent = Steady::now();
  // In the time of the robot this is five seconds at most.
  wait_until([&] { return told("gaitd: robot", 0, "standing"); }, 15.0,
             "a stand after the last velocity");
  const std::chrono::duration<double> to_stand = Steady::now() - silent;
  const double stood = x();
  std::this_thread::sleep_for(std::chrono::seconds(1));
  check(std::abs(x() - stood) < 0.03, "it moves on after the stop");
  std::printf("walked 0.4 m in %.1f s, stood %.1f s after the last velocity, at %.2f m\n",
              took.count(), to_stand.count(), x() - start);
}

void Client::stop() {
  Bool message;
  estop_->write(&message);  // false asks for nothing
  std::this_thread::sleep_for(milliseconds(500));
  check(!told("gaitd: robot", 2, ""), "false on /e_stop made a fault");
  message.data = true;
  estop_->write(&message);
  wait_until([&] { return told("gaitd: robot", 2, "estop"); }, 5.0, "the fault of the e-stop");
  std::printf("the e-stop is a fault of gaitd\n");
}

void Client::stop_silent() {
  Bool message;
  message.data = true;
  const auto asked = [&] {
    estop_->write(&message);  // the first ones may come before they are listened to
    return told("gaitd: connection", 2, "gaitd does not answer");
  };
  wait_until(asked, 15.0, "word of an e-stop that nobody answers");
  std::printf("an e-stop that nobody answers is an error\n");
}

}  // namespace

int main(int argc, char** argv) {
  setvbuf(stdout, nullptr, _IOLBF, 0);
  try {
    Client client(static_cast<unsigned>(std::stoi(argv[1])), argc > 2 ? argv[2] : "");
    if (argc > 3) {
      client.stop_silent();
      return 0;
    }
    client.check_values();
    client.walk();
    client.stop();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "FAILED: %s\n", error.what());
    return 1;
  }
  return 0;
}
