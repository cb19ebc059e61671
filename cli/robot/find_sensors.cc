// SPDX-License-Identifier: Apache-2.0
#include "cli/robot/find_sensors.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "cli/robot/arms.h"

namespace gaitd::porting {
namespace {

using dynamics::UrdfLink;

// Words of a name, cut at what is no letter: "l_ft_frame" has "ft", "shift" has not.
bool has_word(const std::string& name, std::initializer_list<const char*> words) {
  const std::string text = lower_case(name + " " + spaced(name));
  for (const char* word : words) {
    const std::string w = word;
    for (std::size_t at = text.find(w); at != std::string::npos; at = text.find(w, at + 1)) {
      const auto is_letter = [&](std::size_t i) {
        return i < text.size() && std::isalpha(text[i]);
      };
      if ((at == 0 || !is_letter(at - 1)) && !is_letter(at + w.size())) return true;
    }
  }
  return false;
}

// The link that a sensor of <gazebo> belongs to: of a joint its child.
std::string link_of(const Guess& guess, const std::string& reference) {
  if (guess.urdf.find_link(reference) != nullptr) return reference;
  for (const dynamics::UrdfJointNote& joint : guess.outline.joints) {
    if (joint.name == reference) return joint.child;
  }
  return "";
}

bool is_imu(const std::string& name) {
  return has_word(name, {"imu", "gyro", "gyrometer", "gyroscope", "ahrs", "vectornav",
                         "microstrain", "accelerometer", "xsens"});
}

bool is_force(const std::string& name) {
  return has_word(name, {"ft", "fts", "force", "wrench", "loadcell", "forcetorque"});
}

std::vector<bool> bodies_of_legs(const GaitdModel& model, const Guess& guess) {
  std::vector<bool> of_leg(static_cast<std::size_t>(model.body_count), false);
  for (const LegGuess& leg : guess.legs) {
    for (const int joint : leg.joints) of_leg[static_cast<std::size_t>(joint) + 1] = true;
  }
  return of_leg;
}

}  // namespace

FrameGuess find_imu(const Guess& guess) {
  const GaitdModel& model = guess.urdf.model;
  const std::vector<bool> of_leg = bodies_of_legs(model, guess);
  const UrdfLink* chest = guess.urdf.find_link(guess.chest);
  FrameGuess imu;
  imu.name = "imu";
  int best = 0;
  const auto consider = [&](const std::string& name, const std::string& from, int sure) {
    const UrdfLink* link = guess.urdf.find_link(name);
    if (link == nullptr || of_leg[static_cast<std::size_t>(link->body)]) return;
    const bool on_chest = chest != nullptr && link->body == chest->body;
    const int score = sure + (link->body == 0 ? 20 : on_chest ? 10 : 0);
    if (score <= best || (link->body != 0 && !on_chest)) return;
    best = score;
    imu.link = name;
    imu.why = {from, link->body == 0
                         ? "It is in the pelvis."
                         : "It is behind the joints of the waist; none is in the pelvis."};
  };
  for (const dynamics::UrdfSensor& sensor : guess.outline.sensors) {
    if (sensor.type != "imu") continue;
    consider(link_of(guess, sensor.reference),
             "The sensor " + sensor.name + " of type imu in the URDF.", 2);
  }
  for (const UrdfLink& link : guess.urdf.links) {
    if (is_imu(link.name)) consider(link.name, "Named like an IMU.", 1);
  }
  for (const dynamics::UrdfJointNote& joint : guess.outline.joints) {
    if (is_imu(joint.name)) consider(joint.child, "On a joint named like an IMU.", 1);
  }
  if (best > 0) return imu;
  imu.link = model.bodies[0].name;
  imu.X_LF = guess.options.X_LB();
  imu.why = {
      "The URDF names none in pelvis or chest: proposed at the origin of the pelvis. Say where "
      "it is."};
  return imu;
}

FrameGuess find_force_sensor(const Guess& guess, int side) {
  const SoleGuess& sole = guess.soles[static_cast<std::size_t>(side)];
  const int foot = guess.model.feet[side].body;
  FrameGuess sensor;
  const auto take = [&](const std::string& name, const std::string& from) {
    const UrdfLink* link = guess.urdf.find_link(name);
    if (link == nullptr || link->body != foot || !sensor.link.empty()) return;
    sensor.link = name;
    sensor.why = {from};
  };
  for (const dynamics::UrdfSensor& s : guess.outline.sensors) {
    if (has_word(s.type, {"force"})) {
      take(link_of(guess, s.reference), "The sensor " + s.name + " of the URDF.");
    }
  }
  for (const UrdfLink& link : guess.urdf.links) {
    if (is_force(link.name)) take(link.name, "Named like a force sensor.");
  }
  for (const dynamics::UrdfJointNote& joint : guess.outline.joints) {
    if (is_force(joint.name)) take(joint.child, "On a joint named like a force sensor.");
  }
  if (!sensor.link.empty()) return sensor;
  sensor.link = sole.frame.link;
  sensor.X_LF.linear() = sole.frame.X_LF.linear();
  sensor.why = {
      "None is named: proposed at the origin of the foot, z up. Say where it is, or take the "
      "line out if there is none."};
  return sensor;
}

std::string find_chest(const Guess& guess, Reasons* why) {
  const GaitdModel& model = guess.urdf.model;
  const std::vector<bool> of_leg = bodies_of_legs(model, guess);
  std::vector<double> above(static_cast<std::size_t>(model.body_count), 0.0);  // with what hangs on
  for (int i = model.body_count - 1; i > 0; --i) {
    above[static_cast<std::size_t>(i)] += model.bodies[i].mass;
    above[static_cast<std::size_t>(model.bodies[i].parent)] += above[static_cast<std::size_t>(i)];
  }
  const std::vector<double> arms = arms_begin(guess);
  int at = 0;
  double carried = 0.0;  // by `at`, without legs
  for (int i = 1; i < model.body_count; ++i) {
    if (model.bodies[i].parent == 0 && !of_leg[static_cast<std::size_t>(i)]) {
      carried += above[static_cast<std::size_t>(i)];
    }
  }
  for (;;) {
    int heaviest = -1;
    for (int i = 1; i < model.body_count; ++i) {
      const auto body = static_cast<std::size_t>(i);
      if (model.bodies[i].parent != at || of_leg[body]) continue;
      if (arms[body] != 0.0) continue;
      if (above[body] < 0.6 * carried) continue;
      if (heaviest < 0 || above[body] > above[static_cast<std::size_t>(heaviest)]) heaviest = i;
    }
    if (heaviest < 0) break;
    at = heaviest;
    carried = above[static_cast<std::size_t>(at)];
  }
  if (at == 0) {
    why->push_back("No joints lead from the pelvis to a chest.");
    return "";
  }
  why->push_back(format("Carries %.0f %% of the robot, with what hangs on it.",
                        100.0 * carried / model.total_mass));
  return model.bodies[at].name;
}

}  // namespace gaitd::porting
