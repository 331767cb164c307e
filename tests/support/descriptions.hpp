// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "model/build.hpp"
#include "model/mesh_generators.hpp"

/// Descriptions of small models for tests, built by the same code as a deck's.
namespace fexp::test {

inline const physics::LinearElastic steel{7850.0, 2.1e11, 0.3};
inline const physics::LinearElastic rubber{1000.0, 1.0e6, 0.4};

/// Description with one material "m" and one section "s".
inline model::Description description(const physics::LinearElastic& law, double thickness) {
  model::Description d;
  d.run.duration = 1.0;
  d.contact.enabled = false;
  d.materials.push_back({"m", law, {}});
  d.sections.push_back({"s", "m", thickness, {}});
  return d;
}

inline model::BodyDescription& add_body(model::Description& d, const std::string& name,
                                        const model::MeshGenerator& mesh) {
  model::BodyDescription body;
  body.name = name;
  body.section = "s";
  body.mesh = mesh;
  d.bodies.push_back(std::move(body));
  return d.bodies.back();
}

/// Adds a node set of all nodes in a box.
inline void add_box_set(model::Description& d, const std::string& name, const Vec3d& low, const Vec3d& high) {
  model::NodeSet set;
  set.name = name;
  set.box = model::BoxSelection{low, high};
  d.node_sets.push_back(std::move(set));
}

inline void fix(model::Description& d, const std::string& set, std::vector<std::string> dofs) {
  d.fixed.push_back({set, std::move(dofs), {}});
}

/// Builds the model from generated meshes; wrong input fails the test.
inline model::Model build(const model::Description& d) {
  std::vector<model::Mesh> meshes;
  for (const model::BodyDescription& body : d.bodies) {
    meshes.push_back(model::generate_mesh(std::get<model::MeshGenerator>(body.mesh)));
  }
  ErrorList errors;
  model::Model model = model::build_model(d, meshes, errors);
  for (const InputError& error : errors.errors()) {
    ADD_FAILURE() << error.text();
  }
  return model;
}

}  // namespace fexp::test
