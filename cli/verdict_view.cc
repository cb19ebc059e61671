// SPDX-License-Identifier: Apache-2.0
#include "cli/verdict_view.h"

#include "cli/table.h"
#include "daemon/verdict/number_text.h"

namespace gaitd::cli {
namespace {

using Rows = std::vector<std::vector<std::string>>;

constexpr std::size_t kIndent = 2;

std::string indented(const Rows& rows, std::size_t columns) {
  std::string out;
  const std::string lines =
      rows.empty() ? "" : table({}, rows, columns > kIndent ? columns - kIndent : columns);
  for (std::size_t at = 0; at < lines.size();) {
    const std::size_t end = lines.find('\n', at) + 1;
    out += std::string(kIndent, ' ') + lines.substr(at, end - at);
    at = end;
  }
  return out;
}

}  // namespace

std::string expectations_text(const daemon::Verdict& verdict, std::size_t columns) {
  Rows rows;
  for (const daemon::Judgement& judgement : verdict.judgements) {
    rows.push_back({judgement.pass ? "ok" : "FAIL", judgement.name, judgement.figure,
                    judgement.bound, judgement.note});
  }
  return indented(rows, columns);
}

std::string figures_text(const daemon::Verdict& verdict) {
  Rows rows;
  for (const daemon::Figure& figure : verdict.figures) {
    rows.push_back({figure.name, daemon::number_text(figure.value, figure.unit)});
  }
  return "figures\n" + indented(rows, 0);
}

std::string failed_expectations(const daemon::Verdict& verdict) {
  std::string out;
  for (const daemon::Judgement& judgement : verdict.judgements) {
    if (judgement.pass) continue;
    out += (out.empty() ? "" : ", ") + judgement.name + " " + judgement.figure;
  }
  return out;
}

}  // namespace gaitd::cli
