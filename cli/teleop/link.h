// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/rpc_client.h"

namespace gaitd::cli::teleop {

/// A connection to gaitd that never waits: requests go out one behind the other, answers are taken
/// when they are there.
class Link {
 public:
  explicit Link(Destination destination);
  ~Link() { close(); }
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  bool up() const { return fd_ >= 0; }
  int fd() const { return fd_; }  ///< -1 if not up
  bool open();                    ///< again; waits for a few ms at most
  void close();
  void give_up(const std::string& why);  ///< closes it for that reason
  const std::string& why_down() const { return why_down_; }

  /// Its id, or 0 if the connection is not up any more.
  int send(const std::string& method, const nlohmann::json& params);
  struct Answer {
    int id = 0;
    daemon::RpcResult result;
  };
  /// All that have come. The connection may be down afterwards.
  std::vector<Answer> receive();

 private:
  void flush();

  Destination destination_;
  int fd_ = -1;
  int next_id_ = 1;
  std::string out_, in_;  // not yet sent; the beginning of a line
  std::string why_down_;
};

}  // namespace gaitd::cli::teleop
