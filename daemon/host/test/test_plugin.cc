// SPDX-License-Identifier: Apache-2.0
// One small plugin, built several times with one thing wrong each.
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "gaitd/abi/backend.h"
#include "gaitd/abi/plugin.h"

#ifndef TEST_LAYER
#define TEST_LAYER GAITD_LAYER_TOE_OFF
#endif
#ifndef TEST_MAGIC
#define TEST_MAGIC GAITD_PLUGIN_MAGIC
#endif
#ifndef TEST_MAJOR
#define TEST_MAJOR GAITD_ABI_MAJOR
#endif
#ifndef TEST_MINOR
#define TEST_MINOR GAITD_ABI_MINOR
#endif
#ifndef TEST_SIZE
#define TEST_SIZE sizeof(GaitdPluginDescriptor)
#endif
#ifndef TEST_ID
#define TEST_ID "good"
#endif
#ifndef TEST_VERSION
#define TEST_VERSION "1.2.3"
#endif
#ifndef TEST_MINIMUM
#define TEST_MINIMUM 0.0
#endif
#ifndef TEST_SECOND_NAME
#define TEST_SECOND_NAME "count"
#endif
#ifndef TEST_ANSWER
#define TEST_ANSWER 1
#endif
#ifndef TEST_BACKEND_SIZE
#define TEST_BACKEND_SIZE sizeof(GaitdBackendVtable)
#endif
#ifndef TEST_SECTION
#define TEST_SECTION GAITD_PLUGIN_SECTION
#endif
#define EXPORT __attribute__((visibility("default")))

extern "C" {

EXPORT extern const GaitdPluginDescriptor gaitd_plugin;
__attribute__((used, section(TEST_SECTION))) const GaitdPluginDescriptor gaitd_plugin = {
    TEST_MAGIC,
    TEST_MAJOR,
    TEST_MINOR,
    TEST_SIZE,
    TEST_LAYER,
    1,
    0,
    TEST_ID,
    TEST_VERSION,
    "test",
    5.0,
    2,
    0,
    {{"gain", "1/s", "a gain", GAITD_PARAMETER_REAL, 0, TEST_MINIMUM, 10.0, 2.0},
     {TEST_SECOND_NAME, "", "a count", GAITD_PARAMETER_INTEGER, 0, 0.0, 5.0, 3.0}}};

#ifdef TEST_UNRESOLVED
void gaitd_test_function_that_nobody_has();
#endif
}

namespace {

#ifdef TEST_THREAD_LOCAL
thread_local int calls = 0;
#else
int calls = 0;
#endif

struct Self {
  double gain = 0.0;
  const GaitdHost* host = nullptr;
};

GaitdStatus init(void* self, const GaitdModel* model, const double* parameters, uint32_t count) {
#ifdef TEST_CRASH_IN_INIT
  raise(SIGSEGV);
#endif
#ifdef TEST_THROW_IN_INIT
  throw std::runtime_error("no such luck");
#endif
  auto* s = static_cast<Self*>(self);
#ifdef TEST_ERROR_IN_INIT
  s->host->log(s->host->context, GAITD_LOG_ERROR, "this robot has no toes");
  return GAITD_ERROR;
#endif
  if (count != 2 || model->size != sizeof(GaitdModel)) return GAITD_INVALID_ARGUMENT;
  s->gain = parameters[0];
  s->host->log(s->host->context, GAITD_LOG_INFO, model->name);
  return GAITD_OK;
}
GaitdStatus ok(void*) { return GAITD_OK; }
GaitdStatus process(void* self, const void*, void* output) {
#ifdef TEST_THROW_IN_PROCESS
  throw std::runtime_error("not now");
#endif
  auto* out = static_cast<GaitdToeOff*>(output);
  out->active = TEST_ANSWER;
  out->side = ++calls;
  out->criterion[0] = static_cast<Self*>(self)->gain;
  return GAITD_OK;
}
GaitdStatus get_state(void*, void*) { return GAITD_OK; }
GaitdStatus set_state(void*, const void*) { return GAITD_OK; }
GaitdStatus set_parameter(void* self, uint32_t, double value) {
  static_cast<Self*>(self)->gain = value;
  return GAITD_OK;
}
void destroy(void* self) { delete static_cast<Self*>(self); }

[[maybe_unused]] const GaitdLayerVtable kVtable = {sizeof(GaitdLayerVtable),
                                                   0,
                                                   init,
                                                   ok,
                                                   process,
                                                   ok,
                                                   get_state,
                                                   set_state,
                                                   set_parameter,
                                                   ok,
#ifdef TEST_NO_DESTROY
                                                   nullptr,
#else
                                                   destroy,
#endif
                                                   nullptr};

GaitdStatus backend_init(void*, const GaitdModel*, const char* config, double, int32_t, char* error,
                         uint32_t size) {
  if (std::strcmp(config, "{}") == 0) return GAITD_OK;
  std::strncpy(error, "can0: no such key\ncan1: out of range", size - 1);
  return GAITD_INVALID_ARGUMENT;
}
[[maybe_unused]] const GaitdBackendVtable kBackendVtable = {
    TEST_BACKEND_SIZE,
    0,
    backend_init,
    ok,
    [](void*, GaitdSensors*) -> GaitdStatus { return GAITD_OK; },
    [](void*, const GaitdJointCommands*) -> GaitdStatus { return GAITD_OK; },
    ok,
    [](void*, GaitdTruth*) -> GaitdStatus { return GAITD_OK; },
    [](void*, const GaitdDisturbance*) -> GaitdStatus { return GAITD_OK; },
    ok,
    ok,
    destroy,
    [](void*, GaitdHealth*) -> GaitdStatus { return GAITD_OK; }};

struct AtLoad {
  AtLoad() {
#ifdef TEST_CRASH_AT_LOAD
    raise(SIGSEGV);
#endif
#ifdef TEST_HANG_AT_LOAD
    for (;;) sleep(1);
#endif
#ifdef TEST_EXIT_AT_LOAD
    _exit(0);
#endif
  }
#ifdef TEST_EXIT_AT_UNLOAD
  ~AtLoad() { _exit(0); }
#endif
} at_load;

}  // namespace

extern "C" {
#if defined(TEST_BACKEND)
EXPORT GaitdStatus gaitd_create_backend(const GaitdHost* host, GaitdBackendInstance* instance) {
  if (host->abi_major != GAITD_ABI_MAJOR) return GAITD_INVALID_ARGUMENT;
  *instance = {new Self{0.0, host}, &kBackendVtable};
  return GAITD_OK;
}
#elif !defined(TEST_NO_CREATE)
EXPORT GaitdStatus gaitd_create(const GaitdHost* host, GaitdInstance* instance) {
#ifdef TEST_UNRESOLVED
  gaitd_test_function_that_nobody_has();
#endif
#ifdef TEST_THROW_IN_CREATE
  throw std::runtime_error("out of order");
#endif
#ifdef TEST_NO_DESTROY
  static Self self{0.0, host};  // nobody would delete it
  *instance = {&self, &kVtable};
#else
  *instance = {new Self{0.0, host}, &kVtable};
#endif
  return GAITD_OK;
}
#endif
}
