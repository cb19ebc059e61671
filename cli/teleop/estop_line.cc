// SPDX-License-Identifier: Apache-2.0
#include "cli/teleop/estop_line.h"

#include <algorithm>
#include <utility>

namespace gaitd::cli::teleop {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kAskAgain{300};          // until it is asked again
constexpr milliseconds kLongestPatience{5000};  // no answer takes longer
constexpr milliseconds kIdle{500};              // while nobody needs it
constexpr milliseconds kKnock{20};              // while somebody does

}  // namespace

EstopLine::EstopLine(Destination destination) : link_(std::move(destination)) {}

void EstopLine::pull(Time now) {
  // What is on its way has the time that it was given.
  if (open_ && link_.send("estop", nullptr) != 0) return;
  if (!open_) {
    open_ = true;
    trouble_.clear();
    first_ = 0;
  }
  patience_ = kAskAgain;
  ask(now);
}

void EstopLine::ask(Time now) {
  int id = link_.send("estop", nullptr);
  if (id == 0 && link_.open()) id = link_.send("estop", nullptr);
  if (id == 0) {
    next_ = now + kKnock;
    return;
  }
  if (first_ == 0) first_ = id;
  next_ = now + patience_;
  patience_ = std::min<Time::duration>(2 * patience_, kLongestPatience);
}

void EstopLine::tick(Time now) {
  for (const Link::Answer& answer : link_.receive()) {
    const auto* error = std::get_if<daemon::RpcError>(&answer.result);
    if (!open_ || first_ == 0 || answer.id < first_) continue;
    if (error == nullptr) {
      open_ = false;
    } else {
      trouble_ = error->message;
      patience_ = kAskAgain;
      next_ = std::min(next_, now + kAskAgain);
    }
  }
  if (open_ && !link_.up()) {
    patience_ = kAskAgain;
    next_ = std::min(next_, now + kKnock);
  }
  if (now < next_) return;
  if (open_) {
    link_.close();  // whatever holds it up there; a late answer to it is lost
    return ask(now);
  }
  if (!link_.up()) link_.open();
  next_ = now + kIdle;
}

std::string EstopLine::text() const {
  if (!open_) return "";
  const std::string why = trouble_.empty() ? link_.why_down() : trouble_;
  const std::string first = why.substr(0, why.find('\n'));
  return "E-STOP NOT CONFIRMED: use the e-stop of the robot" + (first.empty() ? "" : "; " + first);
}

}  // namespace gaitd::cli::teleop
