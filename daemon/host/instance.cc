// SPDX-License-Identifier: Apache-2.0
#include "daemon/host/instance.h"

#include <dlfcn.h>

#include <cstddef>
#include <exception>
#include <initializer_list>
#include <utility>

namespace gaitd::daemon {
namespace {

// Calls a plugin function that returns a status; an exception must not cross the boundary, but one
// that does is no reason to end.
template <typename Function>
bool call(const char* name, std::string* error, Function&& function) {
  try {
    const GaitdStatus status = function();
    if (status == GAITD_OK) return true;
    *error = std::string(name) + "() returned " + status_text(status);
  } catch (const std::exception& e) {
    *error = std::string(name) + "() threw an exception across the C boundary: " + e.what();
  } catch (...) {
    *error = std::string(name) + "() threw an exception across the C boundary";
  }
  return false;
}

// Names the functions that are missing in a table.
bool complete(std::initializer_list<std::pair<const char*, bool>> functions, std::string* error) {
  std::string missing;
  for (const auto& [name, there] : functions) {
    if (!there) missing += (missing.empty() ? "" : ", ") + std::string(name);
  }
  if (!missing.empty()) *error = "no function in the vtable for: " + missing;
  return missing.empty();
}

template <typename Vtable>
bool check_size(const Vtable* vtable, std::size_t needed, std::string* error) {
  if (vtable != nullptr && vtable->size >= needed) return true;
  *error = vtable == nullptr
               ? "create left the vtable null"
               : "the vtable has " + std::to_string(vtable->size) + " bytes, needs " +
                     std::to_string(needed) + "; build against the gaitd-dev of this gaitd";
  return false;
}

}  // namespace

const char* status_name(GaitdStatus status) {
  switch (status) {
    case GAITD_OK:
      return "GAITD_OK";
    case GAITD_ERROR:
      return "GAITD_ERROR";
    case GAITD_INVALID_ARGUMENT:
      return "GAITD_INVALID_ARGUMENT";
    case GAITD_NOT_SUPPORTED:
      return "GAITD_NOT_SUPPORTED";
    case GAITD_NOT_READY:
      return "GAITD_NOT_READY";
    case GAITD_EXCEPTION:
      return "GAITD_EXCEPTION";
    default:
      return "unknown status";
  }
}

std::string status_text(GaitdStatus status) {
  return std::string(status_name(status)) + " (" + std::to_string(status) + ")";
}

void* open_library(const char* path, std::string* error) {
  void* library = nullptr;
  try {
    library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  } catch (...) {
    *error = "a static initialiser of the library threw an exception";
    return nullptr;
  }
  if (library == nullptr) {
    const char* reason = dlerror();
    *error = reason == nullptr ? "dlopen failed" : reason;
  }
  return library;
}

bool create_layer(void* library, const GaitdHost& host, GaitdInstance* instance,
                  std::string* error) {
  const auto create = reinterpret_cast<GaitdCreateFunction>(dlsym(library, GAITD_CREATE_SYMBOL));
  if (create == nullptr) {
    *error = "no symbol " GAITD_CREATE_SYMBOL;
    return false;
  }
  *instance = {};
  if (!call(GAITD_CREATE_SYMBOL, error, [&] { return create(&host, instance); })) return false;
  const GaitdLayerVtable* v = instance->vtable;
  return check_size(v, sizeof(*v), error) &&
         complete({{"init", v->init != nullptr},
                   {"activate", v->activate != nullptr},
                   {"process", v->process != nullptr},
                   {"reset", v->reset != nullptr},
                   {"get_state", v->get_state != nullptr},
                   {"set_state", v->set_state != nullptr},
                   {"set_parameter", v->set_parameter != nullptr},
                   {"deactivate", v->deactivate != nullptr},
                   {"destroy", v->destroy != nullptr}},
                  error);
}

bool init_layer(const GaitdInstance& instance, const GaitdModel& model,
                std::span<const double> parameters, std::string* error) {
  return call("init", error, [&] {
    return instance.vtable->init(instance.self, &model, parameters.data(),
                                 static_cast<std::uint32_t>(parameters.size()));
  });
}

bool activate_layer(const GaitdInstance& instance, std::string* error) {
  return call("activate", error, [&] { return instance.vtable->activate(instance.self); });
}

bool deactivate_layer(const GaitdInstance& instance, std::string* error) {
  return call("deactivate", error, [&] { return instance.vtable->deactivate(instance.self); });
}

bool create_backend(void* library, const GaitdHost& host, GaitdBackendInstance* instance,
                    std::string* error) {
  const auto create =
      reinterpret_cast<GaitdCreateBackendFunction>(dlsym(library, GAITD_CREATE_BACKEND_SYMBOL));
  if (create == nullptr) {
    *error = "no symbol " GAITD_CREATE_BACKEND_SYMBOL;
    return false;
  }
  *instance = {};
  if (!call(GAITD_CREATE_BACKEND_SYMBOL, error, [&] { return create(&host, instance); })) {
    return false;
  }
  const GaitdBackendVtable* v = instance->vtable;
  return check_size(v, offsetof(GaitdBackendVtable, health), error) &&
         complete({{"init", v->init != nullptr},
                   {"start", v->start != nullptr},
                   {"read", v->read != nullptr},
                   {"write", v->write != nullptr},
                   {"advance", v->advance != nullptr},
                   {"truth", v->truth != nullptr},
                   {"disturb", v->disturb != nullptr},
                   {"reset", v->reset != nullptr},
                   {"stop", v->stop != nullptr},
                   {"destroy", v->destroy != nullptr}},
                  error);
}

}  // namespace gaitd::daemon
