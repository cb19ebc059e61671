// SPDX-License-Identifier: Apache-2.0
// Cost of what one control tick asks of the model, on Atlas.
#include <benchmark/benchmark.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

#include "gaitd/dynamics/dynamics.h"
#include "gaitd/dynamics/urdf.h"

namespace gaitd::dynamics {
namespace {

const UrdfResult& atlas() {
  static const UrdfResult result = [] {
    UrdfResult loaded = load_urdf(GAITD_ATLAS_URDF);
    for (const std::string& error : loaded.errors) std::fprintf(stderr, "%s\n", error.c_str());
    if (!loaded.ok()) std::exit(1);
    return loaded;
  }();
  return result;
}

struct State {
  Eigen::Vector3d p_WP;
  Eigen::Quaterniond R_WP;
  Vector6d V_P;
  Eigen::VectorXd q, qd;
};

// A few states in turn, so that no branch or cache favours one of them.
std::array<State, 16> make_states(int joints) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto draw = [&](auto* v) {
    for (Eigen::Index i = 0; i < v->size(); ++i) (*v)[i] = uniform(random);
  };
  std::array<State, 16> states;
  for (State& s : states) {
    Eigen::Vector4d x;
    s.q.resize(joints);
    s.qd.resize(joints);
    draw(&s.p_WP), draw(&x), draw(&s.V_P), draw(&s.q), draw(&s.qd);
    s.R_WP = Eigen::Quaterniond(x).normalized();
  }
  return states;
}

class Tick {
 public:
  Tick() : dynamics(atlas().model), states(make_states(dynamics.joint_count())) {
    for (const char* name : {"pelvis", "utorso", "l_foot", "r_foot", "head"}) {
      frames.push_back(atlas().find_link(name)->body);
      jacobians.emplace_back(Matrix6X::Zero(6, dynamics.velocity_size()));
    }
  }

  void update() {
    const State& s = states[next++ % states.size()];
    dynamics.update(s.p_WP, s.R_WP, s.V_P, s.q, s.qd);
  }

  void query_frames() {
    for (std::size_t k = 0; k < frames.size(); ++k) {
      dynamics.frame_jacobian(frames[k], point, jacobians[k]);
      benchmark::DoNotOptimize(jacobians[k].data());
      benchmark::DoNotOptimize(dynamics.frame_bias_acceleration(frames[k], point));
    }
  }

  Dynamics dynamics;
  std::array<State, 16> states;
  std::vector<int> frames;
  std::vector<Matrix6X> jacobians;
  Eigen::Vector3d point = Eigen::Vector3d(0.04, 0.0, -0.08);
  std::size_t next = 0;
};

// M, c, A, Adot v, com, and J, Jdot v of five frames.
void BM_Everything(benchmark::State& state) {
  Tick tick;
  for (auto _ : state) {
    tick.update();
    tick.query_frames();
    benchmark::ClobberMemory();
  }
}
BENCHMARK(BM_Everything);

void BM_Update(benchmark::State& state) {
  Tick tick;
  for (auto _ : state) {
    tick.update();
    benchmark::ClobberMemory();
  }
}
BENCHMARK(BM_Update);

void BM_KinematicsUpdate(benchmark::State& state) {
  Tick tick;
  Kinematics kinematics(atlas().model);
  for (auto _ : state) {
    const State& s = tick.states[tick.next++ % tick.states.size()];
    kinematics.update(s.p_WP, s.R_WP, s.V_P, s.q, s.qd);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(BM_KinematicsUpdate);

void BM_FiveFrames(benchmark::State& state) {
  Tick tick;
  tick.update();
  for (auto _ : state) {
    tick.query_frames();
    benchmark::ClobberMemory();
  }
}
BENCHMARK(BM_FiveFrames);

void BM_InverseDynamics(benchmark::State& state) {
  Tick tick;
  tick.update();
  const Eigen::VectorXd vdot = Eigen::VectorXd::Ones(tick.dynamics.velocity_size());
  Eigen::VectorXd tau = vdot;
  for (auto _ : state) {
    tick.dynamics.inverse_dynamics(vdot, {}, tau);
    benchmark::DoNotOptimize(tau.data());
    benchmark::ClobberMemory();
  }
}
BENCHMARK(BM_InverseDynamics);

// With the update, because the first call after it factorises M.
void BM_UpdateAndForwardDynamics(benchmark::State& state) {
  Tick tick;
  const Eigen::VectorXd tau = Eigen::VectorXd::Ones(tick.dynamics.velocity_size());
  Eigen::VectorXd vdot = tau;
  for (auto _ : state) {
    tick.update();
    tick.dynamics.forward_dynamics(tau, {}, vdot);
    benchmark::DoNotOptimize(vdot.data());
    benchmark::ClobberMemory();
  }
}
BENCHMARK(BM_UpdateAndForwardDynamics);

}  // namespace
}  // namespace gaitd::dynamics

BENCHMARK_MAIN();
