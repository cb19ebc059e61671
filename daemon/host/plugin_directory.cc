// SPDX-License-Identifier: Apache-2.0
#include "daemon/host/plugin_directory.h"

#include <sys/stat.h>
#include <time.h>

#include <cstdlib>
#include <set>
#include <system_error>

#include "daemon/host/layers.h"
#include "daemon/host/plugin_file.h"

namespace gaitd::daemon {
namespace {

constexpr int kAllLayers[] = {
    GAITD_LAYER_STATE_ESTIMATOR, GAITD_LAYER_ICP_PLANNER,           GAITD_LAYER_STEP_ADJUSTER,
    GAITD_LAYER_TOE_OFF,         GAITD_LAYER_WHOLE_BODY_CONTROLLER, GAITD_LAYER_TASK_SOURCE,
    GAITD_LAYER_BACKEND};

std::optional<std::filesystem::path> find_in(const std::vector<std::filesystem::path>& roots,
                                             int layer, const std::string& variant) {
  std::error_code ignored;
  for (const std::filesystem::path& root : roots) {
    const auto path = root / layer_name(layer) / (variant + ".so");
    if (std::filesystem::is_regular_file(path, ignored)) return path;
  }
  return std::nullopt;
}

// What tells a file from itself after a change.
struct Stamp {
  dev_t device = 0;
  ino_t inode = 0;
  off_t size = 0;
  std::int64_t modified = 0;  // ns
  std::int64_t changed = 0;   // ns

  bool operator==(const Stamp&) const = default;
};

std::int64_t nanoseconds(const timespec& time) {
  return std::int64_t{1000000000} * time.tv_sec + time.tv_nsec;
}

std::optional<Stamp> stamp_of(const std::filesystem::path& path) {
  struct stat info {};
  if (stat(path.c_str(), &info) != 0) return std::nullopt;
  return Stamp{info.st_dev, info.st_ino, info.st_size, nanoseconds(info.st_mtim),
               nanoseconds(info.st_ctim)};
}

// A file that has just been changed may change again under the same stamp: file systems count in
// steps of up to 2 s.
bool is_settled(const Stamp& stamp) {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return std::abs(nanoseconds(now) - stamp.changed) > 2'000'000'000;
}

}  // namespace

struct PluginDirectory::Known {
  Stamp stamp;
  PluginEntry entry;
};

bool PluginDirectory::is_path(const std::string& variant) {
  return variant.find('/') != std::string::npos || variant.ends_with(".so");
}

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

PluginEntry PluginDirectory::describe(const std::filesystem::path& path, int layer,
                                      const std::string& variant) const {
  PluginEntry entry;
  entry.path = path;
  entry.layer = layer;
  entry.variant = variant;
  ++files_read_;
  if (const auto file = read_plugin_file(path, layer, &entry.refusal)) {
    entry.descriptor = file->descriptor;
    if (variant != file->descriptor.id) {
      entry.descriptor.reset();
      entry.refusal.add("id", file->descriptor.id, variant + ", as the file is called",
                        "rename the file or the variant");
    }
  }
  return entry;
}

std::vector<PluginEntry> PluginDirectory::list() const {
  const std::scoped_lock lock(mutex_);
  std::vector<PluginEntry> entries;
  std::map<std::string, std::shared_ptr<const Known>> there;  // what is gone is forgotten
  for (const int layer : kAllLayers) {
    for (const std::string& variant : variants(layer)) {
      const auto path = find_in(roots_, layer, variant);
      const auto stamp = path ? stamp_of(*path) : std::nullopt;
      if (!stamp) continue;
      const auto before = known_.find(path->string());
      auto known = before == known_.end() ? nullptr : before->second;
      if (known == nullptr || known->stamp != *stamp) {
        known = std::make_shared<Known>(Known{*stamp, describe(*path, layer, variant)});
      }
      entries.push_back(known->entry);
      if (is_settled(*stamp)) there[path->string()] = std::move(known);
    }
  }
  known_ = std::move(there);
  return entries;
}

}  // namespace gaitd::daemon
