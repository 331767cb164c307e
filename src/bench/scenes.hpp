// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "model/build.hpp"
#include "model/mesh_generators.hpp"

/// Models of any size for the benchmarks, of elastic steel shells unless it says so.
namespace fexp::bench {

/// Their shells are a fifth as thick as their elements are wide. There are no conditions and loads unless it says so.
enum class Scene {
  plate,             ///< One plate that spins about its long edge and stretches, without contact
  quiet_plate,       ///< The same with self-contact that never touches: one island
  flowing_plate,     ///< The spinning plate with 3 points of Johnson and Cook's law that flow everywhere
  held_plate,        ///< A plate at rest with one edge held, on which gravity begins to act; without contact
  separate_spheres,  ///< Spheres of 192 triangles that fly and spin apart from each other: an island each
  meeting_spheres,   ///< Pairs of such spheres that collide at 20 length/time from the first steps on: an island each
};

/// Thickness over element width, whatever the size of the mesh: contact distance grows with it.
inline constexpr double relative_thickness = 0.2;
inline constexpr double sphere_radius = 0.5;
inline constexpr int sphere_cells = 4;

/// Mean width of the cells of a sphere [length].
[[nodiscard]] double sphere_width(int cells);

/// A sphere's cells for about so many elements.
[[nodiscard]] int cells_of_sphere(Index elements);

/// A body of the section "shell".
[[nodiscard]] model::BodyDescription body(const std::string& name, const model::MeshGenerator& mesh);

/// The scene with about so many elements. Throws when it cannot be built.
[[nodiscard]] model::Model build(Scene scene, Index elements);

/// examples/four_spheres.toml, without output, with 12 cells^2 triangles a sphere. Where spheres have more than the
/// example's 4 cells, their thickness, the gaps between them and the duration shrink as their elements do: shells stay
/// as slender as the example's against their elements, and a run has about `part` as many steps before and after the
/// impact.
[[nodiscard]] model::Model four_spheres(int cells, double part = 1.0);

/// One sphere of about so many elements.
[[nodiscard]] model::Model sphere(Index elements);

/// Time in which a run of the model takes its first four steps.
[[nodiscard]] double four_steps(const model::Model& model);

}  // namespace fexp::bench
