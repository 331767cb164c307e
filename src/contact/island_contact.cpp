// SPDX-License-Identifier: Apache-2.0
#include "contact/island_contact.hpp"

namespace fexp::contact {

void IslandContact::assign(const model::Model&, std::span<const Index>, std::span<const Index>, const model::State&) {}
void IslandContact::advance(const model::Model&, const model::NodeMotion*, double) {}
ContactReport IslandContact::evaluate(const model::Model&, const model::NodeMotion*, double, Vec3d*, BodyContact*) {
  return {};
}
void IslandContact::store_sides(const model::Model&, model::State&) const {}

}  // namespace fexp::contact
