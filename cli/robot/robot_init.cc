// SPDX-License-Identifier: Apache-2.0
#include "cli/robot/robot_init.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <set>

#include "cli/robot/ankle_reach.h"
#include "cli/robot/drive_limits.h"
#include "cli/robot/find_legs.h"
#include "cli/robot/find_sensors.h"
#include "cli/robot/fixed_joints.h"
#include "cli/robot/posture.h"
#include "cli/robot/proportions.h"
#include "cli/robot/sole_shape.h"

namespace gaitd::porting {
namespace {

using Eigen::Vector3d;

bool load(const std::string& text, Guess* guess, std::string* error) {
  guess->options.limits_required = false;
  guess->options.nearest_inertias = true;
  guess->options.fixed.clear();
  for (const FixedGuess& fixed : guess->fixed) guess->options.fixed.push_back(fixed.joint);
  guess->urdf = dynamics::load_urdf_text(text, guess->urdf_file, guess->options);
  // Where it was written the author meant it.
  for (int i = 0; i < guess->urdf.model.joint_count; ++i) {
    GaitdJoint& joint = guess->urdf.model.joints[i];
    if (const auto* note = range_of_continuous(*guess, joint.name)) {
      joint.position_min = note->lower;
      joint.position_max = note->upper;
    }
  }
  guess->model = guess->urdf.model;
  error->clear();
  for (const std::string& line : guess->urdf.errors) *error += (error->empty() ? "" : "\n") + line;
  return guess->urdf.ok();
}

void fill_frame(const Guess& guess, const FrameGuess& from, const std::string& name,
                GaitdFrame* frame) {
  const dynamics::UrdfLink* link = guess.urdf.find_link(from.link);
  std::strncpy(frame->name, name.c_str(), GAITD_NAME_SIZE - 1);
  frame->body = link->body;
  const Eigen::Isometry3d X = Eigen::Translation3d(link->p_BL) * link->R_BL * from.X_LF;
  Vector3d::Map(frame->origin) = X.translation();
  Eigen::Vector4d::Map(frame->orientation) = Eigen::Quaterniond(X.linear()).normalized().coeffs();
}

// The link from which both legs hang; the body may be called after a footprint that is fixed to it.
std::string link_above(const Guess& guess, const LegPair& pair) {
  const auto joint_to = [&](const std::string& link) {
    return std::find_if(guess.outline.joints.begin(), guess.outline.joints.end(),
                        [&](const auto& joint) { return joint.child == link; });
  };
  std::array<std::vector<std::string>, 2> above;
  for (std::size_t side = 0; side < 2; ++side) {
    std::string link = guess.urdf.model.bodies[pair.joints[side].front() + 1].name;
    for (auto joint = joint_to(link); joint != guess.outline.joints.end(); joint = joint_to(link)) {
      if (above[side].size() > guess.outline.joints.size()) break;
      link = joint->parent;
      above[side].push_back(link);
    }
  }
  for (const std::string& link : above[0]) {
    if (std::find(above[1].begin(), above[1].end(), link) != above[1].end()) return link;
  }
  return guess.urdf.model.bodies[pair.pelvis].name;
}

// From the origin of the pelvis to the middle of the hips, m, if that is more than half a leg; or
// zero.
Vector3d from_hips(const Guess& guess) {
  const auto poses = body_poses(guess.urdf.model, zero_position(guess.urdf.model));
  Vector3d middle = Vector3d::Zero();
  double length = 0.0;
  for (const LegGuess& leg : guess.legs) {
    const Vector3d hip = poses[static_cast<std::size_t>(leg.joints.front()) + 1].translation();
    middle += 0.5 * hip;
    length +=
        0.5 * (hip - poses[static_cast<std::size_t>(leg.joints.back()) + 1].translation()).norm();
  }
  return middle.norm() > 0.5 * length ? middle : Vector3d::Zero();
}

bool find_pelvis(const std::string& text, Guess* guess, std::string* error) {
  guess->options.root_link.clear();
  guess->options.R_LB.setIdentity();
  guess->options.p_LB.setZero();
  guess->pelvis_why.clear();
  for (LegGuess& leg : guess->legs) leg = {};
  LegPair pair;
  if (!find_legs(guess->urdf.model, &pair, error)) return false;
  // Toes may be several, beside or behind each other.
  for (std::vector<int> toes = find_toes(guess->urdf.model, pair); !toes.empty();
       toes = find_toes(guess->urdf.model, pair)) {
    for (const int toe : toes) {
      guess->fixed.push_back({guess->urdf.model.joints[toe].name, "a toe"});
    }
    if (!load(text, guess, error) || !find_legs(guess->urdf.model, &pair, error)) return false;
  }
  const GaitdModel& model = guess->urdf.model;
  std::array<std::vector<Vector3d>, 2> points;
  for (std::size_t side = 0; side < 2; ++side) {
    Reasons unused;
    for (const ShapePoint& p : shape_points(*guess, pair.joints[side].back() + 1, true, &unused)) {
      points[side].push_back(p.p);
    }
  }
  int left = 0;
  // From the axes of the body to those of the link that becomes the pelvis.
  const Eigen::Quaterniond R_BL = guess->urdf.find_link(link_above(*guess, pair))->R_BL;
  const Eigen::Matrix3d R = R_BL.inverse().toRotationMatrix() *
                            find_directions(model, pair, points, &left, &guess->pelvis_why);
  guess->pelvis_why.insert(
      guess->pelvis_why.begin(),
      format("The body from which two chains of %zu joints hang that mirror each other.",
             pair.joints[0].size()));
  std::array<std::vector<std::string>, 2> names;
  for (std::size_t side = 0; side < 2; ++side) {
    const std::size_t of =
        side == 0 ? static_cast<std::size_t>(left) : 1 - static_cast<std::size_t>(left);
    for (const int joint : pair.joints[of]) names[side].emplace_back(model.joints[joint].name);
  }
  guess->options.root_link = link_above(*guess, pair);
  guess->options.R_LB = Eigen::Quaterniond(R).normalized();
  if (!load(text, guess, error)) return false;
  for (std::size_t side = 0; side < 2; ++side) {
    for (const std::string& name : names[side]) {
      for (int i = 0; i < guess->urdf.model.joint_count; ++i) {
        if (name == guess->urdf.model.joints[i].name) guess->legs[side].joints.push_back(i);
      }
    }
  }
  // Some frames lie on the ground, or where the designer began to draw.
  const Vector3d far = from_hips(*guess);
  if (far.isZero(0.0)) return true;
  guess->options.p_LB = R * far;
  guess->pelvis_why.push_back(
      format("Its frame lies %.2f m from the hips: the origin is put between them.", far.norm()));
  return load(text, guess, error);
}

// The corners of the sole that somebody told, in the frame of the foot; R: from axes of the pelvis;
// `ankle`: x there of the joint that pitches the foot.
std::vector<ShapePoint> told_corners(const std::vector<double>& sole, const Eigen::Matrix3d& R,
                                     double ankle) {
  std::vector<ShapePoint> points;
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      points.push_back({R * Vector3d(x * sole[0] + sole[3] + ankle, y * sole[1], -sole[2])});
    }
  }
  return points;
}

