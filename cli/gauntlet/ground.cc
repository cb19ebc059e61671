// SPDX-License-Identifier: Apache-2.0
#include "cli/gauntlet/ground.h"

#include <algorithm>
#include <cmath>

namespace gaitd::cli {
namespace {

constexpr double kHalfFoot = 0.1302;  // m, sole frame to toe and heel
constexpr double kEdge = 0.005;       // m, at least between a sole and the edge of its tread
constexpr double kWidth = 2.0;        // m, of all ground, across
constexpr double kBehind = 1.0;       // m of ground behind the robot
constexpr double kAhead = 2.0;        // m of ground beyond the last foothold

// Ground with its top at `height`, from one place to another, and as wide as between `right` and
// `left`.
Box ground(double from, double to, double right, double left, double height) {
  return {0.5 * (from + to), 0.5 * (right + left), 0.5 * height, to - from, left - right, height};
}
Box platform(double from, double to, double height) {
  return ground(from, to, -0.5 * kWidth, 0.5 * kWidth, height);
}

class Footholds {
 public:
  Footholds(const Draws& draws, Story* story)
      : story_(story), left_(draws.coin("first")), y_(draws.between("width", 0.22, 0.28) / 2) {}

  void add(double x, double z, double roll = 0.0, double pitch = 0.0) {
    story_->footholds.push_back({left_, x, left_ ? y_ : -y_, z, roll, pitch});
    left_ = !left_;
  }
  bool left() const { return left_; }  ///< the foot of the next one
  double y() const { return left_ ? y_ : -y_; }

  // Both feet side by side, where the last one stands.
  void end() {
    const Foothold last = story_->footholds.back();
    add(last.x, last.z);
    story_->goal_x = last.x;
    story_->steps = static_cast<int>(story_->footholds.size());
  }

 private:
  Story* story_;
  bool left_;
  double y_;
};

// A foot on each of these heights in turn, every one `length` behind the one before; edges lie
// halfway. Both feet stand on the first height in the beginning.
void walk_over(const Draws& draws, const std::vector<double>& heights, double length,
               Story* story) {
  const double play = std::min(0.02, 0.5 * length - kHalfFoot - kEdge);
  Footholds footholds(draws, story);
  story->start_z = heights.front();
  double from = -kBehind;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const auto place = static_cast<int>(i);
    const double x = length * (place + 1);
    footholds.add(x + draws.between("foothold", -play, play, place), heights[i]);
    const bool last = i + 1 == heights.size();
    if (!last && heights[i + 1] == heights[i]) continue;
    const double to = last ? x + kAhead : x + 0.5 * length;
    if (heights[i] > 0.0) story->boxes.push_back(platform(from, to, heights[i]));
    from = to;
  }
  footholds.end();
}

}  // namespace

Story stairs(const Draws& draws, bool up) {
  Story story;
  story.swing = draws.between("swing", 0.8, 1.0);
  story.transfer = draws.between("transfer", 0.25, 0.35);
  const double rise = draws.between("rise", 0.10, 0.20);
  const double tread = draws.between("tread", 0.29, 0.38);
  const int count = draws.whole("count", 3, 5);
  const int before = draws.whole("before", 1, 2);
  std::vector<double> heights;
  for (int i = 1 - before; i <= count + 1; ++i) {
    const int level = std::clamp(i, 0, count);
    heights.push_back(rise * (up ? level : count - level));
  }
  walk_over(draws, heights, tread, &story);
  return story;
}

Story drops(const Draws& draws) {
  Story story;
  story.swing = draws.between("swing", 0.7, 0.9);
  story.transfer = draws.between("transfer", 0.25, 0.35);
  const double length = draws.between("length", 0.30, 0.40);
  const int count = draws.whole("count", 2, 3);
  double height = 0.0;
  std::vector<double> heights;
  // From the end: how far it still goes down from each ledge.
  for (int i = 0; i <= count; ++i) {
    if (i > 0) height += draws.between("drop", 0.10, 0.20, i);
    heights.insert(heights.begin(), static_cast<std::size_t>(draws.whole("between", 1, 3, i)),
                   height);
  }
  heights.push_back(0.0);
  walk_over(draws, heights, length, &story);
  return story;
}

