// SPDX-License-Identifier: Apache-2.0
#include "bus_load.h"

namespace gaitd::can {

double frame_time(const BitRates& rates, int length, bool extended) {
  const int payload = 8 * length;
  if (rates.data <= 0) {
    // Start to CRC is stuffed: at worst one bit after the first five and then after every fourth.
    const int stuffed = (extended ? 54 : 34) + payload;
    const int rest = 13;  // CRC delimiter, acknowledge, end of frame, space
    return (stuffed + (stuffed - 1) / 4 + rest) / rates.nominal;
  }
  const int arbitration = 17;        // start to bit-rate switch
  const int end = 12;                // acknowledge, end of frame, space
  const int data = 5 + payload;      // error state, length, payload
  const int check = 4 + 17 + 6 + 1;  // stuff count, CRC, its fixed stuff bits, delimiter
  return (arbitration + (arbitration - 1) / 4 + end) / rates.nominal +
         (data + data / 4 + check) / rates.data;
}

}  // namespace gaitd::can
