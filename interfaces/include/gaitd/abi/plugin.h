/* SPDX-License-Identifier: Apache-2.0
 *
 * The plugin contract. A plugin is one shared library with two exported symbols:
 *   gaitd_plugin  a constant GaitdPluginDescriptor in the section ".gaitd_plugin": plain data
 *                 without pointers, so that the host reads it from the file without loading it;
 *   gaitd_create  makes instances.
 * Threads: [main] any thread but the real-time one; [rt] the real-time thread, which must not
 * allocate, lock, block, throw, do I/O or read a clock.
 */
#ifndef GAITD_ABI_PLUGIN_H_
#define GAITD_ABI_PLUGIN_H_

#include "gaitd/abi/types.h"

#ifdef __cplusplus
extern "C" {
#endif

#define GAITD_PLUGIN_MAGIC 0x6e67706474696167ULL /* "gaitdpgn" */
#define GAITD_ABI_MAJOR 1
#define GAITD_ABI_MINOR 0
#define GAITD_PLUGIN_SECTION ".gaitd_plugin"
#define GAITD_PLUGIN_SYMBOL "gaitd_plugin"
#define GAITD_CREATE_SYMBOL "gaitd_create"

enum { GAITD_MAX_PARAMETERS = 96, GAITD_DESCRIPTION_SIZE = 120, GAITD_UNIT_SIZE = 16 };

enum {
  GAITD_LAYER_STATE_ESTIMATOR = 0,
  GAITD_LAYER_ICP_PLANNER = 1,
  GAITD_LAYER_STEP_ADJUSTER = 2,
  GAITD_LAYER_TOE_OFF = 3,
  GAITD_LAYER_WHOLE_BODY_CONTROLLER = 4,
  GAITD_LAYER_TASK_SOURCE = 5,
  GAITD_LAYER_COUNT = 6,
  GAITD_LAYER_BACKEND = 100
};

/* What a descriptor says of its plugin beyond its layer. */
enum {
  GAITD_CAPABILITY_SIMULATION = 1 << 0 /* a backend: no hardware; truth, disturb and reset work */
};

typedef int32_t GaitdStatus;
enum {
  GAITD_OK = 0,
  GAITD_ERROR = -1,
  GAITD_INVALID_ARGUMENT = -2,
  GAITD_NOT_SUPPORTED = -3,
  GAITD_NOT_READY = -4,
  GAITD_EXCEPTION = -5
};

enum { GAITD_PARAMETER_REAL = 0, GAITD_PARAMETER_INTEGER = 1, GAITD_PARAMETER_BOOLEAN = 2 };

/* Whom a parameter is for. */
enum {
  GAITD_RANK_TUNING = 0,  /* who makes a robot walk better, or otherwise */
  GAITD_RANK_PORTING = 1, /* who brings gaitd to another robot, its sensors, its drives */
  GAITD_RANK_EXPERT = 2   /* who knows the code that it is read in */
};

/* Every value crosses the boundary as a double; integers and booleans must be whole. */
typedef struct GaitdParameter {
  char name[GAITD_NAME_SIZE];
  char unit[GAITD_UNIT_SIZE];
  char description[GAITD_DESCRIPTION_SIZE];
  int32_t type;
  int32_t rank; /* GAITD_RANK_* */
  double minimum;
  double maximum;
  double default_value;
} GaitdParameter;

typedef struct GaitdPluginDescriptor {
  uint64_t magic;
  uint32_t abi_major;
  uint32_t abi_minor;
  uint32_t struct_size; /* of this descriptor */
  int32_t layer;
  uint32_t layer_version;
  uint32_t capabilities;         /* GAITD_CAPABILITY_*; any other bit: refused */
  char id[GAITD_NAME_SIZE];      /* variant name: [a-z0-9_]+ */
  char version[GAITD_NAME_SIZE]; /* semantic version */
  char build[GAITD_NAME_SIZE];
  double worst_case_us; /* declared worst case of process(), a budget */
  uint32_t parameter_count;
  uint32_t reserved;
  GaitdParameter parameters[GAITD_MAX_PARAMETERS];
} GaitdPluginDescriptor;

enum { GAITD_LOG_DEBUG = 0, GAITD_LOG_INFO = 1, GAITD_LOG_WARNING = 2, GAITD_LOG_ERROR = 3 };

/* Services of the host. [main] */
typedef struct GaitdHost {
  uint32_t size;
  uint32_t abi_major;
  void* context;
  void (*log)(void* context, int32_t level, const char* message);
} GaitdHost;

/* ----------------------------------------------------------------------- layer contracts -- */
/*  layer                   reads                                        writes
 *  state_estimator         Sensors, GaitState*, JointCommands*, Start   RobotState
 *  icp_planner             RobotState, GaitState                        IcpPlan
 *  step_adjuster           RobotState, GaitState, IcpPlan, ToeOff*      StepAdjustment
 *  toe_off                 RobotState, GaitState, IcpPlan, StepAdj.     ToeOff
 *  whole_body_controller   RobotState, GaitState, ToeOff, Objectives    WbcOutput
 *  task_source             RobotState, GaitState, Motions               TaskReferences
 *  (* of the tick before)
 */
typedef struct GaitdLayerTime {
  int64_t tick;
  double time;   /* s, tick clock */
  double period; /* s, since the tick before */
} GaitdLayerTime;

/* Where the operator says the robot stands when the estimator is reset: middle of the feet. */
typedef struct GaitdStart {
  double position[3]; /* m, W */
  double yaw;         /* rad */
} GaitdStart;

typedef struct GaitdStateEstimatorInput {
  uint32_t size;
  uint32_t reserved;
  GaitdLayerTime time;
  GaitdStart start;
  double omega; /* 1/s */
  const GaitdSensors* sensors;
  const GaitdGaitState* gait;
  const GaitdJointCommands* commands;
  /* Of the last tick: that of GaitdRobotState, and the vertical force of a load on a standing robot
   * that is not in `loads` yet. Where it is not 0, the balance does not tell where gravity points.
   */
  double external_wrench[6];
  const GaitdLoads* loads; /* what the robot carries */
} GaitdStateEstimatorInput;

typedef struct GaitdIcpPlannerInput {
  uint32_t size;
  uint32_t reserved;
  GaitdLayerTime time;
  const GaitdRobotState* robot;
  const GaitdGaitState* gait;
} GaitdIcpPlannerInput;

typedef struct GaitdStepAdjusterInput {
  uint32_t size;
  uint32_t reserved;
  GaitdLayerTime time;
  const GaitdRobotState* robot;
  const GaitdGaitState* gait;
  const GaitdIcpPlan* plan;
  const GaitdToeOff* toe_off;
} GaitdStepAdjusterInput;

typedef struct GaitdToeOffInput {
  uint32_t size;
  uint32_t reserved;
  GaitdLayerTime time;
  const GaitdRobotState* robot;
  const GaitdGaitState* gait;
  const GaitdIcpPlan* plan;
  const GaitdStepAdjustment* adjustment;
} GaitdToeOffInput;

typedef struct GaitdWholeBodyControllerInput {
  uint32_t size;
  uint32_t reserved;
  GaitdLayerTime time;
  const GaitdRobotState* robot;
  const GaitdGaitState* gait;
  const GaitdToeOff* toe_off;
  const GaitdObjectives* objectives;
} GaitdWholeBodyControllerInput;

typedef struct GaitdWholeBodyControllerOutput {
  uint32_t size;
  uint32_t reserved;
  GaitdJointCommands commands;
  GaitdWbcInfo info;
} GaitdWholeBodyControllerOutput;

typedef struct GaitdTaskSourceInput {
  uint32_t size;
  uint32_t reserved;
  GaitdLayerTime time;
  const GaitdRobotState* robot;
  const GaitdGaitState* gait;
  const GaitdMotions* motions;
} GaitdTaskSourceInput;

/* Canonical state of each layer: what any variant needs to continue from any other. */
typedef struct GaitdStateEstimatorState {
  uint32_t size;
  int32_t initialised;
  double pelvis_position[3];
  double pelvis_orientation[4];
  double pelvis_velocity[3];    /* m/s, W */
  double gyro_bias[3];          /* rad/s, pelvis frame */
  double accelerometer_bias[3]; /* m/s^2, pelvis frame */
  int32_t contact[GAITD_MAX_FEET];
  double anchor[GAITD_MAX_FEET][3]; /* m, W: sole origin of a foot in contact */
  double anchor_yaw[GAITD_MAX_FEET];
} GaitdStateEstimatorState;

typedef struct GaitdIcpPlannerState {
  uint32_t size;
  int32_t phase;
  double icp[2];    /* last reference */
  double offset[2]; /* decaying difference */
  double start_ecmp[2];
  int32_t start_ecmp_valid;
  int32_t plan_revision;
} GaitdIcpPlannerState;

typedef struct GaitdStepAdjusterState {
  uint32_t size;
  int32_t step_index;
  double shift[3];
  double time_shift;
  double kappa;
  double direction[2];
  double integral[2]; /* m, of the feedback when standing */
} GaitdStepAdjusterState;

typedef struct GaitdToeOffState {
  uint32_t size;
  int32_t active;
  int32_t side;
  int32_t reserved;
  double time_satisfied;
} GaitdToeOffState;

typedef struct GaitdWholeBodyControllerState {
  uint32_t size;
  int32_t contact_count;
  double pelvis_acceleration[6];
  double joint_acceleration[GAITD_MAX_JOINTS];
  double rho[GAITD_MAX_CONTACTS][4];
  int32_t contact_body[GAITD_MAX_CONTACTS];
  double position_reference[GAITD_MAX_JOINTS];
  double velocity_reference[GAITD_MAX_JOINTS];
} GaitdWholeBodyControllerState;

/* How far a part is on the way of its motion: the way from there through the points that are left
 * is the way that it was on. */
typedef struct GaitdMotionProgress {
  uint32_t id;
  int32_t kind;   /* GAITD_MOTION_NONE: the robot holds the part by itself */
  double elapsed; /* s, since it began */
  /* Of the joints of an arm, else 0-2: position, 3-6: orientation, and 0-2: linear, 3-5: angular.
   */
  double value[GAITD_MAX_MOTION_AXES];
  double velocity[GAITD_MAX_MOTION_AXES];
  double acceleration[GAITD_MAX_MOTION_AXES];
} GaitdMotionProgress;

typedef struct GaitdTaskSourceState {
  uint32_t size;
  int32_t reserved;
  GaitdMotionProgress parts[GAITD_PART_COUNT];
  double joint_position[GAITD_MAX_JOINTS]; /* references of the last tick */
  double joint_velocity[GAITD_MAX_JOINTS];
} GaitdTaskSourceState;

/* input and output point to the structs of the layer. Every function returns a GaitdStatus. */
typedef struct GaitdLayerVtable {
  uint32_t size;
  uint32_t reserved;
  GaitdStatus (*init)(void* self, const GaitdModel* model, const double* parameters,
                      uint32_t parameter_count);                          /* [main] */
  GaitdStatus (*activate)(void* self);                                    /* [main] */
  GaitdStatus (*process)(void* self, const void* input, void* output);    /* [rt] */
  GaitdStatus (*reset)(void* self);                                       /* [rt] */
  GaitdStatus (*get_state)(void* self, void* state);                      /* [rt] */
  GaitdStatus (*set_state)(void* self, const void* state);                /* [rt] */
  GaitdStatus (*set_parameter)(void* self, uint32_t index, double value); /* [rt] */
  GaitdStatus (*deactivate)(void* self);                                  /* [main] */
  void (*destroy)(void* self);                                            /* [main] */
  const void* (*get_extension)(void* self, const char* id);               /* [main] */
} GaitdLayerVtable;

typedef struct GaitdInstance {
  void* self;
  const GaitdLayerVtable* vtable;
} GaitdInstance;

typedef GaitdStatus (*GaitdCreateFunction)(const GaitdHost* host, GaitdInstance* instance);

#ifdef __cplusplus
}
#endif

#endif /* GAITD_ABI_PLUGIN_H_ */
