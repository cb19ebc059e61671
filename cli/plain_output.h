// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ostream>
#include <streambuf>
#include <string>

#include "daemon/config/printable.h"

namespace gaitd::cli {

/// While it lives, everything that goes to a stream passes daemon::printable on its way: the one
/// place that keeps the escape sequences of foreign files, logs and daemons from a terminal. What
/// gaitctl itself moves a cursor with does not go through streams.
class PlainOutput : public std::streambuf {
 public:
  explicit PlainOutput(std::ostream* stream);
  ~PlainOutput() override;
  PlainOutput(const PlainOutput&) = delete;
  PlainOutput& operator=(const PlainOutput&) = delete;

 protected:
  int_type overflow(int_type c) override;
  std::streamsize xsputn(const char* text, std::streamsize count) override;
  int sync() override;

 private:
  bool put();  // what is in text_

  std::ostream* stream_;
  std::streambuf* target_;
  daemon::Printable filter_;
  std::string text_;
};

}  // namespace gaitd::cli
