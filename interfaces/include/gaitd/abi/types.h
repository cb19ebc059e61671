/* SPDX-License-Identifier: Apache-2.0
 *
 * The plain structs that layers exchange. C99, no dependency, fixed-width types.
 *
 * Conventions, everywhere unless a field says otherwise:
 *   SI units, radians; world frame W: x forward, z up.
 *   Twists, momenta and Jacobian rows: angular first, then linear.
 *   Wrenches: moment first, then force, at the same point.
 *   Quaternions: x, y, z, w, rotating vectors of the named frame into its parent frame.
 *   Sole frame: origin at the middle of the sole, x towards the toe, y left, z up.
 *   Feet are indexed GAITD_LEFT, GAITD_RIGHT. Masks: bit i is row or joint i.
 * Structs are frozen: fields are only ever appended at the tail, `size` says how much is there.
 * Structs that stand in arrays or inside others have no `size`: they grow into their `reserve`.
 */
#ifndef GAITD_ABI_TYPES_H_
#define GAITD_ABI_TYPES_H_

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
  GAITD_MAX_MOTION_AXES = 12,
  GAITD_MAX_MOTION_POINTS = 16,
  GAITD_NAME_SIZE = 48
};

enum { GAITD_LEFT = 0, GAITD_RIGHT = 1, GAITD_BOTH = 2 };

/* ---------------------------------------------------------------------------------- model -- */

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

/* -------------------------------------------------------------------------------- sensors -- */

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
  double icp[2]; /* m, W, with omega of the gait */
  double cop[2]; /* m, W, of both feet together; last valid one in flight */
  GaitdFootState feet[GAITD_MAX_FEET];
  double pelvis_velocity_covariance[9]; /* (m/s)^2, W, row-major */
  double external_wrench[6];            /* moment first, about the CoM, W */
} GaitdRobotState;

/* ----------------------------------------------------------------------------------- gait -- */

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
  int32_t reserved;
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

/* -------------------------------------------------------------------------------- motions -- */

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

/* -------------------------------------------------------------------------------- planner -- */

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
  double angular_momentum_rate[3]; /* N m, about the CoM; only rows in the mask are wanted */
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

/* ----------------------------------------------------------------------------- objectives -- */

typedef struct GaitdContactPoint {
  int32_t side;
  int32_t body;
  double point[3];   /* m, body frame */
  double normal[3];  /* unit, W */
  double tangent[3]; /* unit, W, first edge direction of the friction pyramid */
  double friction;
  double rho_min;    /* N, of each basis vector */
  double rho_max;    /* N, of each basis vector; may be 0 while a point is being loaded */
  double reserve[4]; /* 0 */
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

/* ------------------------------------------------------------------------------- commands -- */

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
} GaitdWbcInfo;

/* ---------------------------------------------------------------------------------- truth -- */

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

#endif /* GAITD_ABI_TYPES_H_ */
