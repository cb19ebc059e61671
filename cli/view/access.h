// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/server/rights.h"

namespace gaitd::cli {

/// Who may see and do what through `gaitctl view`. A port does not know who asks, so each role has
/// a secret of its own; and a page of somebody else in the same browser must not borrow it.
class Access {
 public:
  /// Tokens for every role up to `highest`. `origins`: of pages elsewhere that may connect, as
  /// "https://app.foxglove.dev".
  Access(daemon::Role highest, std::vector<std::string> origins);

  daemon::Role highest() const { return highest_; }
  /// 32 hexadecimal digits; of a role that is not given: empty.
  const std::string& token(daemon::Role role) const {
    return tokens_[static_cast<std::size_t>(role)];
  }
  /// The role of whoever knows this token. Takes as long whatever is wrong with it.
  std::optional<daemon::Role> role_of(std::string_view token) const;

  /// Whether a request names this server as a browser would that was given its address: a number,
  /// or a name of this machine. Another name is how a foreign page gets around the rule of origins.
  static bool is_own_host(std::string_view host);
  /// Whether a page of this origin may connect: the one served under `host`, one of the list, or
  /// one of a file, as the windows of desktop programs are. No origin: no browser. A token it needs
  /// too.
  bool allows_origin(std::string_view origin, std::string_view host, bool tls) const;

 private:
  daemon::Role highest_;
  std::array<std::string, daemon::kRoleNames.size()> tokens_;
  std::vector<std::string> origins_;
};

/// "127.0.0.1:8765", "[::1]:8765", "8765" → address and port. Null with what is wrong.
struct ListenAddress {
  std::string address;
  unsigned short port = 0;
  bool loopback = true;
};
std::optional<ListenAddress> parse_listen_address(const std::string& text, std::string* error);

}  // namespace gaitd::cli
