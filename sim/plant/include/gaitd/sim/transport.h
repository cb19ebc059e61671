// SPDX-License-Identifier: Apache-2.0
// The way of readings to the controller: late, unpunctual, and sometimes they do not come.
//
// The sensors measure at every plant step. Once per control period the bus brings one frame: what
// was measured one delay before, rounded to plant steps. Each frame has a delay of its own within
// the jitter, but none overtakes another: then, and where the frame is lost, the controller has the
// reading before, with its stamp and its sequence number, and it grows old.
#ifndef GAITD_SIM_TRANSPORT_H_
#define GAITD_SIM_TRANSPORT_H_

#include <cstdint>
#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/sim/draw.h"
#include "gaitd/sim/frame_timing.h"
#include "gaitd/sim/random.h"
#include "gaitd/sim/sensor_figures.h"

namespace gaitd::sim {

class Transport {
 public:
  // `delay`: which one of `figures`; `index`: of the sensor, among all that have a way of their
  // own. `time_step`: of the plant, s; `steps_per_period`: plant steps in a control period.
  Transport(const SensorFigures& figures, const Draw& delay, double time_step, int steps_per_period,
            const SensorSeed& seed, uint64_t index);

  // Oldest measurement that a frame may bring, in plant steps.
  int longest_delay() const { return longest_; }

  // Draws the delay and starts over at plant step 0, with a frame that came as it should.
  void reset();

  // The frame of control tick `tick`. True: it came; it brings what was measured at step().
  bool advance(int64_t tick);

  // Plant step of the measurement that the controller has.
  int64_t step() const { return step_; }

  // About that measurement, at control tick `tick`, `time` seconds after the start.
  GaitdSignalInfo info(int64_t tick, double time) const;

 private:
  int delay_steps(double delay) const;

  bool arrival_stamps_;
  Draw delay_range_;
  double time_step_;
  int steps_per_period_;
  SensorSeed seed_;
  uint64_t index_;
  FrameTiming timing_;
  int longest_;

  double delay_ = 0;  // s
  int64_t step_ = 0;
  int64_t arrival_ = 0;  // control tick at which it came
  RandomStream stream_;
};

// The last measurements of one sensor, and the one that the controller has.
template <class Reading>
class DelayLine {
 public:
  // `longest`: plant steps that a measurement is kept; `empty` has the size of all.
  DelayLine(int longest, const Reading& empty)
      : ring_(static_cast<size_t>(longest) + 1, empty), shown_(empty) {}
  size_t size() const { return ring_.size(); }
  void store(int64_t step, const Reading& reading) { ring_[slot(step)] = reading; }
  void show(int64_t step) { shown_ = ring_[slot(step)]; }
  const Reading& shown() const { return shown_; }

 private:
  size_t slot(int64_t step) const {
    const auto size = static_cast<int64_t>(ring_.size());
    return static_cast<size_t>(((step % size) + size) % size);
  }
  std::vector<Reading> ring_;
  Reading shown_;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_TRANSPORT_H_
