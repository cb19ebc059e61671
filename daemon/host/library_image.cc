// SPDX-License-Identifier: Apache-2.0
#include "daemon/host/library_image.h"

#include <dlfcn.h>
#include <link.h>

#include <algorithm>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "daemon/host/instance.h"
#include "gaitd/sdk/bounds.h"

namespace gaitd::daemon {
namespace {

struct Unused {
  std::mutex mutex;
  std::vector<std::unique_ptr<LibraryImage>> idle;
  std::vector<std::unique_ptr<LibraryImage>> kept;
};

Unused& unused() {
  static auto* const all = new Unused;  // outlives every user
  return *all;
}

// Libraries that this process has mapped since its start.
unsigned long long mapped_so_far() {
  unsigned long long count = 0;
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* out) {
        *static_cast<unsigned long long*>(out) = info->dlpi_adds;
        return 1;
      },
      &count);
  return count;
}

}  // namespace

std::unique_ptr<LibraryImage> LibraryImage::map(const PluginFile& file, const GaitdModel& model,
                                                const ProbeOptions* probe_options,
                                                Refusal* refusal) {
  std::unique_ptr<LibraryImage> image;
  {
    const std::scoped_lock lock(unused().mutex);
    auto& images = unused().idle;
    const auto same = std::find_if(images.begin(), images.end(),
                                   [&](const auto& one) { return one->copy_.holds(file.bytes); });
    if (same != images.end()) {
      image = std::move(*same);
      images.erase(same);
    } else if (images.size() >= bounds::kIdleLibraries) {
      refusal->add("libraries",
                   std::to_string(images.size()) +
                       " that are loaded, not used any "
                       "more and cannot be unloaded",
                   "less than " + std::to_string(bounds::kIdleLibraries),
                   "start gaitd again; link plugins with -fno-gnu-unique and without -z nodelete");
      return nullptr;
    }
  }
  if (image == nullptr) {
    std::optional<StagedCopy> copy = StagedCopy::create(file, refusal);
    if (!copy) return nullptr;
    image.reset(new LibraryImage(std::move(*copy)));
  }
  const bool proven = probe_options == nullptr ||
                      (probe_options->proven != nullptr && probe_options->proven->hold(file));
  const bool sound = proven || probe(image->copy_.fd(), model, refusal, *probe_options);
  if (sound && (image->handle_ != nullptr || image->open(file, refusal))) return image;
  if (image->handle_ == nullptr && image->is_mapped()) {
    keep(std::move(image));  // half initialised
  } else {
    release(std::move(image));
  }
  return nullptr;
}

bool LibraryImage::open(const PluginFile& file, Refusal* refusal) {
  const unsigned long long before = mapped_so_far();
  std::string error;
  handle_ = open_library(copy_.path().c_str(), &error);
  alone_ = mapped_so_far() == before + 1;
  if (handle_ != nullptr) return true;
  if (error.starts_with(copy_.path())) error.replace(0, copy_.path().size(), file.path.string());
  refusal->add("dlopen", error, "every symbol resolved",
               "link what is missing into the plugin (-Wl,--no-undefined finds it)");
  return false;
}

bool LibraryImage::is_mapped() {
  handle_ = dlopen(copy_.path().c_str(), RTLD_NOW | RTLD_NOLOAD);
  return handle_ != nullptr;
}

// True if it is gone.
bool LibraryImage::unmap() {
  if (handle_ == nullptr) return true;
  if (!alone_) return false;
  dlclose(handle_);
  return !is_mapped();
}

void LibraryImage::release(std::unique_ptr<LibraryImage> image) {
  if (image == nullptr || image->unmap()) return;
  const std::scoped_lock lock(unused().mutex);
  unused().idle.push_back(std::move(image));
}

void LibraryImage::keep(std::unique_ptr<LibraryImage> image) {
  const std::scoped_lock lock(unused().mutex);
  unused().kept.push_back(std::move(image));
}

}  // namespace gaitd::daemon
