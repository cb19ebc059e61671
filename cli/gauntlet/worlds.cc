// SPDX-License-Identifier: Apache-2.0
#include "cli/gauntlet/worlds.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace gaitd::cli {
namespace {

constexpr double kBase = 0.3;       // m, of the walkway above the floor of the pit
constexpr double kHalfWidth = 1.2;  // m, of the walkway
constexpr double kBetween = 0.7;    // m of walkway before, between and behind the obstacles

class Course {
 public:
  Course(const Draws& draws, double difficulty, Story* story)
      : draws_(draws), difficulty_(difficulty), story_(story) {}

  double end() const { return x_; }

  void level(double length) {
    platform(x_, x_ + length, kBase);
    x_ += length;
  }
  void add(int kind, int place) {
    place_ = 100 * place;
    using Obstacle = void (Course::*)();
    constexpr Obstacle kObstacles[] = {&Course::doorway, &Course::pillars, &Course::kerb,
                                       &Course::stairs,  &Course::ramps,   &Course::blocks,
                                       &Course::stones,  &Course::rubble};
    static_assert(std::size(kObstacles) == kKinds);
    const Obstacle obstacle = kObstacles[kind];
    (this->*obstacle)();
  }
  static constexpr int kKinds = 8;

 private:
  double between(const char* what, double low, double high, int i = 0) const {
    return draws_.between(what, low, high, place_ + i);
  }
  int whole(const char* what, int low, int high, int i = 0) const {
    return draws_.whole(what, low, high, place_ + i);
  }
  void box(const Box& box) { story_->boxes.push_back(box); }
  void platform(double from, double to, double height) {
    box({0.5 * (from + to), 0.0, 0.5 * height, to - from, 2.0 * kHalfWidth, height});
  }

  void doorway() {
    constexpr double kThick = 0.15, kHigh = 1.2;  // m
    const double door = 1.6 - 0.4 * difficulty_ + between("door", -0.1, 0.1);
    const double y = between("door/y", -0.25, 0.25);
    const double length = 0.5;
    const double x = x_ + 0.5 * length;
    level(length);
    for (const auto& [from, to] :
         {std::pair{-kHalfWidth, y - 0.5 * door}, {y + 0.5 * door, kHalfWidth}}) {
      box({x, 0.5 * (from + to), kBase + 0.5 * kHigh, kThick, to - from, kHigh});
    }
  }

  void pillars() {
    const int count = 1 + static_cast<int>(std::lround(2.0 * difficulty_));
    const double first = draws_.sign("pillar/side", place_);
    const double apart = 1.0;  // m, along the way
    const double begin = x_ + 0.4;
    level(0.8 + apart * (count - 1));
    for (int i = 0; i < count; ++i) {
      const double size = between("pillar/size", 0.25, 0.45, i);
      const double high = between("pillar/high", 0.4, 1.0, i);
      const double side = i % 2 == 0 ? first : -first;
      box({begin + apart * i, side * between("pillar/y", 0.5, 0.9, i), kBase + 0.5 * high, size,
           size, high});
    }
  }

  void kerb() {
    const double rise = 0.05 + 0.13 * difficulty_ + between("kerb", -0.02, 0.02);
    const double length = between("kerb/length", 0.5, 1.2);
    platform(x_, x_ + length, kBase + rise);
    x_ += length;
  }

  // Up and down again, no step as high as another.
  void stairs() {
    const int count = whole("stairs", 2, 3);
    std::vector<double> heights;
    double height = kBase;
    for (int i = 0; i < count; ++i) {
      height += 0.05 + 0.1 * difficulty_ + between("stairs/rise", -0.03, 0.03, i);
      heights.push_back(height);
    }
    for (int i = count - 1; i-- > 0;) {
      heights.push_back(heights[static_cast<std::size_t>(i)] +
                        between("stairs/uneven", -0.02, 0.02, i));
    }
    for (std::size_t i = 0; i < heights.size(); ++i) {
      const bool top = static_cast<int>(i) == count - 1;
      const double tread = top ? 0.7 : between("stairs/tread", 0.32, 0.45, static_cast<int>(i));
      platform(x_, x_ + tread, heights[i]);
      x_ += tread;
    }
  }

