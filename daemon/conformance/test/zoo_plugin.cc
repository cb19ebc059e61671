// SPDX-License-Identifier: Apache-2.0
// A toe-off layer in plain C style, right in everything, and built once more for each thing that a
// plugin can do wrong.
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <stdexcept>

#include "gaitd/abi/plugin.h"

#define EXPORT __attribute__((visibility("default")))

extern "C" {
EXPORT extern const GaitdPluginDescriptor gaitd_plugin;
__attribute__((used, section(GAITD_PLUGIN_SECTION))) const GaitdPluginDescriptor gaitd_plugin = {
    GAITD_PLUGIN_MAGIC,
    GAITD_ABI_MAJOR,
    GAITD_ABI_MINOR,
    sizeof(GaitdPluginDescriptor),
    GAITD_LAYER_TOE_OFF,
    1,
    0,
    ZOO_ID,
    "1.0.0",
    "zoo",
#if defined(ZOO_SLOW) || defined(ZOO_SLOWER)
    0.5,
#else
    1000.0,
#endif
    2,
    0,
    {{"gain", "1/s", "a gain", GAITD_PARAMETER_REAL, 0, 0.0, 10.0, 2.0},
     {"count", "", "a count", GAITD_PARAMETER_INTEGER, 0, 0.0, 5.0, 3.0}}};
}

