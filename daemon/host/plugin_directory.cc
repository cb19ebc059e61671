// SPDX-License-Identifier: Apache-2.0
#include "daemon/host/plugin_directory.h"

#include <set>
#include <system_error>

#include "daemon/host/layers.h"
#include "daemon/host/plugin_file.h"

namespace gaitd::daemon {
namespace {

constexpr int kAllLayers[] = {GAITD_LAYER_STATE_ESTIMATOR,       GAITD_LAYER_ICP_PLANNER,
                              GAITD_LAYER_STEP_ADJUSTER,         GAITD_LAYER_TOE_OFF,
                              GAITD_LAYER_WHOLE_BODY_CONTROLLER, GAITD_LAYER_BACKEND};

bool is_path(const std::string& variant) {
  return variant.find('/') != std::string::npos || variant.ends_with(".so");
}

std::optional<std::filesystem::path> find_in(const std::vector<std::filesystem::path>& roots,
                                             int layer, const std::string& variant) {
  std::error_code ignored;
  for (const std::filesystem::path& root : roots) {
    const auto path = root / layer_name(layer) / (variant + ".so");
    if (std::filesystem::is_regular_file(path, ignored)) return path;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::filesystem::path> PluginDirectory::find(int layer, const std::string& variant,
                                                           std::string* error) const {
  std::error_code ignored;
  if (is_path(variant)) {
    if (std::filesystem::is_regular_file(variant, ignored)) return variant;
    *error = variant + ": no such file; give the path of a plugin library, or a variant";
    return std::nullopt;
  }
  if (auto path = find_in(roots_, layer, variant)) return path;
  *error = "no variant '" + variant + "' of " + std::string(layer_name(layer)) + " in";
  for (const std::filesystem::path& root : roots_) *error += ' ' + root.string();
  if (roots_.empty()) *error += " any folder, since none is configured";
  *error += "; there is:";
  const std::vector<std::string> there = variants(layer);
  for (const std::string& name : there) *error += ' ' + name;
  if (there.empty()) *error += " none";
  return std::nullopt;
}

std::vector<std::string> PluginDirectory::variants(int layer) const {
  std::set<std::string> names;
  for (const std::filesystem::path& root : roots_) {
    std::error_code error;
    for (std::filesystem::directory_iterator it(root / layer_name(layer), error), end;
         !error && it != end; it.increment(error)) {
      if (it->path().extension() == ".so") names.insert(it->path().stem().string());
    }
  }
  return {names.begin(), names.end()};
}

std::vector<PluginEntry> PluginDirectory::list() const {
  std::vector<PluginEntry> entries;
  for (const int layer : kAllLayers) {
    for (const std::string& variant : variants(layer)) {
      const auto path = find_in(roots_, layer, variant);
      if (!path) continue;
      PluginEntry entry;
      entry.path = *path;
      entry.layer = layer;
      entry.variant = variant;
      if (const auto file = read_plugin_file(*path, layer, &entry.refusal)) {
        entry.descriptor = file->descriptor;
        if (variant != file->descriptor.id) {
          entry.descriptor.reset();
          entry.refusal.add("id", file->descriptor.id, variant + ", as the file is called",
                            "rename the file or the variant");
        }
      }
      entries.push_back(std::move(entry));
    }
  }
  return entries;
}

}  // namespace gaitd::daemon