Story slope(const Draws& draws, bool up) {
  constexpr double kThick = 0.2;    // m, of the board
  constexpr double kBeside = 0.17;  // m, from a foothold to the nearest bend
  Story story;
  story.swing = draws.between("swing", 0.7, 0.9);
  story.transfer = draws.between("transfer", 0.25, 0.35);
  const double angle = draws.between("angle", 3.0, 13.0) * kRadiansPerDegree;
  const double length = draws.between("length", 0.22, 0.34);
  const int count = draws.whole("count", 4, 7);
  const double first = draws.between("approach", 0.25, 0.35);
  const double bottom = first + kBeside;  // where the board begins
  const double run = 2.0 * kBeside + length * (count - 1);
  const double rise = run * std::tan(angle);
  const double pitch = up ? -angle : angle;
  const double start = up ? 0.0 : rise;
  const double end = rise - start;
  story.start_z = start;
  // The middle of the surface, and the board below it.
  story.boxes.push_back({bottom + 0.5 * run - 0.5 * kThick * std::sin(pitch), 0.0,
                         0.5 * rise - 0.5 * kThick * std::cos(pitch), run / std::cos(angle), kWidth,
                         kThick, 0.0, pitch});
  if (up) {
    story.boxes.push_back(platform(bottom + run, bottom + run + kAhead, rise));
  } else {
    story.boxes.push_back(platform(-kBehind, bottom, rise));
  }
  Footholds footholds(draws, &story);
  footholds.add(first, start);
  for (int i = 0; i < count; ++i) {
    const double x = bottom + kBeside + length * i;
    footholds.add(x, start - (x - bottom) * std::tan(pitch), 0.0, pitch);
  }
  footholds.add(bottom + run + kBeside, end);
  footholds.add(bottom + run + kBeside + length, end);
  footholds.end();
  return story;
}

Story blocks(const Draws& draws) {
  constexpr double kSize = 0.4, kThick = 0.15;  // m
  constexpr double kBase = 0.3;                 // m, so that no block is in the ground
  constexpr double kGap = 0.02;                 // m, between the field and the ground around it
  Story story;
  story.swing = draws.between("swing", 0.9, 1.1);
  story.transfer = draws.between("transfer", 0.3, 0.4);
  const double layer = draws.between("layer", 0.08, 0.15);
  const int rows = draws.whole("rows", 3, 4);
  const int trend = draws.whole("trend", -1, 1);  // the field goes down, up and down, or up
  const double first = draws.between("approach", 0.25, 0.35);
  int level = trend < 0 ? rows + 1 : trend == 0 ? 1 : 0;
  const auto height = [&] { return kBase + layer * level; };

  Footholds footholds(draws, &story);
  story.start_z = height();
  const double field = first + 0.5 * kSize;  // where it begins
  story.boxes.push_back(platform(-kBehind, field - kGap, height()));
  footholds.add(first, height());
  footholds.add(first, height());
  for (int row = 0; row < rows; ++row) {
    const int change = trend == 0 ? draws.whole("change", -1, 1, row)
                                  : trend * std::min(1, draws.whole("change", 0, 2, row));
    level = std::max(0, level + change);
    const double x = field + kSize * (row + 0.5);
    for (int foot = 0; foot < 2; ++foot) {
      const int block = 2 * row + foot;
      const double tilt = draws.between("tilt", 5.0, 15.0, block) * kRadiansPerDegree *
                          draws.sign("tilt/sign", block);
      const bool rolls = draws.coin("tilt/axis", block);
      const double roll = rolls ? tilt : 0.0, pitch = rolls ? 0.0 : tilt;
      const double y = footholds.left() ? 0.5 * kSize : -0.5 * kSize;
      story.boxes.push_back({x - 0.5 * kThick * std::sin(pitch), y + 0.5 * kThick * std::sin(roll),
                             height() - 0.5 * kThick * std::cos(tilt), kSize, kSize, kThick, roll,
                             pitch});
      footholds.add(x, height() + (footholds.y() - y) * std::tan(roll), roll, pitch);
    }
  }
  if (trend < 0 && draws.coin("last")) --level;
  const double beyond = field + kSize * rows + kGap;
  story.boxes.push_back(platform(beyond, beyond + kAhead, height()));
  footholds.add(beyond + 0.5 * kSize, height());
  footholds.end();
  return story;
}

