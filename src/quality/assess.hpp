// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "model/mesh.hpp"
#include "model/model.hpp"
#include "quality/finding.hpp"

namespace fexp::quality {

/// Everything below, warnings first. `meshes` are those the model was built from, one for each described body. Copies
/// of an array are alike, so what concerns one body alone is looked for in the first copy.
[[nodiscard]] std::vector<Finding> assess(const model::Model& model, std::span<const model::Mesh> meshes);

/// Normals that disagreed with their neighbours' in the mesh ("turned_normals"). The model's do not.
[[nodiscard]] std::vector<Finding> turned_normals(const model::Model& model, std::span<const model::Mesh> meshes);

/// Bodies of several pieces ("pieces"), and pieces that nothing holds, loads or sets in motion: a warning when nothing
/// can hit them either ("idle"), else a note ("waiting").
[[nodiscard]] std::vector<Finding> loose_pieces(const model::Model& model);

/// How many free edges a body has ("free_edges", a note), and free edges that lie on each other without a node in
/// common, as along a seam that was not welded ("open_seam").
[[nodiscard]] std::vector<Finding> free_edges(const model::Model& model);

/// Nodes of different elements in one place, or nearly: of one body ("duplicate_nodes"), or of two, which are not
/// joined by that ("unjoined_bodies").
[[nodiscard]] std::vector<Finding> near_nodes(const model::Model& model);

/// Elements that lie on each other, nearly parallel and closer than half the sum of their thicknesses
/// ("overlapping_shells"). A note where contact would not act between them anyway.
[[nodiscard]] std::vector<Finding> overlapping_shells(const model::Model& model);

/// Mass that mass scaling gave the parts of bodies ("added_mass"): a warning where it is more than 5 % of the part's.
[[nodiscard]] std::vector<Finding> added_mass(const model::Model& model);

/// Nodes that a tie was to hold and that are too far from its surface ("far_tied_nodes").
[[nodiscard]] std::vector<Finding> far_tied_nodes(const model::Model& model);

/// A few elements whose critical step is so far below that of the others that it costs half again as many steps
/// ("slivers").
[[nodiscard]] std::vector<Finding> slivers(const model::Model& model);

}  // namespace fexp::quality
