// SPDX-License-Identifier: Apache-2.0
#include "contact/near_edges.hpp"

#include <cmath>
#include <vector>

#include "base/processor.hpp"
#include "contact/kernels/near_edge_kernel.hpp"

namespace fexp::contact {

void make_ready(std::span<const NearEdge> edges, BlockEdges& block) noexcept {
  block.count = static_cast<Index>(edges.size());
  block.box = {};
  const auto set = [&](Index row, std::size_t lane, const Vec3d& v) {
    block.rows[at(row)][lane] = v.x;
    block.rows[at(row) + 1][lane] = v.y;
    block.rows[at(row) + 2][lane] = v.z;
  };
  for (std::size_t lane = 0; lane < edges.size(); ++lane) {
    const NearEdge& edge = edges[lane];
    const Vec3d along = edge.end - edge.begin;
    const double along2 = dot(along, along);
    const Box box = edge.box();
    set(edge_row_begin, lane, edge.begin);
    set(edge_row_along, lane, along);
    set(edge_row_low, lane, box.low);
    set(edge_row_high, lane, box.high);
    block.rows[at(edge_row_inverse2)][lane] = along2 > 0.0 ? 1.0 / along2 : 0.0;
    block.rows[at(edge_row_reach)][lane] = edge.reach;
    block.rows[at(edge_row_node)][lane] = static_cast<double>(edge.node[0]);
    block.rows[at(edge_row_node) + 1][lane] = static_cast<double>(edge.node[1]);
    block.rows[at(edge_row_number)][lane] = static_cast<double>(edge.number);
    block.box.include(box);
  }
  for (std::size_t lane = edges.size(); lane < at(most_edges); ++lane) {
    for (auto& row : block.rows) {
      row[lane] = 0.0;
    }
    set(edge_row_low, lane, {HUGE_VAL, HUGE_VAL, HUGE_VAL});
    set(edge_row_high, lane, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL});
  }
}

std::span<const NearEdgeKernel> near_edge_kernels() {
  static const std::vector<NearEdgeKernel> kernels = [] {
    std::vector<NearEdgeKernel> made{kernels::near_edges_baseline()};
#if defined(__x86_64__)
    if (has_avx2()) {
      made.push_back(kernels::near_edges_avx2());
    }
    if (has_avx512()) {
      made.push_back(kernels::near_edges_avx512());
    }
#endif
    return made;
  }();
  return kernels;
}

}  // namespace fexp::contact
