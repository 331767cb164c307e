// SPDX-License-Identifier: Apache-2.0
#include "io/deck.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "model/build.hpp"
#include "support/decks.hpp"

namespace fexp::io {
namespace {

Deck parse_well(std::string_view text) {
  ErrorList errors;
  Deck deck = parse_deck(text, "deck.toml", errors);
  for (const InputError& error : errors.errors()) {
    ADD_FAILURE() << error.text();
  }
  return deck;
}

/// Line of the full deck, from 1, where a text first stands.
int line_of(const std::string& text) {
  const std::size_t position = test::full_deck.find(text);
  EXPECT_NE(position, std::string::npos) << text;
  int line = 1;
  for (std::size_t i = 0; i < std::min(position, test::full_deck.size()); ++i) {
    line += test::full_deck[i] == '\n' ? 1 : 0;
  }
  return line;
}

TEST(deck, title_units_run_and_output_are_read) {
  const Deck deck = parse_well(test::full_deck);
  EXPECT_EQ(deck.title, "everything");
  EXPECT_EQ(deck.units.of("force*length/mass^2"), "kN*mm/kg^2");
  EXPECT_EQ(deck.units.time, "ms");
  const model::RunSettings& run = deck.description.run;
  EXPECT_EQ(run.duration, 2.0);
  EXPECT_EQ(run.safety, 0.8);
  EXPECT_EQ(run.damping, 0.5);
  EXPECT_EQ(run.energy_drift_limit, 0.01);
  EXPECT_EQ(run.step_collapse, 0.0);
  EXPECT_EQ(run.drilling, 0.2);
  EXPECT_EQ(run.epoch_steps, 32);
  EXPECT_EQ(deck.output.results_interval, 0.1);
  EXPECT_EQ(deck.output.history_interval, 0.01);
  EXPECT_EQ(deck.output.nodes, std::vector<std::string>{"edge"});
  EXPECT_EQ(deck.output.bodies, std::vector<std::string>{"ball"});
  EXPECT_EQ(deck.output.deflate, 3);
}

TEST(deck, curves_materials_and_sections_are_read) {
  const model::Description d = parse_well(test::full_deck).description;
  ASSERT_EQ(d.curves.size(), 1U);
  EXPECT_EQ(d.curves[0].name, "ramp");
  EXPECT_EQ(d.curves[0].points, (std::vector<std::array<double, 2>>{{0.0, 0.0}, {1.5, 2.0}}));
  ASSERT_EQ(d.materials.size(), 1U);
  EXPECT_EQ(d.materials[0].name, "steel");
  const auto law = std::get<physics::LinearElastic>(d.materials[0].law);
  EXPECT_EQ(law.density, 7.85e-6);
  EXPECT_EQ(law.young, 210.0);
  EXPECT_EQ(law.poisson, 0.3);
  ASSERT_EQ(d.sections.size(), 1U);
  EXPECT_EQ(d.sections[0].name, "thin");
  EXPECT_EQ(d.sections[0].material, "steel");
  EXPECT_EQ(d.sections[0].thickness, 0.5);
}

TEST(deck, the_first_law_is_taken_when_none_is_named) {
  std::string text = test::full_deck;
  const std::string line = "law = \"linear_elastic\"\n";
  text.erase(text.find(line), line.size());
  EXPECT_EQ(std::get<physics::LinearElastic>(parse_well(text).description.materials.at(0).law).young, 210.0);
}

TEST(deck, bodies_are_read_with_mesh_placement_and_motion) {
  const model::Description d = parse_well(test::full_deck).description;
  ASSERT_EQ(d.bodies.size(), 2U);
  const model::BodyDescription &ball = d.bodies[0], &plate = d.bodies[1];
  const auto sphere = std::get<model::CubedSphere>(std::get<model::MeshGenerator>(ball.mesh));
  EXPECT_EQ(sphere.radius, 0.5);
  EXPECT_EQ(sphere.cells, 3);
  EXPECT_EQ(ball.section, "thin");
  EXPECT_EQ(ball.scale, 2.0);
  ASSERT_EQ(ball.rotate.size(), 2U);
  EXPECT_EQ(ball.rotate[0].axis, (Vec3d{0.0, 0.0, 1.0}));
  EXPECT_EQ(ball.rotate[1].angle_degrees, 30.0);
  EXPECT_EQ(ball.rotate[1].point, (Vec3d{0.0, 1.0, 0.0}));
  EXPECT_EQ(ball.translate, (Vec3d{1.0, 2.0, 3.5}));
  EXPECT_EQ(ball.velocity, (Vec3d{0.0, 0.0, -1.0}));
  EXPECT_EQ(ball.angular_velocity, (Vec3d{0.1, 0.0, 0.0}));
  EXPECT_TRUE(ball.flip_normals);
  EXPECT_FALSE(ball.array.has_value());
  const auto rectangle = std::get<model::Plate>(std::get<model::MeshGenerator>(plate.mesh));
  EXPECT_EQ(rectangle.length_x, 4.0);
  EXPECT_EQ(rectangle.cells_x, 5);
  EXPECT_EQ(rectangle.cells_y, 8);
  EXPECT_EQ(rectangle.diagonals, "crossed");
  ASSERT_EQ(plate.parts.size(), 1U);
  EXPECT_EQ(plate.parts[0].part, "shell");
  EXPECT_EQ(plate.parts[0].section, "thin");
  ASSERT_TRUE(plate.array.has_value());
  EXPECT_EQ(plate.array.value_or(model::Array{}).count, (std::array{2, 1, 3}));
  EXPECT_EQ(plate.array.value_or(model::Array{}).pitch, (Vec3d{10.0, 0.0, 10.0}));
}

TEST(deck, sets_conditions_and_loads_are_read) {
  const model::Description d = parse_well(test::full_deck).description;
  ASSERT_EQ(d.node_sets.size(), 2U);
  EXPECT_EQ(d.node_sets[0].bodies, std::vector<std::string>{"plate"});
  EXPECT_TRUE(d.node_sets[0].boundary);
  EXPECT_EQ(d.node_sets[0].box.value_or(model::BoxSelection{}).low, (Vec3d{0.0, 0.0, -21.0}));
  EXPECT_EQ(d.node_sets[0].box.value_or(model::BoxSelection{}).high, (Vec3d{0.0, 3.0, -19.0}));
  EXPECT_EQ(d.node_sets[1].bodies, std::vector<std::string>{"ball"});
  EXPECT_FALSE(d.node_sets[1].box.has_value());
  ASSERT_EQ(d.fixed.size(), 2U);
  EXPECT_EQ(d.fixed[0].set, "edge");
  EXPECT_EQ(d.fixed[0].dofs.size(), 6U);
  EXPECT_EQ(d.fixed[1].dofs, (std::vector<std::string>{"x", "rz"}));
  ASSERT_EQ(d.prescribed.size(), 1U);
  EXPECT_EQ(d.prescribed[0].dof, "y");
  EXPECT_EQ(d.prescribed[0].velocity, 3.0);
  EXPECT_EQ(d.prescribed[0].curve, "ramp");
  ASSERT_EQ(d.symmetry.size(), 1U);
  EXPECT_EQ(d.symmetry[0].normal, (Vec3d{1.0, 0.0, 0.0}));
  ASSERT_EQ(d.gravity.size(), 1U);
  EXPECT_EQ(d.gravity[0].acceleration, (Vec3d{0.0, 0.0, -9.81e-3}));
  ASSERT_EQ(d.pressure.size(), 1U);
  EXPECT_EQ(d.pressure[0].bodies, std::vector<std::string>{"ball"});
  EXPECT_EQ(d.pressure[0].part, "shell");
  EXPECT_EQ(d.pressure[0].value, 0.1);
  ASSERT_EQ(d.forces.size(), 1U);
  EXPECT_EQ(d.forces[0].force, (Vec3d{1.0, 0.0, 0.0}));
  EXPECT_EQ(d.forces[0].moment, (Vec3d{0.0, 1.0, 0.0}));
  EXPECT_TRUE(d.forces[0].total);
  ASSERT_EQ(d.point_masses.size(), 1U);
  EXPECT_EQ(d.point_masses[0].mass, 0.01);
  EXPECT_EQ(d.point_masses[0].inertia, 0.02);
  EXPECT_TRUE(d.point_masses[0].total);
}

TEST(deck, prescribed_motions_local_axes_and_the_smallest_step_are_read) {
  const model::Description d = parse_well(R"([run]
duration = 1
minimum_step = 1e-6
[[body]]
name = "a"
mesh = {kind = "cubed_sphere", radius = 1}
[[fixed]]
set = "all"
dofs = ["x"]
axes = { x = [1, 1, 0], xy = [0, 1, 0] }
[[prescribed]]
set = "all"
dof = "y"
displacement = 2
[prescribed.axes]
x = [0, 0, 1]
xy = [0, 1, 1]
[[prescribed]]
set = "all"
dof = "rz"
acceleration = -3
)")
                                   .description;
  EXPECT_EQ(d.run.minimum_step, 1e-6);
  EXPECT_EQ(d.fixed.at(0).axes.value_or(model::LocalAxes{}).x, (Vec3d{1.0, 1.0, 0.0}));
  ASSERT_EQ(d.prescribed.size(), 2U);
  EXPECT_EQ(d.prescribed[0].displacement, 2.0);
  EXPECT_FALSE(d.prescribed[0].velocity.has_value());
  EXPECT_FALSE(d.prescribed[0].acceleration.has_value());
  EXPECT_EQ(d.prescribed[0].axes.value_or(model::LocalAxes{}).xy, (Vec3d{0.0, 1.0, 1.0}));
  EXPECT_EQ(d.prescribed[1].acceleration, -3.0);
  EXPECT_FALSE(d.prescribed[1].axes.has_value());
}

TEST(deck, physical_groups_of_sets_and_mesh_files_are_read) {
  const Deck deck = parse_well(R"([run]
duration = 1
[[body]]
name = "a"
mesh.kind = "file"
mesh.path = "a.msh"
mesh.weld_tolerance = 0
[[node_set]]
name = "rim"
group = "rim of a"
)");
  EXPECT_EQ(deck.description.node_sets.at(0).group, "rim of a");
  const auto file = std::get<model::MeshFile>(deck.description.bodies.at(0).mesh);
  EXPECT_EQ(file.path, "a.msh");
  EXPECT_EQ(file.weld_tolerance, 0.0);
}

TEST(deck, a_model_is_built_of_it) {
  const Deck deck = parse_well(test::full_deck);
  ErrorList errors;
  InputFiles files;
  const std::vector<model::Mesh> meshes = load_meshes(deck, "", files, errors);
  const model::Model model = model::build_model(deck.description, meshes, errors);
  check_output(deck.output, model, errors);
  for (const InputError& error : errors.errors()) {
    ADD_FAILURE() << error.text();
  }
  EXPECT_EQ(model.body_count(), 7);
  EXPECT_EQ(model.element_count(), 12 * 9 + 6 * 4 * 5 * 8);
}

TEST(deck, settings_of_walls_and_of_pairs_in_contact_are_read) {
  const Deck deck = parse_well(R"([run]
duration = 1
[[body]]
name = "a"
mesh = { kind = "cubed_sphere", radius = 1 }
[[plane]]
name = "floor"
point = [0, 0, 0]
normal = [0, 0, 1]
friction = 0.25
damping = 1
[[plane]]
name = "ceiling"
point = [0, 0, 9]
normal = [0, 0, -1]
[contact]
penalty = "element"
[[contact.pairs]]
bodies = ["a", "a"]
friction = 0.5
[[contact.pairs]]
bodies = ["a", "b"]
damping = 0.125
penalty_scale = 3
stiffness = 7
)");
  const model::Description& d = deck.description;
  EXPECT_EQ(d.planes.at(0).friction, 0.25);
  EXPECT_EQ(d.planes.at(0).damping, 1.0);
  EXPECT_FALSE(d.planes.at(1).friction.has_value());
  EXPECT_FALSE(d.planes.at(1).damping.has_value());
  EXPECT_EQ(d.contact.penalty, "element");
  ASSERT_EQ(d.contact.pairs.size(), 2U);
  EXPECT_EQ(d.contact.pairs[0].bodies, (std::array<std::string, 2>{"a", "a"}));
  EXPECT_EQ(d.contact.pairs[0].friction, 0.5);
  EXPECT_FALSE(d.contact.pairs[0].damping.has_value());
  EXPECT_EQ(d.contact.pairs[0].place.line, 18);
  EXPECT_FALSE(d.contact.pairs[1].friction.has_value());
  EXPECT_EQ(d.contact.pairs[1].damping, 0.125);
  EXPECT_EQ(d.contact.pairs[1].penalty_scale, 3.0);
  EXPECT_EQ(d.contact.pairs[1].stiffness, 7.0);
}

TEST(deck, walls_and_contact_are_read) {
  const model::Description d = parse_well(test::full_deck).description;
  ASSERT_EQ(d.planes.size(), 1U);
  EXPECT_EQ(d.planes[0].name, "floor");
  EXPECT_EQ(d.planes[0].point, (Vec3d{0.0, 0.0, -50.0}));
  EXPECT_EQ(d.planes[0].normal, (Vec3d{0.0, 0.0, 2.0}));
  EXPECT_EQ(d.planes[0].stiffness, 100.0);
  ASSERT_EQ(d.cylinders.size(), 1U);
  EXPECT_EQ(d.cylinders[0].point, (Vec3d{0.0, 0.0, -60.0}));
  EXPECT_EQ(d.cylinders[0].axis, (Vec3d{0.0, 3.0, 0.0}));
  EXPECT_EQ(d.cylinders[0].radius, 5.0);
  EXPECT_EQ(d.cylinders[0].velocity, (Vec3d{1.0, 0.0, 0.0}));
  EXPECT_FALSE(d.cylinders[0].inside);
  ASSERT_EQ(d.spheres.size(), 1U);
  EXPECT_EQ(d.spheres[0].centre, (Vec3d{0.0, 0.0, 1.0}));
  EXPECT_TRUE(d.spheres[0].inside);
  EXPECT_EQ(d.spheres[0].displacement, (Vec3d{0.0, 0.0, 2.0}));
  EXPECT_EQ(d.spheres[0].curve, "ramp");
  EXPECT_TRUE(d.contact.enabled);
  EXPECT_FALSE(d.contact.self);
  EXPECT_EQ(d.contact.penalty_scale, 0.5);
  EXPECT_EQ(d.contact.stiffness, 10.0);
  EXPECT_EQ(d.contact.exclude, (std::vector<std::array<std::string, 2>>{{"ball", "plate"}, {"ball", "ball"}}));
}

TEST(deck, every_place_is_that_of_its_table) {
  const Deck deck = parse_well(test::full_deck);
  const model::Description& d = deck.description;
  EXPECT_EQ(d.curves.at(0).place.line, line_of("[[curve]]"));
  EXPECT_EQ(d.materials.at(0).place.line, line_of("[[material]]"));
  EXPECT_EQ(d.sections.at(0).place.line, line_of("[[section]]"));
  EXPECT_EQ(d.bodies.at(0).place.line, line_of("[[body]]"));
  EXPECT_EQ(d.bodies.at(0).mesh_place.text(), "deck.toml:" + std::to_string(line_of("mesh = {")) + ":8");
  EXPECT_EQ(d.bodies.at(1).mesh_place.line, line_of("[body.mesh]"));
  EXPECT_EQ(d.bodies.at(1).parts.at(0).place.text(), "deck.toml:" + std::to_string(line_of("parts = ")) + ":10");
  EXPECT_EQ(d.node_sets.at(0).place.line, line_of("[[node_set]]"));
  EXPECT_EQ(d.fixed.at(1).place.line, line_of("dofs = ") - 2);
  EXPECT_EQ(d.prescribed.at(0).place.line, line_of("[[prescribed]]"));
  EXPECT_EQ(d.symmetry.at(0).place.line, line_of("[[symmetry]]"));
  EXPECT_EQ(d.gravity.at(0).place.line, line_of("[[gravity]]"));
  EXPECT_EQ(d.pressure.at(0).place.line, line_of("[[pressure]]"));
  EXPECT_EQ(d.forces.at(0).place.line, line_of("[[force]]"));
  EXPECT_EQ(d.planes.at(0).place.line, line_of("[[plane]]"));
  EXPECT_EQ(d.contact.place.line, line_of("[contact]"));
  EXPECT_EQ(deck.output.place.line, line_of("[output]"));
  EXPECT_EQ(d.planes.at(0).place.file, "deck.toml");
}

TEST(deck, what_is_left_out_keeps_its_default) {
  const Deck deck =
      parse_well("[run]\nduration = 1\n[[body]]\nname = \"a\"\nmesh = {kind = \"cubed_sphere\", radius = 1}\n");
  EXPECT_EQ(deck.description.run.safety, model::RunSettings{}.safety);
  EXPECT_EQ(deck.description.contact.stiffness, -1.0);
  EXPECT_EQ(deck.output.results_interval, -1.0);
  EXPECT_TRUE(deck.description.contact.enabled);
  EXPECT_EQ(deck.description.bodies.at(0).scale, 1.0);
}

TEST(deck, byte_order_mark_and_carriage_returns_do_no_harm) {
  std::string text = "\xef\xbb\xbf";
  for (const char c : test::full_deck) {
    text += c == '\n' ? "\r\n" : std::string(1, c);
  }
  EXPECT_EQ(parse_well(text).description.bodies.size(), 2U);
}

}  // namespace
}  // namespace fexp::io