  // A board up, a gap, and a board down.
  void ramps() {
    constexpr double kThick = 0.2;  // m
    const double angle = (4.0 + 8.0 * difficulty_ + between("ramp", -1.0, 1.0)) * kRadiansPerDegree;
    const double run = between("ramp/run", 0.9, 1.2);
    const double rise = run * std::tan(angle);
    const double gap = 0.04 + 0.1 * difficulty_;
    for (const double pitch : {-angle, angle}) {
      box({x_ + 0.5 * run - 0.5 * kThick * std::sin(pitch), 0.0,
           kBase + 0.5 * rise - 0.5 * kThick * std::cos(pitch), run / std::cos(angle),
           2.0 * kHalfWidth, kThick, 0.0, pitch});
      x_ += run;
      if (pitch > 0.0) break;
      x_ += gap;
      platform(x_, x_ + 0.5, kBase + rise);
      x_ += 0.5;
    }
  }

  void blocks() {
    constexpr double kSize = 0.4, kThick = 0.15;  // m
    constexpr int kColumns = 6;
    const int rows = whole("blocks/rows", 3, 4);
    const double layer = 0.04 + 0.08 * difficulty_;
    platform(x_, x_ + kSize * rows, 0.5 * kBase);  // below them
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < kColumns; ++j) {
        const int place = kColumns * i + j;
        const bool edge = i == 0 || i == rows - 1;
        const double z = kBase + layer * whole("blocks/level", 0, edge ? 1 : 2, place);
        const bool tilted = between("blocks/tilted", 0.0, 1.0, place) < 0.6 * difficulty_;
        const double tilt = tilted ? between("blocks/tilt", 4.0, 12.0, place) * kRadiansPerDegree *
                                         draws_.sign("blocks/sign", place_ + place)
                                   : 0.0;
        const bool rolls = draws_.coin("blocks/axis", place_ + place);
        const double roll = rolls ? tilt : 0.0, pitch = rolls ? 0.0 : tilt;
        const double y = kSize * (j - 0.5 * (kColumns - 1));
        box({x_ + kSize * (i + 0.5) - 0.5 * kThick * std::sin(pitch),
             y + 0.5 * kThick * std::sin(roll), z - 0.5 * kThick * std::cos(tilt), kSize, kSize,
             kThick, roll, pitch});
      }
    }
    x_ += kSize * rows;
  }

  void stones() {
    constexpr int kColumns = 5;
    const int rows = whole("stones/rows", 2, 3);
    const double gap = 0.04 + 0.12 * difficulty_;
    const double size = 2.0 * kHalfWidth / kColumns - gap;
    x_ += gap;
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < kColumns; ++j) {
        const int place = kColumns * i + j;
        const double height = kBase + 0.06 * difficulty_ * between("stones", -1.0, 1.0, place);
        const double y = (size + gap) * (j - 0.5 * (kColumns - 1));
        box({x_ + 0.5 * size, y, 0.5 * height, size, size, height});
      }
      x_ += size + gap;
    }
  }

  void rubble() {
    const int count = 10 + static_cast<int>(std::lround(30.0 * difficulty_));
    const double length = 1.4;
    for (int i = 0; i < count; ++i) {
      const double high = 0.02 + (0.02 + 0.06 * difficulty_) * between("rubble/high", 0.0, 1.0, i);
      Box stone{x_ + between("rubble/x", 0.1, length - 0.1, i),
                between("rubble/y", -1.1, 1.1, i),
                kBase + 0.5 * high,
                between("rubble/length", 0.06, 0.2, i),
                between("rubble/width", 0.06, 0.2, i),
                high};
      stone.yaw = between("rubble/yaw", -1.57, 1.57, i);
      box(stone);
    }
    level(length);
  }

  const Draws& draws_;
  const double difficulty_;
  Story* story_;
  double x_ = -1.0;
  int place_ = 0;
};

}  // namespace

Story world(const Draws& draws, double difficulty) {
  constexpr double kTimePerMetre = 14.0;  // s
  Story story;
  story.start_z = kBase;
  Course course(draws, difficulty, &story);
  course.level(1.0 + kBetween);
  const int count = std::clamp(
      static_cast<int>(std::lround(1.0 + 2.0 * difficulty + draws.between("count", -0.4, 0.4))), 1,
      3);
  int last = -1;
  for (int i = 0; i < count; ++i) {
    int kind = draws.whole("kind", 0, Course::kKinds - 1, i);
    if (kind == last) kind = (kind + 1) % Course::kKinds;
    last = kind;
    course.add(kind, i);
    course.level(kBetween);
  }
  const double end = course.end();
  course.level(1.0);
  story.sees = true;
  story.at = 1.5;
  story.goal_x = end;
  story.goal_y = draws.between("goal/y", -0.4, 0.4);
  story.goal_yaw = draws.between("goal/yaw", -0.5, 0.5);
  story.goes = true;
  story.tolerance = 0.15;
  story.time = 20.0 + kTimePerMetre * end;
  story.steps = 4;
  story.more_steps = true;
  return story;
}

}  // namespace gaitd::cli
