// SPDX-License-Identifier: Apache-2.0
#include "model/principal_axes.hpp"

#include <cmath>
#include <utility>

namespace fexp::model {

namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

/// Jacobi's rotation in the plane of axes p and q, which makes a[p][q] zero; the columns of `vectors` turn along.
void rotate(Matrix& a, Matrix& vectors, std::size_t p, std::size_t q) noexcept {
  if (a[p][q] == 0.0) {
    return;
  }
  const double theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
  const double root = std::abs(theta) + std::sqrt(theta * theta + 1.0);
  const double t = theta < 0.0 ? -1.0 / root : 1.0 / root;
  const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
  const std::size_t r = 3 - p - q;
  const double pq = a[p][q], pr = a[p][r], qr = a[q][r];
  a[p][p] -= t * pq;
  a[q][q] += t * pq;
  a[p][q] = a[q][p] = 0.0;
  a[p][r] = a[r][p] = c * pr - s * qr;
  a[q][r] = a[r][q] = s * pr + c * qr;
  for (auto& row : vectors) {
    const double vp = row[p], vq = row[q];
    row[p] = c * vp - s * vq;
    row[q] = s * vp + c * vq;
  }
}

}  // namespace

PrincipalAxes principal_axes(const std::array<double, 6>& matrix) noexcept {
  constexpr int sweeps = 12;  // The off-diagonal falls quadratically; six are enough.
  const auto& [xx, yy, zz, xy, yz, zx] = matrix;
  Matrix a{{{xx, xy, zx}, {xy, yy, yz}, {zx, yz, zz}}};
  Matrix vectors{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
  for (int i = 0; i < sweeps; ++i) {
    rotate(a, vectors, 0, 1);
    rotate(a, vectors, 1, 2);
    rotate(a, vectors, 0, 2);
  }
  std::array<std::size_t, 3> order{0, 1, 2};
  const auto sort = [&](std::size_t i, std::size_t j) {
    if (a[order[j]][order[j]] < a[order[i]][order[i]]) {
      std::swap(order[i], order[j]);
    }
  };
  sort(0, 1);
  sort(1, 2);
  sort(0, 1);
  PrincipalAxes found;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t column = order[i];
    found.value[i] = a[column][column];
    found.axis[i] = {vectors[0][column], vectors[1][column], vectors[2][column]};
  }
  found.axis[2] = cross(found.axis[0], found.axis[1]);
  return found;
}

}  // namespace fexp::model
