// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <utility>

#include "physics/closest_lines.hpp"

namespace fexp::physics {

/// Most triangles at an edge.
inline constexpr std::size_t most_at_edge = 8;

/// Two edges a0 a1 and b0 b1, and the third corners of the triangles at each of them.
struct CrossingEdges {
  std::array<Vec3d, 4> end;                               ///< a0, a1, b0, b1
  std::array<std::array<Vec3d, most_at_edge>, 2> corner;  ///< Of the triangles at edge a, at edge b
  std::array<int, 2> triangles{};                         ///< 1 at a free edge, 2, or more where surfaces branch
};

/// How far two surfaces are closest where their edges cross, 0 to 1, and its gradient.
struct Sharpness {
  double part{1.0};
  std::array<Vec3d, 4> end{};         ///< By the ends [1/length]
  std::array<int, 2> corner{-1, -1};  ///< By which corners it changes: most_at_edge x edge + triangle; -1: by none
  std::array<Vec3d, 2> by_corner{};   ///< [1/length]
};

/// Squared sines between which a crossing fades as the edges come to be parallel.
inline constexpr double parallel_sine2 = 0.0025;
inline constexpr double crossing_sine2 = 0.01;
/// Sines of angles between triangles and the plane across the common normal. A crossing fades out over fading_sine
/// where a triangle leads towards the other edge, and where the two triangles of a fold fall away from it by less than
/// that in the mean; below flat_sine a fold counts as flat.
inline constexpr double fading_sine = 0.3;
inline constexpr double flat_sine = 0.01;

namespace detail {

/// A triangle at edge 0 or 1. With the unit normal n towards the other edge and the direction m in the triangle's plane
/// that leads away from its edge, its sine is -n.m: positive where it falls away from the other edge.
class Fall {
 public:
  Fall(const CrossingEdges& edges, std::size_t edge, std::size_t triangle, const ClosestOnLines& lines,
       int side) noexcept
      : edge_(edge), triangle_(triangle), along_{edges.end[1] - edges.end[0], edges.end[3] - edges.end[2]} {
    scale_ = (edge == 0 ? side : -side) / norm(lines.normal);
    normal_ = scale_ * lines.normal;
    const Vec3d from = edges.corner[edge][triangle] - edges.end[2 * edge];
    position_ = dot(from, along_[edge]) / dot(along_[edge], along_[edge]);
    const Vec3d inward = from - position_ * along_[edge];
    height_ = norm(inward);
    inward_ = (1.0 / height_) * inward;
    sine_ = -dot(normal_, inward_);
  }

  [[nodiscard]] double sine() const noexcept { return sine_; }

  /// Adds `factor` times the gradient of the sine. -d(n.m) = -m.dn - n.dm, with dn across n and dm across m.
  void add_gradient(double factor, std::size_t place, Sharpness& sharpness) const noexcept {
    const Vec3d turn = (factor * scale_) * (inward_ + sine_ * normal_);
    const Vec3d lean = (factor / height_) * (normal_ + sine_ * inward_);
    std::array<Vec3d, 2> by_along{-cross(along_[1], turn), -cross(turn, along_[0])};
    by_along[edge_] += position_ * lean;
    sharpness.end[0] -= by_along[0];
    sharpness.end[1] += by_along[0];
    sharpness.end[2] -= by_along[1];
    sharpness.end[3] += by_along[1];
    sharpness.end[2 * edge_] += lean;
    sharpness.corner[place] = static_cast<int>(most_at_edge * edge_ + triangle_);
    sharpness.by_corner[place] = -lean;
  }

 private:
  std::size_t edge_;
  std::size_t triangle_;
  std::array<Vec3d, 2> along_;
  double scale_{};
  Vec3d normal_;
  double position_{};
  double height_{};
  Vec3d inward_;
  double sine_{};
};

/// A factor that rises from 0 to 1, and its slope.
struct Ramp {
  explicit Ramp(double value) noexcept : part(value < 0.0 ? 0.0 : value > 1.0 ? 1.0 : value) {
    slope = value > 0.0 && value < 1.0 ? 1.0 / fading_sine : 0.0;
  }
  double part;
  double slope{};
};

/// Lowers the sharpness to what the triangles at one of the edges leave: of a fold the two that fall away least.
inline void lower_by_edge(const CrossingEdges& edges, std::size_t edge, const ClosestOnLines& lines, int side,
                          Sharpness& sharpness) noexcept {
  Fall least(edges, edge, 0, lines, side);
  if (edges.triangles[edge] == 1) {
    const Ramp away(1.0 + least.sine() / fading_sine);
    if (away.part < sharpness.part) {
      sharpness = {};
      sharpness.part = away.part;
      least.add_gradient(away.slope, 0, sharpness);
    }
    return;
  }
  Fall next(edges, edge, 1, lines, side);
  if (next.sine() < least.sine()) {
    std::swap(least, next);
  }
  for (std::size_t t = 2; t < static_cast<std::size_t>(edges.triangles[edge]); ++t) {
    const Fall fall(edges, edge, t, lines, side);
    if (fall.sine() < least.sine()) {
      next = least;
      least = fall;
    } else if (fall.sine() < next.sine()) {
      next = fall;
    }
  }
  const Ramp away(1.0 + least.sine() / fading_sine);
  const Ramp folded((0.5 * (least.sine() + next.sine()) - flat_sine) / fading_sine);
  const double part = away.part * folded.part;
  if (part < sharpness.part) {
    sharpness = {};
    sharpness.part = part;
    const double by_mean = 0.5 * away.part * folded.slope;
    least.add_gradient(by_mean + away.slope * folded.part, 0, sharpness);
    next.add_gradient(by_mean, 1, sharpness);
  }
}

}  // namespace detail

/// The surfaces are closest at the crossing, with the second edge on side +1 or -1 of the first one along the common
/// normal, where no triangle at an edge leads towards the other edge. Where one comes to lie across the normal, the
/// other edge touches all of it, and this pair shares the contact with that of the edge across it; so the crossing
/// fades only behind that. It fades, too, as a fold comes to be flat, and where the edges come to be parallel.
[[nodiscard]] inline Sharpness sharpness_of(const CrossingEdges& edges, const ClosestOnLines& lines,
                                            int side) noexcept {
  Sharpness sharpness;
  const double part = (lines.sine2 - parallel_sine2) / (crossing_sine2 - parallel_sine2);
  if (part < 1.0) {
    const Vec3d a = edges.end[1] - edges.end[0], b = edges.end[3] - edges.end[2];
    const double a2 = dot(a, a), b2 = dot(b, b), scale = 2.0 / (crossing_sine2 - parallel_sine2);
    const Vec3d by_a = (scale / (a2 * b2)) * cross(b, lines.normal) - (scale * lines.sine2 / a2) * a;
    const Vec3d by_b = (scale / (a2 * b2)) * cross(lines.normal, a) - (scale * lines.sine2 / b2) * b;
    sharpness.part = part > 0.0 ? part : 0.0;
    sharpness.end = {-by_a, by_a, -by_b, by_b};
  }
  detail::lower_by_edge(edges, 0, lines, side, sharpness);
  detail::lower_by_edge(edges, 1, lines, side, sharpness);
  return sharpness;
}

}  // namespace fexp::physics
