// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "quality/edge_cuts.hpp"
#include "quality/node_passages.hpp"
#include "quality/surfaces.hpp"

namespace fexp::quality {

/// What crosses in a frame.
struct FrameCrossings {
  std::vector<EdgeCut> cuts;         ///< Ascending
  std::vector<EdgeCut> new_cuts;     ///< Those that are not there in the first frame
  std::vector<NodePassage> through;  ///< Nodes behind what they have passed, ascending by node and body
};

/// Follows surfaces from frame to frame. A node is on the wrong side of another body when its passages through that
/// body's surface since the first frame in which no edge of the two cuts the other one do not cancel: what is through
/// at the start may come out.
class CrossingWatch {
 public:
  explicit CrossingWatch(const Surfaces& surfaces) : surfaces_(surfaces) {}

  /// Looks at the next frame. `alive` has shape [triangles]: 0 where an element has failed.
  [[nodiscard]] FrameCrossings look(std::span<const Vec3d> position, std::span<const char> alive);

 private:
  using BodyPair = std::pair<Index, Index>;
  [[nodiscard]] std::set<BodyPair> body_pairs(const std::vector<EdgeCut>& cuts) const;
  void count(std::span<const Vec3d> position, std::span<const char> alive);
  [[nodiscard]] std::vector<NodePassage> nodes_through(std::span<const char> alive) const;

  const Surfaces& surfaces_;
  std::vector<Vec3d> last_;  // Positions, empty before the first frame
  std::vector<EdgeCut> first_cuts_;
  std::set<BodyPair> never_free_;               // Bodies that have cut each other in all frames so far
  std::map<std::pair<Index, Index>, int> sum_;  // Of passages, by node and body
};

}  // namespace fexp::quality