bool find_feet(const Told& told, Guess* guess, std::string* error) {
  const auto poses = body_poses(guess->urdf.model, zero_position(guess->urdf.model));
  for (std::size_t side = 0; side < 2; ++side) {
    LegGuess& leg = guess->legs[side];
    if (!find_roles(guess->urdf.model, &leg, error)) return false;
    const int foot = leg.joints.back() + 1;
    SoleGuess& sole = guess->soles[side];
    sole.frame.link = guess->urdf.model.bodies[foot].name;
    const Eigen::Matrix3d R = poses[static_cast<std::size_t>(foot)].linear().transpose();
    const double ankle = poses[static_cast<std::size_t>(leg.ankle_pitch) + 1].translation().x() -
                         poses[static_cast<std::size_t>(foot)].translation().x();
    const std::vector<ShapePoint> points = told.sole.empty()
                                               ? shape_points(*guess, foot, true, &sole.frame.why)
                                               : told_corners(told.sole, R, ankle);
    if (!told.sole.empty()) sole.frame.why.emplace_back("As told by --sole.");
    bool found = !points.empty() && find_sole(points, -R.col(2), R.col(0), &sole, error);
    const bool has_collisions = std::ranges::any_of(guess->outline.shapes, [&](const auto& shape) {
      const dynamics::UrdfLink* link = guess->urdf.find_link(shape.link);
      return shape.collision && link != nullptr && link->body == foot;
    });
    if (!found && told.sole.empty() && has_collisions) {
      SoleGuess drawn = sole;
      drawn.frame.why.clear();
      std::string unused;
      const auto visuals = shape_points(*guess, foot, false, &drawn.frame.why);
      found = !visuals.empty() && find_sole(visuals, -R.col(2), R.col(0), &drawn, &unused);
      if (found) sole = drawn;
    }
    if (!found) {
      std::string why;
      for (const std::string& reason : sole.frame.why) why += " " + reason;
      *error =
          "foot " + sole.frame.link + ": " +
          (points.empty() ? "no shape to find the sole from" : *error) + "." + why +
          " Measure it: --sole LENGTH,WIDTH,HEIGHT,AHEAD in m, the height of the last joint of the "
          "leg above the ground, and how far the middle of the sole lies ahead of the one that "
          "pitches the foot";
      return false;
    }
    cut_to_ankle(*guess, static_cast<int>(side), &sole);
    GaitdFoot& out = guess->model.feet[side];
    fill_frame(*guess, sole.frame, side == 0 ? "left_sole" : "right_sole", &out.sole);
    out.body = foot;
    out.point_count = static_cast<int>(sole.outline.size());
    for (std::size_t i = 0; i < sole.outline.size(); ++i) {
      out.points[i][0] = sole.outline[i].x();
      out.points[i][1] = sole.outline[i].y();
    }
    GaitdLeg& to = guess->model.legs[side];
    to.joint_count = static_cast<int>(leg.joints.size());
    std::copy(leg.joints.begin(), leg.joints.end(), to.joints);
    to.hip_pitch = leg.hip_pitch;
    to.knee = leg.knee;
    to.ankle_pitch = leg.ankle_pitch;
    to.ankle_roll = leg.ankle_roll;
  }
  guess->legs_why.emplace_back(
      "Of the joints whose axes lie sideways, the knee is the one furthest from hip and ankle.");
  return true;
}

