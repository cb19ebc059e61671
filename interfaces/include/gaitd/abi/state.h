/* SPDX-License-Identifier: Apache-2.0
 *
 * What is measured, what is estimated, and, in a simulation, what is true. Conventions:
 * gaitd/abi/types.h.
 */
#ifndef GAITD_ABI_STATE_H_
#define GAITD_ABI_STATE_H_

#include "gaitd/abi/model.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct GaitdSignalInfo {
  int64_t stamp_ns; /* when the value was measured, time of the tick clock */
  double age;       /* s, tick time minus stamp */
  uint32_t sequence;
  uint32_t valid; /* 0: do not use */
} GaitdSignalInfo;

typedef struct GaitdJointSensor {
  GaitdSignalInfo info;
  double position;   /* rad */
  double velocity;   /* rad/s */
  double torque;     /* N m */
  double reserve[2]; /* 0 */
} GaitdJointSensor;

typedef struct GaitdImuSensor {
  GaitdSignalInfo info;
  uint32_t has_orientation;
  uint32_t reserved;
  double orientation[4];    /* IMU frame in W */
  double angular_rate[3];   /* rad/s, IMU frame */
  double specific_force[3]; /* m/s^2, IMU frame: acceleration minus gravity */
  double reserve[4];        /* 0 */
} GaitdImuSensor;

/* Wrench of the ground on the foot, in the sensor frame, about the sensor origin. */
typedef struct GaitdFootForceSensor {
  GaitdSignalInfo info;
  double force[3];   /* N */
  double moment[3];  /* N m */
  double reserve[2]; /* 0 */
} GaitdFootForceSensor;

typedef struct GaitdSensors {
  uint32_t size;
  int32_t joint_count;
  int32_t imu_count;
  int32_t foot_count; /* 0: the feet have no force sensors */
  int64_t tick;
  double time; /* s, tick clock */
  GaitdJointSensor joints[GAITD_MAX_JOINTS];
  GaitdImuSensor imus[GAITD_MAX_IMUS];
  GaitdFootForceSensor feet[GAITD_MAX_FEET];
} GaitdSensors;

/* ---------------------------------------------------------------------------- robot state -- */

enum { GAITD_CONTACT_NONE = 0, GAITD_CONTACT_TOE = 1, GAITD_CONTACT_FULL = 2 };

typedef struct GaitdFootState {
  int32_t contact; /* measured: GAITD_CONTACT_NONE or GAITD_CONTACT_FULL */
  int32_t cop_valid;
  double position[3];    /* m, sole origin in W */
  double orientation[4]; /* sole frame in W */
  double twist[6];       /* of the sole origin, W axes, angular first */
  double wrench[6];      /* ground on foot, moment first, about the sole origin, sole axes */
  double normal_force;   /* N, filtered, along the normal of the sole, >= 0 */
  double cop[2];         /* m, sole frame */
  double cop_world[3];   /* m, W */
  double reserve[4];     /* 0 */
} GaitdFootState;

enum {
  GAITD_HANDHOLD_NONE = 0,
  GAITD_HANDHOLD_SOUGHT = 1, /* the hand moves against the normal until something stops it */
  GAITD_HANDHOLD_HELD = 2,   /* it carries load */
  GAITD_HANDHOLD_LET_GO = 3  /* it is being unloaded */
};

/* A hand at something that does not move: a point contact with friction. */
typedef struct GaitdHandhold {
  int32_t state;
  int32_t reserved;
  double position[3]; /* m, W: of the hand now */
  double anchor[3];   /* m, W: where it is to be */
  double normal[3];   /* unit, W: of the surface, towards the robot */
  double friction;
  double force_min;  /* N, along the normal */
  double force_max;  /* N, along the normal, with nothing across */
  double force[3];   /* N, W, on the hand: as the controller planned in the tick before */
  double reserve[2]; /* 0 */
} GaitdHandhold;

typedef struct GaitdRobotState {
  uint32_t size;
  int32_t joint_count;
  int32_t valid;
  int32_t reserved;
  double pelvis_position[3];    /* m, W */
  double pelvis_orientation[4]; /* pelvis frame in W */
  double pelvis_twist[6];       /* pelvis frame, angular first */
  double joint_position[GAITD_MAX_JOINTS];
  double joint_velocity[GAITD_MAX_JOINTS];
  double com[3];
  double com_velocity[3];
  double icp[2]; /* m, W, with omega of the gait; the host adds what the external wrench leans it */
  double cop[2]; /* m, W, of both feet together; last valid one in flight */
  GaitdFootState feet[GAITD_MAX_FEET];
  double pelvis_velocity_covariance[9]; /* (m/s)^2, W, row-major */
  /* Moment first, about the CoM, W: what pulls at the robot steadily. By the host, who finds it
   * from the rest of this state; 0 while nothing pulls. */
  double external_wrench[6];
  /* By the host: com, com_velocity and icp are those of the robot with them. */
  GaitdLoads loads;
  GaitdHandhold handholds[GAITD_MAX_HANDS]; /* by the host */
} GaitdRobotState;

typedef struct GaitdFootTruth {
  double force[3];    /* N, W, ground on foot */
  double slip;        /* m, horizontal path of the contact since the foot was loaded (> 50 N) */
  double penetration; /* m, deepest point */
  double side_force;  /* N, on vertical faces */
  double position[3]; /* m, sole origin in W */
  double orientation[4];
  double reserve[4]; /* 0 */
} GaitdFootTruth;

/* Simulation only; no layer ever reads it. */
typedef struct GaitdTruth {
  uint32_t size;
  int32_t body_contact; /* something other than a foot touches the terrain */
  double time;
  double pelvis_position[3];
  double pelvis_orientation[4];
  double pelvis_twist[6]; /* pelvis frame, angular first */
  double com[3];
  double com_velocity[3];
  GaitdFootTruth feet[GAITD_MAX_FEET];
  double joint_position[GAITD_MAX_JOINTS];
  double joint_velocity[GAITD_MAX_JOINTS];
  double joint_torque[GAITD_MAX_JOINTS]; /* N m, at the joint after the actuator model */
} GaitdTruth;

#ifdef __cplusplus
}
#endif

#endif /* GAITD_ABI_STATE_H_ */
