// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "contact/surface.hpp"
#include "model/state.hpp"
#include "support/descriptions.hpp"

namespace fexp::contact {
namespace {

/// Elements that share a place of the store put each other out, and none gets the normal of another.
TEST(normals, are_those_of_the_element_in_whatever_order_they_are_asked_for) {
  model::Description d = test::description({7850.0, 2.1e11, 0.3}, 0.003);
  test::add_body(d, "ball", model::CubedSphere{1.0, 8});
  const model::Model model = test::build(d);
  const model::State state = model::initial_state(model);
  const Positions x{state.motion.data(), 0.0};
  Normals normals(model, x);
  ASSERT_GT(model.element_count(), 700);
  for (const Index stride : {1, 128, 129, 7}) {
    for (Index i = 0; i < model.element_count(); ++i) {
      const Index element = static_cast<Index>(std::int64_t{i} * stride % model.element_count());
      const auto& t = model.triangle[at(element)];
      const Vec3d area = cross(x(t[1]) - x(t[0]), x(t[2]) - x(t[0]));
      for (int again = 0; again < 2; ++again) {
        ASSERT_EQ(normals(element), (1.0 / norm(area)) * area) << element;
      }
    }
  }
}

}  // namespace
}  // namespace fexp::contact