Story unknown_steps(const Draws& draws) {
  constexpr double kLowest = -0.10, kHighest = 0.04;  // m, against the height of the start
  constexpr double kChange = 0.05;                    // m, from one step to the next
  constexpr double kBase = 0.2;                       // m, height of the start
  Story story;
  story.swing = draws.between("swing", 0.6, 0.8);
  story.transfer = draws.between("transfer", 0.2, 0.3);
  const double length = draws.between("length", 0.32, 0.40);
  const int count = 10;
  story.start_z = kBase;
  story.boxes.push_back(platform(-kBehind, 0.5 * length, kBase));
  double height = 0.0;
  for (int i = 1; i <= count; ++i) {
    height = draws.between("height", std::max(kLowest, height - kChange),
                           std::min(kHighest, height + kChange), i);
    const double to = i < count ? length * (i + 0.5) : length * i + kAhead;
    story.boxes.push_back(platform(length * (i - 0.5), to, kBase + height));
  }
  story.walk = {count, length, 0.0, draws.between("width", 0.22, 0.28), 0.0, draws.coin("first")};
  story.goal_x = length * count;
  story.steps = count;
  return story;
}

Story partial_footholds(const Draws& draws) {
  constexpr double kBase = 0.12;  // m, of the ground above the bottom of the pits
  constexpr double kHalfWidth = 0.5 * kWidth;
  constexpr double kSlit = 0.02;   // m, beside a pit, that is left out
  constexpr double kFirst = 0.32;  // m, to the first foothold
  const auto lane = [](double from, double to, bool left, double inner, double outer) {
    return left ? ground(from, to, inner, outer, kBase) : ground(from, to, -outer, -inner, kBase);
  };
  constexpr double kPit[] = {0.17, 0.12};   // m, of a half and around it
  constexpr double kSole[] = {0.40, 0.24};  // m, of a whole sole and around it
  Story story;
  story.swing = draws.between("swing", 0.6, 0.8);
  story.transfer = draws.between("transfer", 0.25, 0.35);
  const double length = draws.between("length", 0.25, 0.40);
  constexpr int kCount = 9;
  story.start_z = kBase;
  Footholds footholds(draws, &story);
  double beginning[] = {-kBehind, -kBehind};  // of the ground that is still to be laid, by side
  for (int i = 0; i < kCount; ++i) {
    const double x = kFirst + length * i, y = footholds.y();
    const bool left = footholds.left();
    const double out = left ? 1.0 : -1.0;
    double& from = beginning[left ? 0 : 1];
    footholds.add(x, kBase);
    // Not the first one, nor where the feet come to stand.
    if (i == 0 || i + 2 >= kCount || !draws.coin("partial", i)) continue;
    const int axis = draws.whole("axis", 0, 1, i);  // 0: heel or toe, 1: inner or outer half
    const double side = draws.sign("side", i);
    double middle[] = {x, y}, size[] = {kSole[0], kSole[1]};
    size[axis] = kPit[axis];
    middle[axis] += 0.5 * side * size[axis];
    const double near = middle[0] - 0.5 * size[0], far = middle[0] + 0.5 * size[0];
    const double inner = out * middle[1] - 0.5 * size[1];
    const double outer = out * middle[1] + 0.5 * size[1];
    story.boxes.push_back(lane(from, near, left, 0.0, kHalfWidth));
    if (inner > kSlit) story.boxes.push_back(lane(near, far, left, 0.0, inner));
    story.boxes.push_back(lane(near, far, left, outer, kHalfWidth));
    from = far;
  }
  for (const int side : {0, 1}) {
    const double end = kFirst + length * (kCount - 1) + kAhead;
    story.boxes.push_back(lane(beginning[side], end, side == 0, 0.0, kHalfWidth));
  }
  footholds.end();
  return story;
}

}  // namespace gaitd::cli
