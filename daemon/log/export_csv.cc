// SPDX-License-Identifier: Apache-2.0
#include "daemon/log/export_csv.h"

#include <array>
#include <charconv>
#include <cmath>
#include <vector>

namespace gaitd::daemon {

namespace {

// The fewest digits that read back to the same bits.
void append_real(double value, std::string* line) {
  std::array<char, 32> text;
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  line->append(text.data(), result.ptr);
}

void append_integer(double value, std::string* line) {
  std::array<char, 32> text;
  const auto result =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  line->append(text.data(), result.ptr);
}

void append_value(const SignalDescription& signal, double value, std::string* line) {
  switch (signal.kind) {
    case SignalDescription::Kind::kReal:
      append_real(value, line);
      break;
    case SignalDescription::Kind::kInteger:
      if (!std::isnan(value)) append_integer(value, line);
      break;
    case SignalDescription::Kind::kBoolean:
      *line += value != 0.0 ? '1' : '0';
      break;
    case SignalDescription::Kind::kEnumeration:
      if (!std::isnan(value)) *line += signal.words[static_cast<std::size_t>(value)];
      break;
  }
}

}  // namespace

bool export_csv(const LogReader& log, const CsvOptions& options, std::ostream& out,
                std::string* error) {
  const SignalTable& table = log.signals();
  std::vector<std::size_t> chosen;
  std::string line;
  for (const std::string& name : log.match(options.signals)) {
    chosen.push_back(static_cast<std::size_t>(find_signal(table, name)));
    line += (line.empty() ? "" : ",") + name;
  }
  if (chosen.empty()) {
    *error = log.path() + ": no signal matches '" + options.signals +
             "'; `gaitctl log info --signals` lists what there is";
    return false;
  }
  const CsvOptions all;
  const bool ranged = options.start != all.start || options.end != all.end;
  const int time = find_signal(table, "time");
  if (ranged && time < 0) {
    *error = log.path() + ": a time range needs the signal 'time', which this log does not hold";
    return false;
  }
  out << line << '\n';

  std::vector<double> values(table.size());
  LogReader::TickCursor ticks = log.ticks();
  while (out && ticks.next(values)) {
    const double now = ranged ? values[static_cast<std::size_t>(time)] : 0.0;
    if (ranged && !(now >= options.start && now <= options.end)) continue;
    line.clear();
    for (const std::size_t signal : chosen) {
      if (signal != chosen.front()) line += ',';
      append_value(table[signal], values[signal], &line);
    }
    line += '\n';
    out << line;
  }
  out.flush();
  if (!out) *error = "cannot write the CSV: the disk is full or the reader went away";
  return static_cast<bool>(out);
}

}  // namespace gaitd::daemon
