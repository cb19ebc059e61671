// SPDX-License-Identifier: Apache-2.0
#include "lattice.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>
#include <queue>
#include <span>
#include <string>
#include <utility>

#include "angle.h"
#include "gaitd/walking/support.h"
#include "goal_place.h"
#include "sole_table.h"
#include "step_costs.h"
#include "tally.h"

namespace gaitd::footsteps {
namespace {

using walking::Gait;
using walking::other_side;
using walking::side_sign;

constexpr double kLatticeCell = 0.043;  // pelvis heights, of the lattice
// What a pelvis height of uneven ground costs in the estimate.
constexpr double kUneven = 8.0;
// By which the estimate is inflated, search by search.
constexpr double kInflations[] = {3.0, 2.0, 1.5};
// Once there is a way: so much more is spent on a better one, over what it took.
constexpr int kImprove = 2;
constexpr int kLeastImprove = 6000;

// Where the map ends: pelvis heights of level way, by which a foothold that is not known has to be
// nearer to the goal to lead on there; and what that way costs over one on known ground.
constexpr double kLeadsOn = 0.2;
constexpr double kBeyond = 1.5;
constexpr double kSameEnd =
    0.22;  // pelvis heights, around the end of a plan that saw no more there

}  // namespace

Lattice::Lattice(std::shared_ptr<StepMaker> steps, const PlannerOptions& options)
    : MapPlanner(std::move(steps)),
      strides_(make_strides(steps_->unit(), steps_->model().nominal_foot_separation)),
      options_(options) {
  per_metre_ = std::numeric_limits<double>::infinity();
  for (const Stride& s : strides_) {
    if (s.ahead > 0.0) per_metre_ = std::min(per_metre_, s.cost / s.ahead);
  }
  if (steps_->footholds().has_map()) {
    way_ = std::make_unique<WayEstimate>(*steps_, per_metre_, kUneven / steps_->unit(),
                                         options_.ways.get());
  }
}

// One problem. Millions of steps are put into the queue, so it holds little of each.
class Lattice::Search {
 public:
  Search(const Lattice& lattice, const Start& start, const Goal& goal,
         const walking::GaitParameters& parameters)
      : lattice_(lattice),
        steps_(*lattice.steps_),
        start_(start),
        parameters_(parameters),
        exhausted_(goal.exhausted),
        cell_(kLatticeCell * steps_.unit()) {
    const Place from = middle_of(start.feet[GAITD_LEFT], start.feet[GAITD_RIGHT]);
    const double dx = goal.x - from.x, dy = goal.y - from.y;
    const bool near = std::hypot(dx, dy) < steps_.unit();
    goal_ = {goal.x, goal.y, goal.yaw.value_or(near ? from.yaw : std::atan2(dy, dx))};
  }

  Plan run() {
    Plan plan;
    if (!find_goal(&plan.refusal)) return plan;
    int budget = lattice_.options_.expansions;
    for (const double inflation : kInflations) {
      if (!search(inflation, budget)) break;
      budget = enough(expansions_);
      if (expansions_ >= budget) break;
    }
    plan.expansions = expansions_;
    plan.footsteps = best_;
    plan.partial = partial_;
    plan.cost = best_cost_;
    if (best_.empty()) plan.refusal = why_not();
    return plan;
  }

 private:
  // A step onto a sole.
  struct Node {
    SolePlace* sole;
    double cost;           // steps, up to here
    int parent;            // the foot that it steps from; -1: where the plan begins
    bool goal;             // a sole of the goal, exactly
    bool weighed = false;  // the cost of its swing is in it
    bool beyond = false;   // no sole: the way goes on from its parent where nothing is known
  };
  struct Queued {
    double rank;
    std::uint32_t order;  // of equals the first
    Node node;
    bool operator<(const Queued& other) const {  // it comes later
      return rank != other.rank ? rank > other.rank : order > other.order;
    }
  };

  // Where the map ends.
  struct Frontier {
    double rank;
    int node;
    int expansions;  // after which it was found
  };

  // Expansions to end at, if a way was found after so many.
  int enough(int expansions) const {
    return std::min(lattice_.options_.expansions,
                    std::max(kImprove * expansions, expansions + kLeastImprove));
  }
  bool spent(int budget) const {
    return expansions_ >= budget || (frontier_ && expansions_ >= enough(frontier_->expansions));
  }

  // False: there is no place for the feet at the goal, or near it.
  bool find_goal(std::string* refusal) {
    const Place wanted = goal_;
    const GoalPlace found = find_goal_place(steps_, wanted, cell_);
    goal_ = found.middle;
    // What is not known cannot be good yet: on the way there more of it will be seen.
    goal_known_ = found.found;
    const bool later = found.problem == FootholdState::kUnknown && lattice_.options_.explore;
    if (!found.found && !later) {
      *refusal = no_goal_place(wanted, found.problem);
      return false;
    }
    if (lattice_.way_) lattice_.way_->lead_to({goal_.x, goal_.y});
    soles_.emplace(steps_, lattice_.way_.get(), lattice_.per_metre_, cell_, start_, found);
    return true;
  }

