// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "contact/island_contact.hpp"
#include "support/descriptions.hpp"

/// Surfaces and probes for tests of contact.
namespace fexp::test {

inline model::Plate plate(double lx, double ly, int nx, int ny, const char* diagonals = "one") {
  model::Plate p;
  p.length_x = lx;
  p.length_y = ly;
  p.cells_x = nx;
  p.cells_y = ny;
  p.diagonals = diagonals;
  return p;
}

inline model::Mesh mesh(std::vector<Vec3d> position, std::vector<std::array<Index, 3>> triangle) {
  model::Mesh m;
  m.position = std::move(position);
  m.part.assign(triangle.size(), 0);
  m.triangle = std::move(triangle);
  return m;
}

/// Builds a model in which every body has the mesh given here.
inline model::Model build(const model::Description& d, const std::vector<model::Mesh>& meshes) {
  ErrorList errors;
  model::Model model = model::build_model(d, meshes, errors);
  for (const InputError& error : errors.errors()) {
    ADD_FAILURE() << error.text();
  }
  return model;
}

/// Moves the inner nodes of a mesh by up to `size` in each direction.
inline void shake(model::Mesh& m, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-size, size);
  for (Vec3d& x : m.position) {
    x += Vec3d{shift(random), shift(random), shift(random)};
  }
}

/// One node, the tip of a small triangle that is kept out of the way, against a surface that is held still.
class Tip {
 public:
  Tip(const model::Mesh& surface, double thickness, double size = 1.0)
      : node(static_cast<Index>(surface.position.size())) {
    auto d = description(rubber, thickness);
    d.contact.enabled = true;
    add_body(d, "surface", model::CubedSphere{});
    add_body(d, "tip", model::CubedSphere{});
    const Vec3d far{0.0, 0.0, 1.0e3};
    model = build(d, {surface, mesh({far, far + Vec3d{size, 0.0, size}, far + Vec3d{0.0, size, size}}, {{0, 1, 2}})});
    motion = model::initial_state(model).motion;
  }

  /// Moves the tip to a point in one step, and looks.
  void move(const Vec3d& to) {
    motion[at(node)].velocity = to - motion[at(node)].position;
    motion[at(node)].position = to;
    look(started_ ? 1.0 : 0.0);
    started_ = true;
    memory.swap(remembered_);
  }

  /// Energy at the present positions with the sides as they are remembered.
  double energy() {
    look(0.0);
    double sum = 0.0;
    for (const contact::ActivePair& pair : active) {
      sum += pair.energy;
    }
    return sum;
  }

  [[nodiscard]] Vec3d force() const {
    Vec3d sum;
    for (const contact::ActivePair& pair : active) {
      sum += pair.force;
    }
    return sum;
  }

  /// Remembered side of an element, 0 when there is none.
  [[nodiscard]] int side(Index element) const {
    for (const model::ContactSide& s : memory) {
      if (s.element == element) {
        return s.side;
      }
    }
    return 0;
  }

  model::Model model;
  AlignedVector<model::NodeMotion> motion;
  Index node;
  std::vector<model::ContactSide> memory;
  std::vector<contact::ActivePair> active;

 private:
  void look(double dt) {
    std::vector<Index> elements;
    for (Index e = 0; e < model.bodies[0].elements.end; ++e) {
      elements.push_back(e);
    }
    std::vector<double> due(elements.size(), 0.0);
    remembered_.clear();
    active.clear();
    contact::NodeWatch(model, {motion.data(), 0.0}, {motion.data(), dt})
        .look(node, {elements, due, 0.0}, memory, remembered_, active);
  }

  std::vector<model::ContactSide> remembered_;
  bool started_{};
};

/// An island's contact, with all that it writes.
class Contact {
 public:
  Contact(const model::Model& model, const model::State& state) : bodies(model.bodies.size()) {
    nodes.force.resize(model.reference_position.size());
    nodes.stiffness.resize(model.reference_position.size());
    assign(model, state);
  }

  void assign(const model::Model& model, const model::State& state) {
    std::vector<Index> moving, barriers;
    for (Index b = 0; b < model.body_count(); ++b) {
      (model.bodies[at(b)].barrier ? barriers : moving).push_back(b);
    }
    island.assign(model, moving, barriers, state);
  }

  contact::ContactReport evaluate(const model::Model& model, const model::State& state, double dt) {
    nodes.force.assign(nodes.force.size(), {});
    nodes.stiffness.assign(nodes.stiffness.size(), 0.0);
    bodies.assign(bodies.size(), {});
    return island.evaluate(model, state, dt, nodes, bodies.data());
  }

  [[nodiscard]] double energy() const {
    double sum = 0.0;
    for (const contact::BodyContact& body : bodies) {
      sum += body.energy;
    }
    return sum;
  }

  contact::IslandContact island;
  contact::NodeContact nodes;
  std::vector<contact::BodyContact> bodies;
};

}  // namespace fexp::test
