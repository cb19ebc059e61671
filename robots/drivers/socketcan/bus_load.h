// SPDX-License-Identifier: Apache-2.0
// How long frames occupy a bus.
#pragma once

namespace gaitd::can {

struct BitRates {
  double nominal = 1e6;  // bit/s
  double data = 0;       // bit/s of the data phase of CAN FD; 0: classic CAN
};

// Time of one frame with an identifier of 11 bits, or of 29 (`extended`, which is counted on a
// classic bus only), and `length` (<= 8) bytes under the worst bit stuffing, with the space between
// frames, in s.
double frame_time(const BitRates& rates, int length, bool extended = false);

}  // namespace gaitd::can
