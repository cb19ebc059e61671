// SPDX-License-Identifier: Apache-2.0
#include "cli/robot/find_legs.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace gaitd::porting {
namespace {

using Eigen::Vector3d;
using Poses = std::vector<Eigen::Isometry3d>;

constexpr int kLegJoints = 6;
constexpr int kFewestLegJoints = 5;  // without one that rolls the foot
constexpr int kMostLegJoints = 12;
constexpr double kSymmetric = 0.2;   // of the distances between the two chains
constexpr double kPitches = 0.6;     // part of an axis along y
constexpr double kSameAxis = 0.035;  // rad
constexpr double kParallel = 0.99;   // cosine

std::vector<int> chain_to(const GaitdModel& model, int body) {
  std::vector<int> joints;
  for (; body > 0; body = model.bodies[body].parent) joints.push_back(model.bodies[body].joint);
  std::reverse(joints.begin(), joints.end());
  return joints;
}

double mass_of(const GaitdModel& model, const std::vector<int>& joints) {
  double mass = 0.0;
  for (const int joint : joints) mass += model.bodies[joint + 1].mass;
  return mass;
}

double length_of(const Poses& poses, const std::vector<int>& joints) {
  return (poses[joints.back() + 1].translation() - poses[joints.front() + 1].translation()).norm();
}

bool holds_any(const std::string& text, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(),
                     [&](const char* word) { return text.find(word) != std::string::npos; });
}

double name_hint(const GaitdModel& model, const std::vector<int>& joints) {
  double hint = 0.0;
  for (const int joint : joints) {
    const std::string name =
        lower_case(std::string(model.joints[joint].name) + " " + model.bodies[joint + 1].name);
    if (holds_any(name, {"leg", "hip", "knee", "ankle", "foot", "thigh", "shank"})) hint += 1.0;
    if (holds_any(name, {"arm", "shoulder", "elbow", "wrist", "hand"})) hint -= 1.0;
  }
  return hint / static_cast<double>(joints.size());
}

// From a joint of one leg to its mirror. Where along its axis a joint has its origin is up to
// whoever drew it, unless the axis lies along `line`.
Vector3d apart(const GaitdModel& model, const Poses& poses, int a, int b, const Vector3d& line) {
  const Vector3d d = poses[a + 1].translation() - poses[b + 1].translation();
  const Vector3d axis = joint_axis(model, poses, a);
  const bool parallel = std::abs(axis.dot(joint_axis(model, poses, b))) > kParallel;
  return !parallel || std::abs(axis.dot(line)) > kPitches ? d : Vector3d(d - axis * axis.dot(d));
}

// From one chain to its mirror, of length 1; zero if they are at the same place.
Vector3d line_between(const GaitdModel& model, const Poses& poses, const std::vector<int>& a,
                      const std::vector<int>& b) {
  Vector3d raw = Vector3d::Zero();
  for (std::size_t i = 0; i < a.size(); ++i) {
    raw += poses[a[i] + 1].translation() - poses[b[i] + 1].translation();
  }
  if (raw.norm() < 1e-3) return Vector3d::Zero();
  raw.normalize();
  Vector3d line = Vector3d::Zero();
  for (std::size_t i = 0; i < a.size(); ++i) line += apart(model, poses, a[i], b[i], raw);
  return line.norm() < 1e-3 ? raw : Vector3d(line.normalized());
}

// 0 for mirror images: what of the distances from one chain to the other is not along one line.
double asymmetry(const GaitdModel& model, const Poses& poses, const std::vector<int>& a,
                 const std::vector<int>& b) {
  const Vector3d line = line_between(model, poses, a, b);
  if (line.isZero(0.0)) return 1.0;
  double along = 0.0;
  double across = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vector3d d = apart(model, poses, a[i], b[i], line);
    along += std::abs(d.dot(line));
    across += (d - line * d.dot(line)).norm();
  }
  return along > 0.0 ? across / along : 1.0;
}

