// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace gaitd::daemon {

// Text as it may be shown on a terminal: control characters other than tab and end of line, bytes
// that are no UTF-8, and those that turn the direction of writing become \u00xx, as JSON has them.
// A file, a log or a daemon can then show what it likes, but command nothing.
class Printable {
 public:
  // Appends what is complete of it; a character may go on in the next call.
  void append(std::string_view text, std::string* out);
  void finish(std::string* out);  // after the last call

 private:
  void take(unsigned char byte, std::string* out);
  void drop_partial(std::string* out);

  std::string partial_;  // bytes of a character of which more are to come
  std::size_t size_ = 0;
};

std::string printable(std::string_view text);

}  // namespace gaitd::daemon
