// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "gaitd/abi/backend.h"
#include "gaitd/abi/plugin.h"

namespace gaitd::daemon {

/// "GAITD_NOT_READY"; "unknown status" for a number that is none.
const char* status_name(GaitdStatus status);
/// "GAITD_NOT_READY (-4)".
std::string status_text(GaitdStatus status);

/// Calls a plugin function; what it throws becomes GAITD_EXCEPTION. Costs nothing if it does not.
template <typename Function>
GaitdStatus contained(Function&& function) {
  try {
    return function();
  } catch (...) {
    return GAITD_EXCEPTION;
  }
}

/// dlopen with every symbol bound now and none given to others. Null with the reason in `error`.
void* open_library(const char* path, std::string* error);

// Each of these calls plugin functions tagged [main] and returns false with the reason in `error`
// if one fails, throws, or leaves a needed function out of its table.
bool create_layer(void* library, const GaitdHost& host, GaitdInstance* instance,
                  std::string* error);
bool init_layer(const GaitdInstance& instance, const GaitdModel& model,
                std::span<const double> parameters, std::string* error);
bool activate_layer(const GaitdInstance& instance, std::string* error);
bool deactivate_layer(const GaitdInstance& instance, std::string* error);
bool create_backend(void* library, const GaitdHost& host, GaitdBackendInstance* instance,
                    std::string* error);

/// Destroys an instance of either kind; what it throws is dropped.
template <typename Instance>
void destroy_instance(const Instance& instance) {
  try {
    instance.vtable->destroy(instance.self);
  } catch (...) {
    // Nothing of it is used any more.
  }
}

}  // namespace gaitd::daemon
