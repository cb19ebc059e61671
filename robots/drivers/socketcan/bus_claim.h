// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace gaitd::can {

// The right to command the motors of an interface, which one process has at a time: a second one
// would switch off the motors that the first one walks on. It is the name of an abstract socket:
// like the interfaces it belongs to a network namespace, needs no folder that all users may write
// to, and the kernel frees it however the process ends.
class BusClaim {
 public:
  BusClaim() = default;
  ~BusClaim();
  BusClaim(BusClaim&& other) noexcept;
  BusClaim& operator=(BusClaim&& other) noexcept;

  // Empty, or who else has it or why it cannot be had. An interface that does not exist is free.
  std::string take(const std::string& interface);

 private:
  int socket_ = -1;
};

}  // namespace gaitd::can
