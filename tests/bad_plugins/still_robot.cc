// SPDX-License-Identifier: Apache-2.0
// A backend that is no simulation: a robot that answers and never moves. The name "mock" is that of
// a backend that gaitd does not ship.
#include <cstring>

#include "gaitd/abi/backend.h"
#include "gaitd/abi/plugin.h"

#define EXPORT __attribute__((visibility("default")))

extern "C" {
EXPORT extern const GaitdPluginDescriptor gaitd_plugin;
__attribute__((used, section(GAITD_PLUGIN_SECTION)))
const GaitdPluginDescriptor gaitd_plugin = {GAITD_PLUGIN_MAGIC,
                                            GAITD_ABI_MAJOR,
                                            GAITD_ABI_MINOR,
                                            sizeof(GaitdPluginDescriptor),
                                            GAITD_LAYER_BACKEND,
                                            1,
                                            0,
                                            "mock",
                                            "1.0.0",
                                            "test",
                                            5.0,
                                            0,
                                            0,
                                            {}};
}

namespace {

GaitdStatus init(void*, const GaitdModel*, const char*, double, int32_t, char*, uint32_t) {
  return GAITD_OK;
}
GaitdStatus ok(void*) { return GAITD_OK; }
GaitdStatus read(void*, GaitdSensors*) { return GAITD_OK; }  // all as it was: zeros
GaitdStatus write(void*, const GaitdJointCommands*) { return GAITD_OK; }
GaitdStatus no_truth(void*, GaitdTruth*) { return GAITD_NOT_SUPPORTED; }
GaitdStatus no_push(void*, const GaitdDisturbance*) { return GAITD_NOT_SUPPORTED; }
GaitdStatus no_reset(void*) { return GAITD_NOT_SUPPORTED; }
GaitdStatus health(void*, GaitdHealth*) { return GAITD_OK; }
void destroy(void*) {}

const GaitdBackendVtable kVtable = {sizeof(kVtable), 0,       init,     ok, read,    write, ok,
                                    no_truth,        no_push, no_reset, ok, destroy, health};

}  // namespace

extern "C" EXPORT GaitdStatus gaitd_create_backend(const GaitdHost*, GaitdBackendInstance* out) {
  static int self = 0;
  *out = {&self, &kVtable};
  return GAITD_OK;
}
