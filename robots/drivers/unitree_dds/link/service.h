// SPDX-License-Identifier: Apache-2.0
// Requests to a service of the robot, one at a time.
#pragma once

#include <cstdint>
#include <string>

#include "dds_node.h"

namespace gaitd::unitree {

class Service {
 public:
  struct Answer {
    int code = 0;      // 0: done
    std::string data;  // JSON
  };
  static constexpr int kNobody = 3102, kTimeout = 3104;  // codes that the maker's client gives too

  Service(DdsNode* node, const std::string& name);
  // Waits for the answer, at most so long (s).
  Answer call(int64_t api, std::string parameter, double seconds);

 private:
  bool take_answer(int64_t id, int64_t api, Answer* answer);

  dds_entity_t requests_, answers_;
};

// What a code says, for messages.
std::string service_error(int code);

}  // namespace gaitd::unitree
