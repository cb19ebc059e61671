// SPDX-License-Identifier: Apache-2.0
#include "cli/commands.h"

#include "cli/calibrate/calibrate_command.h"
#include "cli/campaign/campaign_command.h"
#include "cli/compare_command.h"
#include "cli/completion_command.h"
#include "cli/daemon_commands.h"
#include "cli/doctor/doctor_command.h"
#include "cli/drive_command.h"
#include "cli/goto_command.h"
#include "cli/help.h"
#include "cli/joint_commands.h"
#include "cli/log_commands.h"
#include "cli/map_command.h"
#include "cli/param_commands.h"
#include "cli/plugin_commands.h"
#include "cli/report/report_command.h"
#include "cli/robot/robot_command.h"
#include "cli/run_command.h"
#include "cli/teleop/teleop_command.h"
#include "cli/view/view_command.h"
#include "cli/watch_command.h"

namespace gaitd::cli {

void add_commands(CLI::App* app, Context* context) {
  add_daemon_commands(app, context);
  add_drive_command(app, context);
  add_goto_command(app, context);
  add_map_command(app, context);
  add_teleop_command(app, context);
  add_plugin_commands(app, context);
  add_joint_commands(app, context);
  add_calibrate_command(app, context);
  add_param_commands(app, context);
  add_watch_command(app, context);
  add_view_command(app, context);
  add_run_command(app, context);
  add_campaign_command(app, context);
  add_compare_command(app, context);
  add_log_commands(app, context);
  add_report_command(app, context);
  add_doctor_command(app, context);
  add_robot_command(app, context);
  add_completion_command(app, context);
  add_help(app);
}

}  // namespace gaitd::cli
