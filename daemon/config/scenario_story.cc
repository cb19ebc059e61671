// SPDX-License-Identifier: Apache-2.0
// What the commands, disturbances and expectations of a scenario say together: what cannot happen
// is an error before the run.
#include <algorithm>
#include <cstdio>

#include "daemon/config/command_parse.h"
#include "daemon/config/names.h"
#include "daemon/config/scenario_sections.h"

namespace gaitd::daemon {
namespace {

// No footstep is done sooner: the shortest transfer and swing that a command may ask for (s).
constexpr double kShortestStep = 0.1;
// A velocity asks for as many as there is time for, a goto for as many as it takes.
constexpr long long kStepsOfDrive = 10000;

std::string at_time(double time) {
  char text[32];
  std::snprintf(text, sizeof text, "%g s", time);
  return text;
}

// Goes through the commands in the order of time. The robot of a simulation arms itself.
class Story {
 public:
  Story(int mode, bool hangs, Issues* issues)
      : mode_(mode), hangs_(hangs), issues_(issues), stopped_by_(hangs ? kHoist : "") {}

  void tell(const ScenarioCommand& scenario_command, const Command& command) {
    at_ = &scenario_command;
    switch (command.type) {
      case CommandType::kArm:
        if (stopped_by_ == "estop") refuse("arm", "a fault is latched by 'estop'", "add a reset");
        stopped_by_.clear();
        break;
      case CommandType::kDisarm:
      case CommandType::kEstop:
        stopped_by_ = scenario_command.method;
        stopped_at_ = scenario_command.at;
        last_.reset();
        break;
      case CommandType::kReset:
        if (stopped_by_ == "estop") stopped_by_ = "reset";
        break;
      case CommandType::kSimReset:
        stopped_by_ = hangs_ ? kHoist : "";
        last_.reset();
        break;
      case CommandType::kMode:
        mode_ = command.mode;
        if (mode_ == GAITD_MODE_STAND) last_.reset();
        break;
      case CommandType::kWalk:
        tell_walk(command.walk);
        break;
      case CommandType::kFootsteps:
        tell_footsteps(command);
        break;
      case CommandType::kDrive:
      case CommandType::kGoto:
        check_armed();
        check_mode();
        last_.reset();
        break;
      case CommandType::kJointTest:
        if (stopped_by_.empty()) {
          refuse(at_->method, "the robot is armed", "add disarm, or start: {hoist: {}}");
        }
        break;
      case CommandType::kPause:
      case CommandType::kResume:
      case CommandType::kPose:
      case CommandType::kTare:
      case CommandType::kPayload:
      case CommandType::kHandhold:
        check_armed();
        break;
      case CommandType::kStop:
      case CommandType::kAbort:
        last_.reset();
        break;
      default:
        break;
    }
  }

 private:
  // The footstep that is ahead for certain until `until`.
  struct Ahead {
    int side = GAITD_BOTH;
    double until = 0.0;
    int line = 0;
  };

  void refuse(std::string_view what, const std::string& why, std::string_view advice) {
    issues_->add_text(at_->where, "commands",
                      std::string(what) + " at " + at_time(at_->at) + " will be refused: " + why +
                          "; " + std::string(advice));
  }

  void check_armed() {
    if (stopped_by_.empty()) return;
    if (stopped_by_ == kHoist) {
      return refuse(at_->method, "the robot hangs on its hoist, disarmed", "add arm before it");
    }
    refuse(at_->method,
           "the robot is not armed since '" + stopped_by_ + "' at " + at_time(stopped_at_),
           stopped_by_ == "estop" ? "add reset and arm before it" : "add arm before it");
  }

  void check_mode() {
    if (mode_ != GAITD_MODE_STAND) return;
    refuse(at_->method, "the gait mode is stand", "write mode: walk-bent");
  }

  void check_side(int first) {
    if (!last_ || at_->at >= last_->until || first == GAITD_BOTH || first != last_->side) return;
    refuse(at_->method,
           "it begins " + std::string(kSideNames[first]) + ", as the footsteps ahead of line " +
               std::to_string(last_->line) + " end",
           "let it begin with the other foot, or later when they are done");
  }

