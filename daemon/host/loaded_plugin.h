// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/host/instance.h"
#include "daemon/host/library_image.h"
#include "daemon/host/plugin_file.h"
#include "daemon/host/probe.h"
#include "daemon/host/refusal.h"
#include "gaitd/abi/backend.h"
#include "gaitd/abi/plugin.h"

namespace gaitd::daemon {

/// Takes what a plugin logs: GAITD_LOG_* level, "layer/variant", text. Called on any thread that
/// calls a plugin function tagged [main].
using PluginLog = std::function<void(int level, std::string_view plugin, std::string_view message)>;

/// The library behind an instance. That of a layer is unloaded with it; that of a backend stays,
/// since nothing is known of the threads that talk to hardware.
class PluginLibrary {
 public:
  /// Maps it (see LibraryImage) and compares the descriptor in memory with that of the file.
  static std::unique_ptr<PluginLibrary> load(PluginFile file, const GaitdModel& model,
                                             const ProbeOptions* probe_options, PluginLog log,
                                             Refusal* refusal);
  ~PluginLibrary();
  PluginLibrary(const PluginLibrary&) = delete;
  PluginLibrary& operator=(const PluginLibrary&) = delete;

  const GaitdPluginDescriptor& descriptor() const { return descriptor_; }
  const std::filesystem::path& path() const { return path_; }  ///< as asked for, not the copy
  const std::string& hash() const { return hash_; }            ///< see PluginFile::hash
  int generation() const { return generation_; }               ///< counts loads of this process
  const GaitdHost* host() const { return &host_; }
  void* handle() const { return image_->handle(); }  ///< of dlopen

 private:
  PluginLibrary() = default;
  static void forward_log(void* context, int32_t level, const char* message);

  std::filesystem::path path_;
  GaitdPluginDescriptor descriptor_{};
  std::string hash_;
  std::string name_;  // layer/variant
  int generation_ = 0;
  std::unique_ptr<LibraryImage> image_;
  PluginLog log_;
  GaitdHost host_{};
};

/// One initialised and active instance of a control layer.
class LoadedLayer {
 public:
  struct Request {
    std::filesystem::path path;
    int layer = GAITD_LAYER_STATE_ESTIMATOR;
    const GaitdModel* model = nullptr;
    std::vector<double> parameters;  ///< in the order of the table; empty: the defaults
    bool probe = true;
    ProbeOptions probe_options;
    PluginLog log;  ///< may be empty
  };

  /// Checks, probes, loads, creates, initialises and activates. Not on the real-time thread. On
  /// refusal returns null and `refusal` says all reasons; nothing of it stays in memory.
  static std::unique_ptr<LoadedLayer> load(const Request& request, Refusal* refusal);
  /// The same with a file that was read before; the path of the request is not looked at.
  static std::unique_ptr<LoadedLayer> load(PluginFile file, const Request& request,
                                           Refusal* refusal);
  ~LoadedLayer();
  LoadedLayer(const LoadedLayer&) = delete;
  LoadedLayer& operator=(const LoadedLayer&) = delete;

  const PluginLibrary& library() const { return *library_; }
  const GaitdPluginDescriptor& descriptor() const { return library_->descriptor(); }

  // The functions of the instance; the structs are those of the layer. An exception that a plugin
  // lets out ends here as GAITD_EXCEPTION. [rt]
  GaitdStatus process(const void* input, void* output) {
    return contained([&] { return vtable_->process(self_, input, output); });
  }
  GaitdStatus reset() {
    return contained([&] { return vtable_->reset(self_); });
  }
  GaitdStatus get_state(void* state) {
    return contained([&] { return vtable_->get_state(self_, state); });
  }
  GaitdStatus set_state(const void* state) {
    return contained([&] { return vtable_->set_state(self_, state); });
  }
  GaitdStatus set_parameter(uint32_t index, double value) {
    return contained([&] { return vtable_->set_parameter(self_, index, value); });
  }
  /// Null if the plugin has no such extension. [main]
  const void* get_extension(const char* id) {
    return vtable_->get_extension == nullptr ? nullptr : vtable_->get_extension(self_, id);
  }

 private:
  LoadedLayer(std::unique_ptr<PluginLibrary> library, const GaitdInstance& instance)
      : library_(std::move(library)), self_(instance.self), vtable_(instance.vtable) {}

  std::unique_ptr<PluginLibrary> library_;
  void* self_;
  const GaitdLayerVtable* vtable_;
  bool active_ = false;
};

/// One instance of a backend; init and start are left to the caller, through the vtable.
class LoadedBackend {
 public:
  struct Request {
    std::filesystem::path path;
    const GaitdModel* model = nullptr;
    bool probe = true;
    ProbeOptions probe_options;
    PluginLog log;  ///< may be empty
  };

  static std::unique_ptr<LoadedBackend> load(const Request& request, Refusal* refusal);
  ~LoadedBackend();  ///< destroys; the caller has stopped it
  LoadedBackend(const LoadedBackend&) = delete;
  LoadedBackend& operator=(const LoadedBackend&) = delete;

  const PluginLibrary& library() const { return *library_; }
  const GaitdPluginDescriptor& descriptor() const { return library_->descriptor(); }
  const GaitdBackendInstance& instance() const { return instance_; }

  /// Calls init. Empty if it went well, else its errors, one per line, with the backend's name.
  std::string init(const GaitdModel& model, const std::string& config_json, double period,
                   int clock);

 private:
  LoadedBackend(std::unique_ptr<PluginLibrary> library, const GaitdBackendInstance& instance)
      : library_(std::move(library)), instance_{instance.self, &vtable_} {
    std::memcpy(&vtable_, instance.vtable,
                std::min<std::size_t>(instance.vtable->size, sizeof(vtable_)));
  }

  std::unique_ptr<PluginLibrary> library_;
  GaitdBackendVtable vtable_{};  // what an older backend does not have is null
  GaitdBackendInstance instance_;
};

}  // namespace gaitd::daemon
