// SPDX-License-Identifier: Apache-2.0
#include "recorded_problems.h"

#include <lzma.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>

namespace gaitd::qp::testing {
namespace {

std::string decompress(const std::string& packed) {
  lzma_stream stream = LZMA_STREAM_INIT;
  if (lzma_stream_decoder(&stream, UINT64_MAX, 0) != LZMA_OK) return {};
  std::string result;
  std::array<std::uint8_t, 1 << 16> buffer;
  stream.next_in = reinterpret_cast<const std::uint8_t*>(packed.data());
  stream.avail_in = packed.size();
  lzma_ret code = LZMA_OK;
  while (code == LZMA_OK) {
    stream.next_out = buffer.data();
    stream.avail_out = buffer.size();
    code = lzma_code(&stream, LZMA_FINISH);
    result.append(reinterpret_cast<const char*>(buffer.data()), buffer.size() - stream.avail_out);
  }
  lzma_end(&stream);
  return code == LZMA_STREAM_END ? result : std::string();
}

// Reads matrices off the front of a byte string.
class Reader {
 public:
  explicit Reader(const std::string& bytes) : bytes_(bytes) {}

  bool take(void* out, std::size_t size) {
    if (size > bytes_.size() - position_) return false;
    std::memcpy(out, bytes_.data() + position_, size);
    position_ += size;
    return true;
  }
  Eigen::MatrixXd matrix(int rows, int cols) {
    Eigen::MatrixXd m(rows, cols);
    complete_ &= take(m.data(), sizeof(double) * m.size());
    return m;
  }
  Eigen::VectorXd vector(int n) { return matrix(n, 1); }
  bool complete() const { return complete_; }

 private:
  const std::string& bytes_;
  std::size_t position_ = 0;
  bool complete_ = true;
};

}  // namespace

std::vector<RecordedProblem> read_recorded(const std::string& name) {
  std::ifstream file(std::string(GAITD_QP_TEST_DATA "/") + name + ".bin.xz", std::ios::binary);
  const std::string packed((std::istreambuf_iterator<char>(file)), {});
  const std::string bytes = decompress(packed);
  Reader reader(bytes);
  std::array<char, 8> magic;
  std::array<std::int32_t, 6> header;
  if (!reader.take(magic.data(), magic.size()) ||
      std::memcmp(magic.data(), "GAITDQP1", magic.size()) != 0 ||
      !reader.take(header.data(), sizeof(header))) {
    return {};
  }
  const auto [count, nv, nrho, neq, nineq, ntask] = header;
  const int n = nv + nrho;
  std::vector<RecordedProblem> result(count);
  for (RecordedProblem& recorded : result) {
    const Eigen::MatrixXd j = reader.matrix(ntask, nv);
    const Eigen::VectorXd p = reader.vector(ntask);
    const Eigen::VectorXd w = reader.vector(ntask);
    const Eigen::VectorXd regv = reader.vector(nv);
    const Eigen::VectorXd regr = reader.vector(nrho);
    OwnedProblem& problem = recorded.problem;
    problem = OwnedProblem({n, neq, nineq});
    problem.H.topLeftCorner(nv, nv) = j.transpose() * w.asDiagonal() * j;
    problem.H.diagonal().head(nv) += regv;
    problem.H.diagonal().tail(nrho) = regr;
    problem.g.head(nv) = -j.transpose() * w.cwiseProduct(p);
    problem.A = reader.matrix(neq, n);
    problem.b = reader.vector(neq);
    problem.C = reader.matrix(nineq, n);
    problem.l = reader.vector(nineq);
    problem.u = reader.vector(nineq);
    problem.lb = reader.vector(n);
    problem.ub = reader.vector(n);
    recorded.reference = reader.vector(n);
  }
  return reader.complete() ? result : std::vector<RecordedProblem>();
}

void tighten(RecordedProblem* recorded) {
  constexpr int kVelocities = 36;
  OwnedProblem& problem = recorded->problem;
  const Eigen::VectorXd torque = problem.C * recorded->reference;
  for (int i = 0; i < torque.size(); i += 3) {
    const double cut = 0.02 * std::abs(torque[i]) + 0.1;
    if (torque[i] > 0.0) {
      problem.u[i] = torque[i] - cut;
    } else {
      problem.l[i] = torque[i] + cut;
    }
  }
  problem.lb.tail(problem.lb.size() - kVelocities).setConstant(4.0);
}

}  // namespace gaitd::qp::testing
