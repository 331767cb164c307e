// SPDX-License-Identifier: Apache-2.0
#include "base/orientation.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace fexp {

namespace {

/// a + b = sum + rest, without an error.
struct TwoSum {
  TwoSum(double a, double b) : sum(a + b) {
    const double of_b = sum - a, of_a = sum - of_b;
    rest = (a - of_a) + (b - of_b);
  }
  double sum;
  double rest;
};

/// A sum of doubles without rounding: parts of ascending size whose bits do not overlap [Sh97, GROW-EXPANSION].
class ExactSum {
 public:
  void add(double value) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const TwoSum two(value, part_[i]);
      value = two.sum;
      if (two.rest != 0.0) {
        part_[kept++] = two.rest;
      }
    }
    if (value != 0.0) {
      part_[kept++] = value;
    }
    count_ = kept;
  }
  void add_product(double a, double b) {
    const double product = a * b;
    add(std::fma(a, b, -product));
    add(product);
  }
  void add_product(double a, double b, double c) {
    const double product = a * b;
    add_product(std::fma(a, b, -product), c);
    add_product(product, c);
  }
  /// The largest part is larger than all others together.
  [[nodiscard]] int sign() const { return count_ == 0 ? 0 : part_[count_ - 1] > 0.0 ? 1 : -1; }

 private:
  // 24 products of three doubles have four parts each.
  std::array<double, 96> part_;
  std::size_t count_{};
};

/// Adds dot(cross(a, b), c).
void add_volume(ExactSum& sum, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  sum.add_product(a.y, b.z, c.x);
  sum.add_product(-a.z, b.y, c.x);
  sum.add_product(a.z, b.x, c.y);
  sum.add_product(-a.x, b.z, c.y);
  sum.add_product(a.x, b.y, c.z);
  sum.add_product(-a.y, b.x, c.z);
}

int exact_orientation(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  ExactSum sum;
  add_volume(sum, b, c, d);
  add_volume(sum, c, b, a);
  add_volume(sum, a, b, d);
  add_volume(sum, a, d, c);
  return sum.sign();
}

/// Sign of (p1 - p0)(q1 - q0) - (r1 - r0)(s1 - s0).
int minor_sign(double p0, double p1, double q0, double q1, double r0, double r1, double s0, double s1) {
  const double left = (p1 - p0) * (q1 - q0), right = (r1 - r0) * (s1 - s0);
  const double value = left - right;
  constexpr double bound = 0x1p-50;  // Twice what [Sh97, section 4.2] shows to be enough
  if (std::abs(value) > bound * (std::abs(left) + std::abs(right))) {
    return value > 0.0 ? 1 : -1;
  }
  ExactSum sum;
  sum.add_product(p1, q1);
  sum.add_product(-p1, q0);
  sum.add_product(-p0, q1);
  sum.add_product(p0, q0);
  sum.add_product(-r1, s1);
  sum.add_product(r1, s0);
  sum.add_product(r0, s1);
  sum.add_product(-r0, s0);
  return sum.sign();
}

/// Sign of the first component of cross(p1 - p0, q1 - q0) that is not zero.
int first_sign_of_cross(const Vec3d& p0, const Vec3d& p1, const Vec3d& q0, const Vec3d& q1) {
  if (const int x = minor_sign(p0.y, p1.y, q0.z, q1.z, p0.z, p1.z, q0.y, q1.y); x != 0) {
    return x;
  }
  if (const int y = minor_sign(p0.z, p1.z, q0.x, q1.x, p0.x, p1.x, q0.z, q1.z); y != 0) {
    return y;
  }
  return minor_sign(p0.x, p1.x, q0.y, q1.y, p0.y, p1.y, q0.x, q1.x);
}

}  // namespace

int orientation(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  const Vec3d u = b - a, v = c - a, w = d - a;
  const double xy = u.x * v.y, yx = u.y * v.x, yz = u.y * v.z, zy = u.z * v.y, zx = u.z * v.x, xz = u.x * v.z;
  const double value = (yz - zy) * w.x + (zx - xz) * w.y + (xy - yx) * w.z;
  const double size = (std::abs(yz) + std::abs(zy)) * std::abs(w.x) + (std::abs(zx) + std::abs(xz)) * std::abs(w.y) +
                      (std::abs(xy) + std::abs(yx)) * std::abs(w.z);
  constexpr double bound = 0x1p-50;  // [Sh97, section 4.3]: (7 + 56 e) e with e = 2^-53 is enough
  if (std::abs(value) > bound * size) {
    return value > 0.0 ? 1 : -1;
  }
  // Where all products are nothing, as in a plane of constant z, so are those of the exact differences.
  return size == 0.0 ? 0 : exact_orientation(a, b, c, d);
}

int moved_orientation(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  const int sign = orientation(a, b, c, d);
  return sign != 0 ? sign : first_sign_of_cross(a, b, a, c);
}

int moved_passing(const Vec3d& p, const Vec3d& q, const Vec3d& a, const Vec3d& b) {
  // The volume is linear in a common motion of p and q, with the gradient cross(q - p, b - a).
  const int sign = orientation(p, q, a, b);
  return sign != 0 ? sign : first_sign_of_cross(p, q, a, b);
}

}  // namespace fexp
