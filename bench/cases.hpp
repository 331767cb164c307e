// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "model/build.hpp"
#include "model/mesh_generators.hpp"

/// Models of any size for the benchmarks, of steel shells a fifth as thick as their elements are wide, without
/// conditions and loads.
namespace fexp::bench {

enum class Scene {
  plate,             ///< One plate that spins about its long edge and stretches, without contact
  quiet_plate,       ///< The same with self-contact that never touches: one island
  separate_spheres,  ///< Spheres of 192 triangles that fly and spin apart from each other: an island each
  meeting_spheres,   ///< Pairs of such spheres that collide at 20 length/time from the first steps on: an island each
};

/// Largest speed in the plates [length/time]: nodes pass each other by a search's skin in about a hundred steps.
inline constexpr double plate_speed = 10.0;
/// Thickness over element width, whatever the size of the mesh: contact distance grows with it.
inline constexpr double relative_thickness = 0.2;
inline constexpr double sphere_radius = 0.5;
inline constexpr int sphere_cells = 4;
inline constexpr Index sphere_elements = 12 * sphere_cells * sphere_cells;

/// Mean width of the cells of a sphere [length].
inline double sphere_width(int cells) { return sphere_radius * std::sqrt(4.0 * 3.14 / 6.0) / cells; }

inline model::BodyDescription body(const std::string& name, const model::MeshGenerator& mesh) {
  model::BodyDescription made;
  made.name = name;
  made.section = "shell";
  made.mesh = mesh;
  return made;
}

/// Time in which a run of the model takes its first four steps.
inline double four_steps(const model::Model& model) { return 4.0 * model.run.safety * model.first_critical_step; }

/// Copies on a grid that is about as high as it is wide.
inline model::Array grid(Index copies, const Vec3d& pitch) {
  const int side = std::max(1, static_cast<int>(std::lround(std::cbrt(static_cast<double>(copies)))));
  const int layers = std::max(1, static_cast<int>(std::lround(static_cast<double>(copies) / (side * side))));
  return {{side, side, layers}, pitch};
}

inline int plate_cells(Index elements) {
  return static_cast<int>(std::lround(std::sqrt(static_cast<double>(elements) / 2.0)));
}

inline model::BodyDescription plate(Index elements) {
  const int cells = plate_cells(elements);
  model::BodyDescription made = body("plate", model::Plate{1.0, 1.0, cells, cells, "alternating"});
  made.angular_velocity = {2.0 * plate_speed, 0.0, 0.0};
  return made;
}

inline model::BodyDescription spheres(const std::string& name, Index copies, const Vec3d& pitch) {
  model::BodyDescription made = body(name, model::CubedSphere{sphere_radius, sphere_cells});
  made.array = grid(copies, pitch);
  return made;
}

/// The scene with about so many elements. Throws when it cannot be built.
inline model::Model build(Scene scene, Index elements) {
  constexpr double diameter = 2.0 * sphere_radius;
  const bool is_plate = scene == Scene::plate || scene == Scene::quiet_plate;
  const double thickness = relative_thickness * (is_plate ? 1.0 / plate_cells(elements) : sphere_width(sphere_cells));
  model::Description d;
  d.run.duration = 1.0;
  d.materials.push_back({"steel", physics::LinearElastic{7850.0, 2.1e11, 0.3}, {}});
  d.sections.push_back({"shell", "steel", thickness, {}});
  d.contact.enabled = scene != Scene::plate;
  if (is_plate) {
    d.bodies.push_back(plate(elements));
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

}  // namespace fexp::bench
