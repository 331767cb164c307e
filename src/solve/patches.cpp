// SPDX-License-Identifier: Apache-2.0
#include "solve/patches.hpp"

#include "model/patch_cut.hpp"

namespace fexp::solve {

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
  const auto patch_at = [&](Index corner) { return patch_of[at(model.element_block[at(corner / 3)])]; };

  std::vector<std::vector<Index>> inner(patches.size());
  std::vector<std::vector<SharedCorner>> shared(patches.size());
  border_start.push_back(0);
  for (const model::Body& body : model.bodies) {
    const auto first = static_cast<Index>(border_node.size());
    for (Index n = body.nodes.begin; n < body.nodes.end; ++n) {
      const IndexRange corners{model.corner_start[at(n)], model.corner_start[at(n) + 1]};
      const Index patch = patch_at(model.corner[at(corners.begin)]);
      bool in_one = true;
      for (Index c = corners.begin; c < corners.end; ++c) {
        in_one = in_one && patch_at(model.corner[at(c)]) == patch;
      }
      if (in_one) {
        inner[at(patch)].push_back(n);
        continue;
      }
      Index place = border_start.back();
      for (Index c = corners.begin; c < corners.end; ++c) {
        const Index corner = model.corner[at(c)];
        shared[at(patch_at(corner))].push_back({corner, place++});
      }
      border_node.push_back(n);
      border_start.push_back(place);
    }
    body_border.push_back({first, static_cast<Index>(border_node.size())});
  }
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const auto append = [](auto& all, const auto& part) {
      const auto begin = static_cast<Index>(all.size());
      all.insert(all.end(), part.begin(), part.end());
      return IndexRange{begin, static_cast<Index>(all.size())};
    };
    patches[p].nodes = append(inner_node, inner[p]);
    patches[p].shared = append(shared_corner, shared[p]);
  }
}

}  // namespace fexp::solve
