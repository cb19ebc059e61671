// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/command_text.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>

#include "gaitd/sdk/layer_names.h"

namespace gaitd::daemon {
namespace {

constexpr const char* kNames[] = {
    "arm",    "disarm", "estop", "reset",     "mode",     "walk",      "footsteps",   "pause",
    "resume", "stop",   "abort", "param.set", "sim.push", "sim.reset", "plugin.swap", "joint.test",
    "pose",   "drive",  "goto",  "tare",      "payload",  "sim.load",  "handhold",    "refine"};

class Writer {
 public:
  Writer(char* buffer, std::size_t size) : buffer_(buffer), size_(size) {}
  __attribute__((format(printf, 2, 3))) void add(const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int n = std::vsnprintf(buffer_ + length_, size_ - length_, format, arguments);
    va_end(arguments);
    if (n > 0) length_ = std::min(length_ + static_cast<std::size_t>(n), size_ - 1);
  }
  void add_quoted(const char* text) {
    add("\"");
    for (; *text != '\0'; ++text) {
      const bool control = static_cast<unsigned char>(*text) < 0x20;
      add(*text == '"' || *text == '\\' ? "\\%c" : "%c", control ? ' ' : *text);
    }
    add("\"");
  }
  std::string_view text() const { return {buffer_, length_}; }

