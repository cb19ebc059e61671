// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "cli/teleop/key_decoder.h"
#include "cli/teleop/link.h"

namespace gaitd::cli::teleop {

/// The e-stop, on a connection that carries nothing else. Pulled, it asks until gaitd confirms it:
/// where nothing comes, on a new connection after 0.3 s, then after twice as long each time, up to
/// 5 s. After a refusal, or where the connection ends, which is made again at once, it begins with
/// 0.3 s anew.
class EstopLine {
 public:
  explicit EstopLine(Destination destination);

  void pull(Time now);  ///< again: asks once more, on the same connection
  void tick(Time now);  ///< often: takes answers, asks again, connects again
  int fd() const { return link_.fd(); }
  /// Pulled and not confirmed: the robot may not know of it.
  bool open() const { return open_; }
  /// What the operator has to know, "" if nothing.
  std::string text() const;

 private:
  void ask(Time now);

  Link link_;
  bool open_ = false;
  int first_ = 0;              // request since it was pulled; 0: none went out
  Time next_{};                // to ask, or to connect, again
  Time::duration patience_{};  // with the next connection
  std::string trouble_;
};

}  // namespace gaitd::cli::teleop
