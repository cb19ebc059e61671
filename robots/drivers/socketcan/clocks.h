// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gaitd::can {

// The clocks of the machine; tests have clocks of their own.
class Clocks {
 public:
  virtual ~Clocks() = default;
  virtual int64_t monotonic_ns() const;
  virtual int64_t realtime_ns() const;  // the wall clock: anybody may set it
  virtual void sleep(double seconds);   // not in the cycle
  static Clocks& system();
};

}  // namespace gaitd::can
