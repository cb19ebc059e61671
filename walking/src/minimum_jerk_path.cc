// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/minimum_jerk_path.h"

#include <Eigen/LU>
#include <algorithm>

namespace gaitd::walking {
namespace {

// Of a quintic of length h, by its ends: jerk and snap are linear in velocity and acceleration
// there (matrices) and in the distance it covers (vector).
struct Ends {
  Eigen::Matrix2d from_start, from_end;
  Eigen::Vector2d from_distance;
};

Ends at_start(double h) {
  Ends e;
  e.from_start << -36.0 / (h * h), -9.0 / h, 192.0 / (h * h * h), 36.0 / (h * h);
  e.from_end << -24.0 / (h * h), 3.0 / h, 168.0 / (h * h * h), -24.0 / (h * h);
  e.from_distance << 60.0 / (h * h * h), -360.0 / (h * h * h * h);
  return e;
}

Ends at_end(double h) {
  Ends e;
  e.from_start << -24.0 / (h * h), -3.0 / h, -168.0 / (h * h * h), -24.0 / (h * h);
  e.from_end << -36.0 / (h * h), 9.0 / h, -192.0 / (h * h * h), 36.0 / (h * h);
  e.from_distance << 60.0 / (h * h * h), 360.0 / (h * h * h * h);
  return e;
}

}  // namespace

// Jerk and snap are the same on both sides of every inner point: a block-tridiagonal system for
// velocity and acceleration there, with blocks of two rows.
void MinimumJerkPath::begin(const Sample& start, const double* times, const Axes* values,
                            int count) {
  using Rows = Eigen::Matrix<double, 2, kMaxAxes>;
  count_ = std::clamp(count, 0, kMaxPoints);
  times_[0] = 0.0;
  knots_[0] = start;
  if (count_ == 0) {
    knots_[0].velocity.setZero();
    knots_[0].acceleration.setZero();
  }
  for (int i = 1; i <= count_; ++i) {
    times_[i] = times[i - 1];
    knots_[i] = {};
    knots_[i].value = values[i - 1];
  }
  std::array<Eigen::Matrix2d, kMaxPoints> upper;  // after elimination
  std::array<Rows, kMaxPoints> right;
  for (int i = 1; i < count_; ++i) {
    const Ends before = at_end(times_[i] - times_[i - 1]);
    const Ends after = at_start(times_[i + 1] - times_[i]);
    const Axes& here = knots_[i].value;
    Eigen::Matrix2d diagonal = before.from_end - after.from_start;
    Rows rest = after.from_distance * (knots_[i + 1].value - here).transpose() -
                before.from_distance * (here - knots_[i - 1].value).transpose();
    if (i == 1) {
      Rows given;
      given << start.velocity.transpose(), start.acceleration.transpose();
      rest -= before.from_start * given;
    } else {
      diagonal -= before.from_start * upper[i - 1];
      rest -= before.from_start * right[i - 1];
    }
    const Eigen::Matrix2d inverse = diagonal.inverse();
    upper[i] = inverse * -after.from_end;
    right[i] = inverse * rest;
  }
  Rows next = Rows::Zero();  // at rest at the last point
  for (int i = count_ - 1; i >= 1; --i) {
    next = right[i] - upper[i] * next;
    knots_[i].velocity = next.row(0).transpose();
    knots_[i].acceleration = next.row(1).transpose();
  }
}

MinimumJerkPath::Sample MinimumJerkPath::at(double t) const {
  if (t >= times_[count_]) return knots_[count_];
  int i = 0;
  while (t >= times_[i + 1]) ++i;
  const double h = times_[i + 1] - times_[i];
  const double s = (t - times_[i]) / h;
  const Sample& a = knots_[i];
  const Sample& b = knots_[i + 1];
  // In units of the length of the quintic.
  const Axes v0 = h * a.velocity, a0 = 0.5 * h * h * a.acceleration;
  const Axes x = b.value - a.value - v0 - a0;
  const Axes v = h * b.velocity - v0 - 2.0 * a0;
  const Axes w = h * h * b.acceleration - 2.0 * a0;
  const Axes c3 = 10.0 * x - 4.0 * v + 0.5 * w;
  const Axes c4 = -15.0 * x + 7.0 * v - w;
  const Axes c5 = 6.0 * x - 3.0 * v + 0.5 * w;
  Sample out;
  out.value = a.value + s * (v0 + s * (a0 + s * (c3 + s * (c4 + s * c5))));
  out.velocity = (v0 + s * (2.0 * a0 + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)))) / h;
  out.acceleration = (2.0 * a0 + s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5))) / (h * h);
  return out;
}

}  // namespace gaitd::walking
