// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/ssl/context.hpp>
#include <memory>
#include <string>

namespace gaitd::cli {

/// TLS with a certificate of this user's own, which nobody else has signed: people compare its
/// fingerprint once. Kept in `file` (mode 0600), so that the fingerprint stays.
struct Certificate {
  std::shared_ptr<boost::asio::ssl::context> context;
  std::string fingerprint;  ///< SHA-256, as browsers show it
};

/// Reads the certificate and its key from `file`, or makes them where there is no such file. Null
/// context with the reason if neither is possible.
Certificate own_certificate(const std::string& file, std::string* error);

/// $XDG_CONFIG_HOME/gaitd/view.pem, or below ~/.config.
std::string certificate_file();

}  // namespace gaitd::cli
