// SPDX-License-Identifier: Apache-2.0
#ifndef GAITD_QP_TEST_RECORDED_PROBLEMS_H_
#define GAITD_QP_TEST_RECORDED_PROBLEMS_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "random_problem.h"

namespace gaitd::qp::testing {

/// One recorded problem with the solution another solver found.
struct RecordedProblem {
  OwnedProblem problem;
  Eigen::VectorXd reference;
};

/// Names of the recorded sequences.
inline constexpr const char* kRecordedSequences[] = {"double_support", "single_support", "toe_off"};

/// Reads a sequence (format: data/README.md). Empty when the file is missing or malformed.
std::vector<RecordedProblem> read_recorded(const std::string& name);

/// Pulls every third torque limit in past the reference solution and asks for ρ ≥ 4. The recording
/// never reaches a torque limit; this one is held by several.
void tighten(RecordedProblem* recorded);

}  // namespace gaitd::qp::testing

#endif  // GAITD_QP_TEST_RECORDED_PROBLEMS_H_
