// SPDX-License-Identifier: Apache-2.0
#include "bench/scenes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

namespace fexp::bench {

namespace {

/// Largest speed in the plates [length/time]: nodes pass each other by a search's skin in about a hundred steps.
constexpr double plate_speed = 10.0;
constexpr Index sphere_elements = 12 * sphere_cells * sphere_cells;

/// Steel and one section of it.
model::Description description(double thickness) {
  model::Description d;
  d.run.duration = 1.0;
  d.materials.push_back({"steel", physics::LinearElastic{7850.0, 2.1e11, 0.3}, {}});
  d.sections.push_back({"shell", "steel", thickness, {}});
  return d;
}

model::Model frozen(const model::Description& d) {
  std::vector<model::Mesh> meshes;
  for (const model::BodyDescription& b : d.bodies) {
    meshes.push_back(model::generate_mesh(std::get<model::MeshGenerator>(b.mesh)));
  }
  ErrorList errors;
  model::Model model = model::build_model(d, meshes, errors);
  if (!errors.errors().empty()) {
    throw std::runtime_error(errors.errors().front().text());
  }
  return model;
}

/// Copies on a grid that is about as high as it is wide.
model::Array grid(Index copies, const Vec3d& pitch) {
  const int side = std::max(1, static_cast<int>(std::lround(std::cbrt(static_cast<double>(copies)))));
  const int layers = std::max(1, static_cast<int>(std::lround(static_cast<double>(copies) / (side * side))));
  return {{side, side, layers}, pitch};
}

int plate_cells(Index elements) {
  return static_cast<int>(std::lround(std::sqrt(static_cast<double>(elements) / 2.0)));
}

model::BodyDescription plate(Index elements) {
  const int cells = plate_cells(elements);
  model::BodyDescription made = body("plate", model::Plate{1.0, 1.0, cells, cells, "alternating"});
  made.angular_velocity = {2.0 * plate_speed, 0.0, 0.0};
  return made;
}

/// Steel of Johnson and Cook's law, and a spin of which it flows after a fifth of the duration, by increments of strain
/// as in a crash.
void let_flow(model::Description& d) {
  physics::JohnsonCook steel;
  static_cast<physics::J2Power&>(steel) = {{7850.0, 2.1e11, 0.3, 0.022, 1.0}, 3.5e8, 2.75e8, 0.36};
  d.materials.front().law = steel;
  d.sections.front().points = 3;
  d.bodies.back().angular_velocity = {700.0, 0.0, 0.0};
  d.run.duration = 5.0e-4;
}

/// Gravity, and the edge at the low end of x held.
void hold(model::Description& d) {
  d.bodies.back().angular_velocity = {};
  model::NodeSet edge;
  edge.name = "edge";
  edge.box = model::BoxSelection{{-1.0e-6, -1.0, -1.0}, {1.0e-6, 2.0, 1.0}};
  d.node_sets.push_back(edge);
  d.fixed.emplace_back().set = "edge";
  d.gravity.emplace_back().acceleration = {0.0, 0.0, -9.81};
}

model::BodyDescription spheres(const std::string& name, Index copies, const Vec3d& pitch) {
  model::BodyDescription made = body(name, model::CubedSphere{sphere_radius, sphere_cells});
  made.array = grid(copies, pitch);
  return made;
}

}  // namespace

double sphere_width(int cells) { return sphere_radius * std::sqrt(4.0 * 3.14 / 6.0) / cells; }

int cells_of_sphere(Index elements) {
  return static_cast<int>(std::lround(std::sqrt(static_cast<double>(elements) / 12.0)));
}

model::BodyDescription body(const std::string& name, const model::MeshGenerator& mesh) {
  model::BodyDescription made;
  made.name = name;
  made.section = "shell";
  made.mesh = mesh;
  return made;
}

model::Model build(Scene scene, Index elements) {
  constexpr double diameter = 2.0 * sphere_radius;
  const bool is_plate = scene == Scene::plate || scene == Scene::quiet_plate || scene == Scene::flowing_plate ||
                        scene == Scene::held_plate;
  const double thickness = relative_thickness * (is_plate ? 1.0 / plate_cells(elements) : sphere_width(sphere_cells));
  model::Description d = description(thickness);
  d.contact.enabled = !is_plate || scene == Scene::quiet_plate;
  if (is_plate) {
    d.bodies.push_back(plate(elements));
    if (scene == Scene::held_plate) {
      hold(d);
    } else if (scene == Scene::flowing_plate) {
      let_flow(d);
    }
  } else if (scene == Scene::separate_spheres) {
    const double pitch = 1.3 * diameter;
    d.bodies.push_back(spheres("sphere", elements / sphere_elements, {pitch, pitch, pitch}));
    d.bodies.back().velocity = {10.0, 0.0, 0.0};
    d.bodies.back().angular_velocity = {5.0, 6.0, 7.0};
  } else {
    const Vec3d pitch{2.6 * diameter, 1.3 * diameter, 1.3 * diameter};
    for (const double side : {-1.0, 1.0}) {
      d.bodies.push_back(spheres(side < 0.0 ? "left" : "right", elements / (2 * sphere_elements), pitch));
      d.bodies.back().translate = {side * (sphere_radius + 0.51 * thickness), 0.0, 0.0};
      d.bodies.back().velocity = {-10.0 * side, 0.0, -0.02 * side};
    }
  }
  return frozen(d);
}

model::Model four_spheres(int cells, double part) {
  constexpr double thickness = 0.01, duration = 0.02;
  struct Sphere {
    const char* name;
    double gap;  // To the first of the pair [length]; 0: is that itself
    double y;
    Vec3d velocity;
  };
  const std::array<Sphere, 4> all{{{"a", 0.0, 0.0, {10.0, 0.0, 0.02}},
                                   {"b", 0.1, 0.0, {-10.0, 0.0, -0.02}},
                                   {"c", 0.0, 2.0, {11.0, 0.0, 0.02}},
                                   {"d", 0.115, 2.0, {-11.0, 0.0, -0.02}}}};
  const double scale = static_cast<double>(sphere_cells) / cells;
  model::Description d = description(scale * thickness);
  d.run.duration = scale * part * duration;
  for (const Sphere& one : all) {
    d.bodies.push_back(body(one.name, model::CubedSphere{sphere_radius, cells}));
    d.bodies.back().translate = {
        one.gap > 0.0 ? 2.0 * sphere_radius + scale * (thickness + part * (one.gap - thickness)) : 0.0, one.y, 0.0};
    d.bodies.back().velocity = one.velocity;
  }
  return frozen(d);
}

model::Model sphere(Index elements) {
  const int cells = cells_of_sphere(elements);
  model::Description d = description(relative_thickness * sphere_width(cells));
  d.bodies.push_back(body("sphere", model::CubedSphere{sphere_radius, cells}));
  return frozen(d);
}

double four_steps(const model::Model& model) { return 4.0 * model.run.safety * model.first_critical_step; }

}  // namespace fexp::bench
