// SPDX-License-Identifier: Apache-2.0
#include "daemon/server/estop_answers.h"

#include <utility>

namespace gaitd::daemon {

void EstopAnswers::stop(Respond respond, std::uint64_t raised) {
  const std::int64_t read_at = flag_->present_tick();
  const std::uint64_t number = raised != 0 ? raised : flag_->raise();
  const Clock::time_point now = Clock::now();
  const double raised_at = std::chrono::duration<double>(now.time_since_epoch()).count();
  waiting_.push_back({number, read_at, raised_at, now, std::move(respond)});
}

bool EstopAnswers::answer(const Waiting& one, Clock::time_point now) const {
  if (!flag_->acted_on(one.number)) {
    if (now < one.since + kPatience) return false;
    one.respond(RpcError{rpc_code::kNoAnswer,
                         "estop: the stop is set, but the control loop has not come to it: it "
                         "hangs, or gaitd is starting or ending; use the e-stop of the robot"});
    return true;
  }
  const std::int64_t tick = flag_->tick();
  if (flag_->present_tick() <= tick && now < one.since + kShowTime) return false;
  one.respond(nlohmann::json{{"accepted", true},
                             {"tick", tick},
                             {"read_at_tick", one.read_at},
                             {"raised_at", one.raised_at},
                             {"note", nullptr}});
  return true;
}

void EstopAnswers::poll(Clock::time_point now) {
  while (!waiting_.empty() && answer(waiting_.front(), now)) waiting_.pop_front();
}

void EstopAnswers::abandon() {
  for (const Waiting& one : std::exchange(waiting_, {})) {
    if (answer(one, one.since + kShowTime)) continue;
    one.respond(RpcError{rpc_code::kStopping,
                         "estop: gaitd is ending; its last act is to switch the motors off"});
  }
}

}  // namespace gaitd::daemon