namespace {

[[maybe_unused]] int shared = 0;
[[maybe_unused]] double* volatile kept = nullptr;

struct Self {
  const GaitdHost* host = nullptr;
  double values[2] = {2.0, 3.0};
  double remembered = 0.0;
  int ticks = 0;
  bool spoiled = false;
};
Self& of(void* self) { return *static_cast<Self*>(self); }

[[maybe_unused]] void spend(double us) {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  const double end = 1e6 * t.tv_sec + 1e-3 * t.tv_nsec + us;
  do {
    clock_gettime(CLOCK_MONOTONIC, &t);
  } while (1e6 * t.tv_sec + 1e-3 * t.tv_nsec < end);
}

GaitdStatus init(void* self, const GaitdModel* model, const double* values, uint32_t count) {
#ifdef ZOO_CRASH_IN_INIT
  raise(SIGSEGV);
#endif
#ifdef ZOO_THROW_IN_INIT
  throw std::runtime_error("no such luck");
#endif
#ifdef ZOO_ERROR_IN_INIT
  of(self).host->log(of(self).host->context, GAITD_LOG_ERROR, "this robot has no toes");
  return GAITD_ERROR;
#endif
#ifndef ZOO_ANY_MODEL
  if (model->size < sizeof(GaitdModel)) return GAITD_INVALID_ARGUMENT;
#endif
  for (uint32_t i = 0; i < count && i < 2; ++i) of(self).values[i] = values[i];
  return GAITD_OK;
}
GaitdStatus ok(void*) { return GAITD_OK; }

// Misbehaves in the middle of the walk, as a real one would.
[[maybe_unused]] GaitdStatus misbehave(Self& s, GaitdToeOff& out) {
#ifdef ZOO_NAN_OUTPUT
  out.criterion[2] = std::nan("");
#endif
#ifdef ZOO_ERROR_STATUS
  return GAITD_ERROR;
#endif
#ifdef ZOO_THROW_IN_PROCESS
  throw std::runtime_error("not now");
#endif
#ifdef ZOO_CRASH_IN_PROCESS
  raise(SIGSEGV);
#endif
#ifdef ZOO_HANG_IN_PROCESS
  for (;;) sleep(1);
#endif
#ifdef ZOO_EXIT_IN_PROCESS
  _exit(0);
#endif
#ifdef ZOO_WRONG_OUTPUT_SIZE
  out.size = 8;
#endif
#ifdef ZOO_NO_SUCH_SIDE
  out.active = 1;
  out.side = 7;
#endif
#ifdef ZOO_ALLOCATE
  delete kept;
  kept = new double(s.values[0]);  // kept, so that the compiler may not leave it out
#endif
  return GAITD_OK;
}

GaitdStatus process(void* self, const void* input, void* output) {
  Self& s = of(self);
  const auto& in = *static_cast<const GaitdToeOffInput*>(input);
  auto& out = *static_cast<GaitdToeOff*>(output);
#ifndef ZOO_ANY_INPUT
  if (in.size < sizeof(in)) return GAITD_INVALID_ARGUMENT;
#else
  if (in.size < sizeof(in)) return GAITD_OK;
#endif
#ifdef ZOO_REFUSE_LONGER
  if (in.size > sizeof(in)) return GAITD_INVALID_ARGUMENT;
#endif
#ifdef ZOO_SLOW
  spend(5.0);
#endif
#ifdef ZOO_SLOWER
  spend(100.0);
#endif
  out = {};
  out.size = sizeof(out);
  out.side = GAITD_BOTH;
  ++s.ticks;
  s.remembered = 0.5 * s.remembered + s.values[0];
  out.criterion[0] = s.remembered;
#ifdef ZOO_RANDOM
  out.criterion[1] = static_cast<double>(reinterpret_cast<std::uintptr_t>(self) % 4096);
#endif
#ifdef ZOO_SHARED_COUNTER
  out.criterion[1] = ++shared;
#endif
#if defined(ZOO_CRASH_ON_NAN) || defined(ZOO_STUCK_ON_NAN)
  if (std::isnan(in.robot->icp[0])) {
#ifdef ZOO_CRASH_ON_NAN
    raise(SIGFPE);
#endif
    s.spoiled = true;
  }
  if (s.spoiled) return GAITD_ERROR;
#endif
#ifdef ZOO_CRASH_ON_LIMIT
  if (s.values[1] == 0.0) raise(SIGFPE);
#endif
  return in.time.tick == 700 ? misbehave(s, out) : GaitdStatus{GAITD_OK};
}
GaitdStatus reset(void* self) {
#ifdef ZOO_THROW_IN_RESET
  throw std::runtime_error("never again");
#endif
#ifndef ZOO_FORGET_IN_RESET
  of(self).remembered = 0.0;
#endif
  of(self).ticks = 0;
  return GAITD_OK;
}
GaitdStatus get_state(void* self, void* state) {
  auto& s = *static_cast<GaitdToeOffState*>(state);
  s = {};
#ifndef ZOO_STATE_SIZE
  s.size = sizeof(s);
#endif
  s.side = GAITD_BOTH;
  s.time_satisfied = of(self).remembered;
  return GAITD_OK;
}
GaitdStatus set_state(void* self, const void* state) {
  const auto& s = *static_cast<const GaitdToeOffState*>(state);
#ifndef ZOO_ANY_STATE
  if (s.size < sizeof(s)) return GAITD_INVALID_ARGUMENT;
#endif
#ifndef ZOO_STATE_LOST
  of(self).remembered = s.time_satisfied;
#endif
  return GAITD_OK;
}
GaitdStatus set_parameter(void* self, uint32_t index, double value) {
#ifdef ZOO_ANY_INDEX
  if (index >= 2) return GAITD_OK;
#endif
  if (index >= 2) return GAITD_INVALID_ARGUMENT;
#ifndef ZOO_ANY_VALUE
  const GaitdParameter& p = gaitd_plugin.parameters[index];
  if (!(value >= p.minimum && value <= p.maximum)) return GAITD_INVALID_ARGUMENT;
  if (index == 1 && value != std::floor(value)) return GAITD_INVALID_ARGUMENT;
#endif
  of(self).values[index] = value;
  return GAITD_OK;
}
void destroy(void* self) {
#ifdef ZOO_CRASH_IN_DESTROY
  raise(SIGSEGV);
#endif
  delete static_cast<Self*>(self);
}
const void* get_extension(void*, const char*) { return nullptr; }

const GaitdLayerVtable kVtable = {sizeof(GaitdLayerVtable),
                                  0,
                                  init,
                                  ok,
#ifdef ZOO_NO_PROCESS
                                  nullptr,
#else
                                  process,
#endif
                                  reset,
                                  get_state,
                                  set_state,
                                  set_parameter,
                                  ok,
                                  destroy,
                                  get_extension};

#ifdef ZOO_CRASH_AT_EXIT
struct AtExit {
  ~AtExit() { raise(SIGSEGV); }
} at_exit;
#endif

}  // namespace

#ifdef ZOO_UNIQUE
template <class T>
struct Shared {
  EXPORT static int value;
};
template <class T>
int Shared<T>::value = 0;
EXPORT int use_unique() { return ++Shared<int>::value; }
#endif

extern "C" EXPORT GaitdStatus gaitd_create(const GaitdHost* host, GaitdInstance* instance) {
#ifndef ZOO_ACCEPT_ANY_ABI
  if (host->abi_major != GAITD_ABI_MAJOR) return GAITD_INVALID_ARGUMENT;
#endif
#ifdef ZOO_CRASH_IN_CREATE
  raise(SIGSEGV);
#endif
#ifdef ZOO_THROW_IN_CREATE
  throw std::runtime_error("out of order");
#endif
#ifdef ZOO_NULL_VTABLE
  *instance = {new Self{host}, nullptr};
  return GAITD_OK;
#endif
  *instance = {new Self{host}, &kVtable};
  return GAITD_OK;
}
