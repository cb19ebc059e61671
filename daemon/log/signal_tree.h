// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "daemon/log/signal.h"

namespace gaitd::daemon {

// The signal table as nested protobuf messages that follow the slash paths. A node is a field: of a
// value if `signal` is set, else of a message with `children`.
struct SignalNode {
  std::string segment;              // of the path, as it stands in the table
  std::string field;                // protobuf identifier, unique among its siblings
  std::string type;                 // of the message or enumeration; "" for plain values
  std::vector<std::string> values;  // names of the values of an enumeration, in the order of words
  int number = 0;                   // of the field
  int signal = -1;                  // position in the table
  std::vector<SignalNode> children;
};

// The root has no name; its children are the fields of the message of a tick. Depends on nothing
// but the table: the layout of the messages in a file of layout version 1 follows from it.
SignalNode build_signal_tree(const SignalTable& table);

}  // namespace gaitd::daemon