std::string side_of(const GaitdModel& model, const std::vector<int>& joints) {
  int votes = 0;
  for (const int joint : joints) {
    const std::string name = lower_case(spaced(model.joints[joint].name));
    const auto says = [&](const char* word, char letter) {
      return name.find(word) != std::string::npos ||
             name.starts_with(std::string(1, letter) + "_") ||
             name.ends_with(std::string("_") + letter) ||
             name.find(std::string("_") + letter + "_") != std::string::npos ||
             name.starts_with(letter + std::string("leg")) ||
             name.find(std::string("_") + letter + "leg") != std::string::npos;
    };
    if (says("left", 'l')) ++votes;
    if (says("right", 'r')) --votes;
  }
  return votes > 0 ? "left" : votes < 0 ? "right" : "";
}

Vector3d snapped(const Vector3d& v) {
  int axis = 0;
  v.cwiseAbs().maxCoeff(&axis);
  return Vector3d::Unit(axis) * (v[axis] > 0 ? 1.0 : -1.0);
}

// From one leg to the other, of length 1.
Vector3d across(const GaitdModel& model, const Poses& poses, const LegPair& pair) {
  return line_between(model, poses, pair.joints[0], pair.joints[1]);
}

// The joint that bends a leg most in the middle, of those that pitch.
int knee_of(const GaitdModel& model, const Poses& poses, const std::vector<int>& joints,
            const Vector3d& lateral) {
  const Vector3d hip = poses[joints.front() + 1].translation();
  const Vector3d ankle = poses[joints.back() + 1].translation();
  int knee = -1;
  double best = 0.25 * (hip - ankle).norm();
  for (const int joint : joints) {
    if (std::abs(joint_axis(model, poses, joint).dot(lateral)) < kPitches) continue;
    const Vector3d at = poses[joint + 1].translation();
    const double middle = std::min((at - hip).norm(), (at - ankle).norm());
    if (middle <= best) continue;
    best = middle;
    knee = joint;
  }
  return knee;
}

// The last joint of a leg that pitches: where others have their origin along their axes says
// little.
int last_pitch(const GaitdModel& model, const Poses& poses, const std::vector<int>& joints,
               const Vector3d& lateral) {
  const auto last = std::find_if(joints.rbegin(), joints.rend(), [&](int joint) {
    return std::abs(joint_axis(model, poses, joint).dot(lateral)) >= kPitches;
  });
  return last == joints.rend() ? joints.back() : *last;
}

}  // namespace

bool find_legs(const GaitdModel& model, LegPair* pair, std::string* error) {
  const Poses poses = body_poses(model, zero_position(model));
  std::vector<bool> carries(static_cast<std::size_t>(model.body_count), false);
  for (int i = 1; i < model.body_count; ++i) carries[model.bodies[i].parent] = true;
  std::vector<std::vector<int>> ends;
  for (int i = 1; i < model.body_count; ++i) {
    if (!carries[i]) ends.push_back(chain_to(model, i));
  }
  double longest = 1e-3;
  for (const std::vector<int>& end : ends) longest = std::max(longest, length_of(poses, end));
  double best = -1e9;
  std::size_t most_joints = 0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (std::size_t j = i + 1; j < ends.size(); ++j) {
      const auto& [a, b] = std::pair(ends[i], ends[j]);
      std::size_t common = 0;
      while (common < a.size() && common < b.size() && a[common] == b[common]) ++common;
      const std::vector<int> left(a.begin() + static_cast<std::ptrdiff_t>(common), a.end());
      const std::vector<int> right(b.begin() + static_cast<std::ptrdiff_t>(common), b.end());
      if (left.size() != right.size() || left.size() > kMostLegJoints) continue;
      if (asymmetry(model, poses, left, right) > kSymmetric) continue;
      const double masses[] = {mass_of(model, left), mass_of(model, right)};
      if (std::abs(masses[0] - masses[1]) > 0.2 * (masses[0] + masses[1])) continue;
      const double names = name_hint(model, left) + name_hint(model, right);
      if (names > 0) most_joints = std::max(most_joints, left.size());
      if (left.size() < kFewestLegJoints) continue;
      const double score = 2.0 * (masses[0] + masses[1]) / model.total_mass +
                           length_of(poses, left) / longest + 0.25 * names;
      if (score <= best) continue;
      best = score;
      pair->joints = {left, right};
      pair->pelvis = common == 0 ? 0 : a[common - 1] + 1;
    }
  }
  if (best > -1e9) return true;
  *error = "no two legs found: expected two chains of at least five joints that mirror each other" +
           (most_joints > 0 ? "; the best have " + std::to_string(most_joints) : std::string());
  return false;
}

