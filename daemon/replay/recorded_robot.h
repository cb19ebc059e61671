// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "daemon/config/robot.h"
#include "daemon/config/settings.h"
#include "daemon/control/pipeline.h"
#include "daemon/host/plugin_directory.h"
#include "daemon/host/plugin_file.h"
#include "daemon/parameters/live_parameters.h"
#include "daemon/replay/replay.h"

namespace gaitd::daemon {

/// The control pipeline as a log tells that it was at tick 0: robot, settings, layers, parameters.
class RecordedRobot {
 public:
  /// Null with what is missing in `error`. `notes`: what is not as it was, such as another build.
  static std::unique_ptr<RecordedRobot> load(const LogReader& log, const ReplayOptions& options,
                                             std::vector<std::string>* notes, std::string* error);

  /// The layer of a swap event, as an order; layer -1: it is left out, since the layer is another
  /// one by --set.
  bool load_swap(const nlohmann::json& event, SwapOrder* order, std::string* error);

  Pipeline& pipeline() { return *pipeline_; }
  LiveParameters& parameters() { return parameters_; }
  const GaitdModel& model() const { return robot_.model; }
  bool arms_itself() const { return arms_itself_; }

 private:
  explicit RecordedRobot(const ReplayOptions& options)
      : directory_(options.plugin_folders), trust_(options.trust) {}
  bool read_robot(const LogReader& log, std::string* error);
  bool read_settings(const LogReader& log, const ReplayOptions& options, std::string* error);
  int variant_word(int layer, const std::string& variant) const;
  bool load_layers(const nlohmann::json& plugins, LayerChain::Layers* layers, std::string* error);
  std::optional<PluginFile> find_recorded(int layer, const nlohmann::json& recorded,
                                          std::string* error) const;
  std::optional<PluginFile> find_wanted(int layer, const std::string& variant,
                                        std::string* error) const;
  std::unique_ptr<LoadedLayer> load_layer(int layer, const std::optional<PluginFile>& library,
                                          const std::vector<double>* values, int* table,
                                          std::string* error);

  PluginDirectory directory_;
  bool arms_itself_ = false;
  bool trust_ = false;  // of the paths that the log names
  Settings settings_;
  Robot robot_;
  LiveParameters parameters_;
  std::vector<std::string>* notes_ = nullptr;
  std::array<std::vector<std::string>, GAITD_LAYER_COUNT> words_;  // of layer/<layer>/variant
  std::unique_ptr<Pipeline> pipeline_;
};

}  // namespace gaitd::daemon
