/* SPDX-License-Identifier: Apache-2.0
 *
 * The robot: bodies, joints, frames, feet and legs. Conventions: gaitd/abi/types.h.
 */
#ifndef GAITD_ABI_MODEL_H_
#define GAITD_ABI_MODEL_H_

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
  GAITD_MAX_JOINTS = 64,
  GAITD_MAX_BODIES = 65,
  GAITD_MAX_FRAMES = 16,
  GAITD_MAX_IMUS = 4,
  GAITD_MAX_FEET = 2,
  GAITD_MAX_FOOT_POINTS = 8,
  GAITD_MAX_CONTACTS = 16,
  GAITD_MAX_FOOTSTEPS = 16,
  GAITD_MAX_REGION_POINTS = 8,
  GAITD_MAX_TASKS = 32,
  GAITD_MAX_TASK_ROWS = 6,
  GAITD_MAX_HANDS = 2,
  GAITD_MAX_CAPSULES = 32,
  GAITD_MAX_SEPARATIONS = 24,
  GAITD_MAX_LOADS = 4,
  GAITD_MAX_MOTION_AXES = 12,
  GAITD_MAX_MOTION_POINTS = 16,
  GAITD_NAME_SIZE = 48
};

enum { GAITD_LEFT = 0, GAITD_RIGHT = 1, GAITD_BOTH = 2 };

enum { GAITD_JOINT_REVOLUTE = 0, GAITD_JOINT_PRISMATIC = 1 };

/* A rigid body with every fixed link merged in. Body 0 is the floating base (pelvis); body i + 1
 * is moved by joint i. Parents come before their children. */
typedef struct GaitdBody {
  char name[GAITD_NAME_SIZE];
  int32_t parent;    /* body index, -1 for body 0 */
  int32_t joint;     /* joint that moves it, -1 for body 0 */
  double mass;       /* kg */
  double com[3];     /* m, body frame */
  double inertia[6]; /* kg m^2 about the centre of mass, body axes: xx xy xz yy yz zz */
  double reserve[2]; /* 0 */
} GaitdBody;

/* The frame of the child body equals the joint frame at position zero. */
typedef struct GaitdJoint {
  char name[GAITD_NAME_SIZE];
  int32_t type;
  int32_t parent_body;
  int32_t child_body;
  int32_t reserved;
  double origin[3];      /* m, joint frame origin in the parent body frame */
  double orientation[4]; /* joint frame in the parent body frame at position zero */
  double axis[3];        /* unit, joint frame */
  double position_min;   /* rad or m */
  double position_max;
  double velocity_limit; /* rad/s or m/s, > 0 */
  double effort_limit;   /* N m or N, > 0 */
  double rotor_inertia;  /* kg m^2 at the output, >= 0 */
  double damping;        /* N m s/rad, viscous, >= 0 */
  double reserve[4];     /* 0 */
} GaitdJoint;

typedef struct GaitdFrame {
  char name[GAITD_NAME_SIZE];
  int32_t body;
  int32_t reserved;
  double origin[3];      /* m, body frame */
  double orientation[4]; /* frame in the body frame */
  double reserve[2];     /* 0 */
} GaitdFrame;

typedef struct GaitdFoot {
  int32_t body;
  int32_t point_count;
  GaitdFrame sole;                         /* sole frame in the body of the foot */
  double points[GAITD_MAX_FOOT_POINTS][2]; /* m, sole frame, physical outline, counter-clockwise */
  double toe_point[3];                     /* m, sole frame: middle of the front edge */
  GaitdFrame force_sensor;                 /* body -1: the foot has none */
  double reserve[4];                       /* 0 */
} GaitdFoot;

/* Joint indices; -1 where the robot has no such joint. `bend` is +1 when a positive knee position
 * bends the leg; the hip and ankle pitch signs say which way follows a bending knee. */
typedef struct GaitdLeg {
  int32_t joint_count;
  int32_t joints[12]; /* from the pelvis to the foot */
  int32_t hip_pitch;
  int32_t knee;
  int32_t ankle_pitch;
  int32_t ankle_roll;
  int32_t reserved;
  double knee_bend_sign;        /* +1 or -1 */
  double hip_pitch_bend_sign;   /* sign of the hip pitch that goes with a bending knee */
  double ankle_pitch_bend_sign; /* likewise; also the sign of dorsiflexion */
  double reserve[4];            /* 0 */
} GaitdLeg;

/* Part of the shape of a body: every point within `radius` of the line between the ends. */
typedef struct GaitdCapsule {
  int32_t body;
  int32_t reserved;
  double ends[2][3]; /* m, body frame; the same twice: a sphere */
  double radius;     /* m, > 0 */
  double reserve[2]; /* 0 */
} GaitdCapsule;

/* What the robot carries and is not in its model: a point mass that moves with a body. */
typedef struct GaitdLoad {
  int32_t body;
  int32_t reserved;
  double mass;   /* kg, > 0 */
  double com[3]; /* m, body frame */
} GaitdLoad;

/* At most one on each body. */
typedef struct GaitdLoads {
  int32_t count;
  int32_t reserved;
  GaitdLoad loads[GAITD_MAX_LOADS];
} GaitdLoads;

typedef struct GaitdModel {
  uint32_t size;
  int32_t body_count;
  int32_t joint_count;
  int32_t imu_count;
  char name[GAITD_NAME_SIZE];
  double total_mass;
  double gravity; /* m/s^2, > 0 */
  GaitdBody bodies[GAITD_MAX_BODIES];
  GaitdJoint joints[GAITD_MAX_JOINTS];
  GaitdFrame imus[GAITD_MAX_IMUS];
  GaitdFoot feet[GAITD_MAX_FEET];
  GaitdLeg legs[GAITD_MAX_FEET];
  int32_t chest_body; /* body whose orientation the upper body task holds; 0 if none */
  int32_t reserved;
  double nominal_position[GAITD_MAX_JOINTS]; /* standing posture */
  double nominal_pelvis_height;              /* m, pelvis origin above the soles in that posture */
  double nominal_com_height;                 /* m, CoM above the soles in that posture */
  double nominal_foot_separation;            /* m, distance of the soles in y in that posture */
  GaitdFrame hands[GAITD_MAX_HANDS];         /* left, right; body 0: the robot has none there */
  int32_t capsule_count;                     /* 0: nothing is known of the shape */
  int32_t reserved_capsules;
  GaitdCapsule capsules[GAITD_MAX_CAPSULES]; /* that are not to touch each other */
} GaitdModel;

#ifdef __cplusplus
}
#endif

#endif /* GAITD_ABI_MODEL_H_ */
