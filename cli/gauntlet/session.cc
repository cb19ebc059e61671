// SPDX-License-Identifier: Apache-2.0
#include "cli/gauntlet/session.h"

#include <algorithm>
#include <cmath>

namespace gaitd::cli {
namespace {

constexpr int kActs = 8;

// One act after another; each says how long it takes.
class Session {
 public:
  explicit Session(const Draws& draws) : draws_(draws) {}

  Story story() {
    for (act_ = 0; act_ < kActs; ++act_) {
      const double begin = now_;
      const int what = draws_.whole("act", 0, 9, act_);
      now_ += what < 4 ? walk() : what < 6 ? drive() : what < 8 ? footstep() : pose();
      if (draws_.whole("mode", 0, 3, act_) == 0) change_mode(begin);
      if (draws_.whole("push", 0, 3, act_) == 0) push(begin);
      // Half of what follows does not wait until this has ended.
      if (draws_.coin("wait", act_)) now_ += draws_.between("rest", 0.0, 3.0, act_);
    }
    std::ranges::stable_sort(said_, {}, &Said::at);
    for (const Said& said : said_) story_.commands.push_back(said.text);
    story_.time = now_;
    return story_;
  }

 private:
  double draw(const char* what, double low, double high) const {
    return draws_.between(what, low, high, act_);
  }
  void say(double at, const std::string& command) {
    said_.push_back({at, "{at: " + text_of(at) + ", " + command + "}"});
  }

  double walk() {
    const int steps = draws_.whole("steps", 1, 6, act_);
    const bool aside = draws_.whole("aside", 0, 2, act_) == 0;
    const bool turns = draws_.coin("turns", act_);
    const double swing = draw("swing", 0.5, 0.9), transfer = draw("transfer", 0.1, 0.5);
    say(now_, "walk: {steps: " + std::to_string(steps) +
                  ", length: " + text_of(draw("length", -0.3, 0.6)) +
                  ", lateral: " + text_of(aside ? draw("lateral", -0.2, 0.2) : 0.0) +
                  ", turn: " + text_of(turns ? draw("turn", -0.3, 0.3) : 0.0) +
                  ", swing: " + text_of(swing) + ", transfer: " + text_of(transfer) + "}");
    const double takes = (steps + 1) * (swing + transfer);
    const int interrupted = draws_.whole("interrupted", 0, 3, act_);
    const double at = now_ + draw("interrupted/at", 0.05, 0.9) * takes;
    if (interrupted == 0) say(at, "stop: {}");
    if (interrupted != 1) return takes;
    const double pause = draw("pause", 0.3, 5.0);
    say(at, "pause: {}");
    say(at + pause, "resume: {}");
    return takes + pause;
  }

  double drive() {
    const double takes = draw("time", 1.0, 5.0);
    say(now_, "velocity: {forward: " + text_of(draw("forward", -0.3, 0.6)) +
                  ", lateral: " + text_of(draw("sideways", -0.15, 0.15)) +
                  ", turn: " + text_of(draw("turning", -0.4, 0.4)) + "}");
    say(now_ + takes, "velocity: {}");
    return takes + 1.5;
  }

  // Relative to the foot that stands, so that the robot ends with its feet apart.
  double footstep() {
    const bool left = draws_.coin("left", act_);
    const double swing = draw("swing", 0.4, 1.0), transfer = draw("transfer", 0.1, 0.8);
    say(now_, std::string("footsteps: {footsteps: [{side: ") + (left ? "left" : "right") +
                  ", x: " + text_of(draw("x", -0.3, 0.5)) +
                  ", y: " + text_of((left ? 1.0 : -1.0) * draw("y", 0.05, 0.45)) +
                  ", yaw: " + text_of(draw("yaw", -0.4, 0.4)) + ", swing: " + text_of(swing) +
                  ", transfer: " + text_of(transfer) + "}]}");
    return swing + 2.0 * transfer + 0.5;
  }

  double pose() {
    const double takes = draw("time", 1.0, 2.5), held = draw("held", 0.0, 6.0);
    const bool pelvis = draws_.coin("pelvis", act_), chest = !pelvis || draws_.coin("chest", act_);
    const bool back = draws_.coin("back", act_);
    const auto move = [&](const char* what, const std::string& pose) {
      say(now_, "pose: {" + (what + (": {" + pose)) + "}, duration: " + text_of(takes) + "}");
      if (back) say(now_ + takes + held, std::string("pose: {") + what + ": {}, duration: 1.5}");
    };
    if (pelvis) {
      move("pelvis", "z: " + text_of(draw("height", -0.12, 0.02)) +
                         ", yaw: " + text_of(draw("pelvis/yaw", -0.2, 0.2)));
    }
    if (chest) {
      move("chest", "yaw: " + text_of(draw("chest/yaw", -0.4, 0.4)) +
                        ", pitch: " + text_of(draw("chest/pitch", -0.1, 0.25)));
    }
    return takes;
  }

  void change_mode(double begin) {
    say(draw("mode/at", begin, now_),
        std::string("mode: ") + (draws_.coin("straight", act_) ? "walk-straight" : "walk-bent"));
  }

  void push(double begin) {
    Push push;
    push.duration = 0.1;
    push.force = draw("impulse", 10.0, 30.0) / push.duration;
    push.direction = draw("direction", -M_PI, M_PI);
    push.time = draw("push/at", begin, now_);
    story_.pushes.push_back(push);
  }

  struct Said {
    double at;  // s
    std::string text;
  };
  const Draws& draws_;
  Story story_;
  std::vector<Said> said_;
  int act_ = 0;
  double now_ = 2.5;  // s
};

}  // namespace

Story session(const Draws& draws) { return Session(draws).story(); }

}  // namespace gaitd::cli
