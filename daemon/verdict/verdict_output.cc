// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "daemon/verdict/number_text.h"
#include "daemon/verdict/verdict.h"

namespace gaitd::daemon {

namespace {

using OrderedJson = nlohmann::ordered_json;

// JSON has neither NaN nor infinity.
OrderedJson number(double value) {
  return std::isfinite(value) ? OrderedJson(value) : OrderedJson(nullptr);
}

}  // namespace

std::string number_text(double value, const std::string& unit) {
  if (std::isnan(value)) return "-";
  char text[40];
  const bool whole = value == std::floor(value) && std::abs(value) < 1e9;
  std::snprintf(text, sizeof(text), whole ? "%.0f" : "%.4g", value);
  return unit.empty() ? text : std::string(text) + " " + unit;
}

VerdictWord verdict_word(const Verdict& verdict, bool judged, bool damaged) {
  const bool fell = verdict.figure("falls") > 0.0;
  if (judged && !verdict.pass) return {"FAILED", false};
  if (fell) return {judged ? "FELL, as the scenario allows" : "FELL, not judged", false};
  if (damaged) return {"not judged: the log is damaged", false};
  if (!judged) return {"not judged: the log holds no expectations", false};
  return {"passed", true};
}

std::string verdict_json(const Verdict& verdict) {
  OrderedJson json;
  json["pass"] = verdict.pass;
  json["expectations"] = OrderedJson::array();
  for (const Judgement& judgement : verdict.judgements) {
    OrderedJson entry = {{"name", judgement.name},
                         {"pass", judgement.pass},
                         {"value", number(judgement.value)},
                         {"figure", judgement.figure},
                         {"bound", judgement.bound}};
    if (!judgement.note.empty()) entry["note"] = judgement.note;
    json["expectations"].push_back(std::move(entry));
  }
  json["figures"] = OrderedJson::object();
  json["units"] = OrderedJson::object();
  for (const Figure& figure : verdict.figures) {
    json["figures"][figure.name] = number(figure.value);
    if (!figure.unit.empty()) json["units"][figure.name] = figure.unit;
  }
  return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace);
}

}  // namespace gaitd::daemon
