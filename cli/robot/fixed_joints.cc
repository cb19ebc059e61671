// SPDX-License-Identifier: Apache-2.0
#include "cli/robot/fixed_joints.h"

#include <algorithm>
#include <initializer_list>
#include <map>
#include <set>

namespace gaitd::porting {
namespace {

bool moves(const dynamics::UrdfJointNote& joint) {
  return joint.type == "revolute" || joint.type == "continuous" || joint.type == "prismatic";
}

bool is_finger(const dynamics::UrdfJointNote& joint) {
  const std::string name = lower_case(joint.name + " " + joint.child);
  const auto holds = [&](std::initializer_list<const char*> words) {
    return std::any_of(words.begin(), words.end(),
                       [&](const char* word) { return name.find(word) != std::string::npos; });
  };
  return holds({"finger", "thumb", "gripper", "knuckle", "pinky", "pinkie", "phalan", "claw",
                "eyelid", "eyebrow", "jaw", "ffj", "mfj", "rfj", "lfj", "thj"}) ||
         (holds({"index", "middle", "ring", "little"}) &&
          holds({"hand", "proximal", "intermediate", "distal"}));
}

// Links that carry nothing, themselves or by what hangs on them.
std::set<std::string> weightless(const dynamics::UrdfOutline& outline) {
  std::map<std::string, std::string> parent;
  std::set<std::string> without;
  for (const dynamics::UrdfJointNote& joint : outline.joints) {
    parent[joint.child] = joint.parent;
    without.insert(joint.child);
  }
  for (std::string link : outline.links_with_mass) {
    while (without.erase(link) > 0) link = parent[link];
  }
  return without;
}

// A joint from the same link as one that mimics it is its mirror: one drive turns both hips of a
// NAO. With one of them fixed the legs would differ.
void fix_mirrors(const dynamics::UrdfOutline& outline, std::vector<FixedGuess>* fixed) {
  for (const dynamics::UrdfJointNote& joint : outline.joints) {
    if (!joint.mimic || !moves(joint) || is_finger(joint)) continue;
    for (const dynamics::UrdfJointNote& mirror : outline.joints) {
      const bool same = mirror.name == joint.mimicked && mirror.parent == joint.parent &&
                        mirror.type == joint.type && !mirror.mimic && moves(mirror);
      const bool there = std::ranges::any_of(
          *fixed, [&](const FixedGuess& one) { return one.joint == mirror.name; });
      if (same && !there) fixed->push_back({mirror.name, joint.name + " mimics it"});
    }
  }
}

}  // namespace

std::vector<FixedGuess> joints_to_fix(const dynamics::UrdfOutline& outline) {
  const std::set<std::string> without_mass = weightless(outline);
  std::vector<FixedGuess> fixed;
  for (const dynamics::UrdfJointNote& joint : outline.joints) {
    if (joint.type == "planar") fixed.push_back({joint.name, "planar"});
    if (!moves(joint)) continue;
    if (joint.mimic) {
      fixed.push_back({joint.name, "mimics another joint"});
    } else if (is_finger(joint)) {
      fixed.push_back({joint.name, "named like a finger or a part of the face"});
    } else if (without_mass.count(joint.child) > 0) {
      fixed.push_back({joint.name, "nothing that it moves has a mass"});
    } else if (!joint.has_effort) {
      fixed.push_back(
          {joint.name, "the URDF gives no effort or no velocity of its drive", !joint.broken});
    } else if (!joint.has_range) {
      fixed.push_back({joint.name, "the URDF gives no range or no axis", !joint.broken});
    }
  }
  fix_mirrors(outline, &fixed);
  return fixed;
}

std::string joints_without_limits(const dynamics::UrdfOutline& outline) {
  std::string names;
  for (const dynamics::UrdfJointNote& joint : outline.joints) {
    if (!moves(joint) || joint.mimic || is_finger(joint)) continue;
    if (joint.has_effort && joint.has_range) continue;
    names += (names.empty() ? "" : ", ") + joint.name;
    if (names.size() > 200) return names + "...";
  }
  return names;
}

}  // namespace gaitd::porting
