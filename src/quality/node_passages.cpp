// SPDX-License-Identifier: Apache-2.0
#include "quality/node_passages.hpp"

#include <algorithm>

#include "base/orientation.hpp"
#include "contact/box_tree.hpp"
#include "parallel/parallel.hpp"

namespace fexp::quality {

namespace {

constexpr Index nodes_in_a_piece = 1024;

using Corners = std::array<Vec3d, 3>;

/// A node goes from p to q through a triangle that is held.
int passage_of_node(const Vec3d& p, const Vec3d& q, const Corners& t) {
  if (p == q) {
    return 0;
  }
  const int side = moved_orientation(t[0], t[1], t[2], q);
  if (side * moved_orientation(t[0], t[1], t[2], p) != -1) {
    return 0;
  }
  const int past = moved_passing(p, q, t[0], t[1]);
  return past == moved_passing(p, q, t[1], t[2]) && past == moved_passing(p, q, t[2], t[0]) ? side : 0;
}

/// Corner i of a triangle goes to another place, past a node at x that is held: the triangle sweeps a tetrahedron.
int passage_of_corner(const Corners& t, std::size_t i, const Vec3d& to, const Vec3d& x) {
  const Vec3d &a = t[i], &b = t[(i + 1) % 3], &c = t[(i + 2) % 3];
  if (a == to) {
    return 0;
  }
  const int forward = orientation(a, b, c, to), side = moved_orientation(to, b, c, x);
  const bool inside = forward != 0 && side == -forward && moved_orientation(a, b, c, x) == forward &&
                      moved_orientation(a, to, b, x) == forward && moved_orientation(a, to, c, x) == -forward;
  return inside ? side : 0;
}

/// What two frames have of all bodies.
class Motion {
 public:
  Motion(const Surfaces& surfaces, std::span<const Vec3d> before, std::span<const Vec3d> after,
         std::span<const char> alive)
      : surfaces_(surfaces), before_(before), after_(after), alive_(alive), swept_(at(surfaces.bodies())) {
    for (Index n = 0; n < surfaces.nodes(); ++n) {
      include(swept_[at(surfaces.node_body[at(n)])], n);
    }
  }

  /// Passages of nodes of bodies that may have come through this one.
  [[nodiscard]] std::vector<NodePassage> through(Index body, const contact::BoxTree& bodies) const {
    std::vector<Index> others;
    bodies.query(swept_[at(body)], [&](Index other) {
      if (other != body) {
        others.push_back(other);
      }
    });
    if (others.empty()) {
      return {};
    }
    const contact::BoxTree triangles = triangles_of(body);
    std::vector<NodePassage> passages;
    for (const Index other : others) {
      const std::vector<NodePassage> found = through(body, triangles, surfaces_.body_nodes[at(other)]);
      passages.insert(passages.end(), found.begin(), found.end());
    }
    std::sort(passages.begin(), passages.end(),
              [](const NodePassage& a, const NodePassage& b) { return a.node < b.node; });
    return passages;
  }

  [[nodiscard]] const std::vector<Box>& swept_boxes() const { return swept_; }

 private:
  void include(Box& box, Index node) const {
    box.include(before_[at(node)]);
    box.include(after_[at(node)]);
  }

  /// The tree's items are places in the body's list of triangles.
  [[nodiscard]] contact::BoxTree triangles_of(Index body) const {
    const std::vector<Index>& list = surfaces_.body_triangles[at(body)];
    std::vector<Box> boxes(list.size());
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (alive_[at(list[i])] != 0) {
        for (const Index n : surfaces_.triangle[at(list[i])]) {
          include(boxes[i], n);
        }
      }
    }
    contact::BoxTree tree;
    tree.build(boxes);
    return tree;
  }

  [[nodiscard]] MovingTriangle moving(Index triangle) const {
    MovingTriangle moving;
    moving.node = surfaces_.triangle[at(triangle)];
    for (std::size_t i = 0; i < 3; ++i) {
      moving.before[i] = before_[at(moving.node[i])];
      moving.after[i] = after_[at(moving.node[i])];
    }
    return moving;
  }

  [[nodiscard]] std::vector<NodePassage> through(Index body, const contact::BoxTree& triangles,
                                                 const std::vector<Index>& nodes) const {
    const std::vector<Index>& list = surfaces_.body_triangles[at(body)];
    const auto passages_of_nodes = [&](Index begin, Index end) {
      std::vector<NodePassage> passages;
      for (Index i = begin; i < end; ++i) {
        const Index node = nodes[at(i)];
        Box box;
        include(box, node);
        int sum = 0;
        triangles.query(box, [&](Index place) {
          sum += sum_of_passages(before_[at(node)], after_[at(node)], moving(list[at(place)]));
        });
        if (sum != 0) {
          passages.push_back({node, body, sum});
        }
      }
      return passages;
    };
    const auto append = [](std::vector<NodePassage> all, const std::vector<NodePassage>& more) {
      all.insert(all.end(), more.begin(), more.end());
      return all;
    };
    return parallel::ordered_fold({0, static_cast<Index>(nodes.size())}, nodes_in_a_piece, std::vector<NodePassage>{},
                                  passages_of_nodes, append);
  }

  const Surfaces& surfaces_;
  std::span<const Vec3d> before_, after_;
  std::span<const char> alive_;
  std::vector<Box> swept_;  // By bodies
};

}  // namespace

int sum_of_passages(const Vec3d& from, const Vec3d& to, const MovingTriangle& triangle) {
  Corners present = triangle.before;
  int sum = passage_of_node(from, to, present);
  std::array<std::size_t, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return triangle.node[i] < triangle.node[j]; });
  for (const std::size_t i : order) {
    sum += passage_of_corner(present, i, triangle.after[i], to);
    present[i] = triangle.after[i];
  }
  return sum;
}

std::vector<NodePassage> find_node_passages(const Surfaces& surfaces, std::span<const Vec3d> before,
                                            std::span<const Vec3d> after, std::span<const char> alive) {
  const Motion motion(surfaces, before, after, alive);
  contact::BoxTree bodies;
  bodies.build(motion.swept_boxes());
  std::vector<std::vector<NodePassage>> through(at(surfaces.bodies()));
  parallel::for_each(surfaces.bodies(), 1, [&](Index body) { through[at(body)] = motion.through(body, bodies); });
  std::vector<NodePassage> all;
  for (const std::vector<NodePassage>& passages : through) {
    all.insert(all.end(), passages.begin(), passages.end());
  }
  return all;
}

}  // namespace fexp::quality
