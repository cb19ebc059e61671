// SPDX-License-Identifier: Apache-2.0
#include "link.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstring>

#include "clock.h"

namespace gaitd::unitree {
namespace {

constexpr int64_t kMs = 1'000'000;
constexpr int64_t kRobotTime = 5'000 * kMs;    // for the first state
constexpr int64_t kForeignTime = 1'000 * kMs;  // that a foreign command counts
constexpr int64_t kLook = 5 * kMs;             // between looks at gaitd while the robot is silent
constexpr int64_t kWriters = 200 * kMs;        // for all writers of the states to be discovered
constexpr int64_t kCount = 100 * kMs;          // between counts of the writers
constexpr double kLockstepRepeat = 0.05;       // s
constexpr int64_t kSlow = 10 * kMs;

WatchOptions watch_options(const Settings& settings, bool lockstep) {
  // A fake robot in lockstep is silent for as long as gaitd takes.
  return {settings.motor_mask(), lockstep ? 1e3 : settings.state_timeout, settings.lowest_charge};
}

uint64_t motors_on(const Command& command) {
  uint64_t on = 0;
  for (int i = 0; i < kMotors; ++i) {
    if (command.motors[i].drive != Drive::kOff) on |= uint64_t{1} << i;
  }
  return on;
}

}  // namespace

Link::Link(const Settings& settings, bool lockstep, bool rescue, Exchange* exchange)
    : settings_(settings),
      lockstep_(lockstep),
      rescue_(rescue),
      exchange_(*exchange),
      node_(settings.domain, settings.interface),
      watch_(watch_options(settings, lockstep)) {
  std::memset(&message_, 0, sizeof(message_));
  const char* commanded = ControlHandover::topic(settings.control);
  states_ = node_.reader(kLowState, unitree_hg_msg_dds__LowState__desc);
  torso_ = node_.reader(kTorsoImu, unitree_hg_msg_dds__IMUState__desc);
  battery_ = node_.reader(kBattery, unitree_hg_msg_dds__BmsState__desc);
  if (!settings.feet.empty()) {
    feet_ = node_.reader(settings.feet.c_str(), gaitd_msg_dds__FootWrenches__desc);
  }
  others_ = node_.reader(commanded, unitree_hg_msg_dds__LowCmd__desc, 1, true);
  commands_ = node_.writer(commanded, unitree_hg_msg_dds__LowCmd__desc);
  waitset_ = node_.waitset();
  for (const dds_entity_t reader : {states_, others_}) node_.attach(waitset_, reader);
}

void Link::log(int level, const std::string& line) const {
  const std::string text =
      std::string(1, static_cast<char>(Talk::kLog)) + static_cast<char>('0' + level) + line;
  send(kTalkFd, text.data(), std::min<size_t>(text.size(), 1000), MSG_NOSIGNAL | MSG_DONTWAIT);
}

void Link::listen_to_gaitd() {
  pollfd descriptor{kTalkFd, POLLIN, 0};
  if (::poll(&descriptor, 1, 0) <= 0) return;
  char letter = 0;
  const ssize_t size = recv(kTalkFd, &letter, 1, MSG_DONTWAIT);
  if (size <= 0 || letter == static_cast<char>(Talk::kStop)) gone_ = true;
}

int Link::take_foreign() {
  int count = 0;
  while (take_sample(others_, &foreign_message_)) ++count;
  if (count > 0) {
    foreign_ += static_cast<uint32_t>(count);
    foreign_ns_ = monotonic_ns();
  }
  return count;
}

// Waits for messages, takes them all, and publishes what follows from them.
void Link::poll(int64_t nanoseconds) {
  dds_waitset_wait(waitset_, nullptr, 0, nanoseconds);
  const int64_t now = monotonic_ns();
  listen_to_gaitd();
  take_foreign();
  // The state first: in lock step what belongs to it was sent before it, and is here as well.
  bool taken = take_sample(states_, &message_);
  if (take_sample(torso_, &torso_message_)) watch_.take_torso(torso_message_, now);
  if (take_sample(battery_, &battery_message_)) watch_.take_battery(battery_message_);
  if (feet_ > 0 && take_sample(feet_, &feet_message_)) watch_.take_feet(feet_message_, now);
  watch_.set_on(on_);
  const uint64_t cycle = cycle_of(message_);
  const bool whole = cycle == 0 || feet_ <= 0 || watch_.state().feet.sequence == cycle;
  // Half of a cycle is not taken; the fake robot sends it again.
  taken = taken && whole && watch_.take(message_, now);
  if (now - counted_ns_ > kCount) {
    counted_ns_ = now;
    twins_ = matched_writers(states_) > 1;
  }
  uint32_t causes = watch_.causes(now);
  if (foreign_ns_ != 0 && now - foreign_ns_ < kForeignTime) causes |= kHoldWriter;
  if (twins_) causes |= kHoldTwin;
  if (gone_ || rescue_) causes |= kHoldGone;
  causes_ = causes;
  // What stands against driving is there for gaitd before the state that shows it.
  publish();
  if (!taken) return;
  exchange_.state.put(watch_.state());
  exchange_.arrived.ring();
}

void Link::publish() {
  Status status{};
  watch_.report(holds_ | causes_, &status);
  dds_sample_lost_status_t lost{};
  dds_get_sample_lost_status(states_, &lost);
  status.lost = lost.total_count;
  status.foreign = foreign_;
  status.unsent = unsent_;
  status.slow = slow_;
  status.late = late_;
  exchange_.status.put(status);
}

std::string Link::wait_for_robot() {
  const int64_t begin = monotonic_ns();
  while (!watch_.heard()) {
    poll(kLook);
    if (gone_) return "stopped";
    if (monotonic_ns() - begin < kRobotTime) continue;
    Status status{};
    watch_.report(0, &status);
    if (status.bad_crc > 0) return "every state of the robot has a wrong CRC";
    if (matched_writers(states_) > 0)
      return std::string(kLowState) + " has a writer that is silent";
    return "no robot on " + std::string(kLowState) + ", domain " +
           std::to_string(settings_.domain) + ", interface " + settings_.interface +
           ": is it on (its states come 90 s after power), is the cable in, has the interface an "
           "address in 192.168.123.0/24?";
  }
  // A second one may be a little slower.
  const int64_t heard = monotonic_ns();
  while (monotonic_ns() - heard < kWriters) poll(kLook);
  return check_robot();
}

std::string Link::check_robot() const {
  const int writers = matched_writers(states_);
  if (writers > 1) {
    return std::to_string(writers) + " writers of " + kLowState +
           ": another robot or a simulator is on this network and domain";
  }
  const bool waits = watch_.state().cycle != 0;
  if (waits != lockstep_) {
    return waits ? "this is a fake robot in lock step: gaitd has to run with --clock lockstep"
                 : "this robot waits for nobody: gaitd has to run with --clock realtime, or with "
                   "gaitd-fake-g1 --lockstep";
  }
  if (message_.mode_pr != 0) return "mode_pr of the robot is not 0 (pitch and roll)";
  const int machine = static_cast<int>(watch_.state().mode_machine);
  const Variant* variant = find_variant(machine);
  if (variant == nullptr && machine != settings_.mode_machine) {
    return "mode_machine " + std::to_string(machine) + " is no published variant" +
           (machine == 0 ? " (0 comes from simulators)" : "") +
           "; unitree_dds.mode_machine: " + std::to_string(machine) + " takes it for 29 joints";
  }
  if (variant == nullptr) return "";
  const uint64_t lacking = variant->missing & settings_.motor_mask();
  std::string names;
  for (int i = 0; i < kMotors; ++i) {
    if ((lacking >> i & 1) != 0) names += (names.empty() ? "" : ", ") + std::string(kJointNames[i]);
  }
  if (names.empty()) return "";
  return "mode_machine " + std::to_string(machine) + " (" + variant->name +
         ") has no motor for joints of the model: " + names;
}

void Link::write(const Command* command, const State& state) {
  Command damping{};
  if (command == nullptr) {
    damping.cycle = state.cycle;
    for (MotorTarget& motor : damping.motors) {
      motor.drive = Drive::kDamp;
      motor.damping = static_cast<float>(settings_.damping);
    }
    command = &damping;
  }
  const LowCmd message =
      pack(*command, motors_, state.position, static_cast<uint8_t>(state.mode_machine));
  const int64_t before = monotonic_ns();
  if (dds_write(commands_, &message) < 0) ++unsent_;
  if (monotonic_ns() - before > kSlow) ++slow_;
}

void Link::write_loop() {
  CommandGate gate(lockstep_ ? 60 : settings_.command_timeout);
  const double repeat = lockstep_ ? kLockstepRepeat : 1 / settings_.rate;
  uint64_t taken = 0;
  while (!over_) {
    const uint32_t commanded = exchange_.commanded.rings();
    const uint32_t arrived = exchange_.arrived.rings();
    const bool alone = (causes_ & kHoldGone) != 0;
    Command command{};
    const uint64_t count = exchange_.command.get(&command);
    const int64_t now = monotonic_ns();
    if (count != taken && !alone) gate.take(command, now);
    taken = count;
    State state{};
    exchange_.state.get(&state);
    const Command* passed = gate.decide(causes_, now);
    holds_ = gate.holds();
    late_ = gate.late();
    // In lock step the state is answered once, by the command for it.
    if (passed == nullptr && lockstep_ && !alone) state.cycle = count == 0 ? 0 : command.cycle;
    write(passed, state);
    on_ = passed != nullptr && passed->driven != 0 ? motors_on(*passed) : 0;
    if (alone) ++damped_;
    // Without gaitd the answers of the lock step come from here.
    if (alone && lockstep_) {
      exchange_.arrived.wait(arrived, repeat);
    } else {
      exchange_.commanded.wait(commanded, repeat);
    }
  }
}

void Link::damp_until_over() {
  const int64_t end = monotonic_ns() + static_cast<int64_t>(1e9 * settings_.damp_time);
  bool told = false;
  while (monotonic_ns() < end) {
    poll(kLook);
    if (told || damped_ == 0) continue;
    const char letter = static_cast<char>(Talk::kBye);
    send(kTalkFd, &letter, 1, MSG_NOSIGNAL | MSG_DONTWAIT);
    told = true;
  }
}

int Link::run() {
  ControlHandover handover(
      settings_, &node_,
      [this] {
        listen_to_gaitd();
        return take_foreign();
      },
      [this] { write(nullptr, watch_.state()); }, gone_);
  if (!rescue_) {
    std::string error = wait_for_robot();
    if (error.empty()) error = handover.take();
    if (!error.empty()) {
      log(GAITD_LOG_ERROR, error);
      handover.give_back();
      return 1;
    }
    foreign_ns_ = 0;
  }
  if (const Variant* variant = find_variant(static_cast<int>(watch_.state().mode_machine))) {
    motors_ &= ~variant->missing;
    if (variant->warning[0] != '\0') {
      log(GAITD_LOG_WARNING, "mode_machine " + std::to_string(variant->number) +
                                 " differs from the published body: " + variant->warning);
    }
  }
  poll(0);
  std::thread writer([this] { write_loop(); });
  if (!rescue_) {
    log(GAITD_LOG_INFO, "the robot is taken: mode_machine " +
                            std::to_string(watch_.state().mode_machine) + ", commands go to " +
                            ControlHandover::topic(settings_.control));
    const char letter = static_cast<char>(Talk::kReady);
    send(kTalkFd, &letter, 1, MSG_NOSIGNAL);
  }
  while (!gone_) poll(kLook);
  damp_until_over();
  // What passes our commands on has to be asked before they cease; what begins to send its own
  // after that.
  std::string error;
  if (settings_.control == Control::kUser) error = handover.give_back();
  over_ = true;
  writer.join();
  if (settings_.control != Control::kUser) error = handover.give_back();
  if (!error.empty()) log(GAITD_LOG_WARNING, error);
  return 0;
}

}  // namespace gaitd::unitree
