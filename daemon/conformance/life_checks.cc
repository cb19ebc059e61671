// SPDX-License-Identifier: Apache-2.0
// From creation to unloading: everything around process().
#include <dlfcn.h>

#include <memory>
#include <string>

#include "daemon/conformance/check_child.h"
#include "daemon/host/parameters.h"

namespace gaitd::daemon {
namespace {

template <class Create, class Instance>
bool refuses_another_abi(CheckRun& run, const char* symbol) {
  const auto create = reinterpret_cast<Create>(dlsym(run.library(), symbol));
  GaitdHost other = run.host();
  other.abi_major = GAITD_ABI_MAJOR + 1;
  Instance instance{};
  if (create == nullptr || contained([&] { return create(&other, &instance); }) == GAITD_OK) {
    return run.fail(std::string(symbol) + "() accepts a host of another ABI major (" +
                    std::to_string(other.abi_major) + "); return GAITD_INVALID_ARGUMENT");
  }
  return true;
}

bool check_init(CheckRun& run, const GaitdInstance& instance) {
  const std::vector<double> defaults = default_parameters(run.descriptor());
  const auto init = [&](const GaitdModel& model, std::uint32_t count) {
    return contained(
        [&] { return instance.vtable->init(instance.self, &model, defaults.data(), count); });
  };
  const auto smaller = std::make_unique<GaitdModel>(run.model());
  smaller->size -= 8;
  if (init(*smaller, run.descriptor().parameter_count) == GAITD_OK) {
    return run.fail("init() accepts a model of a smaller size than it reads; compare model->size");
  }
  std::string error;
  if (!init_layer(instance, run.model(), defaults, &error)) return run.fail(error);
  if (!activate_layer(instance, &error)) return run.fail(error);
  if (const GaitdStatus status = contained([&] { return instance.vtable->reset(instance.self); });
      status != GAITD_OK) {
    return run.fail("reset() returned " + status_text(status) + " on an active instance");
  }
  run.pass("with the defaults of " + std::to_string(defaults.size()) + " parameters");
  return true;
}

// Unloads and says whether it went.
void check_unload(CheckRun& run) {
  run.begin("unload");
  const Dl_info here = [&] {
    Dl_info info{};
    dladdr(&run.descriptor(), &info);
    return info;
  }();
  const std::string path = here.dli_fname == nullptr ? "" : here.dli_fname;
  if (dlclose(run.library()) != 0) {
    run.fail(std::string("dlclose failed: ") + dlerror());
    return;
  }
  void* still = dlopen(path.c_str(), RTLD_NOW | RTLD_NOLOAD);
  if (still != nullptr) {
    run.warn("stays in memory after its last user (a static or unique symbol pins it)");
    return;
  }
  run.pass();
}

}  // namespace

void check_load(CheckRun& run) {
  run.begin("create");
  std::string error;
  if (!refuses_another_abi<GaitdCreateFunction, GaitdInstance>(run, GAITD_CREATE_SYMBOL)) return;
  GaitdInstance first{};
  GaitdInstance second{};
  if (!create_layer(run.library(), run.host(), &first, &error) ||
      !create_layer(run.library(), run.host(), &second, &error)) {
    run.fail(error);
    return;
  }
  if (first.self == second.self) {
    run.fail("two instances are the same object: they would disturb each other in a swap");
    return;
  }
  run.pass();
  run.begin("init");
  if (!check_init(run, first)) return;
  run.begin("destroy");
  if (!deactivate_layer(first, &error)) {
    run.fail(error);
    return;
  }
  try {
    first.vtable->destroy(first.self);
    second.vtable->destroy(second.self);  // one that was never initialised
  } catch (...) {
    run.fail("destroy() threw an exception across the C boundary");
    return;
  }
  run.pass();
  check_unload(run);
}

void check_backend(CheckRun& run) {
  run.begin("create");
  std::string error;
  if (!refuses_another_abi<GaitdCreateBackendFunction, GaitdBackendInstance>(
          run, GAITD_CREATE_BACKEND_SYMBOL)) {
    return;
  }
  GaitdBackendInstance instance{};
  if (!create_backend(run.library(), run.host(), &instance, &error)) {
    run.fail(error);
    return;
  }
  run.pass();
  run.begin("destroy");
  try {
    instance.vtable->destroy(instance.self);
  } catch (...) {
    run.fail("destroy() threw an exception across the C boundary");
    return;
  }
  run.pass();
}

}  // namespace gaitd::daemon
