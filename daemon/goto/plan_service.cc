// SPDX-License-Identifier: Apache-2.0
#include "daemon/goto/plan_service.h"

#include <pthread.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"

namespace gaitd::daemon {
namespace {

// The control thread cannot wake anybody: requests are looked for.
constexpr std::chrono::milliseconds kPoll{2};
constexpr double kSamePlace = 0.02;   // m, and
constexpr double kSameYaw = 0.05;     // rad: a footstep is that one of the route
constexpr double kEndsThere = 0.02;   // m, from the goal to a plan that ends there
constexpr double kMuchBetter = 0.85;  // of the cost of the way that was begun

void raise(double by, GaitdFootstep* step) {
  step->pose.position[2] += by;
  for (int i = 0; i < step->region_count; ++i) step->landing_region[i][2] += by;
}

bool same_place(const GaitdFootstep& a, const GaitdFootstep& b) {
  const auto yaw = [](const GaitdFootstep& step) {
    return sdk::yaw_of(sdk::quaternion(step.pose.orientation));
  };
  return a.side == b.side &&
         std::hypot(a.pose.position[0] - b.pose.position[0],
                    a.pose.position[1] - b.pose.position[1]) < kSamePlace &&
         std::abs(std::remainder(yaw(a) - yaw(b), 2.0 * M_PI)) < kSameYaw;
}

// Whether the feet come to stand at the goal, and not beside a place that was not good yet.
bool ends_there(const std::vector<GaitdFootstep>& steps, const footsteps::Goal& goal) {
  if (steps.size() < 2) return true;
  const GaitdPose middle = walking::middle_pose(steps.end()[-1].pose, steps.end()[-2].pose);
  return std::hypot(middle.position[0] - goal.x, middle.position[1] - goal.y) < kEndsThere;
}

bool same(const GaitdFootstep& a, const GaitdFootstep& b) {
  return footsteps::same_foothold(a.pose, b.pose) && a.swing_duration == b.swing_duration &&
         a.transfer_duration == b.transfer_duration && a.swing_height == b.swing_height;
}

}  // namespace

void PlanService::start() {
  look_around();
  thread_ = std::thread([this] { run(); });
  pthread_setname_np(thread_.native_handle(), "gaitd-goto");
}

void PlanService::stop() {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
  for (PlanPort* port : {&port_, &refinements_}) {
    for (PlanAnswer answer; port->next_answer(answer);) delete answer.plan;
    for (const footsteps::Plan* plan = nullptr; port->next_retired(plan);) delete plan;
  }
}

void PlanService::run() {
  while (!stopping_) {
    look_around();
    answer_all(&port_);
    answer_all(&refinements_);
    std::unique_lock lock(mutex_);
    wake_.wait_for(lock, kPoll, [this] { return stopping_.load(); });
  }
}

void PlanService::look_around() {
  for (Sight sight; !stopping_ && port_.next_sight(sight);) parts_.ground->look(sight);
  const bool live = parts_.ground->live();
  port_.set_live(live);
  refinements_.set_live(live);
}

void PlanService::answer_all(PlanPort* port) {
  PlanRequest request;
  while (!stopping_ && port->next_request(request)) {
    look_around();  // what was seen before it was asked
    bool unchanged = false;
    auto plan = std::make_unique<footsteps::Plan>();
    try {
      *plan = answer(request, &unchanged);
    } catch (const std::exception& problem) {
      plan->refusal = std::string("the planner failed: ") + problem.what();
      planner_.reset();
    }
    if (port->answer({request.serial, plan.get(), unchanged})) static_cast<void>(plan.release());
  }
  for (const footsteps::Plan* plan = nullptr; port->next_retired(plan);) delete plan;
}

footsteps::FootstepPlanner& PlanService::planner(const PlanRequest& request) {
  std::optional<Eigen::Vector2d> goal;
  if (request.kind != PlanKind::kRefine) goal.emplace(request.goal.x, request.goal.y);
  const LiveGround::Known known = parts_.ground->known_towards(goal);
  if (!planner_ || known.map != known_.map) {
    if (known.cleared != known_.cleared) ways_->clear();
    known_ = known;
    footsteps::PlannerOptions options = parts_.options;
    options.explore = parts_.ground->live();
    if (options.explore) options.ways = ways_;
    planner_ = footsteps::make_planner(parts_.planner, *parts_.model, known_.map, options);
  }
  return *planner_;
}

// A map that is made while the robot walks is higher or lower than its feet by what its sensor and
// its estimator are off. What counts is the height from where it stands: plans are made in the
// frame of the map, below the foot that stays. m, by which that is above the map.
double PlanService::above_map(const PlanRequest& request) const {
  if (!parts_.ground->live()) return 0.0;
  double sum = 0.0;
  int count = 0;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    if (request.start.under_way && side == request.start.under_way->side) continue;
    const GaitdPose& foot = request.start.feet[side];
    if (const auto ground = planner_->ground_below(side, foot)) {
      sum += foot.position[2] - *ground;
      ++count;
    }
  }
  return count > 0 ? sum / count : -request.height_offset;
}

