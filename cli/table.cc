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

// One column after the other, always the widest that can, until all of them fit.
void narrow(const std::vector<std::size_t>& least, std::size_t columns,
            std::vector<std::size_t>* widths) {
  const std::size_t gaps = kGap * (std::max<std::size_t>(widths->size(), 1) - 1);
  while (std::accumulate(widths->begin(), widths->end(), gaps) > columns) {
    std::size_t* widest = nullptr;
    for (std::size_t i = 0; i < widths->size(); ++i) {
      std::size_t& width = (*widths)[i];
      if (width > least[i] && (widest == nullptr || width > *widest)) widest = &width;
    }
    if (widest == nullptr) return;
    --*widest;
  }
}

}  // namespace

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
  if (columns > 0) narrow(least, columns, &widths);
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
