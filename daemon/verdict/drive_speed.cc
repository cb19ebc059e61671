// SPDX-License-Identifier: Apache-2.0
#include "daemon/verdict/drive_speed.h"

#include <cmath>

#include "daemon/verdict/run_figures.h"

namespace gaitd::daemon {
namespace {

constexpr double kSlowest = 0.1;  // m/s, rad/s: what is slower is compared with this
constexpr double kSame = 1e-6;

struct Velocity {
  double forward = 0.0, lateral = 0.0, turn = 0.0;

  bool same(const Velocity& other) const {
    return std::abs(forward - other.forward) < kSame && std::abs(lateral - other.lateral) < kSame &&
           std::abs(turn - other.turn) < kSame;
  }
};

struct Columns {
  const Column *forward, *lateral, *turn, *step, *x, *y, *yaw;

  bool all() const {
    return forward != nullptr && lateral != nullptr && turn != nullptr && step != nullptr &&
           x != nullptr && y != nullptr && yaw != nullptr;
  }
  Velocity asked(std::size_t tick) const {
    return {(*forward)[tick], (*lateral)[tick], (*turn)[tick]};
  }
};

double wrapped(double angle) { return std::remainder(angle, 2.0 * M_PI); }

// Mean velocity in the heading of each moment.
Velocity mean_velocity(const RunData& run, const Columns& c, std::size_t from, std::size_t to) {
  Velocity sum;
  for (std::size_t tick = from + 1; tick <= to; ++tick) {
    const double dx = (*c.x)[tick] - (*c.x)[tick - 1];
    const double dy = (*c.y)[tick] - (*c.y)[tick - 1];
    const double heading = (*c.yaw)[tick];
    sum.forward += std::cos(heading) * dx + std::sin(heading) * dy;
    sum.lateral += std::cos(heading) * dy - std::sin(heading) * dx;
    sum.turn += wrapped((*c.yaw)[tick] - (*c.yaw)[tick - 1]);
  }
  const double time = run.time()[to] - run.time()[from];
  return {sum.forward / time, sum.lateral / time, sum.turn / time};
}

// The larger of the two, each relative to what was asked.
double relative_error(const Velocity& real, const Velocity& asked) {
  const double way = std::hypot(real.forward - asked.forward, real.lateral - asked.lateral) /
                     std::max(kSlowest, std::hypot(asked.forward, asked.lateral));
  const double turn = std::abs(real.turn - asked.turn) / std::max(kSlowest, std::abs(asked.turn));
  return std::max(way, turn);
}

}  // namespace

double drive_speed_error(const RunData& run) {
  const Columns c{run.find("drive/step/forward"),
                  run.find("drive/step/lateral"),
                  run.find("drive/step/turn"),
                  run.find("gait/step_index"),
                  run.find_first({"truth/pelvis/x", "pelvis/x"}),
                  run.find_first({"truth/pelvis/y", "pelvis/y"}),
                  run.find_first({"truth/pelvis/yaw", "pelvis/yaw"})};
  if (!c.all()) return kNotMeasured;
  double error = 0.0;
  double time = 0.0;
  // Ticks at which a step of one velocity begins, the first of them left out.
  std::vector<std::size_t> begins;
  Velocity velocity;
  const auto end_stretch = [&] {
    if (begins.size() >= 4) {
      const std::size_t from = begins[1];
      const std::size_t to = begins[begins.size() - (begins.size() % 2 == 0 ? 1 : 2)];
      const double seconds = run.time()[to] - run.time()[from];
      error += seconds * relative_error(mean_velocity(run, c, from, to), velocity);
      time += seconds;
    }
    begins.clear();
  };
  for (std::size_t tick = 1; tick < run.ticks(); ++tick) {
    const bool begins_step = (*c.step)[tick] != (*c.step)[tick - 1];
    const Velocity now = c.asked(tick);
    const bool walking = run.is_during(tick, During::kWalk) && !now.same({});
    if (!walking || (!begins.empty() && !now.same(velocity))) end_stretch();
    if (!walking || !begins_step) continue;
    velocity = now;
    begins.push_back(tick);
  }
  end_stretch();
  return time > 0.0 ? error / time : kNotMeasured;
}

}  // namespace gaitd::daemon
