/* SPDX-License-Identifier: Apache-2.0
 *
 * The backend contract: what reads sensors and applies joint commands. Loaded like any plugin
 * (descriptor with layer GAITD_LAYER_BACKEND), created by gaitd_create_backend.
 */
#ifndef GAITD_ABI_BACKEND_H_
#define GAITD_ABI_BACKEND_H_

#include "gaitd/abi/plugin.h"

#ifdef __cplusplus
extern "C" {
#endif

#define GAITD_CREATE_BACKEND_SYMBOL "gaitd_create_backend"

enum { GAITD_CLOCK_REALTIME = 0, GAITD_CLOCK_LOCKSTEP = 1 };

/* A force on a simulated link, constant in the world for its duration. */
typedef struct GaitdDisturbance {
  int32_t body;
  int32_t reserved;
  double point[3]; /* m, body frame */
  double force[3]; /* N, W */
  double duration; /* s, from the next plant step on */
} GaitdDisturbance;

/* What a robot reports beside its sensors. Those present now; none is remembered. */
enum {
  GAITD_HEALTH_MOTOR = 1 << 0,     /* a drive reports an error, or switched itself off */
  GAITD_HEALTH_BUS = 1 << 1,       /* a bus is off or down, or does not take commands */
  GAITD_HEALTH_ESTOP = 1 << 2,     /* an emergency stop is pressed */
  GAITD_HEALTH_HEARTBEAT = 1 << 3, /* the emergency stop does not answer */
  GAITD_HEALTH_WARNING = 1 << 4    /* a bus is error-passive: not a fault yet */
};

typedef struct GaitdHealth {
  uint32_t size;
  uint32_t conditions; /* GAITD_HEALTH_* */
  uint32_t late;       /* replies, counted since start */
  uint32_t missing;
  uint32_t duplicate;
  uint32_t stale;
  uint32_t lost;                     /* frames that the receiver dropped */
  uint32_t unsent;                   /* commands that the bus did not take */
  char text[GAITD_DESCRIPTION_SIZE]; /* the first condition in words, "" if there is none */
} GaitdHealth;

/* One tick: read -> (control) -> write -> [lockstep: advance]. */
typedef struct GaitdBackendVtable {
  uint32_t size;
  uint32_t reserved;
  /* config: JSON text; every unknown key, wrong type or value out of range is refused with all
   * errors in `error`, one per line. [main] */
  GaitdStatus (*init)(void* self, const GaitdModel* model, const char* config, double period,
                      int32_t clock, char* error, uint32_t error_size);
  GaitdStatus (*start)(void* self); /* [main] */
  /* GAITD_NOT_READY: no sensors newer than those of the last read. [rt] */
  GaitdStatus (*read)(void* self, GaitdSensors* sensors);
  GaitdStatus (*write)(void* self, const GaitdJointCommands* commands); /* [rt] */
  /* Lockstep only: runs the plant one period under the last command. [control thread, outside
   * the guarded section] */
  GaitdStatus (*advance)(void* self);
  GaitdStatus (*truth)(void* self, GaitdTruth* truth);                     /* [rt] */
  GaitdStatus (*disturb)(void* self, const GaitdDisturbance* disturbance); /* [rt] */
  /* Simulation: back to the start state. [control thread, outside the guarded section] */
  GaitdStatus (*reset)(void* self);
  GaitdStatus (*stop)(void* self); /* [main] */
  void (*destroy)(void* self);     /* [main] */
  /* May be null: always healthy. [any, rt included] */
  GaitdStatus (*health)(void* self, GaitdHealth* health);
  /* May be null. Simulation: what a body carries from the next period on, in place of what it
   * carried; mass 0: nothing. It moves with the body at once, as if it had done so before. [rt] */
  GaitdStatus (*carry)(void* self, const GaitdLoad* load);
} GaitdBackendVtable;

typedef struct GaitdBackendInstance {
  void* self;
  const GaitdBackendVtable* vtable;
} GaitdBackendInstance;

typedef GaitdStatus (*GaitdCreateBackendFunction)(const GaitdHost* host,
                                                  GaitdBackendInstance* instance);

#ifdef __cplusplus
}
#endif

#endif /* GAITD_ABI_BACKEND_H_ */
