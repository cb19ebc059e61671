// SPDX-License-Identifier: Apache-2.0
#include "cli/plain_output.h"

#include <string_view>

#include "cli/table.h"

namespace gaitd::cli {

PlainOutput::PlainOutput(std::ostream* stream, std::size_t columns)
    : stream_(stream), target_(stream->rdbuf(this)), flags_(stream->flags()), columns_(columns) {
  // What is seen part by part cannot be folded as a line.
  if (columns > 0) stream->unsetf(std::ios_base::unitbuf);
}

PlainOutput::~PlainOutput() {
  filter_.finish(&text_);
  sync();
  stream_->rdbuf(target_);
  if ((flags_ & std::ios_base::unitbuf) != 0) stream_->setf(std::ios_base::unitbuf);
}

bool PlainOutput::put() {
  const std::size_t end = columns_ == 0 ? text_.size() : text_.rfind('\n') + 1;
  if (end == 0) return true;
  const std::string lines = folded(text_.substr(0, end), columns_);
  text_.erase(0, end);
  const auto size = static_cast<std::streamsize>(lines.size());
  return target_->sputn(lines.data(), size) == size;
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

// What is flushed is to be seen, whether its line has ended or not.
int PlainOutput::sync() {
  const std::string rest = folded(text_, columns_);
  text_.clear();
  const auto size = static_cast<std::streamsize>(rest.size());
  if (size > 0 && target_->sputn(rest.data(), size) != size) return -1;
  return target_->pubsync();
}

}  // namespace gaitd::cli
