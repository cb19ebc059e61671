// SPDX-License-Identifier: Apache-2.0
#include "cli/view/access.h"

#include <sys/random.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <cctype>
#include <charconv>
#include <stdexcept>
#include <utility>

namespace gaitd::cli {
namespace {

namespace ip = boost::asio::ip;

std::string random_token() {
  static constexpr char kDigits[] = "0123456789abcdef";
  unsigned char bytes[16];
  if (getrandom(bytes, sizeof(bytes), 0) != sizeof(bytes)) {
    throw std::runtime_error("the kernel gives no random numbers");
  }
  std::string token;
  for (const unsigned char byte : bytes) {
    token += kDigits[byte >> 4];
    token += kDigits[byte & 15];
  }
  return token;
}

bool same(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned char difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference = static_cast<unsigned char>(difference | (a[i] ^ b[i]));
  }
  return difference == 0;
}

std::string lower(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(), [](unsigned char c) { return std::tolower(c); });
  return out;
}

std::string own_name() {
  char name[256] = {};
  return gethostname(name, sizeof(name) - 1) == 0 ? lower(name) : std::string();
}

}  // namespace

Access::Access(daemon::Role highest, std::vector<std::string> origins)
    : highest_(highest), origins_(std::move(origins)) {
  for (std::size_t role = 0; role <= static_cast<std::size_t>(highest); ++role) {
    tokens_[role] = random_token();
  }
}

std::optional<daemon::Role> Access::role_of(std::string_view token) const {
  std::optional<daemon::Role> found;
  for (std::size_t role = 0; role < tokens_.size(); ++role) {
    if (!tokens_[role].empty() && same(tokens_[role], token))
      found = static_cast<daemon::Role>(role);
  }
  return found;
}

bool Access::is_own_host(std::string_view host) {
  std::string name = lower(host);
  if (name.starts_with('[')) {
    const std::size_t end = name.find(']');
    if (end == std::string::npos) return false;
    name = name.substr(1, end - 1);
  } else if (const std::size_t colon = name.rfind(':'); colon != std::string::npos) {
    name.erase(colon);
  }
  boost::system::error_code error;
  ip::make_address(name, error);
  if (!error || name == "localhost") return true;
  const std::string own = own_name();
  return !own.empty() && (name == own || name == own + ".local");
}

bool Access::allows_origin(std::string_view origin, std::string_view host, bool tls) const {
  if (origin.empty()) return true;
  const std::string asked = lower(origin);
  // A page of a file that somebody was sent has no token: none is kept in what browsers send by
  // themselves.
  if (asked == "file://") return true;
  if (asked == (tls ? "https://" : "http://") + lower(host)) return true;
  return std::ranges::any_of(origins_, [&](const auto& one) { return lower(one) == asked; });
}

std::optional<ListenAddress> parse_listen_address(const std::string& text, std::string* error) {
  const auto wrong = [&](const std::string& what) {
    *error = "--listen: " + what + ", got \"" + text +
             "\"; expected ADDRESS:PORT, as 127.0.0.1:8765 or [::1]:8765";
    return std::nullopt;
  };
  const std::size_t colon = text.rfind(':');
  std::string address = colon == std::string::npos ? "127.0.0.1" : text.substr(0, colon);
  const std::string digits = colon == std::string::npos ? text : text.substr(colon + 1);
  ListenAddress listen;
  const char* const end = digits.data() + digits.size();
  const auto [stop, failed] = std::from_chars(digits.data(), end, listen.port);
  if (failed != std::errc() || stop != end) return wrong("no port");
  if (address.starts_with('[') && address.ends_with(']')) {
    address = address.substr(1, address.size() - 2);
  }
  if (address == "localhost") address = "127.0.0.1";
  boost::system::error_code invalid;
  const ip::address parsed = ip::make_address(address, invalid);
  if (invalid) return wrong("no address");
  listen.address = address;
  listen.loopback = parsed.is_loopback();
  return listen;
}

}  // namespace gaitd::cli
