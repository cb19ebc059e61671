// SPDX-License-Identifier: Apache-2.0
#ifndef GAITD_QP_PROBLEM_H_
#define GAITD_QP_PROBLEM_H_

#include <Eigen/Core>

namespace gaitd::qp {

/// Numbers of unknowns and rows; of one problem, or the largest a solver has room for.
struct Dimensions {
  int unknowns = 0;      ///< n, length of x
  int equalities = 0;    ///< rows of A
  int inequalities = 0;  ///< rows of C, two-sided; the bounds on x do not count

  friend bool operator==(const Dimensions&, const Dimensions&) = default;
};

/// Read-only view of a column-major matrix of doubles; does not own, never copies.
///
/// Converts from any Eigen object with direct access to column-major storage (matrices, maps,
/// refs, blocks). Anything that would need a temporary does not compile. The viewed object must
/// outlive the view.
class MatrixView {
 public:
  MatrixView() = default;
  /// `stride` is the distance in doubles from one column to the next.
  MatrixView(const double* data, int rows, int cols, int stride)
      : data_(data), rows_(rows), cols_(cols), stride_(stride) {}

  template <typename Derived>
  MatrixView(const Eigen::MatrixBase<Derived>& m)  // NOLINT(google-explicit-constructor)
      : data_(m.derived().data()),
        rows_(static_cast<int>(m.rows())),
        cols_(static_cast<int>(m.cols())),
        stride_(static_cast<int>(m.derived().outerStride())) {
    static_assert((Eigen::internal::traits<Derived>::Flags & Eigen::DirectAccessBit) != 0,
                  "a view needs stored data, not an expression");
    static_assert(!Derived::IsRowMajor, "a view needs column-major data");
    static_assert(Derived::InnerStrideAtCompileTime == 1, "columns must be contiguous");
  }

  const double* data() const { return data_; }
  const double* column(int j) const { return data_ + static_cast<Eigen::Index>(j) * stride_; }
  double operator()(int i, int j) const { return column(j)[i]; }
  int rows() const { return rows_; }
  int cols() const { return cols_; }

 private:
  const double* data_ = nullptr;
  int rows_ = 0;
  int cols_ = 0;
  int stride_ = 0;
};

/// Read-only view of a contiguous vector of doubles; the same rules as MatrixView.
class VectorView {
 public:
  VectorView() = default;
  VectorView(const double* data, int size) : data_(data), size_(size) {}

  template <typename Derived>
  VectorView(const Eigen::MatrixBase<Derived>& v)  // NOLINT(google-explicit-constructor)
      : data_(v.derived().data()), size_(static_cast<int>(v.size())) {
    static_assert((Eigen::internal::traits<Derived>::Flags & Eigen::DirectAccessBit) != 0,
                  "a view needs stored data, not an expression");
    static_assert(Derived::IsVectorAtCompileTime, "a view of a vector needs a vector");
    static_assert(Derived::InnerStrideAtCompileTime == 1, "elements must be contiguous");
  }

  const double* data() const { return data_; }
  double operator[](int i) const { return data_[i]; }
  int size() const { return size_; }

 private:
  const double* data_ = nullptr;
  int size_ = 0;
};

/// Convex quadratic program
///
///     min ½ xᵀ H x + gᵀ x   s.t.   A x = b,   l ≤ C x ≤ u,   lb ≤ x ≤ ub.
///
/// The unit of everything is the caller's. H must be positive semi-definite; only its lower
/// triangle is read. An infinite entry of l, u, lb or ub means "no bound"; l = u and lb = ub are
/// equalities. A, C and the bounds may be left out: a default-constructed view means "none".
struct Problem {
  MatrixView H;   ///< n × n, lower triangle
  VectorView g;   ///< n
  MatrixView A;   ///< equalities × n
  VectorView b;   ///< equalities
  MatrixView C;   ///< inequalities × n
  VectorView l;   ///< inequalities; empty: no lower bound on any row
  VectorView u;   ///< inequalities; empty: no upper bound on any row
  VectorView lb;  ///< n; empty: no lower bound on any unknown
  VectorView ub;  ///< n; empty: no upper bound on any unknown

  /// Sizes as the views state them, without any check.
  Dimensions dimensions() const { return {g.size(), b.size(), C.rows()}; }

  /// Whether every view has the size that dimensions() asks for and n ≥ 1.
  bool consistent() const {
    const auto [n, p, m] = dimensions();
    const auto full_or_empty = [](const VectorView& v, int size) {
      return v.size() == size || v.size() == 0;
    };
    return n >= 1 && H.rows() == n && H.cols() == n && A.rows() == p && (p == 0 || A.cols() == n) &&
           (m == 0 || C.cols() == n) && full_or_empty(l, m) && full_or_empty(u, m) &&
           full_or_empty(lb, n) && full_or_empty(ub, n);
  }
};

}  // namespace gaitd::qp

#endif  // GAITD_QP_PROBLEM_H_
