// SPDX-License-Identifier: Apache-2.0
#include "io/node_welding.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

namespace fexp::io {

namespace {

/// Nodes by grid cell: a hash table of chains. A chain may hold nodes of several cells, which the distance sorts out.
class NodeGrid {
 public:
  NodeGrid(const Box& box, double tolerance, std::size_t points)
      : low_(box.low), tolerance_(tolerance), head_(std::bit_ceil(points + 1), no_index) {
    const double diagonal = norm(box.high - box.low);
    // Much larger than the tolerance, so that most points look into one cell only; bounded below so that cell numbers
    // stay small whatever the tolerance is.
    cell_size_ = std::max(16.0 * tolerance, 1.0e-9 * diagonal);
    if (!(cell_size_ > 0.0)) {
      cell_size_ = 1.0;
    }
  }

  Index find_or_add(const Vec3d& p, std::vector<Vec3d>& nodes) {
    const std::array<std::int64_t, 3> low = cell(p, -tolerance_), high = cell(p, tolerance_);
    Index found = no_index;
    for (std::int64_t i = low[0]; i <= high[0]; ++i) {
      for (std::int64_t j = low[1]; j <= high[1]; ++j) {
        for (std::int64_t k = low[2]; k <= high[2]; ++k) {
          found = first(found, find(p, bucket({i, j, k}), nodes));
        }
      }
    }
    if (found == no_index) {
      found = static_cast<Index>(nodes.size());
      nodes.push_back(p);
      Index& head = head_[bucket(cell(p, 0.0))];
      next_.push_back(head);
      head = found;
    }
    return found;
  }

 private:
  static Index first(Index a, Index b) noexcept { return a == no_index || (b != no_index && b < a) ? b : a; }

  /// Lowest node of the chain within the tolerance.
  [[nodiscard]] Index find(const Vec3d& p, std::size_t bucket, const std::vector<Vec3d>& nodes) const {
    Index found = no_index;
    for (Index n = head_[bucket]; n != no_index; n = next_[at(n)]) {
      const Vec3d d = nodes[at(n)] - p;
      if (dot(d, d) <= tolerance_ * tolerance_) {
        found = n;  // chains descend, so the last one found is the lowest
      }
    }
    return found;
  }
  [[nodiscard]] std::array<std::int64_t, 3> cell(const Vec3d& p, double shift) const {
    const auto number = [&](double x, double low) {
      const double cells = (x + shift - low) / cell_size_;
      const auto whole = static_cast<std::int64_t>(cells);  // rounds towards zero
      return static_cast<double>(whole) > cells ? whole - 1 : whole;
    };
    return {number(p.x, low_.x), number(p.y, low_.y), number(p.z, low_.z)};
  }
  [[nodiscard]] std::size_t bucket(const std::array<std::int64_t, 3>& c) const noexcept {
    std::uint64_t h = 0;
    for (const std::int64_t i : c) {
      h = (h ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15U;
      h ^= h >> 29U;
    }
    return static_cast<std::size_t>(h) & (head_.size() - 1);
  }

  Vec3d low_;
  double tolerance_;
  double cell_size_{};
  std::vector<Index> head_;
  std::vector<Index> next_;
};

}  // namespace

WeldedNodes weld_nodes(const std::vector<Vec3d>& points, double tolerance) {
  WeldedNodes welded;
  if (points.empty()) {
    return welded;
  }
  Box box;
  for (const Vec3d& p : points) {
    box.include(p);
  }
  if (tolerance < 0.0) {
    tolerance = 1.0e-6 * norm(box.high - box.low);
  }
  // No two points are farther apart than the diagonal, and a bounded tolerance keeps cell numbers small.
  tolerance = std::min(tolerance, 2.0 * norm(box.high - box.low));
  NodeGrid grid(box, tolerance, points.size());
  welded.node.reserve(points.size());
  for (const Vec3d& p : points) {
    welded.node.push_back(grid.find_or_add(p, welded.position));
  }
  return welded;
}

}  // namespace fexp::io