footsteps::Plan PlanService::answer(const PlanRequest& request, bool* unchanged) {
  footsteps::FootstepPlanner& planner = this->planner(request);
  const double bias = above_map(request);
  if (offered_ && offered_->first == request.taken) {
    route_ = std::move(offered_->second);
    on_route_ = 0;
    offered_.reset();
  }
  PlanRequest on_map = request;
  for (GaitdPose& foot : on_map.start.feet) foot.position[2] -= bias;
  if (on_map.start.under_way) raise(-bias, &*on_map.start.under_way);
  for (int i = 0; i < on_map.ahead_count; ++i) raise(-bias, &on_map.ahead[i]);
  footsteps::Plan plan;
  switch (request.kind) {
    case PlanKind::kGoto:
      plan = planner.plan(on_map.start, on_map.goal, on_map.parameters);
      if (!plan.refusal.empty()) break;  // what is under way goes on
      exhausted_.clear();
      offered_ = {request.serial, plan};
      break;
    case PlanKind::kRevise:
      on_map.goal.exhausted = exhausted_;
      plan = revise(on_map, unchanged);
      if (!*unchanged) offered_ = {request.serial, plan};
      break;
    case PlanKind::kRefine:
      plan.footsteps = planner.refine(
          on_map.start, {on_map.ahead.begin(), on_map.ahead.begin() + on_map.ahead_count},
          on_map.parameters);
      break;
  }
  for (GaitdFootstep& step : plan.footsteps) raise(bias, &step);
  return plan;
}

// The footsteps of the route behind the one that is under way; nothing if that is none of them. Of
// several at one place it is the nearest to the one before, of two as near the later one: routes
// come back to where they were.
std::optional<std::vector<GaitdFootstep>> PlanService::left_of_route(const PlanRequest& request) {
  if (!request.start.under_way) return std::nullopt;
  const GaitdFootstep& now = *request.start.under_way;
  const auto& steps = route_.footsteps;
  const auto off = [this](std::ptrdiff_t i) { return std::abs(i - on_route_); };
  const auto count = static_cast<std::ptrdiff_t>(steps.size());
  std::ptrdiff_t at = count;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    if (!same_place(steps[static_cast<std::size_t>(i)], now)) continue;
    if (at == count || off(i) <= off(at)) at = i;
  }
  if (at == count) return std::nullopt;
  on_route_ = at;
  return std::vector<GaitdFootstep>(steps.begin() + at + 1, steps.end());
}

// The same footsteps as long as they can be taken and lead to the goal. Else another way; and if
// there is none, as many of them as can be taken.
footsteps::Plan PlanService::revise(const PlanRequest& request, bool* unchanged) {
  const auto found = left_of_route(request);
  footsteps::Goal goal = request.goal;
  const std::vector<GaitdFootstep> left = found.value_or(std::vector<GaitdFootstep>{});
  const bool known = found && !route_.partial && ends_there(left, goal);
  // It comes to the end of a plan that has not been taken further on the way there.
  if (found && left.empty() && route_.partial) {
    const double* end = request.start.under_way->pose.position;
    exhausted_.emplace_back(end[0], end[1]);
    goal.exhausted = exhausted_;
  }
  footsteps::Plan adapted;
  if (!left.empty()) adapted = planner_->adapt(request.start, left, request.parameters);
  if (known && adapted.refusal.empty()) {
    *unchanged = std::equal(left.begin(), left.end(), adapted.footsteps.begin(),
                            adapted.footsteps.end(), same);
    return *unchanged ? footsteps::Plan{} : adapted;
  }
  footsteps::Plan plan = planner_->plan(request.start, goal, request.parameters);
  if (!left.empty() && adapted.refusal.empty()) {
    go_on(request, adapted, &plan);
  }
  if (plan.refusal.empty()) return plan;
  adapted.refusal = plan.refusal;
  adapted.partial = true;
  return adapted;
}

// From where the map ended a way leads on, over what is seen now: rather that than another way from
// here that is hardly better, or the robot would change its mind at every step.
void PlanService::go_on(const PlanRequest& request, const footsteps::Plan& begun,
                        footsteps::Plan* plan) const {
  footsteps::Start end = request.start;
  for (const GaitdFootstep& step : begun.footsteps) end.feet[step.side] = step.pose;
  end.under_way = begun.footsteps.back();
  end.first_side = walking::other_side(begun.footsteps.back().side);
  footsteps::Plan on = planner_->plan(end, request.goal, request.parameters);
  if (!on.refusal.empty()) return;
  const bool better = plan->refusal.empty() && plan->partial <= on.partial &&
                      plan->cost < kMuchBetter * (begun.cost + on.cost);
  if (better) return;
  const bool ends = on.footsteps.empty();
  on.footsteps.insert(on.footsteps.begin(), begun.footsteps.begin(), begun.footsteps.end());
  if (!ends) on.footsteps[begun.footsteps.size() - 1].closing = 0;
  on.cost += begun.cost;
  *plan = std::move(on);
}

}  // namespace gaitd::daemon
