// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "model/topology.hpp"
#include "quality/assess.hpp"
#include "quality/first_copies.hpp"

namespace fexp::quality {

namespace {

/// Elements of each connected piece of a surface, by edges; pieces in the order of their first element.
std::vector<std::vector<Index>> pieces_by_edges(const std::vector<model::Triangle>& neighbour) {
  std::vector<std::vector<Index>> pieces;
  std::vector<char> seen(neighbour.size(), 0);
  for (std::size_t seed = 0; seed < neighbour.size(); ++seed) {
    if (seen[seed] != 0) {
      continue;
    }
    std::vector<Index>& piece = pieces.emplace_back(1, static_cast<Index>(seed));
    seen[seed] = 1;
    for (std::size_t next = 0; next < piece.size(); ++next) {
      for (const Index other : neighbour[at(piece[next])]) {
        if (other != no_index && seen[at(other)] == 0) {
          seen[at(other)] = 1;
          piece.push_back(other);
        }
      }
    }
  }
  return pieces;
}

/// The odd ones: of each piece those that point to the side that fewer do.
std::vector<Index> odd_ones(const std::vector<std::vector<Index>>& pieces, const std::vector<char>& turned,
                            bool& first_is_odd) {
  std::vector<Index> odd;
  for (const std::vector<Index>& piece : pieces) {
    std::size_t count = 0;
    for (const Index t : piece) {
      count += static_cast<std::size_t>(turned[at(t)]);
    }
    const bool most_turned = 2 * count > piece.size();
    first_is_odd = first_is_odd || most_turned;
    for (const Index t : piece) {
      if ((turned[at(t)] != 0) != most_turned) {
        odd.push_back(t);
      }
    }
  }
  std::sort(odd.begin(), odd.end());
  return odd;
}

}  // namespace

std::vector<Finding> turned_normals(const model::Model& model, std::span<const model::Mesh> meshes) {
  std::vector<Finding> findings;
  for (const Index b : first_copies(model)) {
    const model::Body& body = model.bodies[at(b)];
    const model::Mesh& mesh = meshes[at(body.description)];
    std::vector<model::Triangle> triangle = mesh.triangle, neighbour = model::edge_neighbours(triangle);
    model::orient_consistently(triangle, neighbour);
    std::vector<char> turned(triangle.size(), 0);
    bool any = false;
    for (std::size_t t = 0; t < triangle.size(); ++t) {
      turned[t] = static_cast<char>(triangle[t] != mesh.triangle[t]);
      any = any || turned[t] != 0;
    }
    if (!any) {
      continue;
    }
    bool first_is_odd = false;
    Finding finding;
    finding.kind = "turned_normals";
    finding.body = body.family;
    finding.item = "element";
    for (const Index t : odd_ones(pieces_by_edges(neighbour), turned, first_is_odd)) {
      add_item(finding, mesh.triangle_label.empty() ? t : mesh.triangle_label[at(t)]);
    }
    finding.message = fmt::format("the normals of {} elements point against those of their neighbours", finding.count);
    finding.cure =
        first_is_odd
            ? "they were made to agree, but the first element of a piece decides and is an odd one here, so that all "
              "others were turned: turn the odd ones in the mesh, or set flip_normals, where a pressure acts"
            : "they were turned to agree with the first element of their piece; check the side that a pressure acts on";
    findings.push_back(std::move(finding));
  }
  return findings;
}

}  // namespace fexp::quality
