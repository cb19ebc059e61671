// SPDX-License-Identifier: Apache-2.0
// What a plugin does with inputs and values that it should not get.
#include <cstring>
#include <limits>
#include <memory>
#include <string>

#include "daemon/conformance/check_child.h"
#include "daemon/conformance/sample_walk.h"
#include "daemon/host/check_output.h"
#include "gaitd/sdk/layer.h"

namespace gaitd::daemon {
namespace {

constexpr int kTicksBefore = 1500;  // to the middle of the first swing
constexpr int kTicksSpoiled = 20;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Refused: a wrong index and every value that the table does not allow.
bool refuses_bad_values(CheckRun& run, Instance& instance) {
  const GaitdPluginDescriptor& d = run.descriptor();
  if (instance.set_parameter(d.parameter_count, 0.0) == GAITD_OK ||
      instance.set_parameter(std::numeric_limits<std::uint32_t>::max(), 0.0) == GAITD_OK) {
    return run.fail("set_parameter() accepts an index beyond its table");
  }
  for (std::uint32_t i = 0; i < d.parameter_count; ++i) {
    const GaitdParameter& p = d.parameters[i];
    const double bad[] = {kNan, kInfinity, p.minimum - 1.0, p.maximum + 1.0};
    for (const double value : bad) {
      if (instance.set_parameter(i, value) == GAITD_OK) {
        return run.fail("set_parameter() accepts " + std::to_string(value) + " for " + p.name +
                        "; return GAITD_INVALID_ARGUMENT and keep the old value");
      }
    }
    if (p.type != GAITD_PARAMETER_REAL && p.minimum + 0.5 < p.maximum &&
        instance.set_parameter(i, p.minimum + 0.5) == GAITD_OK) {
      return run.fail(std::string("set_parameter() accepts a fraction for the whole number ") +
                      p.name);
    }
  }
  return true;
}

// Each at its ends, with some ticks; then everything as before gives sound outputs.
template <int kLayer>
void parameters(CheckRun& run) {
  run.begin("parameters");
  Instance instance;
  if (!Instance::make(run, &instance)) return;
  if (!refuses_bad_values(run, instance)) return;
  const GaitdPluginDescriptor& d = run.descriptor();
  const auto out = std::make_unique<typename sdk::LayerTraits<kLayer>::Output>();
  SampleWalk walk(run.model());
  for (std::uint32_t i = 0; i < d.parameter_count; ++i) {
    const GaitdParameter& p = d.parameters[i];
    for (const double value : {p.minimum, p.maximum, p.default_value}) {
      if (const GaitdStatus status = instance.set_parameter(i, value); status != GAITD_OK) {
        run.fail(std::string("set_parameter() returned ") + status_text(status) + " for " + p.name +
                 " = " + std::to_string(value) + ", which its table allows");
        return;
      }
      for (int k = 0; k < 3 && walk.tick(); ++k) {
        const auto in = input_of<kLayer>(walk.inputs());
        instance.process(&in, out.get());
      }
    }
  }
  instance.reset();
  SampleWalk again(run.model());
  for (int k = 0; k < 100 && again.tick(); ++k) {
    const auto in = input_of<kLayer>(again.inputs());
    const GaitdStatus status = instance.process(&in, out.get());
    const char* error =
        status == GAITD_OK ? output_error(*out, run.model().joint_count) : status_name(status);
    if (error != nullptr) {
      run.fail(std::string("all back at their defaults and reset: ") + error);
      return;
    }
  }
  run.pass(std::to_string(d.parameter_count) + " set live to their ends; bad values refused");
}

// An input that is shorter than what the layer reads is refused, a longer one is a newer host.
template <int kLayer>
bool sizes(CheckRun& run) {
  run.begin("sizes");
  Instance instance;
  if (!Instance::make(run, &instance)) return false;
  const auto out = std::make_unique<typename sdk::LayerTraits<kLayer>::Output>();
  SampleWalk walk(run.model());
  walk.tick();
  auto in = input_of<kLayer>(walk.inputs());
  const auto real = in.size;
  for (const std::uint32_t size : {0u, 8u, real - 8u}) {
    in.size = size;
    if (instance.process(&in, out.get()) == GAITD_OK) {
      return run.fail("process() accepts an input of " + std::to_string(size) + " bytes, reads " +
                      std::to_string(real) + "; compare input->size and refuse");
    }
  }
  struct Newer {
    decltype(in) known;
    double later[8];
  } newer{};
  newer.known = in;
  newer.known.size = sizeof(newer);
  if (const GaitdStatus status = instance.process(&newer, out.get()); status != GAITD_OK) {
    return run.fail("process() returned " + status_text(status) +
                    " for an input with fields appended; structs only grow at the tail");
  }
  run.pass();
  return true;
}

template <int kLayer>
void bad_numbers(CheckRun& run) {
  run.begin("bad_numbers");
  Instance instance;
  if (!Instance::make(run, &instance)) return;
  const auto out = std::make_unique<typename sdk::LayerTraits<kLayer>::Output>();
  const auto set = std::make_unique<InputSet>();
  SampleWalk walk(run.model());
  const auto process = [&](double spoil) {
    walk.tick();
    *set = walk.inputs();
    if (spoil != 0.0) set->spoil(spoil);
    const auto in = input_of<kLayer>(*set);
    return instance.process(&in, out.get());
  };
  for (int i = 0; i < kTicksBefore; ++i) process(0.0);
  for (const double value : {kNan, kInfinity, 1e300}) {
    // Any status will do, and an output that the daemon finds out; then it must be able to go on.
    for (int i = 0; i < kTicksSpoiled; ++i) {
      if (process(value) == GAITD_EXCEPTION) {
        run.fail("process() threw at " + std::to_string(value) + " in its input");
        return;
      }
    }
    for (int i = 0; i < kTicksSpoiled; ++i) process(0.0);
    instance.reset();
    *out = {};
    for (int i = 0; i < 50; ++i) {
      const GaitdStatus status = process(0.0);
      const char* error =
          status == GAITD_OK ? output_error(*out, run.model().joint_count) : status_name(status);
      if (error != nullptr) {
        run.fail("after " + std::to_string(value) + " in its input, reset() and good input: " +
                 error + "; reset() must clear all that the bad numbers got into");
        return;
      }
    }
  }
  run.pass("not a number, infinite and huge in every sensor and state");
}

}  // namespace

void check_parameters(CheckRun& run) {
  with_layer(run.descriptor().layer, [&](auto layer) { parameters<layer>(run); });
}

void check_inputs(CheckRun& run) {
  with_layer(run.descriptor().layer, [&](auto layer) {
    sizes<layer>(run);
    bad_numbers<layer>(run);
  });
}

}  // namespace gaitd::daemon