std::vector<int> find_toes(const GaitdModel& model, const LegPair& pair) {
  const Poses poses = body_poses(model, zero_position(model));
  std::vector<int> toes;
  for (const std::vector<int>& joints : pair.joints) {
    if (joints.size() <= kFewestLegJoints) continue;
    const int last = joints.back();
    // The sixth joint of a leg rolls its foot.
    const Vector3d axis = joint_axis(model, poses, last);
    if (joints.size() == kLegJoints && std::abs(axis.dot(across(model, poses, pair))) < kPitches)
      continue;
    const double leg = length_of(poses, joints);
    const double mass = model.bodies[last + 1].mass;
    const double foot = model.bodies[model.joints[last].parent_body].mass;
    const double before =
        (poses[last + 1].translation() - poses[joints[joints.size() - 2] + 1].translation()).norm();
    // The joints of an ankle are near each other, and what hangs on the last is the foot.
    if (before > 0.08 * leg && mass < foot) toes.push_back(last);
  }
  return toes.size() == 2 ? toes : std::vector<int>();
}

Eigen::Matrix3d find_directions(const GaitdModel& model, const LegPair& pair,
                                const std::array<std::vector<Vector3d>, 2>& foot_points, int* left,
                                Reasons* why) {
  const Poses poses = body_poses(model, zero_position(model));
  const Eigen::Matrix3d to_pelvis = poses[pair.pelvis].linear().transpose();
  Vector3d up = Vector3d::Zero();
  for (const std::vector<int>& joints : pair.joints) {
    up += poses[joints.front() + 1].translation() - poses[joints.back() + 1].translation();
  }
  // The legs mirror each other, so the line from one to the other is exact; where they hang from
  // the pelvis, up is the axis of the pelvis that is nearest.
  Vector3d lateral = to_pelvis * across(model, poses, pair);
  const double turned = std::acos(std::min(1.0, lateral.dot(snapped(lateral))));
  if (turned < kSameAxis) {
    lateral = snapped(lateral);
  } else {
    why->push_back(
        format("The legs stand %.1f degrees off the axes of the link.", turned * 180.0 / M_PI));
  }
  up = to_pelvis * up;
  up -= lateral * up.dot(lateral);
  Vector3d vertical = snapped(up);
  vertical = (vertical - lateral * vertical.dot(lateral)).normalized();
  const Vector3d forward = lateral.cross(vertical);  // if leg 0 is the left one

  double toes = 0.0;
  double knees = 0.0;
  for (std::size_t side = 0; side < 2; ++side) {
    const std::vector<int>& joints = pair.joints[side];
    const Vector3d to_side = poses[pair.pelvis].linear() * lateral;
    const Vector3d ankle = poses[last_pitch(model, poses, joints, to_side) + 1].translation();
    double front = -1e9;
    double back = 1e9;
    for (const Vector3d& point : foot_points[side]) {
      const Vector3d p = poses[joints.back() + 1] * point - ankle;
      front = std::max(front, (to_pelvis * p).dot(forward));
      back = std::min(back, (to_pelvis * p).dot(forward));
    }
    if (front > back) toes += 2.0 * (front + back) / (front - back);
    const int knee = knee_of(model, poses, joints, to_side);
    if (knee < 0) continue;
    const GaitdJoint& j = model.joints[knee];
    const double range = j.position_max + j.position_min;
    const Vector3d arm = ankle - poses[knee + 1].translation();
    const double moved =
        (to_pelvis * joint_axis(model, poses, knee).cross(arm)).dot(forward) * range;
    if (std::abs(range) < 0.5 || std::abs(moved) < 0.05 * length_of(poses, joints)) continue;
    knees += moved < 0 ? 0.5 : -0.5;
  }
  const std::string name = side_of(model, pair.joints[0]);
  const double names = name == "left" ? 1.0 : name == "right" ? -1.0 : 0.0;
  const double frame = 0.3 * forward.x();
  const double sum = toes + knees + names + frame;
  const double sign = sum >= 0 ? 1.0 : -1.0;
  *left = sum >= 0 ? 0 : 1;
  Eigen::Matrix3d R;
  R << sign * forward, sign * lateral, vertical;

  std::string for_it, against;
  const auto count = [&](const char* what, double vote) {
    if (std::abs(vote) < 0.05) return;
    std::string& list = vote * sign > 0 ? for_it : against;
    list += (list.empty() ? "" : ", ") + std::string(what);
  };
  count("the feet reach further before the ankles than behind them", toes);
  count("the knees bend backwards", knees);
  count("names of joints", names);
  count("x axis of the link", frame);
  why->push_back("Forward: " + for_it + (against.empty() ? "." : "; against it: " + against + "."));
  if (std::abs(sum) < 0.6) why->push_back("Not sure: look at the picture.");
  return R;
}

