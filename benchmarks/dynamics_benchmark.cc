// SPDX-License-Identifier: Apache-2.0
// What one tick asks of the model, on the recorded states.
#include <memory>

#include "gaitd/dynamics/dynamics.h"
#include "gaitd/sdk/views.h"
#include "measure.h"
#include "recorded_ticks.h"
#include "walking/test/atlas.h"

namespace gaitd::benchmarks {
namespace {

using testing::atlas;

template <class Model>
void update(Model& model, const GaitdRobotState& robot) {
  const int joints = atlas().joint_count;
  model.update(robot);
}

// Five frames: pelvis, chest, feet and the last body.
class Frames {
 public:
  Frames()
      : bodies_{0, atlas().feet[0].body, atlas().feet[1].body, 1, atlas().body_count - 1},
        jacobian_(dynamics::Matrix6X::Zero(6, 6 + atlas().joint_count)) {}
  void query(dynamics::Dynamics& model) {
    for (int body : bodies_) {
      model.frame_jacobian(body, point_, jacobian_);
      benchmark::DoNotOptimize(jacobian_.data());
      benchmark::DoNotOptimize(model.frame_bias_acceleration(body, point_));
    }
  }

 private:
  const int bodies_[5];
  const Eigen::Vector3d point_{0.04, 0.0, -0.08};
  dynamics::Matrix6X jacobian_;
};

}  // namespace

void add_dynamics_benchmarks() {
  add("dynamics/kinematics", [](benchmark::State& state) {
    const auto ticks = read_walk("flat");
    dynamics::Kinematics kinematics(atlas());
    measure(
        state, static_cast<int>(ticks.size()), [] {},
        [&](int k) { update(kinematics, ticks[k].robot); });
  });
  // M, c, A, Adot v, com.
  add("dynamics/update", [](benchmark::State& state) {
    const auto ticks = read_walk("flat");
    dynamics::Dynamics dynamics(atlas());
    measure(
        state, static_cast<int>(ticks.size()), [] {},
        [&](int k) { update(dynamics, ticks[k].robot); });
  });
  // The same with J and Jdot v of five frames: all that a tick needs.
  add("dynamics/everything", [](benchmark::State& state) {
    const auto ticks = read_walk("flat");
    dynamics::Dynamics dynamics(atlas());
    Frames frames;
    measure(
        state, static_cast<int>(ticks.size()), [] {},
        [&](int k) {
          update(dynamics, ticks[k].robot);
          frames.query(dynamics);
        });
  });
}

}  // namespace gaitd::benchmarks