// Where legs are not found without them, joints without effort, velocity or range may be their
// drives: only those that legs do not have stay fixed.
bool find_pelvis_without_limits(const std::string& text, Guess* guess, std::string* error) {
  const std::vector<FixedGuess> before = guess->fixed;
  std::erase_if(guess->fixed, [](const FixedGuess& fixed) { return fixed.lacks_limits; });
  if (guess->fixed.size() == before.size()) return false;
  if (!load(text, guess, error) || !find_pelvis(text, guess, error)) return false;
  std::set<std::string> legs;
  for (const LegGuess& leg : guess->legs) {
    for (const int joint : leg.joints) legs.insert(guess->urdf.model.joints[joint].name);
  }
  for (const FixedGuess& fixed : before) {
    if (fixed.lacks_limits && !legs.contains(fixed.joint)) guess->fixed.push_back(fixed);
  }
  guess->options = {};
  return load(text, guess, error) && find_pelvis(text, guess, error);
}

}  // namespace

bool guess_robot(const std::string& urdf, const std::string& name, const Told& told, Guess* guess,
                 std::string* error) {
  guess->urdf_file = urdf;
  guess->name = name;
  std::string text;
  if (!dynamics::read_urdf_text(urdf, &text, error)) return false;
  guess->outline = dynamics::read_urdf_outline(text);
  guess->fixed = joints_to_fix(guess->outline);
  if (!told.sole.empty() &&
      !(told.sole[0] > 0 && told.sole[1] > 0 && told.sole[2] >= 0 && std::isfinite(told.sole[3]))) {
    *error = "--sole: expected a length and a width above 0, a height, and how far it lies ahead";
    return false;
  }
  for (const std::string& glob : told.fix) guess->fixed.push_back({glob, "as told by --fix"});
  if (!load(text, guess, error)) {
    *error +=
        "\nwhat of it walking does not need, `--fix GLOB` leaves out: joints that do not move";
    return false;
  }
  for (const std::string& glob : told.fix) {
    const auto& unused = guess->urdf.unused_fixed;
    if (std::find(unused.begin(), unused.end(), glob) == unused.end()) continue;
    *error = urdf;
    error->append(": no joint is called ").append(glob).append(" (--fix)");
    return false;
  }
  std::string again;
  if (!find_pelvis(text, guess, error) && !find_pelvis_without_limits(text, guess, &again)) {
    const std::string lacking = joints_without_limits(guess->outline);
    if (!lacking.empty())
      *error += "; these lack effort, velocity or range and were left out: " + lacking;
    *error = urdf + ": " + *error + (again.empty() ? "" : "\nwith them: " + again);
    return false;
  }
  const bool stands = find_feet(told, guess, error);
  if (stands) {
    guess->chest = find_chest(*guess, &guess->chest_why);
    guess->imu = find_imu(*guess);
    fill_frame(*guess, guess->imu, guess->imu.name, &guess->model.imus[0]);
    guess->model.imu_count = 1;
    for (int side = 0; side < 2; ++side) {
      guess->force_sensors[static_cast<std::size_t>(side)] = find_force_sensor(*guess, side);
      fill_frame(*guess, guess->force_sensors[static_cast<std::size_t>(side)],
                 side == 0 ? "left_force" : "right_force", &guess->model.feet[side].force_sensor);
    }
  }
  if (!stands || !solve_posture(guess, error)) {
    *error = urdf + ": " + *error;
    return false;
  }
  guess_drive_limits(guess);
  find_proportions(guess);
  return true;
}

}  // namespace gaitd::porting
