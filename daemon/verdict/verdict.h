// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "daemon/log/log_reader.h"
#include "daemon/verdict/expectations.h"

namespace gaitd::daemon {

// What the log must supply besides the signals, in its metadata:
//   joints      JSON [{"name": "l_leg_kny", "effort_limit": 890.0}, ...]
//   legs        JSON {"left": {"knee": "l_leg_kny", "knee_bend_sign": 1, "knee_straight": 0,
//                     "joints": [names]}, "right": {...}}; "knee" null or absent if the leg has
//                     none, "knee_straight" (rad, 0 if absent) where the leg is straight
//   fault_bits  JSON {"fall": 3, ...}: bit numbers of the signal safety/faults
//   scenario    its name; a run of one passes only if it was not broken off
//   end         how the run ended, optional, at the end of the file: whole are "settled",
//   "duration" realtime_factor, wall_seconds   numbers as text, optional, at the end of the file
// and, where the run has closing steps, the boolean signal gait/closing: true during their swing.

// One expectation, judged.
struct Judgement {
  std::string name;    // as in the scenario file; of a check: its signal, statistic and phase
  std::string figure;  // what was measured, for people
  double value = 0.0;  // the same; NaN if it could not be measured
  std::string bound;   // what was expected, e.g. "<= 0.03 m"
  bool pass = false;
  std::string note;  // why it could not be measured, or which signal was the worst
};

// One measured figure.
struct Figure {
  std::string name;
  double value = 0.0;  // NaN: not measurable in this log
  std::string unit;
};

struct Verdict {
  bool pass = false;                  // every expectation holds
  std::vector<std::string> refusals;  // commands that gaitd refused: when, which and why
  std::vector<Judgement> judgements;
  std::vector<Figure> figures;

  // NaN if there is no figure of that name.
  double figure(const std::string& name) const;
};

// Everything comes from the log alone. Truth is used where the log has it, the estimate otherwise.
Verdict compute_verdict(const LogReader& log, const Expectations& expectations);

// What may be said of a run in a word. A fall never passes here, and neither does a run whose log
// does not hold what was expected of it (`judged` false) or is damaged.
struct VerdictWord {
  std::string text;
  bool good = false;
};
VerdictWord verdict_word(const Verdict& verdict, bool judged, bool damaged);

std::string verdict_json(const Verdict& verdict);

}  // namespace gaitd::daemon
