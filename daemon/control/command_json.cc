// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/command_json.h"

#include <nlohmann/json.hpp>

namespace gaitd::daemon {
namespace {

using nlohmann::json;

// Calls `field(name, value)` for everything that a footstep of a command says; both directions.
template <class Footstep, class Field>
void visit(Footstep& step, Field&& field) {
  field("side", step.side);
  field("position", step.pose.position);
  field("orientation", step.pose.orientation);
  field("swing_duration", step.swing_duration);
  field("transfer_duration", step.transfer_duration);
  field("swing_height", step.swing_height);
  field("closing", step.closing);
  field("polygon_count", step.polygon_count);
  field("region_count", step.region_count);
  field("contact_polygon", step.contact_polygon);
  field("landing_region", step.landing_region);
}

template <class Test, class Field>
void visit_joint_test(Test& test, Field&& field) {
  field("joint", test.joint);
  field("amplitude", test.amplitude);
  field("duration", test.duration);
}

template <class Motion, class Field>
void visit_motion(Motion& motion, Field&& field) {
  field("kind", motion.kind);
  field("frame", motion.frame);
  field("axis_mask", motion.axis_mask);
}

template <class Point, class Field>
void visit_point(Point& point, Field&& field) {
  field("time", point.time);
  field("value", point.value);
}

template <class Load, class Field>
void visit_load(Load& load, Field&& field) {
  field("body", load.body);
  field("mass", load.mass);
  field("com", load.com);
}

template <class Handhold, class Field>
void visit_handhold(Handhold& handhold, Field&& field) {
  field("hand", handhold.hand);
  field("release", handhold.release);
  field("normal", handhold.normal);
  field("friction", handhold.friction);
  field("force", handhold.force);
}

template <class Walk, class Field>
void visit_walk(Walk& walk, Field&& field) {
  field("steps", walk.steps);
  field("length", walk.length);
  field("lateral", walk.lateral);
  field("width", walk.width);
  field("turn", walk.turn);
  field("swing_duration", walk.swing_duration);
  field("transfer_duration", walk.transfer_duration);
  field("first_side", walk.first_side);
}

template <class Drive, class Field>
void visit_drive(Drive& drive, Field&& field) {
  field("forward", drive.velocity.forward);
  field("lateral", drive.velocity.lateral);
  field("turn", drive.velocity.turn);
  field("session", drive.session);
  field("renewal", drive.renewal);
  field("holds", drive.holds);
}

struct Write {
  json* out;
  template <class T>
  void operator()(const char* name, const T& value) const {
    (*out)[name] = value;
  }
};
template <class T>
void read(const json& in, T& value) {
  in.get_to(value);
}
template <class T, std::size_t kSize>
void read(const json& in, T (&values)[kSize]) {
  for (std::size_t i = 0; i < kSize; ++i) read(in.at(i), values[i]);
}
struct Read {
  const json* in;
  template <class T>
  void operator()(const char* name, T& value) const {
    read(in->at(name), value);
  }
};

}  // namespace

std::string input_text(const Command& c, int parameter_owner, int parameter_place) {
  json out = {{"type", static_cast<int>(c.type)}};
  switch (c.type) {
    case CommandType::kMode:
      out["mode"] = c.mode;
      break;
    case CommandType::kWalk:
      visit_walk(c.walk, Write{&out});
      break;
    case CommandType::kFootsteps:
    case CommandType::kRefine:
      out["replace"] = c.replace;
      if (c.routed) out["routed"] = true;
      out["footsteps"] = json::array();
      for (int i = 0; i < c.footstep_count; ++i) {
        json step;
        visit(c.footsteps[i], Write{&step});
        if (c.footsteps[i].id != 0) step["id"] = c.footsteps[i].id;
        if (c.footsteps[i].region_told != 0) step["region_told"] = c.footsteps[i].region_told;
        out["footsteps"].push_back(std::move(step));
      }
      break;
    case CommandType::kPush:
      out["body"] = c.push.body;
      out["point"] = c.push.point;
      out["force"] = c.push.force;
      out["duration"] = c.push.duration;
      break;
    case CommandType::kSimLoad:
      visit_load(c.load, Write{&out});
      break;
    case CommandType::kPayload:
      out["action"] = static_cast<int>(c.payload.action);
      visit_load(c.payload.load, Write{&out});
      break;
    case CommandType::kHandhold:
      visit_handhold(c.handhold, Write{&out});
      break;
    case CommandType::kJointTest:
      visit_joint_test(c.joint_test, Write{&out});
      break;
    case CommandType::kPose:
      out["part"] = c.pose.part;
      visit_motion(c.pose.motion, Write{&out});
      out["points"] = json::array();
      for (int i = 0; i < c.pose.motion.point_count; ++i) {
        json point;
        visit_point(c.pose.motion.points[i], Write{&point});
        out["points"].push_back(std::move(point));
      }
      break;
    case CommandType::kDrive:
      visit_drive(c.drive, Write{&out});
      if (c.drive.ends) out["ends"] = true;
      break;
    case CommandType::kSetParameter:
      out["owner"] = parameter_owner;
      out["place"] = parameter_place;
      out["value"] = c.parameter_value;
      break;
    default:
      break;
  }
  return out.dump();
}

bool read_input(const json& in, Command* c, int* parameter_owner, int* parameter_place) {
  try {
    *c = Command{};
    c->type = static_cast<CommandType>(in.at("type").get<int>());
    if (c->type == CommandType::kMode) c->mode = in.at("mode").get<int>();
    if (c->type == CommandType::kWalk) visit_walk(c->walk, Read{&in});
    if (c->type == CommandType::kJointTest) visit_joint_test(c->joint_test, Read{&in});
    if (c->type == CommandType::kSimLoad) visit_load(c->load, Read{&in});
    if (c->type == CommandType::kHandhold) visit_handhold(c->handhold, Read{&in});
    if (c->type == CommandType::kPayload) {
      c->payload.action = static_cast<PayloadAction>(in.at("action").get<int>());
      visit_load(c->payload.load, Read{&in});
    }
    if (c->type == CommandType::kPose) {
      GaitdMotion& motion = c->pose.motion;
      c->pose.part = in.at("part").get<int>();
      visit_motion(motion, Read{&in});
      for (const json& point : in.at("points")) {
        if (motion.point_count >= GAITD_MAX_MOTION_POINTS) return false;
        visit_point(motion.points[motion.point_count++], Read{&point});
      }
    }
    if (c->type == CommandType::kDrive) {
      visit_drive(c->drive, Read{&in});
      c->drive.ends = in.value("ends", false);
    }
    if (c->type == CommandType::kFootsteps || c->type == CommandType::kRefine) {
      c->replace = in.at("replace").get<bool>();
      c->routed = in.value("routed", false);
      for (const json& step : in.at("footsteps")) {
        if (c->footstep_count >= static_cast<int>(c->footsteps.size())) return false;
        GaitdFootstep& footstep = c->footsteps[c->footstep_count++];
        footstep = {};
        visit(footstep, Read{&step});
        footstep.id = step.value("id", std::uint32_t{0});
        footstep.region_told = step.value("region_told", 0);
      }
    }
    if (c->type == CommandType::kSetParameter) {
      *parameter_owner = in.at("owner").get<int>();
      *parameter_place = in.at("place").get<int>();
      c->parameter_value = in.at("value").get<double>();
    }
    return true;
  } catch (const json::exception&) {
    return false;
  }
}

}  // namespace gaitd::daemon
