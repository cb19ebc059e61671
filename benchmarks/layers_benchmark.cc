// SPDX-License-Identifier: Apache-2.0
// Layers on the recorded walks: the projector, the whole-body controller and the step adjuster, and
// what a call of a plugin costs.
#include <algorithm>
#include <filesystem>
#include <memory>

#include "daemon/config/paths.h"
#include "daemon/host/loaded_plugin.h"
#include "gaitd/sdk/layer.h"
#include "measure.h"
#include "never.h"
#include "nullspace_qp.h"
#include "recorded_ticks.h"
#include "step_plan.h"
#include "walking/test/atlas.h"

namespace gaitd::benchmarks {
namespace {

using plugins::InverseDynamicsQp;
using testing::atlas;

constexpr GaitdLayerTime kTime{0, 0.0, 0.001};

template <class Layer>
std::unique_ptr<Layer> make_layer() {
  auto layer = std::make_unique<Layer>(atlas());
  for (std::size_t i = 0; i < Layer::kParameters.size(); ++i) {
    layer->set_parameter(static_cast<int>(i), Layer::kParameters[i].default_value);
  }
  return layer;
}

// All tasks of a tick, then the rows of the joints that are pulled straight.
void projector(benchmark::State& state, const std::string& walk) {
  const auto ticks = read_walk(walk);
  const int joints = atlas().joint_count;
  InverseDynamicsQp qp(atlas());
  plugins::NullSpaceProjector projector(6 + joints, InverseDynamicsQp::kMaxRows);
  Eigen::VectorXd row(6 + joints);
  const sdk::Parameters<plugins::NullspaceQp::P> defaults{plugins::NullspaceQp::kParameters};
  const auto limits = InverseDynamicsQp::limits_of(defaults);
  std::vector<double> least(ticks.size(), 1e9);
  for (auto _ : state) {
    const double before = calibration();
    // begin() fills the tasks and is no part of it, so each tick is repeated on its own.
    for (std::size_t k = 0; k < ticks.size(); ++k) {
      const GaitdObjectives& o = ticks[k].objectives;
      qp.begin(ticks[k].robot, o, o.momentum_mask, limits);
      least[k] = least_of_five(
          1, [] {},
          [&](int) {
            projector.clear();
            qp.claim(o, projector);
            projector.compute(0.005);
            for (int i = 0; i < joints; ++i) {
              if (o.privileged_weight[i] > 0.0) projector.row(6 + i, row);
            }
            benchmark::DoNotOptimize(row.data());
          })[0];
    }
    show(state, distribution(least), before);
  }
}

// Thirty-five dense task rows, none of them of a single joint.
void dense_projector(benchmark::State& state) {
  plugins::NullSpaceProjector projector(36, 35);
  const Eigen::MatrixXd rows = Eigen::MatrixXd::Random(35, 36);
  measure(
      state, 100, [] {},
      [&](int) {
        projector.clear();
        for (int r = 0; r < 35; ++r) projector.add(rows.row(r));
        projector.compute(0.005);
        benchmark::DoNotOptimize(projector.trace());
      });
}

void whole_body_controller(benchmark::State& state, const std::string& walk) {
  const auto ticks = read_walk(walk);
  const auto layer = make_layer<plugins::NullspaceQp>();
  const auto out = std::make_unique<GaitdWholeBodyControllerOutput>();
  measure(
      state, static_cast<int>(ticks.size()), [&] { layer->reset(); },
      [&](int k) {
        const RecordedTick& t = ticks[k];
        layer->process({sizeof(GaitdWholeBodyControllerInput), 0, kTime, &t.robot, &t.gait,
                        &t.toe_off, &t.objectives},
                       *out);
      });
}

void step_adjuster(benchmark::State& state, const std::string& walk) {
  const auto ticks = read_walk(walk);
  const auto layer = make_layer<plugins::StepPlan>();
  GaitdStepAdjustment out{};
  measure(
      state, static_cast<int>(ticks.size()), [&] { layer->reset(); },
      [&](int k) {
        const RecordedTick& t = ticks[k];
        const GaitdToeOff& toe_off = ticks[std::max(k - 1, 0)].toe_off;  // one tick late
        layer->process(
            {sizeof(GaitdStepAdjusterInput), 0, kTime, &t.robot, &t.gait, &t.plan, &toe_off}, out);
      });
}

// The least layer that there is, called as gaitd calls it and called as a C++ object.
constexpr int kCalls = 1000;
const GaitdGaitState kGait{};
const GaitdToeOffInput kToeOffInput{
    sizeof(GaitdToeOffInput), 0, kTime, nullptr, &kGait, nullptr, nullptr};

void plugin_call(benchmark::State& state) {
  std::filesystem::path file;
  const daemon::Paths paths = daemon::Paths::detect();
  for (const auto& folder : paths.plugin_folders()) {
    if (std::filesystem::exists(folder / "toe_off/never.so")) file = folder / "toe_off/never.so";
  }
  daemon::LoadedLayer::Request request;
  request.path = file;
  request.layer = GAITD_LAYER_TOE_OFF;
  request.model = &atlas();
  daemon::Refusal refusal;
  const auto layer = daemon::LoadedLayer::load(request, &refusal);
  if (layer == nullptr) return state.SkipWithError(refusal.text().c_str());
  GaitdToeOff out{};
  measure(
      state, 100, [] {},
      [&](int) {
        for (int i = 0; i < kCalls; ++i) layer->process(&kToeOffInput, &out);
      },
      kCalls);
}

void direct_call(benchmark::State& state) {
  plugins::Never layer(atlas());
  GaitdToeOff out{};
  measure(
      state, 100, [] {},
      [&](int) {
        for (int i = 0; i < kCalls; ++i) {
          layer.process(kToeOffInput, out);
          benchmark::DoNotOptimize(out);
        }
      },
      kCalls);
}

}  // namespace

void add_layer_benchmarks() {
  add("projector/35x36", dense_projector);
  for (const char* walk : kRecordedWalks) {
    const std::string name = walk;
    add("projector/" + name, [name](benchmark::State& s) { projector(s, name); });
    add("whole_body_controller/" + name,
        [name](benchmark::State& s) { whole_body_controller(s, name); });
    add("step_adjuster/" + name, [name](benchmark::State& s) { step_adjuster(s, name); });
  }
  add("plugin_call", plugin_call);
  add("plugin_call/direct", direct_call);
}

}  // namespace gaitd::benchmarks
