// SPDX-License-Identifier: Apache-2.0
#include "lattice.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <queue>
#include <unordered_set>
#include <utility>

#include "angle.h"
#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"
#include "goal_place.h"
#include "step_costs.h"

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

// One problem.
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
    if (lattice_.way_) lattice_.way_->lead_to({goal_.x, goal_.y});
    int budget = lattice_.options_.expansions;
    for (const double inflation : kInflations) {
      if (!search(inflation, budget)) break;
      budget = std::min(lattice_.options_.expansions,
                        std::max(kImprove * expansions_, expansions_ + kLeastImprove));
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
  Place goal_place(int side) const { return sole_beside(goal_, side, steps_.model()); }

  Foothold look(int side, const Place& place) const {
    return steps_.footholds().at(side, place, walking::kMaxStepTilt);
  }

  // False: there is no place for the feet at the goal, or near it.
  bool find_goal(std::string* refusal) {
    const Place wanted = goal_;
    const GoalPlace found = find_goal_place(steps_, wanted, cell_);
    goal_ = found.middle;
    goal_footholds_ = found.footholds;
    // What is not known cannot be good yet: on the way there more of it will be seen.
    goal_known_ = found.found;
    const bool later = found.problem == FootholdState::kUnknown && lattice_.options_.explore;
    if (!found.found && !later) *refusal = no_goal_place(wanted, found.problem);
    return found.found || later;
  }

  double estimate(const Node& node) const {
    const Place& p = node.place;
    const Place end = goal_place(node.side);
    const double distance = std::hypot(end.x - p.x, end.y - p.y);
    const double turn = std::abs(wrapped(end.yaw - p.yaw));
    // Each step takes one foot on, past the other one; the turn goes on meanwhile.
    return std::max(
        {lattice_.per_metre_ * distance, way_from(node.side, p), turn / (1.5 * kHeading)});
  }

  // Of the middle of the feet, if the other one stood beside that one.
  double way_from(int side, const Place& sole) const {
    if (!lattice_.way_) return 0.0;
    const Place middle = sole_beside(sole, other_side(side), steps_.model());
    return lattice_.way_->from({middle.x, middle.y});
  }

  std::uint64_t key_of(int side, int i, int j, int heading) const {
    return (static_cast<std::uint64_t>(i + (1 << 24)) << 32) ^
           (static_cast<std::uint64_t>(j + (1 << 24)) << 6) ^
           static_cast<std::uint64_t>(heading << 1 | side);
  }

  const Foothold& foothold(std::uint64_t key, int side, const Place& place) {
    const auto [entry, fresh] = footholds_.try_emplace(key);
    if (fresh) entry->second = look(side, place);
    return entry->second;
  }

  void push(Node node, double inflation) {
    const double rank = node.cost + inflation * estimate(node);
    queue_.push({rank, order_++, std::move(node)});
  }

  GaitdPose pose_of(int node) const {
    return Footholds::pose_of(nodes_[node].place, nodes_[node].foothold);
  }
  // Where the foot of `side` stands when `node`, of the other foot, is the last footstep.
  GaitdPose stands(int node, int side) const {
    const int before = nodes_[node].parent;
    return before < 0 || is_start(before) ? start_.feet[side] : pose_of(before);
  }
  bool is_start(int node) const { return nodes_[node].parent < 0; }
  GaitdPose stance_of(int node) const {
    return is_start(node) ? start_.feet[nodes_[node].side] : pose_of(node);
  }

  // Whether the queued step can be taken; its footstep.
  StepState step_to(const Node& node, GaitdFootstep* step) const {
    return steps_.make(node.side, Footholds::pose_of(node.place, node.foothold),
                       stance_of(node.parent), stands(node.parent, node.side), parameters_, step);
  }

  void begin(double inflation) {
    queue_ = {};
    nodes_.clear();
    closed_.clear();
    order_ = 0;
    frontier_.reset();
    for (int stance = 0; stance < GAITD_MAX_FEET; ++stance) {
      if (start_.first_side == stance) continue;  // it has to step, not to stand
      const GaitdPose& foot = start_.feet[stance];
      Node node{
          stance,
          {foot.position[0], foot.position[1], sdk::yaw_of(sdk::quaternion(foot.orientation))},
          ~std::uint64_t{0} - static_cast<std::uint64_t>(stance),
          {},
          -1,
          0.0,
          false};
      node.foothold.z = foot.position[2];
      push(node, inflation);
    }
  }

  // False: no way with a cost below that of the best so far.
  bool search(double inflation, int budget) {
    begin(inflation);
    bool found = false;
    while (!queue_.empty() && expansions_ < budget) {
      const Node node = queue_.top().node;
      queue_.pop();
      if (closed_.contains(node.key) || node.cost >= best_cost_) continue;
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
        if (const double more = node.weighed ? 0.0
                                             : swing_cost(step, stands(node.parent, node.side),
                                                          steps_.unit(), parameters_);
            more > 0.0) {
          Node weighed = node;
          weighed.weighed = true;
          weighed.cost += more;
          push(std::move(weighed), inflation);
          continue;
        }
      }
      closed_.insert(node.key);
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
      take(frontier_->second);
      best_cost_ = nodes_[frontier_->second].cost + kBeyond * estimate(nodes_[frontier_->second]);
      partial_ = true;
    }
    return found;
  }

  void expand(int at, double inflation) {
    ++expansions_;
    const Node node = nodes_[at];
    const double distance = std::hypot(goal_.x - node.place.x, goal_.y - node.place.y);
    if (distance < nearest_) {
      nearest_ = distance;
      nearest_place_ = node.place;
      tally_ = {};
    }
    const int side = other_side(node.side);
    if (goal_known_) add_goal(at, side, inflation);
    if (node.goal) return;
    const bool explore = lattice_.options_.explore && !is_start(at);
    std::optional<Place> onwards;  // over ground that is not known
    double least = 0.0;            // of the ways on there
    if (explore) {
      least = way_from(node.side, node.place) - kLeadsOn * steps_.unit() * lattice_.per_metre_;
    }
    const double outwards = side_sign(side);
    const double c = std::cos(node.place.yaw), s = std::sin(node.place.yaw);
    for (const Stride& stride : lattice_.strides_) {
      const double y = outwards * stride.outwards;
      const double x = node.place.x + c * stride.ahead - s * y - goal_.x;
      const double v = node.place.y + s * stride.ahead + c * y - goal_.y;
      const double yaw = node.place.yaw + outwards * stride.turn * kHeading - goal_.yaw;
      const int i = static_cast<int>(std::lround(x / cell_));
      const int j = static_cast<int>(std::lround(v / cell_));
      int heading = static_cast<int>(std::lround(yaw / kHeading)) % kHeadings;
      if (heading < 0) heading += kHeadings;
      const std::uint64_t key = key_of(side, i, j, heading);
      if (closed_.contains(key)) continue;
      const Place place{goal_.x + cell_ * i, goal_.y + cell_ * j,
                        wrapped(goal_.yaw + heading * kHeading)};
      const Foothold& found = foothold(key, side, place);
      tally_.count(found.state);
      if (found.state == FootholdState::kGood) {
        add({side, place, key, found, at, stride.cost, false}, inflation);
      }
      if (found.state == FootholdState::kUnknown && explore) {
        if (const double way = way_from(side, place); way < least) {
          least = way;
          onwards = place;
        }
      }
    }
    if (onwards) add_beyond(at, *onwards, inflation);
  }

  // The way ends here for now, and goes on over ground that is seen from here, best by who looks
  // there: with its back to it the robot would see no more of it.
  void add_beyond(int at, const Place& onwards, double inflation) {
    const Node& node = nodes_[at];
    const bool known = std::any_of(exhausted_.begin(), exhausted_.end(), [&](const auto& p) {
      return std::hypot(p.x() - node.place.x, p.y() - node.place.y) < kSameEnd * steps_.unit();
    });
    if (known) return;
    const double towards =
        std::atan2(onwards.y - node.place.y, onwards.x - node.place.x) - node.place.yaw;
    const double there = estimate(node) + std::abs(wrapped(towards)) / kHeading;
    Node beyond = node;
    beyond.key = (std::uint64_t{1} << 62) + static_cast<std::uint64_t>(at);
    beyond.parent = at;
    beyond.cost = node.cost + kBeyond * there;
    beyond.beyond = true;
    const double rank = beyond.cost + (inflation - 1.0) * there;
    if (!frontier_ || rank < frontier_->first) frontier_ = {rank, at};
    queue_.push({rank, order_++, std::move(beyond)});
  }

  // The last footstep but one, or the last one. How the first of the two is reached decides whether
  // the second can be taken, so that there may be many of it.
  void add_goal(int at, int side, double inflation) {
    const Node& node = nodes_[at];
    const Place place = goal_place(side);
    const double unit = steps_.unit();
    const double c = std::cos(node.place.yaw), s = std::sin(node.place.yaw);
    const double dx = place.x - node.place.x, dy = place.y - node.place.y;
    const double ahead = (c * dx + s * dy) / unit;
    const double outwards =
        (side_sign(side) * (c * dy - s * dx) - steps_.model().nominal_foot_separation) / unit;
    const double turn = side_sign(side) * wrapped(place.yaw - node.place.yaw) / kHeading;
    if (!is_goal_stride(ahead, outwards, turn)) return;
    const std::uint64_t key = node.goal ? ~std::uint64_t{0} - 2
                                        : (std::uint64_t{1} << 63) + static_cast<std::uint64_t>(at);
    add({side, place, key, goal_footholds_[static_cast<std::size_t>(side)], at,
         stride_cost(ahead, outwards, std::abs(turn)), true},
        inflation);
  }

  void add(Node node, double inflation) {
    const Node& from = nodes_[node.parent];
    const double height = node.foothold.z - from.foothold.z;
    if (std::abs(height) > steps_.highest_step()) {
      tally_.count(StepState::kReach);
      return;
    }
    node.cost += from.cost + node.foothold.cost + height_cost(height / steps_.unit());
    if (node.cost < best_cost_) push(std::move(node), inflation);
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
  std::array<Foothold, GAITD_MAX_FEET> goal_footholds_;
  bool goal_known_ = true;
  bool partial_ = false;                            // best_ ends where the map does
  std::optional<std::pair<double, int>> frontier_;  // rank and node, where the map ends

  std::priority_queue<Queued> queue_;
  std::uint32_t order_ = 0;
  std::vector<Node> nodes_;  // that were expanded
  std::unordered_set<std::uint64_t> closed_;
  std::unordered_map<std::uint64_t, Foothold> footholds_;
  int expansions_ = 0;
  double best_cost_ = std::numeric_limits<double>::infinity();
  std::vector<GaitdFootstep> best_;
  double nearest_ = std::numeric_limits<double>::infinity();  // m, to the goal
  Place nearest_place_;
  Tally tally_;  // since it came so near
};

Plan Lattice::plan(const Start& start, const Goal& goal,
                   const walking::GaitParameters& parameters) {
  Search search(*this, start, goal, parameters);
  Plan plan = search.run();
  if (plan.refusal.empty()) steps_->finish(start, parameters, &plan);
  return plan;
}

}  // namespace gaitd::footsteps
