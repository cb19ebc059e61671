// SPDX-License-Identifier: Apache-2.0
#include "walk_problems.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "nullspace_qp.h"
#include "recorded_problems.h"
#include "walking/test/atlas.h"

namespace gaitd::benchmarks {
namespace {

qp::testing::OwnedProblem copy(const qp::Problem& p) {
  const auto matrix = [](const qp::MatrixView& m) {
    return Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>(
        m.data(), m.rows(), m.cols(),
        Eigen::OuterStride<>(m.cols() > 1 ? m.column(1) - m.data() : m.rows()));
  };
  using qp::testing::to_vector;
  qp::testing::OwnedProblem out;
  out.H = matrix(p.H);
  out.g = to_vector(p.g);
  out.A = matrix(p.A);
  out.b = to_vector(p.b);
  out.C = matrix(p.C);
  out.l = to_vector(p.l);
  out.u = to_vector(p.u);
  out.lb = to_vector(p.lb);
  out.ub = to_vector(p.ub);
  return out;
}

// Torque rows at a limit, per problem; negative when one cannot be solved.
double torques_at_limit(const QpSequence& problems) {
  qp::DenseSolver solver(kMaxProblem);
  long active = 0;
  for (const auto& problem : problems) {
    const qp::Result result = solver.solve(problem.view());
    if (!result.solved()) return -1.0;
    active += std::count_if(result.active.inequalities.begin(), result.active.inequalities.end(),
                            [](qp::Side side) { return side != qp::Side::none; });
  }
  return static_cast<double>(active) / static_cast<double>(problems.size());
}

}  // namespace

QpSequence recorded_problems(const std::string& name) {
  QpSequence problems;
  for (auto& recorded : qp::testing::read_recorded(name)) {
    problems.push_back(std::move(recorded.problem));
  }
  return problems;
}

QpSequence walk_problems(const std::string& walk, double torque_scale) {
  using plugins::NullspaceQp;
  const auto layer = std::make_unique<NullspaceQp>(testing::atlas());
  for (std::size_t i = 0; i < NullspaceQp::kParameters.size(); ++i) {
    const bool scale = static_cast<NullspaceQp::P>(i) == NullspaceQp::P::kTorqueScale;
    layer->set_parameter(static_cast<int>(i),
                         scale ? torque_scale : NullspaceQp::kParameters[i].default_value);
  }
  QpSequence problems;
  auto out = std::make_unique<GaitdWholeBodyControllerOutput>();
  for (const RecordedTick& tick : read_walk(walk)) {
    const GaitdWholeBodyControllerInput in{
        sizeof(in), 0, {0, 0.0, 0.001}, &tick.robot, &tick.gait, &tick.toe_off, &tick.objectives};
    layer->process(in, *out);
    problems.push_back(copy(layer->problem().problem()));
  }
  return problems;
}

void scale_torque_limits(double scale, QpSequence* problems) {
  for (auto& problem : *problems) {
    for (Eigen::Index row = 0; row < problem.l.size(); ++row) {
      if (!std::isfinite(problem.l[row])) continue;  // of the forces together
      const double middle = 0.5 * (problem.l[row] + problem.u[row]);
      const double half = 0.5 * scale * (problem.u[row] - problem.l[row]);
      problem.l[row] = middle - half;
      problem.u[row] = middle + half;
    }
  }
}

double binding_scale(const QpSequence& problems) {
  for (double scale = 1.0; scale > 0.02; scale *= 0.95) {
    QpSequence scaled = problems;
    scale_torque_limits(scale, &scaled);
    const double active = torques_at_limit(scaled);
    if (active < 0.0) return 0.0;
    if (active >= 1.0) return scale;
  }
  return 0.0;
}

}  // namespace gaitd::benchmarks
