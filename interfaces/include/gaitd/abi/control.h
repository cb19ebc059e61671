/* SPDX-License-Identifier: Apache-2.0
 *
 * The problem of the whole-body controller, and its answer. Conventions: gaitd/abi/types.h.
 */
#ifndef GAITD_ABI_CONTROL_H_
#define GAITD_ABI_CONTROL_H_

#include "gaitd/abi/gait.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct GaitdContactPoint {
  int32_t side; /* of a foot; GAITD_BOTH: it belongs to a hand */
  int32_t body;
  double point[3];   /* m, body frame */
  double normal[3];  /* unit, W */
  double tangent[3]; /* unit, W, first edge direction of the friction pyramid */
  double friction;
  double rho_min;    /* N, of each basis vector */
  double rho_max;    /* N, of each basis vector; may be 0 while a point is being loaded */
  double weight;     /* of its rho, over rho_weight of the objectives; 0: 1 */
  double reserve[3]; /* 0 */
} GaitdContactPoint;

enum { GAITD_TASK_FRAME = 0, GAITD_TASK_JOINT = 1 };

/* FRAME: acceleration of a point fixed to a body. Rows 0-2 angular, 3-5 linear, along the axes of
 * `axes` (a frame given in W). JOINT: row 0, `index` is the joint. The acceleration already holds
 * all feedback; the controller subtracts the velocity-product term itself. */
typedef struct GaitdTask {
  int32_t type;
  int32_t index; /* body or joint */
  uint32_t row_mask;
  int32_t reserved;
  double point[3]; /* m, body frame */
  double axes[4];  /* quaternion */
  double acceleration[GAITD_MAX_TASK_ROWS];
  double weight[GAITD_MAX_TASK_ROWS];
  double reserve[8]; /* 0 */
} GaitdTask;

/* Two points of bodies that are close: their distance, against its own speed. */
typedef struct GaitdSeparation {
  int32_t body[2];
  double point[2][3];  /* m, body frames */
  double normal[3];    /* unit, W, from the second to the first */
  double acceleration; /* m/s^2, that the distance has at least */
  double weight;       /* of what is missing, squared */
  double reserve[2];   /* 0 */
} GaitdSeparation;

typedef struct GaitdObjectives {
  uint32_t size;
  int32_t contact_count;
  int32_t task_count;
  uint32_t momentum_mask;  /* rows 0-2 angular, 3-5 linear, W, about the CoM */
  double momentum_rate[6]; /* N m, N; the z row is always filled */
  double momentum_weight[6];
  double height_target;      /* m, CoM in W that the z row aims at */
  double external_wrench[6]; /* about the CoM, W */
  double rho_weight;
  double rho_rate_weight;
  double acceleration_weight;                    /* of every generalised acceleration */
  double posture_acceleration[GAITD_MAX_JOINTS]; /* joint tasks, diagonal; feedback included */
  double posture_weight[GAITD_MAX_JOINTS];       /* 0: no task for this joint */
  double privileged_acceleration[GAITD_MAX_JOINTS];
  double privileged_weight[GAITD_MAX_JOINTS]; /* 0: no privileged acceleration of this joint */
  double joint_stiffness[GAITD_MAX_JOINTS];   /* N m/rad, passed on to the drives */
  double joint_damping[GAITD_MAX_JOINTS];     /* N m s/rad */
  GaitdContactPoint contacts[GAITD_MAX_CONTACTS];
  GaitdTask tasks[GAITD_MAX_TASKS];
  int32_t separation_count;
  int32_t reserved;
  GaitdSeparation separations[GAITD_MAX_SEPARATIONS];
} GaitdObjectives;

enum {
  GAITD_JOINT_MODE_OFF = 0,     /* no torque at all */
  GAITD_JOINT_MODE_DAMPING = 1, /* damping only */
  GAITD_JOINT_MODE_TORQUE = 2   /* torque + stiffness (position error) + damping (rate error) */
};

typedef struct GaitdJointCommand {
  int32_t mode;
  int32_t reserved;
  double torque;       /* N m, feed-forward */
  double position;     /* rad */
  double velocity;     /* rad/s */
  double stiffness;    /* N m/rad */
  double damping;      /* N m s/rad */
  double acceleration; /* rad/s^2, expected under this command; 0 if nothing is expected */
  double reserve[2];   /* 0 */
} GaitdJointCommand;

typedef struct GaitdJointCommands {
  uint32_t size;
  int32_t joint_count;
  int64_t tick;
  GaitdJointCommand joints[GAITD_MAX_JOINTS];
  double reserve[4]; /* 0 */
} GaitdJointCommands;

enum {
  GAITD_WBC_SOLVED = 0,
  GAITD_WBC_MAX_ITERATIONS = 1,
  GAITD_WBC_INFEASIBLE = 2,
  GAITD_WBC_NON_FINITE = 3
};

/* What the whole-body controller found, for the fallback, the log and the cross-fade. */
typedef struct GaitdWbcInfo {
  int32_t status;
  int32_t iterations;
  double kkt_residual;
  double null_trace;             /* freedoms that no task claims; 0 where there is no projector */
  double momentum_residual;      /* N, wanted minus achieved linear momentum rate, wanted rows */
  double pelvis_acceleration[6]; /* pelvis frame, angular first */
  double joint_acceleration[GAITD_MAX_JOINTS];
  double foot_wrench[GAITD_MAX_FEET][6]; /* ground on foot, moment first, about the sole, W axes */
  double hand_force[GAITD_MAX_HANDS][3]; /* on a hand that holds on to something, W */
} GaitdWbcInfo;

#ifdef __cplusplus
}
#endif

#endif /* GAITD_ABI_CONTROL_H_ */