  void tell_walk(const walking::WalkCommand& walk) {
    check_armed();
    check_mode();
    check_side(walk.first_side);
    int first = walk.first_side;
    if (first == GAITD_BOTH) first = last_ && at_->at < last_->until ? 1 - last_->side : GAITD_BOTH;
    if (first == GAITD_BOTH) return last_.reset();
    put_ahead(walk.steps % 2 == 0 ? first : 1 - first, walk.steps + 1);  // the closing step
  }

  void tell_footsteps(const Command& command) {
    check_armed();
    check_mode();
    if (command.footstep_count == 0) return;
    if (!command.replace) check_side(command.footsteps[0].side);
    for (int i = 1; i < command.footstep_count; ++i) {
      if (command.footsteps[i].side != command.footsteps[i - 1].side) continue;
      refuse(at_->method,
             "footsteps " + std::to_string(i) + " and " + std::to_string(i + 1) + " are both " +
                 std::string(kSideNames[command.footsteps[i].side]),
             "let the sides alternate");
      break;
    }
    put_ahead(command.footsteps[command.footstep_count - 1].side, command.footstep_count);
  }

  void put_ahead(int side, int count) {
    const double begin = last_ && at_->at < last_->until ? last_->until : at_->at;
    last_ = Ahead{side, begin + kShortestStep * count, at_->where.line};
  }

  static constexpr const char* kHoist = "start.hoist";

  int mode_;
  bool hangs_;
  Issues* issues_;
  const ScenarioCommand* at_ = nullptr;
  std::string stopped_by_;  // the command after which the robot is not armed; "": it is
  double stopped_at_ = 0.0;
  std::optional<Ahead> last_;
};

}  // namespace

CommandedSteps check_commands(const std::vector<ScenarioCommand>& commands, int mode, bool hangs,
                              Issues* issues) {
  CommandedSteps steps;
  Story story(mode, hangs, issues);
  for (const ScenarioCommand& scenario_command : commands) {
    Issues ignored;  // reported when the command was read
    const auto command = parse_command(scenario_command.method,
                                       from_json(scenario_command.params, scenario_command.where),
                                       nullptr, "", &ignored);
    if (!command) continue;
    story.tell(scenario_command, *command);
    if (command->type == CommandType::kWalk) {
      steps.advancing += command->walk.steps;
      ++steps.closing;
    }
    if (command->type == CommandType::kDrive || command->type == CommandType::kGoto) {
      steps.advancing += kStepsOfDrive;
    }
    if (command->type == CommandType::kFootsteps) steps.advancing += command->footstep_count;
  }
  return steps;
}

void check_expectations(const Expectations& expect, const CommandedSteps& steps, double duration,
                        MapReader* map) {
  const std::string commanded = std::to_string(steps.advancing) + " by the commands";
  const auto at_most = [&](std::string_view key, const std::optional<int>& value) {
    if (!value || *value <= steps.advancing) return;
    map->fail(key, "at most the steps that are commanded, " + commanded, std::to_string(*value),
              steps.advancing == 0 ? "add a walk to 'commands'" : "lower it or walk further");
  };
  at_most("steps_taken", expect.steps_taken);
  at_most("toe_off_steps_min", expect.toe_off_steps_min);
  if (expect.stance_knee_mean_max && steps.advancing == 0) {
    map->fail("stance_knee_mean_max", "a walk, as it is taken over single support", "none",
              "add a walk to 'commands'");
  }
  for (const SignalCheck& check : expect.checks) {
    const bool walks = check.during != During::kAlways && check.during != During::kStand;
    if (!walks || steps.advancing > 0) continue;
    map->fail("checks", "a walk, as '" + check.signal + "' is checked while walking", "none",
              "add a walk to 'commands' or write 'during: always'");
  }
  if (expect.pelvis_drift_max && expect.pelvis_drift_max->start >= duration) {
    map->fail("pelvis_drift_max", "a start before the end of the scenario",
              at_time(expect.pelvis_drift_max->start),
              "make 'duration' longer or the time smaller");
  }
}

}  // namespace gaitd::daemon
