// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/state_text.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "gaitd/sdk/layer_names.h"
#include "gaitd/walking/support.h"

namespace gaitd::daemon {
namespace {

// Appends to a text of fixed size; what does not fit is left out.
class Text {
 public:
  Text(char* text, std::size_t size) : text_(text), size_(size) {}
  [[gnu::format(printf, 2, 3)]] void add(const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int length = std::vsnprintf(text_ + used_, size_ - used_, format, arguments);
    va_end(arguments);
    if (length > 0) used_ = std::min(used_ + static_cast<std::size_t>(length), size_ - 1);
  }
  std::string_view view() const { return {text_, used_}; }

 private:
  char* const text_;
  const std::size_t size_;
  std::size_t used_ = 0;
};

}  // namespace

std::string_view state_text(const Pipeline& pipeline, char* buffer, std::size_t size) {
  const TickData& d = pipeline.data();
  Text text(buffer, size);
  text.add(R"({"state":"%s","faults":[)", kSafetyStateNames[static_cast<int>(d.safety)]);
  const char* comma = "";
  for (std::size_t i = 0; i < kFaultNames.size(); ++i) {
    if ((d.faults >> i & 1u) == 0) continue;
    text.add("%s\"%s\"", comma, kFaultNames[i]);
    comma = ",";
  }
  text.add("]");
  const LayerChain::Failure& failure = pipeline.layers().failure();
  if ((d.faults & (kFaultEstimator | kFaultLayer | kFaultSolver)) != 0 && failure.layer >= 0) {
    text.add(R"(,"layer":"%s","what":"%s")", sdk::kLayerNames[failure.layer].data(), failure.what);
  }
  if ((d.faults & kFaultCapture) != 0) {
    const CaptureCheck& capture = pipeline.safety().capture();
    text.add(R"(,"what":"ICP %.2f m off the feet, beyond %.2f m")", capture.distance(),
             capture.limit());
  }
  if ((d.faults & kFaultSensors) != 0) {
    const SensorMonitor::Suspect& suspect = pipeline.monitor().suspect();
    text.add(R"(,"sensor":"%s","what":"%s for %.0f ms")", suspect.sensor,
             name_of(suspect.suspicion), 1e3 * suspect.age);
  }
  text.add("}");
  return text.view();
}

const char* outcome_text(int outcome) {
  constexpr const char* kTexts[] = {
      "nothing was weighed",
      "found",
      "nothing is carried",
      "the robot did not stand at rest",
      "something pulls sideways: let go of load and robot",
      "more than the robot can carry, or too far off",
  };
  static_assert(std::size(kTexts) == static_cast<int>(walking::Payload::Outcome::kTooMuch) + 1);
  return kTexts[std::clamp<int>(outcome, 0, std::size(kTexts) - 1)];
}

std::string_view dropped_text(const SensorMonitor& monitor, int index, char* buffer,
                              std::size_t size) {
  const SensorMonitor::Suspect& joint = monitor.dropped(index);
  Text text(buffer, size);
  text.add(R"({"dropped":"%s","what":"%s for %.0f ms: damped until the robot is armed again"})",
           joint.sensor, name_of(joint.suspicion), 1e3 * joint.age);
  return text.view();
}

std::string_view payload_text(const PayloadData& payload, const char* link, char* buffer,
                              std::size_t size) {
  using Outcome = walking::Payload::Outcome;
  Text text(buffer, size);
  const double* c = payload.found.com;
  const double* u = payload.uncertainty;
  switch (payload.outcome) {
    case Outcome::kFound:
      text.add(R"({"payload":"%s","mass":%.3f,"com":[%.4f,%.4f,%.4f],)", link, payload.found.mass,
               c[0], c[1], c[2]);
      text.add(R"("uncertainty":[%.3f,%.3f,%.3f]})", u[0], u[1], u[2]);
      break;
    case Outcome::kNothing:
      text.add(R"({"payload":"nothing"})");
      break;
    default:
      text.add(R"({"payload":"not weighed","what":"%s"})",
               outcome_text(static_cast<int>(payload.outcome)));
  }
  return text.view();
}

std::string_view surplus_text(double surplus, char* buffer, std::size_t size) {
  Text text(buffer, size);
  text.add(R"({"weight":"at least %.1f kg %s than gaitd knows of",)", std::abs(surplus),
           surplus > 0.0 ? "more" : "less");
  text.add(R"("what":"a load that it was not told of, or that is not there, or a pull; )"
           R"(stand, then gaitctl payload estimate"})");
  return text.view();
}

std::string_view bearing_text(int side, double share, char* buffer, std::size_t size) {
  Text text(buffer, size);
  text.add(R"({"foot":"%s","what":"bears on %.0f %% of its foothold"})", walking::side_name(side),
           100.0 * share);
  return text.view();
}

std::string_view handhold_text(int hand, walking::Handholds::Change change, char* buffer,
                               std::size_t size) {
  constexpr const char* kTexts[] = {"",
                                    "holds on",
                                    "lets go: it found nothing to hold on to",
                                    "lets go: it was torn off its place",
                                    "lets go: the robot steps",
                                    "lets go: a joint of its arm failed",
                                    "lets go"};
  static_assert(std::size(kTexts) == static_cast<int>(walking::Handholds::Change::kReleased) + 1);
  Text text(buffer, size);
  text.add(R"({"handhold":"%s","what":"%s"})", walking::side_name(hand),
           kTexts[static_cast<int>(change)]);
  return text.view();
}

std::string_view hand_text(int hand, const GaitdHandReference& reference, char* buffer,
                           std::size_t size) {
  Text text(buffer, size);
  text.add(R"({"hand":"%s","what":"stops %.3f m and %.3f rad off its goal",)",
           walking::side_name(hand), reference.position_error, reference.turn_error);
  text.add(R"("of_it_out_of_reach":[%.3f,%.3f]})", reference.reach_error[0],
           reference.reach_error[1]);
  return text.view();
}

}  // namespace gaitd::daemon
