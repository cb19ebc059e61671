// SPDX-License-Identifier: Apache-2.0
// process() over a walk: right, in time, without the heap, and the same every time.
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "daemon/conformance/allocation_guard.h"
#include "daemon/conformance/check_child.h"
#include "daemon/conformance/sample_walk.h"
#include "daemon/host/check_output.h"
#include "gaitd/sdk/layer.h"

namespace gaitd::daemon {
namespace {

constexpr int kWarmUp = 100;          // ticks, in which the heap may be used
constexpr int kTicksOfRepeat = 1800;  // standing, the first transfer and the first swing
constexpr double kGrossly = 20.0;     // times the declared time: no noise of the machine

double now_us() {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

template <class... Values>
std::string text(const char* format, Values... values) {
  char out[240];
  std::snprintf(out, sizeof(out), format, values...);
  return out;
}

const char* phase_name(const GaitdGaitState& gait) {
  constexpr const char* kNames[] = {"stand", "transfer", "swing"};
  return kNames[std::clamp<int>(gait.phase, 0, 2)];
}

// What is wrong with the answer to a sound input; "" if nothing.
template <class Output>
std::string error_of(const InputSet& in, GaitdStatus status, const Output& out, int joints) {
  const char* error = nullptr;
  if (status != GAITD_OK) {
    error = status_name(status);
  } else {
    error = output_error(out, joints);
  }
  if (error == nullptr) return "";
  return text("%s %s (tick %lld, %s)", status != GAITD_OK ? "process() returned" : "output", error,
              static_cast<long long>(in.time.tick), phase_name(in.gait));
}

void judge_time(CheckRun& run, std::vector<double> times) {
  run.begin("time");
  const double declared = run.descriptor().worst_case_us;
  std::sort(times.begin(), times.end());
  const double median = times[times.size() / 2];
  const std::string figures = text("median %.1f us, 99 %% %.1f us, declared worst case %.1f us",
                                   median, times[times.size() * 99 / 100], declared);
  if (median > kGrossly * declared) {
    run.fail(figures +
             "; make process() faster, without sleeping or blocking, or declare its time");
  } else if (median > declared) {
    run.warn(figures + "; more than declared on this machine");
  } else {
    run.pass(figures);
  }
}

void judge_allocations(CheckRun& run, long allocations, int ticks) {
  run.begin("allocation");
  if (!allocations_are_counted()) {
    run.skip("this build has a sanitizer, which owns the heap");
  } else if (allocations > 0) {
    run.fail(text("%ld allocations in %d ticks after the first %d; take all memory in init()",
                  allocations, ticks, kWarmUp));
  } else {
    run.pass(text("none in %d ticks", ticks));
  }
}

template <int kLayer>
void walk(CheckRun& run) {
  run.begin("process");
  Instance instance;
  if (!Instance::make(run, &instance)) return;
  SampleWalk walk(run.model());
  const auto out = std::make_unique<typename sdk::LayerTraits<kLayer>::Output>();
  std::vector<double> times;
  times.reserve(20000);
  long allocations = 0;
  while (walk.tick()) {
    const auto in = input_of<kLayer>(walk.inputs());
    const long before = allocation_count();
    const double start = now_us();
    const GaitdStatus status = instance.process(&in, out.get());
    times.push_back(now_us() - start);
    if (times.size() > kWarmUp) allocations += allocation_count() - before;
    const std::string error = error_of(walk.inputs(), status, *out, run.model().joint_count);
    if (!error.empty()) {
      run.fail(error);
      return;
    }
  }
  const int ticks = static_cast<int>(times.size());
  run.pass(text("%d ticks of standing and walking", ticks));
  judge_time(run, std::move(times));
  judge_allocations(run, allocations, ticks - kWarmUp);
}

// Two instances, the second reset in mid-walk of another, see the same and say the same.
template <int kLayer>
bool repeatable(CheckRun& run) {
  run.begin("repeatable");
  using Output = typename sdk::LayerTraits<kLayer>::Output;
  Instance first, second;
  if (!Instance::make(run, &first) || !Instance::make(run, &second)) return false;
  const auto a = std::make_unique<Output>();
  const auto b = std::make_unique<Output>();
  {
    SampleWalk before(run.model());
    for (int i = 0; i < kTicksOfRepeat && before.tick(); ++i) {
      const auto in = input_of<kLayer>(before.inputs());
      second.process(&in, b.get());
    }
    if (const GaitdStatus status = second.reset(); status != GAITD_OK) {
      return run.fail("reset() returned " + status_text(status));
    }
    *b = {};
  }
  SampleWalk walk(run.model());
  for (int i = 0; i < kTicksOfRepeat && walk.tick(); ++i) {
    const auto in = input_of<kLayer>(walk.inputs());
    const GaitdStatus status = first.process(&in, a.get());
    if (status == second.process(&in, b.get()) && std::memcmp(a.get(), b.get(), sizeof(*a)) == 0) {
      continue;
    }
    const auto* from = reinterpret_cast<const unsigned char*>(a.get());
    const auto* to = reinterpret_cast<const unsigned char*>(b.get());
    const auto byte = std::mismatch(from, from + sizeof(*a), to).first - from;
    return run.fail(text(
        "a fresh instance and one after reset() differ at tick %lld in byte %ld of the output; "
        "reset() must leave nothing of before, and nothing may be shared, random or timed",
        static_cast<long long>(walk.inputs().time.tick), static_cast<long>(byte)));
  }
  run.pass(text("the same bits in %d ticks, fresh and after reset()", kTicksOfRepeat));
  return true;
}

// The first byte in which two states differ, but for the last digits of a number; -1 if they do
// not. A word that is no normal number (two integers are none) has to be the same in every bit.
template <class State>
long difference(const State& a, const State& b) {
  constexpr double kDigits = 1e-9;
  static_assert(sizeof(State) % sizeof(double) == 0);
  for (std::size_t at = 0; at < sizeof(State); at += sizeof(double)) {
    double x, y;
    std::memcpy(&x, reinterpret_cast<const char*>(&a) + at, sizeof(x));
    std::memcpy(&y, reinterpret_cast<const char*>(&b) + at, sizeof(y));
    if (std::memcmp(&x, &y, sizeof(x)) == 0) continue;
    const bool numbers = (x == 0.0 || std::isnormal(x)) && (y == 0.0 || std::isnormal(y));
    if (!numbers || std::abs(x - y) > kDigits * (1.0 + std::abs(x))) return static_cast<long>(at);
  }
  return -1;
}

// What one instance leaves another takes over, in mid-swing.
template <int kLayer>
void state(CheckRun& run) {
  run.begin("state");
  using State = typename sdk::LayerTraits<kLayer>::State;
  Instance first, second;
  if (!Instance::make(run, &first) || !Instance::make(run, &second)) return;
  const auto out = std::make_unique<typename sdk::LayerTraits<kLayer>::Output>();
  SampleWalk walk(run.model());
  for (int i = 0; i < kTicksOfRepeat && walk.tick(); ++i) {
    const auto in = input_of<kLayer>(walk.inputs());
    first.process(&in, out.get());
  }
  const auto given = std::make_unique<State>();
  const auto taken = std::make_unique<State>();
  given->size = taken->size = sizeof(State);
  if (const GaitdStatus status = first.get_state(given.get()); status != GAITD_OK) {
    run.fail("get_state() returned " + status_text(status));
    return;
  }
  if (given->size != sizeof(State)) {
    run.fail(text("get_state() left size %u, needs %zu", given->size, sizeof(State)));
    return;
  }
  if (const GaitdStatus status = second.set_state(given.get()); status != GAITD_OK) {
    run.fail("set_state() returned " + status_text(status) + " for a state of the same variant");
    return;
  }
  second.get_state(taken.get());
  if (const long byte = difference(*given, *taken); byte >= 0) {
    run.fail(text("get_state() after set_state() gives another state (byte %ld)", byte));
    return;
  }
  for (int i = 0; i < 200 && walk.tick(); ++i) {
    const auto in = input_of<kLayer>(walk.inputs());
    const GaitdStatus status = second.process(&in, out.get());
    const std::string error = error_of(walk.inputs(), status, *out, run.model().joint_count);
    if (!error.empty()) {
      run.fail("after set_state(): " + error);
      return;
    }
  }
  given->size = 0;
  if (second.set_state(given.get()) == GAITD_OK) {
    run.fail("set_state() accepts a state of size 0; compare state->size with what it reads");
    return;
  }
  run.pass("handed over in mid-swing");
}

}  // namespace

void check_walk(CheckRun& run) {
  with_layer(run.descriptor().layer, [&](auto layer) { walk<layer>(run); });
}

void check_repeat(CheckRun& run) {
  with_layer(run.descriptor().layer, [&](auto layer) {
    if (repeatable<layer>(run)) state<layer>(run);
  });
}

}  // namespace gaitd::daemon
