// SPDX-License-Identifier: Apache-2.0
#include "io/refinement.hpp"

#include <gtest/gtest.h>

#include <variant>

namespace fexp::io {
namespace {

model::BodyDescription body_with(const model::AnyMesh& mesh) {
  model::BodyDescription body;
  body.name = "b";
  body.mesh = mesh;
  return body;
}

ErrorList refined(double factor, std::vector<model::BodyDescription>& bodies) {
  Refinement refinement;
  refinement.factor = factor;
  ErrorList errors;
  refine_meshes(refinement, bodies, errors);
  return errors;
}

TEST(refinement, multiplies_all_numbers_of_cells_and_nothing_else) {
  std::vector<model::BodyDescription> bodies{body_with(model::Plate{3.0, 2.0, 6, 4, "crossed"}),
                                             body_with(model::CubedSphere{2.0, 8})};
  EXPECT_TRUE(refined(0.5, bodies).empty());
  const auto& plate = std::get<model::Plate>(std::get<model::MeshGenerator>(bodies[0].mesh));
  EXPECT_EQ(plate.cells_x, 3);
  EXPECT_EQ(plate.cells_y, 2);
  EXPECT_EQ(plate.length_x, 3.0);
  EXPECT_EQ(std::get<model::CubedSphere>(std::get<model::MeshGenerator>(bodies[1].mesh)).cells, 4);
}

TEST(refinement, refuses_parts_of_cells_too_many_and_meshes_from_files) {
  for (const double factor : {0.25, 2.0e4}) {
    std::vector<model::BodyDescription> bodies{body_with(model::Plate{3.0, 2.0, 8, 6, "one"})};
    EXPECT_FALSE(refined(factor, bodies).empty()) << factor;
  }
  std::vector<model::BodyDescription> bodies{body_with(model::MeshFile{"a.obj"})};
  EXPECT_TRUE(refined(1.0, bodies).empty());
  EXPECT_EQ(refined(2.0, bodies).size(), 1U);
}

}  // namespace
}  // namespace fexp::io