  void push(const Node& node, double inflation) {
    queue_.push({node.cost + inflation * node.sole->estimate, order_++, node});
  }

  GaitdPose pose_of(int node) const {
    return Footholds::pose_of(nodes_[node].sole->place, nodes_[node].sole->foothold);
  }
  // Where the foot of `side` stands when `node`, of the other foot, is the last footstep.
  GaitdPose stands(int node, int side) const {
    const int before = nodes_[node].parent;
    return before < 0 || is_start(before) ? start_.feet[side] : pose_of(before);
  }
  bool is_start(int node) const { return nodes_[node].parent < 0; }
  GaitdPose stance_of(int node) const {
    return is_start(node) ? start_.feet[nodes_[node].sole->side] : pose_of(node);
  }

  // Whether the queued step can be taken; its footstep.
  StepState step_to(const Node& node, GaitdFootstep* step) const {
    const SolePlace& sole = *node.sole;
    return steps_.make(sole.side, Footholds::pose_of(sole.place, sole.foothold),
                       stance_of(node.parent), stands(node.parent, sole.side), parameters_, step);
  }

  void begin(double inflation) {
    queue_ = {};
    nodes_.clear();
    ++search_;
    order_ = 0;
    frontier_.reset();
    for (int stance = 0; stance < GAITD_MAX_FEET; ++stance) {
      if (start_.first_side == stance) continue;  // it has to step, not to stand
      push({&soles_->start(stance), 0.0, -1, false}, inflation);
    }
  }

  // The soles of the goal may be reached in many ways; `beyond` is at the place of its parent.
  bool is_closed(const Node& node) const {
    return !node.goal && !node.beyond && node.sole->closed_in == search_;
  }

  // False: no way with a cost below that of the best so far.
  bool search(double inflation, int budget) {
    begin(inflation);
    bool found = false;
    while (!queue_.empty() && !spent(budget)) {
      const Node node = queue_.top().node;
      queue_.pop();
      if (is_closed(node) || node.cost >= best_cost_) continue;
      if (node.beyond) {
        best_cost_ = node.cost;
        take(node.parent);
        partial_ = found = true;
        break;
      }
      GaitdFootstep step;
      if (node.parent >= 0) {
        const StepState state = step_to(node, &step);
        tally_.count(state);
        if (state != StepState::kGood) continue;
        if (const double more = node.weighed
                                    ? 0.0
                                    : swing_cost(step, stands(node.parent, node.sole->side),
                                                 steps_.unit(), parameters_);
            more > 0.0) {
          Node weighed = node;
          weighed.weighed = true;
          weighed.cost += more;
          push(weighed, inflation);
          continue;
        }
      }
      node.sole->closed_in = search_;
      nodes_.push_back(node);
      const int at = static_cast<int>(nodes_.size()) - 1;
      if (node.goal && nodes_[node.parent].goal) {
        best_cost_ = node.cost;
        take(at);
        partial_ = false;
        found = true;
        break;
      }
      expand(at, inflation);
    }
    // Out of expansions: as far as the best of what was reached.
    if (!found && best_.empty() && frontier_) {
      take(frontier_->node);
      const Node& last = nodes_[frontier_->node];
      best_cost_ = last.cost + kBeyond * last.sole->estimate;
      partial_ = true;
    }
    return found;
  }

  void expand(int at, double inflation) {
    ++expansions_;
    const SolePlace& from = *nodes_[at].sole;
    const double distance = std::hypot(goal_.x - from.place.x, goal_.y - from.place.y);
    if (distance < nearest_) {
      nearest_ = distance;
      nearest_place_ = from.place;
      tally_ = {};
    }
    const int side = other_side(from.side);
    if (goal_known_) add_goal(at, side, inflation);
    if (nodes_[at].goal) return;
    const bool explore = lattice_.options_.explore && !is_start(at);
    std::optional<Place> onwards;  // over ground that is not known
    double least = 0.0;            // of the ways on there
    if (explore) {
      least = from.way - kLeadsOn * steps_.unit() * lattice_.per_metre_;
    }
    const double outwards = side_sign(side);
    const double c = std::cos(from.place.yaw), s = std::sin(from.place.yaw);
    for (const Stride& stride : lattice_.strides_) {
      const double y = outwards * stride.outwards;
      SolePlace& sole = soles_->nearest(
          side, {from.place.x + c * stride.ahead - s * y, from.place.y + s * stride.ahead + c * y,
                 from.place.yaw + outwards * stride.turn * kHeading});
      if (sole.closed_in == search_) continue;
      tally_.count(sole.foothold.state);
      if (sole.foothold.state == FootholdState::kGood) {
        add({&sole, stride.cost, at, false}, inflation);
      }
      if (sole.foothold.state == FootholdState::kUnknown && explore && sole.way < least) {
        least = sole.way;
        onwards = sole.place;
      }
    }
    if (onwards) add_beyond(at, *onwards, inflation);
  }

