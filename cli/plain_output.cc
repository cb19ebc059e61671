// SPDX-License-Identifier: Apache-2.0
#include "cli/plain_output.h"

#include <string_view>

namespace gaitd::cli {

PlainOutput::PlainOutput(std::ostream* stream) : stream_(stream), target_(stream->rdbuf(this)) {}

PlainOutput::~PlainOutput() {
  filter_.finish(&text_);
  put();
  target_->pubsync();
  stream_->rdbuf(target_);
}

bool PlainOutput::put() {
  const auto size = static_cast<std::streamsize>(text_.size());
  const bool done = target_->sputn(text_.data(), size) == size;
  text_.clear();
  return done;
}

PlainOutput::int_type PlainOutput::overflow(int_type c) {
  if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
  const char one = traits_type::to_char_type(c);
  return xsputn(&one, 1) == 1 ? c : traits_type::eof();
}

std::streamsize PlainOutput::xsputn(const char* text, std::streamsize count) {
  filter_.append(std::string_view(text, static_cast<std::size_t>(count)), &text_);
  return put() ? count : 0;
}

int PlainOutput::sync() { return target_->pubsync(); }

}  // namespace gaitd::cli
