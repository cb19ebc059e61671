/* SPDX-License-Identifier: Apache-2.0
 *
 * The walk: footsteps and gait state, the ICP plan, the adjusted step, and toe-off. Conventions:
 * gaitd/abi/types.h.
 */
#ifndef GAITD_ABI_GAIT_H_
#define GAITD_ABI_GAIT_H_

#include "gaitd/abi/model.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { GAITD_MODE_STAND = 0, GAITD_MODE_WALK_STRAIGHT = 1, GAITD_MODE_WALK_BENT = 2 };
enum { GAITD_PHASE_STAND = 0, GAITD_PHASE_TRANSFER = 1, GAITD_PHASE_SWING = 2 };

typedef struct GaitdPose {
  double position[3];
  double orientation[4];
} GaitdPose;

typedef struct GaitdFootstep {
  int32_t side;
  uint32_t id;              /* counts footsteps since start-up, from 1 */
  GaitdPose pose;           /* sole frame in W */
  double swing_duration;    /* s */
  double transfer_duration; /* s, of the transfer before the swing */
  double swing_height;      /* m, above the higher of lift-off and touchdown */
  int32_t polygon_count;    /* 0: whole sole */
  int32_t region_count;     /* 0: anywhere */
  int32_t closing;          /* brings the feet side by side; not counted as a step */
  int32_t region_told;      /* whoever sent the footstep wants it in that region */
  double contact_polygon[GAITD_MAX_FOOT_POINTS][2];  /* m, sole frame, counter-clockwise */
  double landing_region[GAITD_MAX_REGION_POINTS][3]; /* m, W, convex, counter-clockwise */
  double reserve[8];                                 /* 0 */
} GaitdFootstep;

/* Where a foot stands or stood last, with the part of the sole that may carry load. */
typedef struct GaitdFoothold {
  GaitdPose pose;
  int32_t contact; /* commanded: GAITD_CONTACT_* */
  int32_t polygon_count;
  double contact_polygon[GAITD_MAX_FOOT_POINTS][2]; /* m, sole frame, never empty */
  double reserve[4];                                /* 0 */
} GaitdFoothold;

typedef struct GaitdGaitState {
  uint32_t size;
  int32_t mode;
  int32_t phase;
  int32_t support;        /* GAITD_LEFT, GAITD_RIGHT or GAITD_BOTH */
  int32_t step_index;     /* of the current transfer or swing, from 1; 0 before the first */
  int32_t footstep_count; /* footsteps ahead, the current one included; at most the maximum */
  int32_t early_contact;
  int32_t late_contact;
  int32_t paused;
  int32_t plan_revision;  /* changes whenever footsteps, phase or timing changed */
  int32_t next_side;      /* foot that swings now or next; GAITD_BOTH when none */
  int32_t transfer_final; /* this transfer ends in standing */
  int32_t trailing_side;  /* transfer: foot that the load leaves; GAITD_BOTH from standing */
  int32_t reserved;
  double omega;                   /* 1/s, natural frequency of the ICP */
  double time_in_phase;           /* s */
  double phase_duration;          /* s, as planned; infinite standing is 0 */
  double time_remaining;          /* s, >= 0 */
  double final_transfer_duration; /* s, of the transfer after the last footstep */
  GaitdFoothold footholds[GAITD_MAX_FEET];
  GaitdFootstep commanded[GAITD_MAX_FOOTSTEPS];
  GaitdFootstep adjusted[GAITD_MAX_FOOTSTEPS]; /* commanded + shifts: what everybody uses */
} GaitdGaitState;

typedef struct GaitdIcpPlan {
  uint32_t size;
  int32_t reserved;
  double icp[2];          /* m, W */
  double icp_velocity[2]; /* m/s */
  double ecmp[2];         /* m, W */
  double icp_end[2];      /* m, at the end of the phase */
  /* m, at the next touchdown, and at the end of the transfer that follows it; icp_end when no step
     is ahead */
  double icp_touchdown[2];
  double icp_transferred[2];
  double kappa;          /* kappa reference, section 1 of the theory */
  double time_remaining; /* s, of the phase */
  double offset[2];      /* m, decaying difference between this reference and the pure plan */
  double gamma[GAITD_MAX_FOOTSTEPS]; /* d icp / d foothold i, all later footholds moving along */
} GaitdIcpPlan;

typedef struct GaitdStepAdjustment {
  uint32_t size;
  int32_t active;
  double shift[3];                 /* m, W, absolute against the commanded foothold */
  double time_shift;               /* s, absolute against the planned duration of the phase */
  double ecmp[2];                  /* m, desired */
  double cmp[2];                   /* m, desired, inside the support polygon plus excursion */
  double kappa;                    /* that was used between the two */
  double linear_momentum_rate[2];  /* N, desired */
  double angular_momentum_rate[3]; /* N m, about the CoM; only rows in the mask; small ones weigh
                                      little */
  int32_t angular_momentum_mask;
  int32_t reserved;
} GaitdStepAdjustment;

enum {
  GAITD_TOE_OFF_ICP = 0,
  GAITD_TOE_OFF_ICP_DISTANCE = 1,
  GAITD_TOE_OFF_COP = 2,
  GAITD_TOE_OFF_CMP = 3,
  GAITD_TOE_OFF_ANKLE = 4,
  GAITD_TOE_OFF_CRITERIA = 5
};

typedef struct GaitdToeOff {
  uint32_t size;
  int32_t active;
  int32_t side;
  int32_t reserved;
  double toe_point[3];                      /* m, sole frame */
  double criterion[GAITD_TOE_OFF_CRITERIA]; /* value, see the layer's documentation */
  int32_t satisfied[GAITD_TOE_OFF_CRITERIA + 1];
} GaitdToeOff;

#ifdef __cplusplus
}
#endif

#endif /* GAITD_ABI_GAIT_H_ */
