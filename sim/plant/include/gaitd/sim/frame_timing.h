// SPDX-License-Identifier: Apache-2.0
// How punctual the frames of a bus are, and which of them never come.
#ifndef GAITD_SIM_FRAME_TIMING_H_
#define GAITD_SIM_FRAME_TIMING_H_

#include <optional>

#include "gaitd/sim/draw.h"
#include "gaitd/sim/random.h"

namespace gaitd::sim {

struct TimingFigures {
  Draw jitter;          // s, at most, either way
  Draw jitter_tail;     // s, mean of an exponential on top, cut at 5 ms
  Draw lost_frames;     // share of the frames that never come
  Draw lost_burst = 1;  // frames lost in a row
};

class FrameTiming {
 public:
  explicit FrameTiming(const TimingFigures& figures) : figures_(figures) {}

  // s by which a frame may be later than its delay.
  double latest() const;
  // Draws how bad this bus is; no frames are being lost.
  void draw(RandomStream* stream);
  // s by which the next frame is later than its delay; none: it is lost.
  std::optional<double> next(RandomStream* stream);

 private:
  TimingFigures figures_;
  double jitter_ = 0;       // s
  double tail_ = 0;         // s
  double loss_chance_ = 0;  // that frames begin to be lost
  int lost_ = 0;            // frames still to lose
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_FRAME_TIMING_H_
