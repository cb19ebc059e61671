// SPDX-License-Identifier: Apache-2.0
#include "daemon/host/loaded_plugin.h"

#include <dlfcn.h>

#include <atomic>
#include <cstring>
#include <optional>
#include <utility>

#include "daemon/host/instance.h"
#include "daemon/host/layers.h"
#include "daemon/host/parameters.h"

namespace gaitd::daemon {
namespace {

std::atomic<int> generations{0};

void refuse_start(const std::string& what, const std::string& error, Refusal* refusal) {
  refusal->add(what, error, "success", "see the plugin's log for its reason");
}

}  // namespace

void PluginLibrary::forward_log(void* context, int32_t level, const char* message) {
  const auto* library = static_cast<const PluginLibrary*>(context);
  if (library == nullptr || message == nullptr || !library->log_) return;
  try {
    library->log_(level, library->name_, message);
  } catch (...) {
    // A log that fails is no reason to unwind through the plugin.
  }
}

std::unique_ptr<PluginLibrary> PluginLibrary::load(PluginFile file, const GaitdModel& model,
                                                   const ProbeOptions* probe_options, PluginLog log,
                                                   Refusal* refusal) {
  refusal->file = file.path.string();
  auto image = LibraryImage::map(file, model, probe_options, refusal);
  if (image == nullptr) return nullptr;
  const void* in_memory = dlsym(image->handle(), GAITD_PLUGIN_SYMBOL);
  if (in_memory == nullptr ||
      std::memcmp(in_memory, &file.descriptor, sizeof(file.descriptor)) != 0) {
    LibraryImage::release(std::move(image));
    refusal->add("descriptor", "other content in memory than in the file",
                 "constant data without pointers", "export the plugin with the macro of the SDK");
    return nullptr;
  }

  std::unique_ptr<PluginLibrary> library(new PluginLibrary);
  library->path_ = file.path;
  library->descriptor_ = file.descriptor;
  library->hash_ = file.hash();
  library->name_ = std::string(layer_name(file.descriptor.layer)) + "/" + file.descriptor.id;
  library->generation_ = ++generations;
  library->image_ = std::move(image);
  library->log_ = std::move(log);
  library->host_ = {sizeof(GaitdHost), GAITD_ABI_MAJOR, library.get(), &forward_log};
  return library;
}

PluginLibrary::~PluginLibrary() {
  if (descriptor_.layer == GAITD_LAYER_BACKEND) {
    LibraryImage::keep(std::move(image_));
  } else {
    LibraryImage::release(std::move(image_));
  }
}

std::unique_ptr<LoadedLayer> LoadedLayer::load(const Request& request, Refusal* refusal) {
  std::optional<PluginFile> file = read_plugin_file(request.path, request.layer, refusal);
  return file ? load(std::move(*file), request, refusal) : nullptr;
}

std::unique_ptr<LoadedLayer> LoadedLayer::load(PluginFile file, const Request& request,
                                               Refusal* refusal) {
  refusal->file = file.path.string();
  const GaitdPluginDescriptor& descriptor = file.descriptor;
  const std::vector<double> parameters =
      request.parameters.empty() ? default_parameters(descriptor) : request.parameters;
  if (parameters.size() != descriptor.parameter_count) {
    refusal->add("parameters", std::to_string(parameters.size()) + " values",
                 "one for each of its " + std::to_string(descriptor.parameter_count),
                 "resolve the values against the table of this library");
    return nullptr;
  }
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const std::string wrong = check_parameter(descriptor.parameters[i], parameters[i]);
    if (!wrong.empty()) {
      refusal->add(std::string("parameter ") + descriptor.parameters[i].name, wrong,
                   "a value in its range", "correct the configuration");
    }
  }
  if (!refusal->empty()) return nullptr;

  std::unique_ptr<PluginLibrary> library =
      PluginLibrary::load(std::move(file), *request.model,
                          request.probe ? &request.probe_options : nullptr, request.log, refusal);
  if (!library) return nullptr;
  std::string error;
  GaitdInstance instance{};
  if (!create_layer(library->handle(), *library->host(), &instance, &error)) {
    refuse_start("create", error, refusal);
    return nullptr;
  }
  std::unique_ptr<LoadedLayer> layer(new LoadedLayer(std::move(library), instance));
  if (!init_layer(instance, *request.model, parameters, &error)) {
    refuse_start("init", error, refusal);
    return nullptr;
  }
  if (!activate_layer(instance, &error)) {
    refuse_start("activate", error, refusal);
    return nullptr;
  }
  layer->active_ = true;
  return layer;
}

LoadedLayer::~LoadedLayer() {
  const GaitdInstance instance{self_, vtable_};
  std::string ignored;
  if (active_) deactivate_layer(instance, &ignored);
  destroy_instance(instance);
}

std::unique_ptr<LoadedBackend> LoadedBackend::load(const Request& request, Refusal* refusal) {
  std::optional<PluginFile> file = read_plugin_file(request.path, GAITD_LAYER_BACKEND, refusal);
  if (!file) return nullptr;
  std::unique_ptr<PluginLibrary> library =
      PluginLibrary::load(std::move(*file), *request.model,
                          request.probe ? &request.probe_options : nullptr, request.log, refusal);
  if (!library) return nullptr;
  std::string error;
  GaitdBackendInstance instance{};
  if (!create_backend(library->handle(), *library->host(), &instance, &error)) {
    refuse_start("create", error, refusal);
    return nullptr;
  }
  return std::unique_ptr<LoadedBackend>(new LoadedBackend(std::move(library), instance));
}

LoadedBackend::~LoadedBackend() { destroy_instance(instance_); }

std::string LoadedBackend::init(const GaitdModel& model, const std::string& config_json,
                                double period, int clock) {
  std::string text(16 * 1024, '\0');
  std::string failure;
  GaitdStatus status = GAITD_EXCEPTION;
  try {
    status = instance_.vtable->init(instance_.self, &model, config_json.c_str(), period, clock,
                                    text.data(), static_cast<std::uint32_t>(text.size()));
  } catch (...) {
    failure = "threw an exception across the C boundary";
  }
  if (status == GAITD_OK) return "";
  text.resize(std::strlen(text.c_str()));
  if (failure.empty()) failure = text.empty() ? "returned " + status_text(status) : text;
  return std::string("backend ") + descriptor().id + ": init: " + failure;
}

}  // namespace gaitd::daemon
