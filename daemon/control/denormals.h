// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <xmmintrin.h>

namespace gaitd::daemon {

// Denormal numbers cost a hundred times a normal one: none on this thread while it lives.
class FlushDenormals {
 public:
  FlushDenormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040); }
  ~FlushDenormals() { _mm_setcsr(before_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  const unsigned before_;
};

}  // namespace gaitd::daemon
