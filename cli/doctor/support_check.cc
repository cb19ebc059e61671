// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "cli/doctor/log_checks.h"
#include "gaitd/walking/polygon.h"

namespace gaitd::doctor {
namespace {

constexpr double kLost = 0.05;       // m, capture point off its plan
constexpr double kBegan = 0.03;      // m
constexpr double kEdge = 0.01;       // m, CoP from the border of the feet
constexpr double kPush = 0.15;       // of the weight
constexpr double kPushLeast = 0.05;  // s
constexpr double kPushBefore = 0.5;  // s before the capture point leaves its plan
constexpr double kWindow = 0.02;     // s, over which the CoM accelerates

using daemon::Column;

std::vector<double> icp_error(const LogCase& log) {
  const Column* x = log.find("icp/x");
  const Column* y = log.find("icp/y");
  const Column* wanted_x = log.find("icp/desired/x");
  const Column* wanted_y = log.find("icp/desired/y");
  if (x == nullptr || y == nullptr || wanted_x == nullptr || wanted_y == nullptr) return {};
  std::vector<double> error(x->size());
  for (std::size_t i = 0; i < error.size(); ++i) {
    error[i] = std::hypot((*x)[i] - (*wanted_x)[i], (*y)[i] - (*wanted_y)[i]);
  }
  return error;
}

// Horizontal force on the robot that its feet did not make: m a minus what they measured.
std::vector<Eigen::Vector2d> outer_force(const LogCase& log, double mass) {
  std::vector<Eigen::Vector2d> outer;
  const auto window =
      std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(kWindow / log.period())));
  for (int axis = 0; axis < 2; ++axis) {
    const std::string name = axis == 0 ? "x" : "y";
    const Column* velocity = log.find("com/velocity/" + name);
    const Column* left = log.find("foot/left/force/" + name);
    const Column* right = log.find("foot/right/force/" + name);
    if (velocity == nullptr || left == nullptr || right == nullptr) return {};
    outer.resize(velocity->size(), Eigen::Vector2d::Zero());
    double feet = 0.0;  // sum over the window
    for (std::size_t i = 0; i < outer.size(); ++i) {
      feet += (*left)[i] + (*right)[i];
      if (i < window) continue;
      feet -= (*left)[i - window] + (*right)[i - window];
      const double acceleration =
          ((*velocity)[i] - (*velocity)[i - window]) / (static_cast<double>(window) * log.period());
      outer[i][axis] = mass * acceleration - feet / static_cast<double>(window);
    }
  }
  return outer;
}

struct Push {
  Episode episode;
  Eigen::Vector2d force;  // N, mean
};

std::optional<Push> find_push(const LogCase& log, std::size_t before) {
  const GaitdModel* model = log.model();
  if (model == nullptr) return std::nullopt;
  const std::vector<Eigen::Vector2d> outer = outer_force(log, model->total_mass);
  const double least = kPush * model->total_mass * model->gravity;
  std::optional<Push> push;
  for (std::size_t i = 0; i < std::min(outer.size(), before); ++i) {
    if (!log.controlled(i) || outer[i].norm() < least) continue;
    Push now{{i, i}, Eigen::Vector2d::Zero()};
    while (now.episode.end < outer.size() && outer[now.episode.end].norm() >= least) {
      now.force += outer[now.episode.end++];
    }
    const auto length = static_cast<double>(now.episode.end - now.episode.begin);
    now.force /= length;
    i = now.episode.end;
    const bool close = log.time(before) - log.time(now.episode.begin) < kPushBefore;
    if (length * log.period() >= kPushLeast && close &&
        (!push || now.force.norm() > push->force.norm())) {
      push = now;
    }
  }
  return push;
}

// Where the soles that carry load are, and how far inside them the CoP is; NaN if unknown.
double cop_margin(const LogCase& log, std::size_t i) {
  const GaitdModel* model = log.model();
  const Column* x = log.find("cop/x");
  const Column* y = log.find("cop/y");
  if (model == nullptr || x == nullptr || y == nullptr) return kNoTime;
  walking::ConvexPolygon soles;
  for (int side = 0; side < 2; ++side) {
    const std::string prefix = "foot/" + std::string(daemon::kSides[side]) + "/";
    std::array<const Column*, 4> pose = {log.find(prefix + "x"), log.find(prefix + "y"),
                                         log.find(prefix + "yaw"), log.find(prefix + "force/z")};
    if (std::count(pose.begin(), pose.end(), nullptr) != 0) return kNoTime;
    if ((*pose[3])[i] < 0.02 * model->total_mass * model->gravity) continue;
    const Eigen::Rotation2Dd turn((*pose[2])[i]);
    for (int p = 0; p < model->feet[side].point_count; ++p) {
      soles.add(turn * Eigen::Map<const Eigen::Vector2d>(model->feet[side].points[p]) +
                Eigen::Vector2d((*pose[0])[i], (*pose[1])[i]));
    }
  }
  soles.make_hull();
  return soles.empty() ? kNoTime : soles.inside_distance({(*x)[i], (*y)[i]});
}

}  // namespace

Findings check_support(const LogCase& log) {
  const std::vector<double> error = icp_error(log);
  std::vector<bool> wrong(error.size());
  for (std::size_t i = 0; i < wrong.size(); ++i) wrong[i] = log.controlled(i) && error[i] > kLost;
  auto episode = last_episode(log, wrong, 0.01, 0.2);
  if (!episode) return {};
  while (episode->begin > 0 && log.controlled(episode->begin - 1) &&
         error[episode->begin] > kBegan) {
    --episode->begin;
  }
  int on_edge = 0;
  std::size_t first_on_edge = 0;
  for (std::size_t i = episode->begin; i < std::min(log.end(), episode->end); ++i) {
    if (!(cop_margin(log, i) < kEdge)) continue;
    if (on_edge++ == 0) first_on_edge = i;
  }
  std::string edge;
  if (on_edge > 0) {
    edge = format(": the CoP stood on the edge of the feet for %.2f s, from %.3f s on",
                  on_edge * log.period(), log.time(first_on_edge));
  }
  const char* advice =
      "gait.recovery, step_adjuster.variant=step_plan and its reach_* let steps catch more; "
      "step_adjuster.gain_*, wider or slower steps";
  Findings findings = {log_finding(
      log, "cop", episode->begin,
      (log.ended_badly() ? "the capture point left its plan and the CoP could not bring it back"
                         : "the capture point was off its plan by more than 50 mm for a while") +
          edge,
      advice)};
  if (const auto push = find_push(log, episode->begin + 1)) {
    const double length =
        static_cast<double>(push->episode.end - push->episode.begin) * log.period();
    findings.push_back(log_finding(
        log, "push", push->episode.begin,
        format("something pushed the robot, with about %.0f N towards %s for %.2f s: more than its "
               "feet and steps could answer",
               push->force.norm(), direction(push->force).c_str(), length),
        advice));
  }
  return findings;
}

}  // namespace gaitd::doctor
