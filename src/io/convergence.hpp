// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

/// How fast results on refined meshes converge.
namespace fexp::io {

struct MeshResult {
  double factor{};  ///< Cells per length, in any unit
  double result{};
};

/// p of |result - reference| ~ factor^-p through two meshes. None where a result meets the reference.
[[nodiscard]] std::optional<double> order_towards(double reference, const MeshResult& coarse, const MeshResult& fine);

/// Whether three meshes of these cells per length are refined by one ratio, without which no order follows from them.
[[nodiscard]] bool refined_evenly(double coarse, double middle, double fine) noexcept;

/// The order, and what the results converge to.
struct Extrapolation {
  double order{};
  double limit{};
};

/// Richardson's extrapolation [L. F. Richardson, Phil. Trans. R. Soc. A 210 (1911) 307-357; order from three meshes:
/// P. J. Roache, J. Fluids Eng. 116 (1994) 405-413]: results = limit + c factor^-order through three meshes, coarse to
/// fine. None where these are not refined evenly, or the results do not approach a limit.
[[nodiscard]] std::optional<Extrapolation> extrapolate(const std::array<MeshResult, 3>& meshes);

}  // namespace fexp::io
