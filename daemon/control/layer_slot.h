// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <utility>

#include "daemon/control/output_blend.h"
#include "daemon/control/output_fade.h"
#include "daemon/control/stopwatch.h"
#include "daemon/control/swap_journal.h"
#include "daemon/host/check_output.h"
#include "gaitd/sdk/layer.h"

namespace gaitd::daemon {

// An instance of a layer with what belongs to it.
struct LayerInstance {
  std::unique_ptr<LoadedLayer> layer;
  int table = -1;   // of its parameters in LiveParameters
  int variant = 0;  // its place in the signal table
};

// One layer of the chain: the instance in use, its last good output, and the course of a hot swap:
//   order → shadow (beside the one in use) → state handed over, switched between two ticks →
//   cross-fade and probation (the one before beside it) → done, the one before stays ready.
// Real-time safe; instances are made and destroyed elsewhere.
template <int kLayer>
class LayerSlot {
 public:
  using Traits = sdk::LayerTraits<kLayer>;
  using Input = typename Traits::Input;
  using Output = typename Traits::Output;
  using State = typename Traits::State;

  LayerSlot(std::unique_ptr<LoadedLayer> layer, const GaitdModel& model, const SwapRules& rules)
      : model_(model), rules_(rules), in_use_{std::move(layer), -1, 0} {}

  // Null, or what went wrong: then `out` is the last good output.
  const char* run(const Input& in, Output& out, double* time_us) {
    const Stopwatch watch;
    const char* error =
        phase_ == Phase::kProbation ? call_timed(in_use_, in, out) : call(in_use_, in, out);
    if (phase_ == Phase::kShadow) {
      shadow(in, out);
    } else {
      if (phase_ == Phase::kProbation) error = prove(in, out, error);
      fade_.apply(in.time.period, out);
    }
    if (error == nullptr) {
      last_good_ = out;
    } else {
      take_back(out);
    }
    *time_us = watch.microseconds();
    return error;
  }

  // ---- Between ticks.

  // `controlled`: the layer runs in every tick. If not, there is nothing to compare it with, and it
  // is taken at once.
  void begin(const SwapOrder& order, bool controlled) {
    const SwapReport swap{
        .request = order.request, .layer = kLayer, .rollback = order.candidate == nullptr};
    if (swapping() && swap.rollback) {
      roll_back("it was asked for", false);
      journal_.swap() = swap;
      journal_.swap().rolled_back_already = true;
      return journal_.tell(SwapStep::kRolledBack);
    }
    if (swapping()) {
      return refuse(order, "another swap of this layer is under way; wait until it is done");
    }
    journal_.swap() = swap;
    if (swap.rollback) return exchange_with_previous(controlled);
    beside_ = {std::unique_ptr<LoadedLayer>(order.candidate), order.table, order.variant};
    elapsed_ = 0.0;
    too_long_ = false;
    if (!controlled) {
      std::swap(in_use_, beside_);
      journal_.tell(SwapStep::kSwitched);
      return accept();
    }
    if (!begin_from(in_use_, beside_)) return refuse("it does not take the state of the layer");
    phase_ = Phase::kShadow;
    journal_.tell(SwapStep::kShadow);
  }
  // Does not even begin; a swap that is under way goes on.
  void refuse(const SwapOrder& order, const char* why) {
    journal_.tell({.request = order.request, .layer = kLayer, .why = why}, SwapStep::kRefused,
                  order.candidate);
  }
  bool swapping() const { return phase_ != Phase::kSteady; }
  bool on_probation() const { return phase_ == Phase::kProbation; }
  bool has_previous() const { return previous_.layer != nullptr; }

  // Ends a swap that cannot go on: the layer does not run any more.
  void give_up(const char* why) {
    give_up_shadow(why);
    if (phase_ == Phase::kProbation) roll_back(why, true);
  }
  // What has not come into use yet does not any more.
  void give_up_shadow(const char* why) {
    if (phase_ == Phase::kShadow) refuse(why);
  }
  // Something went wrong that the newcomer may have caused.
  void doubt(const char* why) {
    if (phase_ == Phase::kProbation) doubt_ = why;
  }
  // Replay: this tick takes too long, as it did when it was recorded.
  void take_too_long() { too_long_ = true; }

  void reset() {
    in_use_.layer->reset();
    if (beside_.layer) beside_.layer->reset();
    last_good_ = {};
    fade_.end();
  }
  GaitdStatus set_parameter(int index, double value) {
    for (LayerInstance* other : {&beside_, &previous_}) {
      if (other->layer && other->table == in_use_.table) other->layer->set_parameter(index, value);
    }
    return in_use_.layer->set_parameter(index, value);
  }
  LayerInstance& in_use() { return in_use_; }
  // What the plugins that run declare as their worst case. [rt]
  double budget_us() const { return budget_of(in_use_) + budget_of(beside_); }
  // What happened, in order, each once.
  bool take_report(SwapReport* report) { return journal_.take(report); }

 private:
  enum class Phase { kSteady, kShadow, kProbation };
  static constexpr double kLongestWait = 10.0;  // s, for toe-off to end

  static double budget_of(const LayerInstance& instance) {
    return instance.layer ? instance.layer->descriptor().worst_case_us : 0.0;
  }