bool find_roles(const GaitdModel& model, LegGuess* leg, std::string* error) {
  const Poses poses = body_poses(model, zero_position(model));
  std::vector<int> pitches;
  for (const int joint : leg->joints) {
    if (std::abs(joint_axis(model, poses, joint).y()) > kPitches) pitches.push_back(joint);
  }
  const auto at = [&](int joint) { return poses[joint + 1].translation(); };
  double best = 0.0;
  for (std::size_t i = 0; i < pitches.size(); ++i) {
    for (std::size_t k = i + 1; k < pitches.size(); ++k) {
      for (std::size_t m = k + 1; m < pitches.size(); ++m) {
        // A yaw or roll that is tilted pitches as well, but not about the axis of the knee.
        const Vector3d knee = joint_axis(model, poses, pitches[k]);
        const double aligned = std::abs(knee.dot(joint_axis(model, poses, pitches[i])) *
                                        knee.dot(joint_axis(model, poses, pitches[m])));
        const double thigh = (at(pitches[k]) - at(pitches[i])).norm();
        const double shank = (at(pitches[m]) - at(pitches[k])).norm();
        const double score = aligned * std::min(thigh, shank);
        if (score <= best) continue;
        best = score;
        leg->hip_pitch = pitches[i];
        leg->knee = pitches[k];
        leg->ankle_pitch = pitches[m];
      }
    }
  }
  if (leg->knee < 0) {
    *error = std::string("the leg that ends at ") + model.joints[leg->joints.back()].name +
             ": expected three joints that pitch at hip, knee and ankle, got " +
             std::to_string(pitches.size());
    return false;
  }
  const auto knee = std::find(leg->joints.begin(), leg->joints.end(), leg->knee);
  double rolls = 0.5;
  for (auto it = knee + 1; it != leg->joints.end(); ++it) {
    const double along = std::abs(joint_axis(model, poses, *it).x());
    if (*it == leg->ankle_pitch || along <= rolls) continue;
    rolls = along;
    leg->ankle_roll = *it;
  }
  return true;
}

}  // namespace gaitd::porting