 private:
  char* buffer_;
  std::size_t size_;
  std::size_t length_ = 0;
};

// The last point of the way: where it leads.
void add_motion(Writer& w, const walking::MotionCommand& command) {
  constexpr const char* kParts[] = {"pelvis", "chest", "left arm", "right arm"};
  constexpr const char* kFrames[] = {"world", "chest", "pelvis"};
  const GaitdMotion& motion = command.motion;
  w.add(R"(,"part":"%s")", kParts[std::clamp<int>(command.part, 0, GAITD_PART_COUNT - 1)]);
  if (motion.kind == GAITD_MOTION_HAND) {
    w.add(R"(,"frame":"%s")", kFrames[std::clamp<int>(motion.frame, 0, 2)]);
  }
  if (motion.point_count < 1) return;
  const GaitdMotionPoint& end = motion.points[motion.point_count - 1];
  w.add(R"(,"points":%d,"duration":%.17g,"to":[)", motion.point_count, end.time);
  const int axes = motion.kind == GAITD_MOTION_ARM ? GAITD_MAX_MOTION_AXES : 6;
  for (int i = 0; i < axes; ++i) w.add(i == 0 ? "%.6g" : ",%.6g", end.value[i]);
  w.add("]");
}

void add_load(Writer& w, const GaitdLoad& load) {
  w.add(R"(,"body":%d,"mass":%.17g,"com":[%.17g,%.17g,%.17g])", load.body, load.mass, load.com[0],
        load.com[1], load.com[2]);
}

}  // namespace

std::string_view command_text(const Command& c, const CommandReply& reply, char* buffer,
                              std::size_t size) {
  Writer w(buffer, size);
  w.add(R"({"command":"%s","request":%llu,"accepted":%s)", kNames[static_cast<int>(c.type)],
        static_cast<unsigned long long>(c.request), reply.accepted ? "true" : "false");
  if (c.type == CommandType::kMode) w.add(R"(,"mode":%d)", c.mode);
  if (c.type == CommandType::kWalk) {
    w.add(R"(,"steps":%d,"length":%.17g,"lateral":%.17g,"width":%.17g,"turn":%.17g)", c.walk.steps,
          c.walk.length, c.walk.lateral, c.walk.width, c.walk.turn);
    w.add(R"(,"swing":%.17g,"transfer":%.17g,"first":%d)", c.walk.swing_duration,
          c.walk.transfer_duration, c.walk.first_side);
  }
  if (c.type == CommandType::kDrive) {
    w.add(R"(,"forward":%.17g,"lateral":%.17g,"turn":%.17g,"renew":%s)", c.drive.velocity.forward,
          c.drive.velocity.lateral, c.drive.velocity.turn, c.drive.renewal ? "true" : "false");
    if (c.drive.ends) w.add(R"(,"end":true)");
  }
  if (c.type == CommandType::kGoto) {
    w.add(R"(,"x":%.17g,"y":%.17g)", c.target.x, c.target.y);
    if (c.target.has_yaw) w.add(R"(,"yaw":%.17g)", c.target.yaw);
  }
  if (c.type == CommandType::kFootsteps) {
    w.add(R"(,"count":%d,"replace":%s)", c.footstep_count, c.replace ? "true" : "false");
  }
  if (c.type == CommandType::kRefine) w.add(R"(,"count":%d)", c.footstep_count);
  if (c.type == CommandType::kPush) {
    w.add(R"(,"body":%d,"force":[%.17g,%.17g,%.17g],"duration":%.17g)", c.push.body,
          c.push.force[0], c.push.force[1], c.push.force[2], c.push.duration);
  }
  if (c.type == CommandType::kSimLoad) add_load(w, c.load);
  if (c.type == CommandType::kPayload) {
    constexpr const char* kActions[] = {"set", "clear", "estimate"};
    w.add(R"(,"action":"%s")", kActions[static_cast<int>(c.payload.action)]);
    add_load(w, c.payload.load);
  }
  if (c.type == CommandType::kHandhold) {
    constexpr const char* kHands[] = {"left", "right", "both"};
    const walking::HandholdCommand& h = c.handhold;
    w.add(R"(,"action":"%s","hand":"%s")", h.release ? "release" : "take", kHands[h.hand]);
    if (!h.release) {
      w.add(R"(,"normal":[%.17g,%.17g,%.17g],"friction":%.17g,"force":%.17g)", h.normal[0],
            h.normal[1], h.normal[2], h.friction, h.force);
    }
  }
  if (c.type == CommandType::kSwap) {
    w.add(R"(,"layer":"%s","to":)", sdk::kLayerNames[c.swap_layer].data());
    w.add_quoted(c.swap_to.data());
  }
  if (c.type == CommandType::kJointTest) {
    w.add(R"(,"joint":%d,"amplitude":%.17g,"duration":%.17g)", c.joint_test.joint,
          c.joint_test.amplitude, c.joint_test.duration);
  }
  if (c.type == CommandType::kPose) {
    add_motion(w, c.pose);
  }
  if (!reply.accepted) {
    w.add(R"(,"reason":)");
    w.add_quoted(reply.message.data());
  }
  w.add("}");
  return w.text();
}

std::string_view note_text(const char* what, const char* text, char* buffer, std::size_t size) {
  Writer w(buffer, size);
  w.add(R"({"%s":)", what);
  w.add_quoted(text);
  w.add("}");
  return w.text();
}

std::string_view push_text(const GaitdDisturbance& push, const char* link, char* buffer,
                           std::size_t size) {
  Writer w(buffer, size);
  w.add(R"({"push":"%s","force":[%.17g,%.17g,%.17g])", link, push.force[0], push.force[1],
        push.force[2]);
  w.add(R"(,"point":[%.17g,%.17g,%.17g],"duration":%.17g})", push.point[0], push.point[1],
        push.point[2], push.duration);
  return w.text();
}

std::string_view load_text(const char* what, const GaitdLoad& load, const char* link, char* buffer,
                           std::size_t size) {
  Writer w(buffer, size);
  w.add(R"({"%s":"%s")", what, link);
  add_load(w, load);
  w.add("}");
  return w.text();
}

std::string_view parameter_text(const char* key, const Command& c, const CommandReply& reply,
                                char* buffer, std::size_t size) {
  Writer w(buffer, size);
  if (reply.accepted) {
    w.add(R"({"name":"%s","old":%.17g,"new":%.17g,"request":%llu})", key, reply.old_value,
          reply.new_value, static_cast<unsigned long long>(c.request));
    return w.text();
  }
  w.add(R"({"command":"param.set","request":%llu,"accepted":false,"name":"%s","value":%.17g)",
        static_cast<unsigned long long>(c.request), key, c.parameter_value);
  w.add(R"(,"reason":)");
  w.add_quoted(reply.message.data());
  w.add("}");
  return w.text();
}

}  // namespace gaitd::daemon