  const char* call(LayerInstance& instance, const Input& in, Output& out) {
    const GaitdStatus status = instance.layer->process(&in, &out);
    return status == GAITD_OK ? output_error(out, model_.joint_count) : status_name(status);
  }
  // Counts what it took of the processor: others that run in between are not its fault.
  const char* call_timed(LayerInstance& instance, const Input& in, Output& out) {
    const ThreadStopwatch watch;
    const char* error = call(instance, in, out);
    if (rules_.wall_time_acts && watch.microseconds() > 1e6 * rules_.period) too_long_ = true;
    return error;
  }
  const char* too_long() {
    if (!std::exchange(too_long_, false)) return nullptr;
    journal_.swap().wall_time = true;
    return "it takes longer than the period of the tick";
  }

  void shadow(const Input& in, const Output& out) {
    const char* error = call_timed(beside_, in, beside_output_);
    if (error == nullptr) error = too_long();
    if (error != nullptr) return refuse(error);
    const double difference = output_difference(model_, out, beside_output_);
    journal_.swap().difference = std::max(journal_.swap().difference, difference);
    if (difference > rules_.difference_limit) {
      return refuse("its output is too far from that of the layer in use");
    }
    elapsed_ += in.time.period;
    if (elapsed_ < rules_.shadow) return;
    if (elapsed_ > rules_.shadow + kLongestWait) return refuse("there was no time to switch");
    if (may_switch(out) && may_switch(beside_output_)) switch_over();
  }

  void switch_over() {
    if (!hand_over(in_use_, beside_)) return refuse("it does not take the state of the layer");
    std::swap(in_use_, beside_);
    phase_ = Phase::kProbation;
    elapsed_ = 0.0;
    fade_.begin(last_good_, rules_.fade);
    doubt_ = nullptr;
    journal_.tell(SwapStep::kSwitched);
  }

  // The newcomer is in use, the one before beside it: what it says counts if the newcomer fails.
  const char* prove(const Input& in, Output& out, const char* error) {
    const char* why = error != nullptr ? error : too_long();
    if (why == nullptr) why = doubt_;
    const char* error_before = call(beside_, in, beside_output_);
    if (fade_.active()) fade_.follow(error_before == nullptr ? beside_output_ : last_good_);
    if (why != nullptr) {
      roll_back(why, true);
      if (error_before == nullptr) out = beside_output_;
      return error_before;
    }
    elapsed_ += in.time.period;
    if (elapsed_ >= rules_.probation) accept();
    return nullptr;
  }

  void accept() {
    phase_ = Phase::kSteady;
    fade_.end();
    journal_.tell(SwapStep::kDone, previous_.layer.release());
    previous_ = std::move(beside_);
    beside_ = {};
  }
  void refuse(const char* why) {
    phase_ = Phase::kSteady;
    journal_.swap().why = why;
    journal_.tell(SwapStep::kRefused, beside_.layer.release());
    beside_ = {};
  }
  void roll_back(const char* why, bool on_its_own) {
    journal_.swap().why = why;
    if (phase_ == Phase::kShadow) return refuse(why);
    std::swap(in_use_, beside_);
    if (!on_its_own) hand_over(beside_, in_use_);
    phase_ = Phase::kSteady;
    fade_.begin(last_good_, rules_.fade);
    journal_.tell(SwapStep::kRolledBack, beside_.layer.release());
    beside_ = {};
  }
  // `gaitctl plugin rollback` after the probation.
  void exchange_with_previous(bool controlled) {
    if (!has_previous()) {
      journal_.swap().why = "there is no layer before this one";
      return journal_.tell(SwapStep::kRefused);
    }
    if (controlled) {
      if (!begin_from(in_use_, previous_)) {
        journal_.swap().why = "the one before does not take the state of the layer";
        return journal_.tell(SwapStep::kRefused);
      }
      fade_.begin(last_good_, rules_.fade);
    }
    std::swap(in_use_, previous_);
    journal_.tell(SwapStep::kRolledBack);
  }

  // To one that ran beside: what it keeps for itself, such as filters of measurements, goes on.
  bool hand_over(LayerInstance& from, LayerInstance& to) {
    State state{};
    return from.layer->get_state(&state) == GAITD_OK && to.layer->set_state(&state) == GAITD_OK;
  }
  // To one that did not.
  bool begin_from(LayerInstance& from, LayerInstance& to) {
    return to.layer->reset() == GAITD_OK && hand_over(from, to);
  }

  void take_back(Output& out) {
    if constexpr (kLayer == GAITD_LAYER_WHOLE_BODY_CONTROLLER) {
      // The log keeps why there is no solution.
      const int status = out.info.status;
      out = last_good_;
      const bool known = status > GAITD_WBC_SOLVED && status <= GAITD_WBC_NON_FINITE;
      out.info.status = known ? status : int{GAITD_WBC_NON_FINITE};
    } else {
      out = last_good_;
    }
  }

  const GaitdModel& model_;
  const SwapRules& rules_;
  LayerInstance in_use_;
  LayerInstance beside_;    // the candidate, in probation the one before
  LayerInstance previous_;  // after probation, for a rollback
  Phase phase_ = Phase::kSteady;
  double elapsed_ = 0.0;  // s, in the phase
  const char* doubt_ = nullptr;
  bool too_long_ = false;
  SwapJournal journal_;
  Output last_good_{};
  Output beside_output_{};
  OutputFade<Output> fade_;
};

}  // namespace gaitd::daemon
