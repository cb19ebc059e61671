// SPDX-License-Identifier: Apache-2.0
#include "cli/table.h"

#include <algorithm>
#include <numeric>

#include "cli/terminal.h"

namespace gaitd::cli {
namespace {

constexpr std::size_t kGap = 2;  // between columns

std::size_t longest_word(const std::string& text) {
  std::size_t longest = 0;
  for (const std::string& word : wrapped(text, 1)) longest = std::max(longest, width_of(word));
  return longest;
}

std::size_t total(const std::vector<std::size_t>& widths) {
  const std::size_t gaps = kGap * (std::max<std::size_t>(widths.size(), 1) - 1);
  return std::accumulate(widths.begin(), widths.end(), gaps);
}

// One column after the other, always the widest that can, until all of them fit.
void narrow(const std::vector<std::size_t>& least, std::size_t columns,
            std::vector<std::size_t>* widths) {
  while (total(*widths) > columns) {
    std::size_t* widest = nullptr;
    for (std::size_t i = 0; i < widths->size(); ++i) {
      std::size_t& width = (*widths)[i];
      if (width > least[i] && (widest == nullptr || width > *widest)) widest = &width;
    }
    if (widest == nullptr) return;
    --*widest;
  }
}

// Whether a table that gave way is still one: a column of three words a line is none.
bool is_readable(const std::vector<std::size_t>& natural, const std::vector<std::size_t>& widths,
                 std::size_t columns) {
  constexpr std::size_t kLong = 40;
  constexpr std::size_t kNarrow = 24;
  if (total(widths) > columns) return widths.size() < 2;
  for (std::size_t i = 0; i < widths.size(); ++i) {
    if (natural[i] >= kLong && widths[i] < kNarrow) return false;
  }
  return true;
}

// The first columns, as many as fit, as a table; below each row the rest of it.
std::string stacked(const std::vector<std::string>& header,
                    const std::vector<std::vector<std::string>>& rows,
                    const std::vector<std::size_t>& widths, std::size_t columns) {
  constexpr std::size_t kIn = 4;
  std::size_t kept = 1;
  std::size_t width = widths[0];
  while (kept + 1 < widths.size() && width + kGap + widths[kept] <= columns) {
    width += kGap + widths[kept++];
  }
  const auto line = [&](const std::vector<std::string>& row) {
    std::string text;
    for (std::size_t i = 0; i < kept && i < row.size(); ++i) {
      text += row[i] + std::string(widths[i] + kGap - width_of(row[i]), ' ');
    }
    const std::size_t end = text.find_last_not_of(' ');
    return text.substr(0, end == std::string::npos ? 0 : end + 1) + "\n";
  };
  std::string out = header.empty() ? "" : line(header);
  for (const auto& row : rows) {
    out += line(row);
    std::string rest;
    for (std::size_t i = kept; i < row.size(); ++i) {
      if (row[i].empty()) continue;
      const std::string name = i < header.size() && !header[i].empty() ? header[i] + ' ' : "";
      rest += (rest.empty() ? "" : ", ") + name + row[i];
    }
    if (rest.empty()) continue;
    for (const std::string& part : wrapped(rest, columns - std::min(kIn, columns))) {
      out += std::string(kIn, ' ') + part + "\n";
    }
  }
  return out;
}

// Where a line that goes on begins again: under its second column, if it has one near.
std::size_t indent_of(const std::string& line) {
  constexpr std::size_t kFarthest = 24;
  const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
  const std::size_t gap = line.find("  ", begin);
  if (gap != std::string::npos) {
    const std::size_t second = line.find_first_not_of(' ', gap);
    if (second != std::string::npos && second <= kFarthest) return second;
  }
  return begin + 2;
}

std::string folded_line(const std::string& line, std::size_t columns) {
  const std::size_t indent = indent_of(line);
  const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
  if (width_of(line) <= columns || columns < indent + 20) return line;
  std::string out;
  std::string now = line.substr(0, begin);
  for (std::size_t at = begin; at < line.size();) {
    // Blanks before a word are kept while it stays on its line.
    const std::size_t word = std::min(line.find_first_not_of(' ', at), line.size());
    const std::size_t end = std::min(line.find(' ', word), line.size());
    const std::string gap = line.substr(at, word - at);
    const std::string text = line.substr(word, end - word);
    at = end;
    if (width_of(now + gap + text) <= columns) {
      now += gap + text;
      continue;
    }
    if (now.find_first_not_of(' ') != std::string::npos) {
      out += now + '\n';
      now = std::string(indent, ' ');
    }
    now += text;
  }
  return out + now;
}

}  // namespace

std::string folded(const std::string& text, std::size_t columns) {
  if (columns == 0) return text;
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    out += folded_line(text.substr(at, end - at), columns);
    if (end < text.size()) out += '\n';
    at = end + 1;
  }
  return out;
}

std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  }));
}

std::vector<std::string> wrapped(const std::string& text, std::size_t columns) {
  if (width_of(text) <= columns) return {text};
  std::vector<std::string> lines;
  for (std::size_t at = text.find_first_not_of(' '); at != std::string::npos;) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    if (!lines.empty() && width_of(lines.back()) + 1 + width_of(word) <= columns) {
      lines.back() += ' ' + word;
    } else {
      lines.push_back(word);
    }
    at = text.find_first_not_of(' ', end);
  }
  return lines;
}

std::string table(const std::vector<std::string>& header,
                  const std::vector<std::vector<std::string>>& rows, std::size_t columns) {
  std::vector<std::size_t> widths;
  std::vector<std::size_t> least;
  const auto measure = [&](const std::vector<std::string>& row) {
    widths.resize(std::max(widths.size(), row.size()));
    least.resize(widths.size());
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], width_of(row[i]));
      least[i] = std::max(least[i], longest_word(row[i]));
    }
  };
  measure(header);
  for (const auto& row : rows) measure(row);
  if (columns > 0) {
    const std::vector<std::size_t> natural = widths;
    narrow(least, columns, &widths);
    if (!is_readable(natural, widths, columns)) return stacked(header, rows, natural, columns);
  }
  std::string out;
  const auto print = [&](const std::vector<std::string>& row) {
    std::vector<std::vector<std::string>> cells;
    std::size_t height = 1;
    for (std::size_t i = 0; i < row.size(); ++i) {
      cells.push_back(wrapped(row[i], widths[i]));
      height = std::max(height, cells.back().size());
    }
    for (std::size_t k = 0; k < height; ++k) {
      std::string line;
      for (std::size_t i = 0; i < row.size(); ++i) {
        const std::string text = k < cells[i].size() ? cells[i][k] : "";
        line += text + std::string(widths[i] + kGap - width_of(text), ' ');
      }
      const std::size_t end = line.find_last_not_of(' ');
      out += line.substr(0, end == std::string::npos ? 0 : end + 1) + "\n";
    }
  };
  if (!header.empty()) print(header);
  for (const auto& row : rows) print(row);
  return out;
}

std::string table(const std::vector<std::string>& header,
                  const std::vector<std::vector<std::string>>& rows) {
  return table(header, rows, output_columns());
}

}  // namespace gaitd::cli
