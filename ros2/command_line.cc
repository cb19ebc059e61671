// SPDX-License-Identifier: Apache-2.0
#include "ros2/command_line.h"

#include <CLI/CLI.hpp>
#include <string>

#include "ros2/names.h"

namespace gaitd::ros2 {
namespace {

constexpr unsigned kLastDomain = 232;  // beyond it there are no ports

}  // namespace

void add_options(CLI::App* app, BridgeOptions* options) {
  app->set_version_flag("--version", GAITD_VERSION, "Show the version and exit");
  app->add_option("--socket", options->socket, "Unix socket of gaitd")->type_name("FILE");
  app->add_option("--domain", options->domain, "DDS domain, 0 to 232")
      ->check(CLI::Range(0u, kLastDomain))
      ->envname("ROS_DOMAIN_ID")
      ->type_name("NUMBER");
  app->add_flag("--localhost", options->localhost,
                "Speak with this machine alone, whatever CYCLONEDDS_URI says")
      ->envname("ROS_LOCALHOST_ONLY");
  app->add_option_function<std::string>(
         "--namespace",
         [options](const std::string& text) {
           const auto name_space = normalised_namespace(text);
           if (!name_space) {
             throw CLI::ValidationError(
                 "--namespace: expected segments of letters, digits and _, "
                 "as /robots/one, got '" +
                 text + "'");
           }
           options->name_space = *name_space;
         },
         "Namespace of the topics, but for /tf, /tf_static, /diagnostics and /clock")
      ->type_name("NAME");
  app->add_option("--rate", options->rate,
                  "Joint states, transforms, odometry and wrenches, Hz, 1 to 200")
      ->check(CLI::Range(1.0, 200.0))
      ->type_name("HZ");
  app->add_flag("--best-effort", options->best_effort,
                "Joint states, odometry and wrenches as sensor data: best effort");
  app->add_flag("--sim-time", options->sim_time,
                "Stamps of the tick clock instead of wall time, and /clock");
  auto* drive = app->add_flag("--drive", options->drive,
                              "Let whoever is on the domain walk the robot by /cmd_vel");
  app->add_flag("--stamped", options->stamped, "/cmd_vel holds TwistStamped instead of Twist")
      ->needs(drive);
  app->add_flag("--auto-mode", options->auto_mode,
                "Set the mode walk-straight where a velocity comes in mode stand")
      ->needs(drive);
  app->add_option("--timeout", options->timeout,
                  "Without a velocity for this time the robot stops, s, 0.1 to 5")
      ->check(CLI::Range(0.1, 5.0))
      ->needs(drive)
      ->type_name("S");
  app->add_flag("!--no-e-stop", options->estop, "Do not take e-stops from /e_stop");
  app->footer("Exit codes: 0 ended as asked, 1 no DDS, 2 usage.");
}

usage::ManText man_text() {
  return {.name = "gaitd-ros2",
          .section = "8",
          .version = GAITD_VERSION,
          .summary = "gaitd(8) on the topics of ROS 2",
          .description =
              "Publishes what gaitd knows of the robot as ROS 2 would, over DDS and without an "
              "installation of ROS: joint_states, odom, foot/left/wrench, foot/right/wrench and "
              "robot_description, and /tf, /tf_static and /diagnostics. It takes e_stop and, with "
              "--drive, cmd_vel. It waits for gaitd, and comes back when gaitd does.\n\n"
              "DDS asks nobody who he is: whoever reaches the domain may stop the robot, and with "
              "--drive walk it.\n",
          .sections = {
              {"EXIT STATUS",
               "0\tIt ended as asked, by SIGINT or SIGTERM.\n"
               "1\tDDS did not start; the reason is on standard output.\n"
               "2\tThe command line is wrong.\n"},
              {"ENVIRONMENT",
               "ROS_DOMAIN_ID\tThe domain, without --domain.\n"
               "ROS_LOCALHOST_ONLY\t1: as --localhost.\n"
               "CYCLONEDDS_URI\tConfiguration of CycloneDDS: interfaces, peers, discovery.\n"},
              {"EXAMPLES",
               "    gaitd-ros2 --localhost\n"
               "    gaitd-ros2 --domain 42 --namespace /atlas --drive --auto-mode\n"
               "    ros2 topic pub -r 10 /cmd_vel geometry_msgs/msg/Twist '{linear: {x: 0.3}}'\n"
               "    ros2 topic pub --once /e_stop std_msgs/msg/Bool '{data: true}'\n"},
              {"SEE ALSO", "gaitd(8), gaitctl(1)\n"}}};
}

}  // namespace gaitd::ros2
