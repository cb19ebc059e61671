// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
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
  /// `columns`: of the terminal that the stream goes to. Lines that are longer go on below, a
  /// little further in, broken between words; 0: no limit.
  PlainOutput(std::ostream* stream, std::size_t columns);
  ~PlainOutput() override;
  PlainOutput(const PlainOutput&) = delete;
  PlainOutput& operator=(const PlainOutput&) = delete;

 protected:
  int_type overflow(int_type c) override;
  std::streamsize xsputn(const char* text, std::streamsize count) override;
  int sync() override;

 private:
  bool put();  // the whole lines in text_; without a limit, all of it

  std::ostream* stream_;
  std::streambuf* target_;
  std::ios_base::fmtflags flags_;
  std::size_t columns_;
  daemon::Printable filter_;
  std::string text_;
};

}  // namespace gaitd::cli
