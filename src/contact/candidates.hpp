// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "contact/kd_tree.hpp"
#include "contact/surface.hpp"

namespace fexp::contact {

/// Pairs of nodes and elements that may come within watch distance while no two nodes of the island have moved by more
/// than the skin relative to each other: compressed rows over nodes, everything ascending.
struct Candidates {
  std::vector<Index> node;     // [rows]
  std::vector<Index> start;    // [rows + 1]
  std::vector<Index> element;  // [candidates]
  /// Relative motion below which no pair of the row comes within watch distance [length], shape [rows].
  std::vector<double> slack;
};

/// Finds candidates with a kd-tree over the nodes, asked by the boxes of the elements in parallel. What is found does
/// not depend on the tree: pairs are taken by their exact distance and sorted.
class CandidateSearch {
 public:
  /// Takes up the bodies to search among, ascending, barriers included.
  void assign(const model::Model& model, std::span<const Index> bodies);

  /// `remembered`: nodes (ascending, repeats allowed) that get a row in any case.
  void search(const model::Model& model, const Positions& x, double skin, std::span<const Index> remembered,
              Candidates& found);

  [[nodiscard]] Index node_count() const noexcept { return static_cast<Index>(nodes_.size()); }
  [[nodiscard]] std::span<const Index> nodes() const noexcept { return nodes_; }

 private:
  struct Pair {
    Index local;  ///< Into nodes_
    Index element;
    double slack;
  };

  void take_points(const model::Model& model, double skin);
  void query(const model::Model& model, const Positions& x, double skin);
  void fill_rows(std::span<const Index> remembered, Candidates& found);

  std::vector<Index> nodes_;     // Of all bodies, ascending
  std::vector<Index> elements_;  // Of all bodies, ascending
  std::vector<Vec3d> points_;    // [nodes_]
  std::vector<double> reach_;    // [nodes_]: half thickness and watch margin [length]
  std::vector<Index> row_size_;  // [nodes_]
  bool barriers_{};              // Some of the bodies are
  Box free_;                     // What the nodes of the other bodies reach
  std::vector<Index> near_;      // Into nodes_: those in the tree, where some are barriers'; else empty
  std::vector<Vec3d> near_points_;
  std::vector<double> near_reach_;
  KdTree tree_;
  std::vector<std::vector<Pair>> pairs_;  // By piece of elements_
};

}  // namespace fexp::contact
