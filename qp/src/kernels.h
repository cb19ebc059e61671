// SPDX-License-Identifier: Apache-2.0
#ifndef GAITD_QP_SRC_KERNELS_H_
#define GAITD_QP_SRC_KERNELS_H_

#include <cstddef>
#include <cstring>
#include <limits>

namespace gaitd::qp::kernels {

// Small vector kernels. They load without alignment requirements, so that a result never depends
// on the address of the data; every order of summation is fixed.

using Vec4 = double __attribute__((vector_size(32)));
inline constexpr int kWidth = 4;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline Vec4 load(const double* p) {
  Vec4 v;
  std::memcpy(&v, p, sizeof(v));
  return v;
}

inline void store(double* p, const Vec4& v) { std::memcpy(p, &v, sizeof(v)); }

inline Vec4 broadcast(double a) { return Vec4{a, a, a, a}; }

inline double sum(const Vec4& v) { return (v[0] + v[2]) + (v[1] + v[3]); }

/// Smallest multiple of the vector width that is at least n.
constexpr int padded(int n) { return (n + kWidth - 1) / kWidth * kWidth; }

/// aᵀb, length n.
inline double dot(int n, const double* a, const double* b) {
  Vec4 s0 = {};
  Vec4 s1 = {};
  int i = 0;
  for (; i + 2 * kWidth <= n; i += 2 * kWidth) {
    s0 += load(a + i) * load(b + i);
    s1 += load(a + i + kWidth) * load(b + i + kWidth);
  }
  if (i + kWidth <= n) {
    s0 += load(a + i) * load(b + i);
    i += kWidth;
  }
  double result = sum(s0 + s1);
  for (; i < n; ++i) result += a[i] * b[i];
  return result;
}

/// y += a x, length n.
inline void axpy(int n, double a, const double* x, double* y) {
  const Vec4 va = broadcast(a);
  int i = 0;
  for (; i + kWidth <= n; i += kWidth) store(y + i, load(y + i) + va * load(x + i));
  for (; i < n; ++i) y[i] += a * x[i];
}

/// y += a x and returns xᵀz in one pass, length n.
inline double axpy_dot(int n, double a, const double* x, double* y, const double* z) {
  const Vec4 va = broadcast(a);
  Vec4 s = {};
  int i = 0;
  for (; i + kWidth <= n; i += kWidth) {
    const Vec4 vx = load(x + i);
    store(y + i, load(y + i) + va * vx);
    s += vx * load(z + i);
  }
  double result = sum(s);
  for (; i < n; ++i) {
    y[i] += a * x[i];
    result += x[i] * z[i];
  }
  return result;
}

/// y += sign · M w with M column-major n × q, n a multiple of kWidth.
inline void multiply_add(int n, int q, const double* m, int ld, const double* w, double sign,
                         double* y) {
  int j = 0;
  for (; j + 4 <= q; j += 4) {
    const double* c = m + static_cast<std::ptrdiff_t>(j) * ld;
    const Vec4 w0 = broadcast(sign * w[j]);
    const Vec4 w1 = broadcast(sign * w[j + 1]);
    const Vec4 w2 = broadcast(sign * w[j + 2]);
    const Vec4 w3 = broadcast(sign * w[j + 3]);
    for (int i = 0; i < n; i += kWidth) {
      const Vec4 a = load(y + i) + w0 * load(c + i) + w1 * load(c + ld + i);
      const Vec4 b = w2 * load(c + 2 * ld + i) + w3 * load(c + 3 * ld + i);
      store(y + i, a + b);
    }
  }
  for (; j < q; ++j) axpy(n, sign * w[j], m + static_cast<std::ptrdiff_t>(j) * ld, y);
}

/// out = Mᵀ x with M column-major n × q, n a multiple of kWidth.
inline void multiply_transposed(int n, int q, const double* m, int ld, const double* x,
                                double* out) {
  int j = 0;
  for (; j + 4 <= q; j += 4) {
    const double* c = m + static_cast<std::ptrdiff_t>(j) * ld;
    Vec4 s0 = {};
    Vec4 s1 = {};
    Vec4 s2 = {};
    Vec4 s3 = {};
    for (int i = 0; i < n; i += kWidth) {
      const Vec4 vx = load(x + i);
      s0 += vx * load(c + i);
      s1 += vx * load(c + ld + i);
      s2 += vx * load(c + 2 * ld + i);
      s3 += vx * load(c + 3 * ld + i);
    }
    out[j] = sum(s0);
    out[j + 1] = sum(s1);
    out[j + 2] = sum(s2);
    out[j + 3] = sum(s3);
  }
  for (; j < q; ++j) out[j] = dot(n, m + static_cast<std::ptrdiff_t>(j) * ld, x);
}

/// Plane rotation of two columns, (a, b) ← (c a + s b, c b − s a), length n, a multiple of kWidth.
inline void rotate(int n, double c, double s, double* a, double* b) {
  const Vec4 vc = broadcast(c);
  const Vec4 vs = broadcast(s);
  for (int i = 0; i < n; i += kWidth) {
    const Vec4 va = load(a + i);
    const Vec4 vb = load(b + i);
    store(a + i, vc * va + vs * vb);
    store(b + i, vc * vb - vs * va);
  }
}

/// Whether all n values are finite; x − x is NaN for infinities and NaN alike.
inline bool all_finite(int n, const double* x) {
  Vec4 s = {};
  int i = 0;
  for (; i + kWidth <= n; i += kWidth) {
    const Vec4 v = load(x + i);
    s += v - v;
  }
  double rest = sum(s);
  for (; i < n; ++i) rest += x[i] - x[i];
  return rest == 0.0;
}

}  // namespace gaitd::qp::kernels

#endif  // GAITD_QP_SRC_KERNELS_H_
