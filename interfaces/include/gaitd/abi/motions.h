/* SPDX-License-Identifier: Apache-2.0
 *
 * What is asked of the body beyond its steps, and where its parts are to be now. Conventions:
 * gaitd/abi/types.h.
 */
#ifndef GAITD_ABI_MOTIONS_H_
#define GAITD_ABI_MOTIONS_H_

#include "gaitd/abi/gait.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What moves. An arm and its hand are one part: the later motion holds. */
enum {
  GAITD_PART_PELVIS = 0,
  GAITD_PART_CHEST = 1,
  GAITD_PART_LEFT_ARM = 2,
  GAITD_PART_RIGHT_ARM = 3,
  GAITD_PART_COUNT = 4
};
enum {
  GAITD_MOTION_NONE = 0,   /* as the robot holds the part by itself */
  GAITD_MOTION_PELVIS = 1, /* axes 0-2: shift of the CoM, m; 3-5: turn of the pelvis */
  GAITD_MOTION_CHEST = 2,  /* axes 3-5: turn of the chest */
  GAITD_MOTION_ARM = 3,    /* axis i: joint i of the arm, from the chest to the hand, rad */
  GAITD_MOTION_HAND = 4    /* axes 0-2: place of the hand in `frame`, m; 3-5: turn in it */
};
enum { GAITD_RELATIVE_TO_WORLD = 0, GAITD_RELATIVE_TO_CHEST = 1, GAITD_RELATIVE_TO_PELVIS = 2 };

/* Turns are roll, pitch and yaw, rad: R = Rz(yaw) Ry(pitch) Rx(roll). Shift and turns of pelvis and
 * chest are against where the robot holds them by itself, in the axes of its heading. */
typedef struct GaitdMotionPoint {
  double time; /* s, since the motion began; they increase */
  double value[GAITD_MAX_MOTION_AXES];
} GaitdMotionPoint;

/* A way through points, from where the part is to rest at the last of them. */
typedef struct GaitdMotion {
  uint32_t id; /* another one: a motion that begins now; 0: none has begun yet */
  int32_t kind;
  int32_t frame;      /* GAITD_RELATIVE_TO_*, of a hand */
  uint32_t axis_mask; /* the others stay where they are when the motion begins */
  int32_t point_count;
  int32_t reserved;
  GaitdMotionPoint points[GAITD_MAX_MOTION_POINTS];
  double reserve[4]; /* 0 */
} GaitdMotion;

/* Everything that was asked of the body beyond its steps. */
typedef struct GaitdMotions {
  uint32_t size;
  uint32_t reserved;
  GaitdMotion parts[GAITD_PART_COUNT];
} GaitdMotions;

/* Where a hand is to be, and how far it is from there. */
typedef struct GaitdHandReference {
  int32_t active;        /* 0: nobody asked for a pose of this hand */
  int32_t on_its_way;    /* 1: until a moment after the last point of its motion */
  GaitdPose goal;        /* W, now */
  double position_error; /* m, of the robot as it is */
  double turn_error;     /* rad, likewise */
  double reach_error[2]; /* m, rad: what the arm misses by its limits */
  double reserve[4];     /* 0 */
} GaitdHandReference;

/* Where the parts of the body that take no steps are to be now. */
typedef struct GaitdTaskReferences {
  uint32_t size;
  int32_t reserved;
  double com_shift[3]; /* m, of the plan; axes of the heading */
  double com_shift_velocity[3];
  double com_shift_acceleration[3];
  double pelvis_turn[4]; /* of the pelvis, against where it would be; axes of the heading */
  double pelvis_turn_rate[3];
  double chest_turn[4]; /* of the chest, likewise */
  double chest_turn_rate[3];
  /* Of arms, neck and the like: the nominal position where nobody asked for another one. */
  double joint_position[GAITD_MAX_JOINTS];
  double joint_velocity[GAITD_MAX_JOINTS];
  double joint_acceleration[GAITD_MAX_JOINTS];
  GaitdHandReference hands[GAITD_MAX_HANDS];
} GaitdTaskReferences;

#ifdef __cplusplus
}
#endif

#endif /* GAITD_ABI_MOTIONS_H_ */
