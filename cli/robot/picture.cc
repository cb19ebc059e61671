// SPDX-License-Identifier: Apache-2.0
#include "cli/robot/picture.h"

#include <algorithm>
#include <sstream>

#include "gaitd/sdk/views.h"

namespace gaitd::porting {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kHeight = 560.0;  // of a view, pixels
constexpr double kWidth = 380.0;
constexpr double kEdge = 40.0;

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  }
  return out;
}

// One projection: which of the axes goes to the right.
class View {
 public:
  View(double left, const Vector3d& right, double bottom, double scale, std::ostringstream* out)
      : left_(left), right_(right), bottom_(bottom), scale_(scale), out_(*out) {}

  Vector2d at(const Vector3d& p) const {
    return {left_ + 0.5 * kWidth + scale_ * p.dot(right_),
            kEdge + kHeight - scale_ * (p.z() - bottom_)};
  }
  void line(const Vector3d& a, const Vector3d& b, const char* color, double width) {
    const Vector2d p = at(a);
    const Vector2d q = at(b);
    out_ << format(
        "<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='%s' "
        "stroke-width='%.1f' stroke-linecap='round'/>\n",
        p.x(), p.y(), q.x(), q.y(), color, width);
  }
  void dot(const Vector3d& a, const char* color, double radius) {
    const Vector2d p = at(a);
    out_ << format("<circle cx='%.1f' cy='%.1f' r='%.1f' fill='%s'/>\n", p.x(), p.y(), radius,
                   color);
  }
  void frame(const Eigen::Isometry3d& X, double length, const std::string& name) {
    const Vector3d o = X.translation();
    line(o, o + length * X.linear().col(0), "#d33", 2);
    line(o, o + length * X.linear().col(1), "#2a2", 2);
    line(o, o + length * X.linear().col(2), "#36d", 2);
    const Vector2d p = at(o);
    out_ << format("<text x='%.1f' y='%.1f'>", p.x() + 6, p.y() - 6) << escaped(name)
         << "</text>\n";
  }

 private:
  double left_;
  Vector3d right_;
  double bottom_, scale_;
  std::ostringstream& out_;
};

Eigen::Isometry3d pose(const std::vector<Eigen::Isometry3d>& bodies, const GaitdFrame& frame) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translate(Vector3d(sdk::view(frame.origin)));
  X.rotate(sdk::quaternion(frame.orientation));
  return bodies[static_cast<std::size_t>(frame.body)] * X;
}

void draw(const Guess& guess, const std::vector<Eigen::Isometry3d>& bodies, double size,
          View* view) {
  const GaitdModel& model = guess.model;
  for (int i = 1; i < model.body_count; ++i) {
    const Vector3d from = bodies[static_cast<std::size_t>(model.bodies[i].parent)].translation();
    view->line(from, bodies[static_cast<std::size_t>(i)].translation(), "#777", 5);
  }
  Vector3d com = Vector3d::Zero();
  for (int i = 0; i < model.body_count; ++i) {
    const auto body = static_cast<std::size_t>(i);
    com += model.bodies[i].mass / model.total_mass * (bodies[body] * Vector3d(model.bodies[i].com));
    view->dot(bodies[body].translation(), "#333", 3);
  }
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdFoot& foot = model.feet[side];
    const Eigen::Isometry3d X = pose(bodies, foot.sole);
    for (int i = 0; i < foot.point_count; ++i) {
      const double* a = foot.points[i];
      const double* b = foot.points[(i + 1) % foot.point_count];
      view->line(X * Vector3d(a[0], a[1], 0), X * Vector3d(b[0], b[1], 0), "#c60", 3);
    }
    view->line(bodies[static_cast<std::size_t>(foot.body)].translation(), X.translation(), "#777",
               3);
    view->frame(X, 0.06 * size, side == GAITD_LEFT ? "left sole" : "right sole");
    if (foot.force_sensor.body >= 0) {
      view->frame(pose(bodies, foot.force_sensor), 0.03 * size, "");
    }
  }
  view->frame(bodies[0], 0.1 * size, "pelvis");
  for (int i = 0; i < model.imu_count; ++i)
    view->frame(pose(bodies, model.imus[i]), 0.05 * size, "IMU");
  const Vector3d sole = pose(bodies, model.feet[GAITD_LEFT].sole).translation();
  view->line(com, {com.x(), com.y(), sole.z()}, "#a0a", 1);
  view->dot(com, "#a0a", 6);
}

}  // namespace

std::string posture_picture(const Guess& guess) {
  const GaitdModel& model = guess.model;
  const auto bodies = body_poses(
      model, Eigen::Map<const Eigen::VectorXd>(model.nominal_position, model.joint_count));
  const double bottom = -model.nominal_pelvis_height;
  double top = 0.0;
  double wide = 0.1;
  for (const Eigen::Isometry3d& X : bodies) {
    top = std::max(top, X.translation().z());
    wide = std::max({wide, std::abs(X.translation().x()), std::abs(X.translation().y())});
  }
  const double size = std::max(top - bottom, 1e-3);
  const double scale = std::min(kHeight / (1.1 * size), 0.5 * kWidth / (1.1 * wide));
  std::ostringstream out;
  out << format(
      "<svg xmlns='http://www.w3.org/2000/svg' width='%.0f' height='%.0f' "
      "font-family='sans-serif' font-size='12'>\n<rect width='100%%' height='100%%' "
      "fill='white'/>\n",
      2 * kWidth, kHeight + 2 * kEdge);
  out << "<text x='12' y='22' font-size='15'>" << escaped(guess.name)
      << ": x red, y green, z blue; centre of mass violet</text>\n";
  const struct {
    const char* title;
    Vector3d right;
  } views[] = {{"from the right: forward is to the right", Vector3d::UnitX()},
               {"from behind: its left is at the left", -Vector3d::UnitY()}};
  for (int i = 0; i < 2; ++i) {
    const double left = i * kWidth;
    out << format("<line x1='%.0f' y1='%.0f' x2='%.0f' y2='%.0f' stroke='#bbb'/>\n", left + 10,
                  kEdge + kHeight, left + kWidth - 10, kEdge + kHeight);
    out << format("<text x='%.0f' y='%.0f'>%s</text>\n", left + 12, kHeight + 2 * kEdge - 14,
                  views[i].title);
    View view(left, views[i].right, bottom, scale, &out);
    draw(guess, bodies, size, &view);
  }
  out << "</svg>\n";
  return out.str();
}

}  // namespace gaitd::porting
