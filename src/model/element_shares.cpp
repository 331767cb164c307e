// SPDX-License-Identifier: Apache-2.0
#include "model/element_shares.hpp"

#include <algorithm>

#include "base/pack.hpp"
#include "parallel/parallel.hpp"
#include "physics/critical_step.hpp"

namespace fexp::model {

namespace {

constexpr Index share_blocks = 1024 / block_lanes;

/// The elements of one block side by side, as the roots of a critical step are found one after the other.
void share_block(const ElementBlock& block, const Model& model, ElementShares& shares) {
  using Lanes = Pack<block_lanes>;
  Vec3<Lanes> side_12, side_13;
  for (Index lane = 0; lane < block_lanes; ++lane) {
    const std::array<Index, 3>& t = model.triangle[at(block.first + std::min(lane, block.count - 1))];
    const Vec3d& origin = model.reference_position[at(t[0])];
    const Vec3d a = model.reference_position[at(t[1])] - origin, b = model.reference_position[at(t[2])] - origin;
    side_12.x.set_lane(lane, a.x);
    side_12.y.set_lane(lane, a.y);
    side_12.z.set_lane(lane, a.z);
    side_13.x.set_lane(lane, b.x);
    side_13.y.set_lane(lane, b.y);
    side_13.z.set_lane(lane, b.z);
  }
  const auto frame = physics::triangle_frame(side_12, side_13);
  const SectionData& section = model.sections[at(block.section)];
  const Lanes step =
      physics::element_critical_step({section.thickness, section.moduli, model.run.drilling}, section.density, frame);
  for (Index lane = 0; lane < block.count; ++lane) {
    const std::size_t e = at(block.first + lane);
    const double area = 0.5 * frame.doubled_area.lane(lane);
    shares.area[e] = area;
    shares.mass[e] = physics::corner_mass(section.density, section.thickness, area);
    shares.inertia[e] = physics::corner_inertia(shares.mass[e], section.thickness, area);
    shares.step[e] = step.lane(lane);
  }
}

}  // namespace

ElementShares element_shares(const Model& model) {
  ElementShares shares;
  for (std::vector<double>* values : {&shares.area, &shares.mass, &shares.inertia, &shares.step}) {
    values->resize(model.triangle.size());
  }
  parallel::for_each(model.block_count(), share_blocks,
                     [&](Index block) { share_block(model.blocks[at(block)], model, shares); });
  return shares;
}

}  // namespace fexp::model