  // The way ends here for now, and goes on over ground that is seen from here, best by who looks
  // there: with its back to it the robot would see no more of it.
  void add_beyond(int at, const Place& onwards, double inflation) {
    const Node& node = nodes_[at];
    const Place& place = node.sole->place;
    const bool known = std::any_of(exhausted_.begin(), exhausted_.end(), [&](const auto& p) {
      return std::hypot(p.x() - place.x, p.y() - place.y) < kSameEnd * steps_.unit();
    });
    if (known) return;
    const double towards = std::atan2(onwards.y - place.y, onwards.x - place.x) - place.yaw;
    const double there = node.sole->estimate + std::abs(wrapped(towards)) / kHeading;
    Node beyond = node;
    beyond.parent = at;
    beyond.cost = node.cost + kBeyond * there;
    beyond.beyond = true;
    const double rank = beyond.cost + (inflation - 1.0) * there;
    if (!frontier_ || rank < frontier_->rank) frontier_ = {rank, at, expansions_};
    queue_.push({rank, order_++, beyond});
  }

  // The last footstep but one, or the last one. How the first of the two is reached decides whether
  // the second can be taken, so that there may be many of it.
  void add_goal(int at, int side, double inflation) {
    const Place& from = nodes_[at].sole->place;
    SolePlace& goal = soles_->goal(side);
    const Place& place = goal.place;
    const double unit = steps_.unit();
    const double c = std::cos(from.yaw), s = std::sin(from.yaw);
    const double dx = place.x - from.x, dy = place.y - from.y;
    const double ahead = (c * dx + s * dy) / unit;
    const double outwards =
        (side_sign(side) * (c * dy - s * dx) - steps_.model().nominal_foot_separation) / unit;
    const double turn = side_sign(side) * wrapped(place.yaw - from.yaw) / kHeading;
    if (!is_goal_stride(ahead, outwards, turn)) return;
    add({&goal, stride_cost(ahead, outwards, std::abs(turn)), at, true}, inflation);
  }

  void add(Node node, double inflation) {
    const Node& from = nodes_[node.parent];
    const Foothold& foothold = node.sole->foothold;
    const double height = foothold.z - from.sole->foothold.z;
    if (std::abs(height) > steps_.highest_step()) {
      tally_.count(StepState::kReach);
      return;
    }
    node.cost += from.cost + foothold.cost + height_cost(height / steps_.unit());
    if (node.cost < best_cost_) push(node, inflation);
  }

  void take(int last) {
    best_.clear();
    for (int at = last; !is_start(at); at = nodes_[at].parent) {
      best_.emplace_back();
      step_to(nodes_[at], &best_.back());
    }
    std::reverse(best_.begin(), best_.end());
  }

  std::string why_not() const {
    std::string text = queue_.empty() ? "no way"
                                      : "no way found in " + std::to_string(expansions_) +
                                            " expansions (goto.expansions)";
    char place[160];
    std::snprintf(place, sizeof(place), " to (%.2f, %.2f): footsteps get as far as (%.2f, %.2f); ",
                  goal_.x, goal_.y, nearest_place_.x, nearest_place_.y);
    const std::string reasons = tally_.text();
    return text + place +
           (reasons.empty() ? "nothing leads on from there" : "beyond it: " + reasons);
  }

  const Lattice& lattice_;
  const StepMaker& steps_;
  const Start& start_;
  const walking::GaitParameters& parameters_;
  const std::span<const Eigen::Vector2d> exhausted_;
  const double cell_;  // m
  Place goal_;
  bool goal_known_ = true;
  bool partial_ = false;  // best_ ends where the map does
  std::optional<Frontier> frontier_;

  std::priority_queue<Queued> queue_;
  std::uint32_t order_ = 0;
  std::vector<Node> nodes_;  // that were expanded
  std::optional<SoleTable> soles_;
  int search_ = 0;  // 1: the first
  int expansions_ = 0;
  double best_cost_ = std::numeric_limits<double>::infinity();
  std::vector<GaitdFootstep> best_;
  double nearest_ = std::numeric_limits<double>::infinity();  // m, to the goal
  Place nearest_place_;
  Tally tally_;  // since it came so near
};

Plan Lattice::plan(const Start& start, const Goal& goal,
                   const walking::GaitParameters& parameters) {
  steps_->set_level(start);
  Search search(*this, start, goal, parameters);
  Plan plan = search.run();
  if (plan.refusal.empty()) steps_->finish(start, parameters, &plan);
  return plan;
}

}  // namespace gaitd::footsteps
