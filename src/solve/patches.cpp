// SPDX-License-Identifier: Apache-2.0
#include "solve/patches.hpp"

#include "model/patch_cut.hpp"

namespace fexp::solve {

using model::block_lanes;

Patches::Patches(const model::Model& model) {
  std::vector<Index> patch_of(model.blocks.size());
  for (Index b = 0; b < model.body_count(); ++b) {
    const IndexRange blocks = model.bodies[at(b)].blocks;
    const Index count = model::patch_count(blocks.size());
    const auto first = static_cast<Index>(patches.size());
    for (Index p = 0; p < count; ++p) {
      Patch patch;
      patch.body = b;
      patch.blocks = {blocks.begin + model::patch_begin(blocks.size(), count, p),
                      blocks.begin + model::patch_begin(blocks.size(), count, p + 1)};
      const model::ElementBlock& last = model.blocks[at(patch.blocks.end - 1)];
      patch.elements = {model.blocks[at(patch.blocks.begin)].first, last.first + last.count};
      for (Index block = patch.blocks.begin; block < patch.blocks.end; ++block) {
        patch_of[at(block)] = static_cast<Index>(patches.size());
      }
      patches.push_back(patch);
    }
    body_patches.push_back({first, static_cast<Index>(patches.size())});
  }
  const auto patch_at = [&](Index element) { return patch_of[at(model.element_block[at(element)])]; };

  std::vector<std::vector<Index>> inner(patches.size()), border(patches.size()), places(patches.size());
  border_start.push_back(0);
  std::vector<Index> owners;  // Patches of a node, in order
  for (const model::Body& body : model.bodies) {
    const auto first = static_cast<Index>(border_node.size());
    for (Index n = body.nodes.begin; n < body.nodes.end; ++n) {
      owners.clear();
      for (Index c = model.corner_start[at(n)]; c < model.corner_start[at(n) + 1]; ++c) {
        // Corners ascend, and so do their patches.
        const Index patch = patch_at(model.corner[at(c)] / 3);
        if (owners.empty() || owners.back() != patch) {
          owners.push_back(patch);
        }
      }
      if (owners.size() == 1) {
        inner[at(owners[0])].push_back(n);
        continue;
      }
      Index place = border_start.back();
      for (const Index patch : owners) {
        border[at(patch)].push_back(n);
        places[at(patch)].push_back(place++);
      }
      border_node.push_back(n);
      border_start.push_back(place);
    }
    body_border.push_back({first, static_cast<Index>(border_node.size())});
  }

  corner.resize(model.blocks.size() * at(block_lanes) * 3);
  std::vector<std::uint16_t> force_of(at(model.node_count()));
  for (std::size_t p = 0; p < patches.size(); ++p) {
    Patch& patch = patches[p];
    const auto append = [](auto& all, const auto& part) {
      const auto begin = static_cast<Index>(all.size());
      all.insert(all.end(), part.begin(), part.end());
      return IndexRange{begin, static_cast<Index>(all.size())};
    };
    patch.nodes = append(inner_node, inner[p]);
    patch.border = append(border_place, places[p]);
    std::uint16_t next = 0;
    for (const auto* const nodes : {&inner[p], &border[p]}) {
      for (const Index n : *nodes) {
        force_of[at(n)] = next++;
      }
    }
    for (Index block = patch.blocks.begin; block < patch.blocks.end; ++block) {
      const model::ElementBlock& elements = model.blocks[at(block)];
      for (Index lane = 0; lane < block_lanes; ++lane) {
        for (std::size_t c = 0; c < 3; ++c) {
          corner[3 * (at(block) * at(block_lanes) + at(lane)) + c] =
              lane < elements.count ? force_of[at(model.triangle[at(elements.first + lane)][c])] : next;
        }
      }
    }
  }
}

}  // namespace fexp::solve
