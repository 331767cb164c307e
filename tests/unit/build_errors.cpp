// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "model/build_checks.hpp"
#include "support/descriptions.hpp"

namespace fexp::model {
namespace {

using test::add_body;

using test::steel;

Description good() {
  Description d = test::description(steel, 0.01);
  add_body(d, "plate", Plate{2.0, 2.0, 2, 2, "one"});
  add_body(d, "ball", CubedSphere{1.0, 2}).translate = {0.0, 50.0, 0.0};
  d.curves.push_back({"ramp", {{0.0, 0.0}, {1.0, 1.0}}, {}});
  test::add_box_set(d, "edge", {0.0, 0.0, 0.0}, {0.0, 2.0, 0.0});
  d.node_sets.back().bodies = {"plate"};
  return d;
}

std::vector<InputError> errors_of(const Description& d, const std::function<void(std::vector<Mesh>&)>& change = {}) {
  std::vector<Mesh> meshes;
  for (const BodyDescription& body : d.bodies) {
    meshes.push_back(generate_mesh(std::get<MeshGenerator>(body.mesh)));
  }
  if (change) {
    change(meshes);
  }
  ErrorList errors;
  static_cast<void>(build_model(d, meshes, errors));
  for (const InputError& error : errors.errors()) {
    EXPECT_FALSE(error.cure.empty()) << error.text();
    EXPECT_FALSE(error.accepted.empty()) << error.text();
  }
  return errors.errors();
}

/// One error, at line 7 of the deck, whose text holds all the pieces.
void expect_one(const std::vector<InputError>& errors, const std::vector<std::string>& pieces) {
  ASSERT_EQ(errors.size(), 1U) << (errors.empty() ? "none" : errors[1].text());
  EXPECT_EQ(errors[0].place.line, 7);
  for (const std::string& piece : pieces) {
    EXPECT_NE(errors[0].text().find(piece), std::string::npos) << errors[0].text() << " lacks " << piece;
  }
}

const Place line_7{"deck.toml", 7, 1};

TEST(build_errors, a_good_description_has_none) { EXPECT_TRUE(errors_of(good()).empty()); }

TEST(build_errors, no_body_is_an_error) {
  Description d = good();
  d.bodies.clear();
  ErrorList errors;
  static_cast<void>(build_model(d, {}, errors));
  EXPECT_FALSE(errors.empty());
}

TEST(build_errors, a_part_without_section_is_named_with_the_known_sections) {
  Description d = good();
  d.bodies[0].section.clear();
  d.bodies[0].place = line_7;
  expect_one(errors_of(d), {"part \"shell\"", "body \"plate\"", "accepted: s"});
}

TEST(build_errors, a_section_that_is_not_there_is_reported_once) {
  Description d = good();
  d.bodies[0].section = "t";
  d.bodies[0].place = line_7;
  expect_one(errors_of(d), {"section \"t\"", "body \"plate\"", "accepted: s"});
}

TEST(build_errors, unknown_parts_and_sections_of_parts_are_named) {
  Description d = good();
  d.bodies[0].parts = {{"wing", "s", line_7}};
  expect_one(errors_of(d), {"no part \"wing\"", "accepted: shell"});
  d.bodies[0].parts = {{"shell", "t", line_7}};
  expect_one(errors_of(d), {"section \"t\""});
}

TEST(build_errors, a_section_of_an_unknown_material_is_named) {
  Description d = good();
  d.sections.push_back({"u", "wood", 0.1, line_7});
  expect_one(errors_of(d), {"section \"u\"", "material \"wood\"", "accepted: m"});
}

/// The description with a plastic material given by a table.
Description with_table(std::initializer_list<std::array<double, 2>> points) {
  Description d = good();
  physics::J2Table law{{1.0, 1.0, 0.3}, {}};
  for (const auto& point : points) {
    law.table.append(point);
  }
  d.materials[0].law = law;
  d.materials[0].place = line_7;
  return d;
}

TEST(build_errors, tables_that_do_not_rise_from_no_strain_are_refused) {
  const std::string accepted = "strains ascending from 0, stresses > 0 that do not fall";
  EXPECT_TRUE(errors_of(with_table({{0.0, 1.0}, {0.1, 1.0}, {0.2, 3.0}})).empty());
  expect_one(errors_of(with_table({})), {"table of material \"m\" has no points", accepted});
  expect_one(errors_of(with_table({{0.1, 1.0}})), {"begins at a strain of 0.1", accepted});
  expect_one(errors_of(with_table({{0.0, 0.0}})), {"a yield stress of 0 at a strain of 0", accepted});
  expect_one(errors_of(with_table({{0.0, 1.0}, {0.1, -1.0}})), {"a yield stress of -1 at a strain of 0.1", accepted});
  expect_one(errors_of(with_table({{0.0, 1.0}, {0.1, 2.0}, {0.1, 3.0}})), {"a strain of 0.1 after one of 0.1"});
  expect_one(errors_of(with_table({{0.0, 2.0}, {0.1, 1.5}})), {"a yield stress of 1.5 after one of 2"});
}

TEST(build_errors, hardening_as_stiff_as_the_elastic_material_is_refused) {
  Description d = good();
  d.materials[0].place = line_7;
  d.materials[0].law = physics::J2Linear{{1.0, 2.0, 0.3}, 1.0, 1.9};
  EXPECT_TRUE(errors_of(d).empty());
  d.materials[0].law = physics::J2Linear{{1.0, 2.0, 0.3}, 1.0, 2.0};
  expect_one(errors_of(d), {"tangent_modulus is 2, young is 2", "less than young"});
}

TEST(build_errors, two_laws_of_the_rate_and_a_filter_without_any_are_refused) {
  Description d = good();
  d.materials[0].place = line_7;
  physics::J2Linear law{{1.0, 2.0, 0.3}, 1.0, 0.0};
  const auto errors_with = [&] {
    d.materials[0].law = law;
    return errors_of(d);
  };
  law.rate_cutoff = 3.0;
  expect_one(errors_with(), {"rate_cutoff is 3", "does not depend on the rate", "cowper_symonds"});
  law.cowper_symonds = physics::CowperSymonds{40.0, 5.0};
  EXPECT_TRUE(errors_with().empty());
  law.rate_sensitivity = 0.1;
  expect_one(errors_with(), {"both cowper_symonds and a rate_sensitivity of 0.1", "one law of the rate"});
  law.cowper_symonds.reset();
  EXPECT_TRUE(errors_with().empty());
}

TEST(build_errors, metals_that_have_melted_at_the_start_are_refused) {
  Description d = good();
  d.materials[0].place = line_7;
  physics::J2Linear law{{1.0, 2.0, 0.3}, 1.0, 0.0};
  const auto errors_with = [&](double reference, double initial) {
    law.heating = physics::AdiabaticHeating{1.0, 900.0, reference, initial};
    d.materials[0].law = law;
    return errors_of(d);
  };
  EXPECT_TRUE(errors_with(300.0, 899.0).empty());
  EXPECT_TRUE(errors_with(300.0, -10.0).empty()) << "colder than the reference";
  expect_one(errors_with(900.0, 300.0), {"reference_temperature is 900", "melting_temperature is 900", "below"});
  expect_one(errors_with(300.0, 901.0), {"initial_temperature is 901", "melting_temperature is 900", "below"});
}

TEST(build_errors, points_through_the_thickness_that_no_rule_has_are_refused) {
  Description d = good();
  d.sections[0].place = line_7;
  for (const int points : {1, 9}) {
    d.sections[0].points = points;
    EXPECT_TRUE(errors_of(d).empty());
  }
  for (const int points : {0, 10}) {
    d.sections[0].points = points;
    expect_one(errors_of(d), {"section \"s\"", "points", "1 to 9"});
  }
  d.sections[0].quadrature = "lobatto";
  d.sections[0].points = 3;
  EXPECT_TRUE(errors_of(d).empty());
  d.sections[0].points = 2;
  expect_one(errors_of(d), {"2 points of Lobatto's rule", "3 to 9"});
}

TEST(build_errors, names_given_twice_or_not_at_all_are_refused) {
  Description d = good();
  d.bodies[1].name = "plate";
  d.bodies[1].place = line_7;
  expect_one(errors_of(d), {"\"plate\"", "another body"});
  d = good();
  d.node_sets[0].name = "all";
  d.node_sets[0].place = line_7;
  expect_one(errors_of(d), {"\"all\"", "another node set"});
  d = good();
  d.curves[0].name.clear();
  d.curves[0].place = line_7;
  expect_one(errors_of(d), {"curve has no name"});
}

TEST(build_errors, a_part_with_two_sections_and_nothing_fixed_are_refused) {
  Description d = good();
  d.bodies[0].parts = {{"shell", "s", {}}, {"shell", "s", line_7}};
  expect_one(errors_of(d), {"part \"shell\"", "twice"});
  d = good();
  d.fixed.push_back({"edge", {}, line_7});
  expect_one(errors_of(d), {"nothing is fixed on set \"edge\"", "accepted: x, y, z, rx, ry, rz"});
}

TEST(build_errors, bodies_so_far_away_that_their_shape_is_lost_are_refused) {
  Description d = good();
  d.bodies[1].place = line_7;
  d.bodies[1].translate = {0.0, 0.0, 1.0e6};
  EXPECT_TRUE(errors_of(d).empty());
  d.bodies[1].translate = {0.0, 0.0, 1.0e10};
  expect_one(errors_of(d), {"body \"ball\" reaches 1e+10", "translation"});
  d.bodies[1].translate = {};
  d.bodies[1].array = Array{{1, 1, 2}, {0.0, 0.0, 1.0e100}};
  expect_one(errors_of(d), {"body \"ball\" reaches 1e+100", "pitch"});
}

TEST(build_errors, copies_on_top_of_each_other_and_bad_counts_are_refused) {
  Description d = good();
  d.bodies[0].place = line_7;
  d.bodies[0].array = Array{{1, 3, 1}, {1.0, 0.0, 0.0}};
  expect_one(errors_of(d), {"3 copies in y"});
  d.bodies[0].array = Array{{1, 1, 0}, {1.0, 1.0, 1.0}};
  expect_one(errors_of(d), {"count in z is 0", "1 to 10000000"});
}

TEST(build_errors, more_elements_than_indices_are_refused_before_memory_is_asked_for) {
  Description d = good();
  d.bodies[0].place = line_7;
  d.bodies[0].array = Array{{10000000, 10000000, 10000000}, {1.0, 1.0, 1.0}};
  expect_one(errors_of(d), {"8000000000000000", "715827882"});
  d.bodies[0].array = Array{{10000000, 9, 1}, {3.0, 3.0, 3.0}};  // 720 million, just too many
  expect_one(errors_of(d), {"720000048 elements"});
}

TEST(build_errors, vectors_without_direction_are_refused) {
  Description d = good();
  d.bodies[0].place = line_7;
  d.bodies[0].rotate = {{{0.0, 0.0, 0.0}, 30.0, {}}};
  expect_one(errors_of(d), {"axis without direction"});
  d = good();
  d.symmetry = {{"edge", {}, line_7}};
  expect_one(errors_of(d), {"symmetry plane has no direction"});
  d = good();
  d.planes = {{{"floor"}, {}, {0.0, std::numeric_limits<double>::quiet_NaN(), 0.0}}};
  d.planes[0].place = line_7;
  expect_one(errors_of(d), {"plane \"floor\" has no direction"});
}

TEST(build_errors, walls_that_move_in_no_way_that_can_be_are_refused) {
  Description d = good();
  d.cylinders.push_back({{"roll"}, {}, {}, 1.0});
  d.cylinders[0].place = line_7;
  expect_one(errors_of(d), {"axis of cylinder \"roll\" has no direction"});
  d.cylinders[0].axis = {1.0, 0.0, 0.0};
  EXPECT_TRUE(errors_of(d).empty());
  d.cylinders[0].velocity = d.cylinders[0].displacement = {1.0, 0.0, 0.0};
  expect_one(errors_of(d), {"cylinder \"roll\" has a velocity and a displacement"});
  d.cylinders[0].velocity = {};
  expect_one(errors_of(d), {"displacement of cylinder \"roll\" is 1 times its size at the start"});
  d.cylinders[0].curve = "ramp";
  EXPECT_TRUE(errors_of(d).empty());
  d.cylinders[0].curve = "slope";
  expect_one(errors_of(d), {"no curve \"slope\"", "ramp"});
  d.cylinders[0].curve = "ramp";
  d.cylinders[0].displacement = {};
  expect_one(errors_of(d), {"cylinder \"roll\" names a curve and does not move"});
  d.cylinders[0].curve.clear();
  d.spheres.push_back({{"roll"}, {}, 1.0});
  d.spheres[0].place = line_7;
  expect_one(errors_of(d), {"\"roll\" is already that of another wall"});
}

TEST(build_errors, walls_with_mass_that_cannot_be_are_refused) {
  Description d = good();
  d.planes.push_back({{"lid"}, {0.0, 0.0, 1.0}, {0.0, 0.0, -1.0}});
  d.planes[0].place = line_7;
  model::RigidPlane& lid = d.planes[0];
  lid.force = {0.0, 0.0, 1.0};
  expect_one(errors_of(d), {"plane \"lid\" has a key force and no mass"});
  lid.force = {};
  lid.free = {"z"};
  expect_one(errors_of(d), {"plane \"lid\" has a key free and no mass"});
  lid.mass = 2.0;
  EXPECT_TRUE(errors_of(d).empty());
  lid.velocity = {0.0, 0.0, -1.0};
  expect_one(errors_of(d), {"plane \"lid\" has a mass and a velocity", "initial_velocity"});
  lid.velocity = {};
  lid.curve = "ramp";
  expect_one(errors_of(d), {"plane \"lid\" names a curve and has no force"});
  lid.force = {0.0, 0.0, 1.0};
  EXPECT_TRUE(errors_of(d).empty());
  lid.initial_velocity = {0.0, 0.5, -1.0};
  expect_one(errors_of(d), {"plane \"lid\" has an initial_velocity along which it is not free"});
  lid.free = {"z", "y"};
  EXPECT_TRUE(errors_of(d).empty());
  lid.guide = {0.0, 0.5, -1.0};
  expect_one(errors_of(d), {"plane \"lid\" has free directions and a guide"});
  lid.free.reset();
  EXPECT_TRUE(errors_of(d).empty());
  lid.guide = {0.0, 0.0, 0.0};
  expect_one(errors_of(d), {"the guide of plane \"lid\" has no direction"});
  lid.guide.reset();
  lid.initial_velocity = {};
  lid.free = std::vector<std::string>{};
  expect_one(errors_of(d), {"plane \"lid\" has a mass and is free in no direction"});
  lid.free.reset();
  lid.name = "plate";
  expect_one(errors_of(d), {"\"plate\" is already that of a body"});
  lid.name = "lid";
  lid.normal = {};
  expect_one(errors_of(d), {"the normal of plane \"lid\" has no direction"});
}

TEST(build_errors, a_radial_velocity_on_its_axis_and_an_axis_without_direction_are_refused) {
  InitialVelocity given;
  given.set = "edge";  // x = 0, y from 0 to 2
  given.radial = 1.0;
  given.place = line_7;
  Description d = good();
  d.initial_velocities = {given};
  d.initial_velocities[0].point = {1.0, 1.0, 0.0};
  EXPECT_TRUE(errors_of(d).empty());
  d.initial_velocities[0].point = {0.0, 1.0, 3.0};
  expect_one(errors_of(d), {"radial velocity of set \"edge\"", "lies on the axis"});
  d.initial_velocities[0].radial = 0.0;
  EXPECT_TRUE(errors_of(d).empty());
  d.bodies[0].rigid = true;
  expect_one(errors_of(d), {"velocity of set \"edge\"", "which is rigid"});
  d.bodies[0].rigid = false;
  d.initial_velocities[0].axis = {};
  expect_one(errors_of(d), {"the axis of the velocity of set \"edge\""});
  d.initial_velocities[0] = given;
  d.initial_velocities[0].set = "egde";
  expect_one(errors_of(d), {"no node set \"egde\"", "edge"});
}

TEST(build_errors, curves_without_points_with_falling_times_or_no_numbers_are_refused) {
  for (const std::vector<std::array<double, 2>>& points : std::vector<std::vector<std::array<double, 2>>>{
           {}, {{1.0, 0.0}, {0.5, 0.0}}, {{0.0, std::numeric_limits<double>::infinity()}}}) {
    Description d = good();
    d.curves[0] = {"ramp", points, line_7};
    expect_one(errors_of(d), {"curve \"ramp\" is no function of time"});
  }
}

TEST(build_errors, unknown_degrees_of_freedom_are_refused) {
  Description d = good();
  d.fixed = {{"edge", {"x", "w"}, line_7}};
  expect_one(errors_of(d), {"\"w\"", "x, y, z, rx, ry, rz"});
  d = good();
  d.prescribed = {{"edge", "", 1.0, "", line_7}};
  expect_one(errors_of(d), {"no degree of freedom"});
}

TEST(build_errors, settings_of_pairs_that_cannot_be_are_refused) {
  Description d = good();
  ContactPair pair;
  pair.bodies = {"plate", "ball"};
  pair.place = line_7;
  d.contact.pairs = {pair};
  expect_one(errors_of(d), {"contact.pairs: nothing is set for \"plate\" and \"ball\""});
  d.contact.pairs[0].friction = 0.0;
  EXPECT_TRUE(errors_of(d).empty());
  d.contact.pairs[0].bodies[1] = "bell";
  expect_one(errors_of(d), {"contact.pairs names body \"bell\"", "plate, ball"});
  d.contact.pairs[0].bodies[1] = "ball";
  d.contact.pairs[0].penalty_scale = 2.0;
  EXPECT_TRUE(errors_of(d).empty());
  d.contact.stiffness = 5.0;
  expect_one(errors_of(d), {"have a penalty_scale besides contact's stiffness"});
  d.contact.stiffness = -1.0;
  d.contact.pairs[0].stiffness = 5.0;
  expect_one(errors_of(d), {"have a penalty_scale besides a stiffness"});
  d.contact.pairs[0].penalty_scale.reset();
  EXPECT_TRUE(errors_of(d).empty());
}

TEST(build_errors, a_pair_is_set_once) {
  Description d = good();
  d.bodies[1].array = Array{{2, 1, 1}, {5.0, 0.0, 0.0}};
  ContactPair pair;
  pair.bodies = {"plate", "ball"};
  pair.friction = 0.1;
  pair.place = {"deck.toml", 3, 1};
  d.contact.pairs = {pair, pair};
  d.contact.pairs[1].place = line_7;
  const std::vector<std::string> twice{"are set already, by the pair of \"plate\" and \"ball\""};
  expect_one(errors_of(d), twice);
  d.contact.pairs[1].bodies = {"ball", "plate"};
  expect_one(errors_of(d), twice);
  d.contact.pairs[1].bodies = {"ball[1,0,0]", "plate"};
  expect_one(errors_of(d), twice);
  d.contact.pairs[1].bodies = {"ball", "ball[0,0,0]"};
  EXPECT_TRUE(errors_of(d).empty());
  d.contact.pairs[0].bodies = {"ball", "ball"};
  expect_one(errors_of(d), {"are set already, by the pair of \"ball\" and \"ball\""});
  d.contact.pairs[1].bodies = {"plate", "plate"};
  EXPECT_TRUE(errors_of(d).empty());
}

TEST(build_errors, a_penalty_that_is_given_and_its_stiffness_come_together) {
  Description d = good();
  d.contact.place = line_7;
  d.contact.penalty = "given";
  expect_one(errors_of(d), {"contact.penalty is \"given\", and no stiffness is"});
  d.contact.stiffness = 5.0;
  EXPECT_TRUE(errors_of(d).empty());
  for (const char* other : {"step", "element"}) {
    d.contact.penalty = other;
    d.contact.stiffness = 5.0;
    expect_one(errors_of(d), {other, "and a stiffness is given"});
    d.contact.stiffness = -1.0;
    EXPECT_TRUE(errors_of(d).empty());
  }
}

TEST(build_errors, unknown_sets_curves_bodies_and_groups_are_named_with_the_known_ones) {
  Description d = good();
  d.fixed = {{"egde", {"x"}, line_7}};
  expect_one(errors_of(d), {"node set \"egde\"", "all, edge"});
  d = good();
  d.gravity = {{{0.0, 0.0, -9.81}, "rmap", line_7}};
  expect_one(errors_of(d), {"curve \"rmap\"", "accepted: ramp"});
  d = good();
  d.node_sets[0].bodies = {"plate", "bell"};
  d.node_sets[0].place = line_7;
  expect_one(errors_of(d), {"node set \"edge\"", "body \"bell\"", "plate, ball"});
  d = good();
  d.pressure = {{{"bell"}, "", 1.0, "", line_7}};
  expect_one(errors_of(d), {"body \"bell\"", "plate, ball"});
  d = good();
  d.contact.exclude = {{"plate", "bell"}};
  d.contact.place = line_7;
  expect_one(errors_of(d), {"contact.exclude", "body \"bell\"", "plate, ball"});
  d = good();
  d.node_sets[0].group = "rimm";
  d.node_sets[0].place = line_7;
  expect_one(errors_of(d,
                       [](std::vector<Mesh>& meshes) {
                         meshes[0].node_groups = {{"rim", {0}}, {"hub", {1}}};
                       }),
             {"group \"rimm\"", "accepted: hub, rim"});
}

TEST(build_errors, an_empty_set_shows_its_selection_and_where_the_bodies_are) {
  Description d = good();
  d.node_sets[0].box = BoxSelection{{5.0, 5.0, 5.0}, {6.0, 6.0, 6.0}};
  d.node_sets[0].place = line_7;
  expect_one(errors_of(d), {"\"edge\"", "[5, 5, 5] to [6, 6, 6]", "\"plate\" fills [0, 0, 0] to [2, 2, 0]"});
}

TEST(build_errors, a_box_whose_low_lies_above_its_high_is_told_as_such) {
  Description d = good();
  d.node_sets[0].place = line_7;
  d.node_sets[0].box = BoxSelection{{0.0, 2.0, 0.0}, {0.0, 0.0, 0.0}};
  expect_one(errors_of(d), {"the box of node set \"edge\" has a low above its high", "low <= high in x, y and z"});
}

TEST(build_errors, a_pressure_on_no_face_names_the_parts) {
  Description d = good();
  d.pressure = {{{"plate"}, "wing", 1.0, "", line_7}};
  expect_one(errors_of(d), {"no part \"wing\"", "accepted: shell"});
  d.pressure = {{{}, "", 1.0, "", line_7}};
  expect_one(errors_of(d), {"names no body", "plate, ball"});
}

TEST(build_errors, a_degree_of_freedom_held_twice_names_both_conditions) {
  Description d = good();
  d.fixed = {{"edge", {"x", "y"}, {}}};
  d.prescribed = {{"all", "z", 1.0, "", {}}, {"all", "y", 1.0, "", line_7}};
  expect_one(errors_of(d), {"set \"all\" prescribes y", "fixed by set \"edge\""});
  d.fixed.clear();
  d.prescribed = {{"edge", "z", 1.0, "", {}}, {"all", "z", 1.0, "", line_7}};
  expect_one(errors_of(d), {"set \"all\" prescribes z of node 0", "\"plate\"", "prescribed by set \"edge\""});
}

TEST(build_errors, a_direction_held_twice_in_part_is_refused_and_one_across_is_not) {
  const LocalAxes inclined{{1.0, 1.0, 0.0}, {0.0, 1.0, 0.0}};
  Description d = good();
  d.fixed = {{"edge", {"x"}, {}}};
  d.prescribed = {{"edge", "x", 1.0, "", line_7}};
  d.prescribed[0].axes = inclined;
  expect_one(errors_of(d), {"set \"edge\" prescribes x", "fixed by set \"edge\""});
  d.prescribed[0].dof = "z";
  EXPECT_TRUE(errors_of(d).empty());
  d.prescribed[0].dof = "rx";
  EXPECT_TRUE(errors_of(d).empty()) << "a rotation is no translation";
  d.fixed[0].axes = inclined;
  d.prescribed[0].dof = "y";
  EXPECT_TRUE(errors_of(d).empty()) << "at right angles";
  d.prescribed[0].axes = {};
  expect_one(errors_of(d), {"set \"edge\" prescribes y", "fixed by set \"edge\""});
}

TEST(build_errors, a_prescribed_motion_is_given_once) {
  Description d = good();
  d.prescribed = {{"edge", "x", {}, "", line_7}};
  expect_one(errors_of(d), {"set \"edge\" is given 0 prescribed motions", "one of velocity, displacement"});
  d.prescribed[0].acceleration = 1.0;
  EXPECT_TRUE(errors_of(d).empty());
  d.prescribed[0].velocity = 1.0;
  expect_one(errors_of(d), {"set \"edge\" is given 2 prescribed motions"});
}

TEST(build_errors, a_displacement_that_jumps_is_refused) {
  const auto with = [](std::vector<std::array<double, 2>> points, const std::string& curve) {
    Description d = good();
    d.curves[0].points = std::move(points);
    d.prescribed = {{"edge", "x", {}, curve, line_7}};
    d.prescribed[0].displacement = 2.0;
    return errors_of(d);
  };
  EXPECT_TRUE(with({{0.0, 0.0}, {1.0, 1.0}}, "ramp").empty());
  EXPECT_TRUE(with({{-1.0, -1.0}, {1.0, 1.0}}, "ramp").empty()) << "it passes zero";
  expect_one(with({{0.0, 0.5}, {1.0, 1.0}}, "ramp"),
             {"the displacement of set \"edge\" is 0.5 times its size at the start"});
  expect_one(with({{0.0, 0.0}, {1.0, 1.0}}, ""), {"1 times its size at the start"});
  expect_one(with({{0.0, 0.0}, {1.0, 1.0}, {1.0, 2.0}}, "ramp"), {"the displacement of set \"edge\" jumps"});
}

TEST(build_errors, axes_that_span_no_plane_are_refused) {
  const std::vector<LocalAxes> wrong{
      {{0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}, {{1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}, {{1.0, 2.0, 0.0}, {2.0, 4.0, 0.0}}};
  for (const LocalAxes& axes : wrong) {
    Description d = good();
    d.fixed = {{"edge", {"x"}, line_7, axes}};
    expect_one(errors_of(d), {"the axes of the condition on set \"edge\" span no plane"});
    d.fixed.clear();
    d.prescribed = {{"edge", "x", 1.0, "", line_7}};
    d.prescribed[0].axes = axes;
    expect_one(errors_of(d), {"span no plane"});
  }
}

TEST(build_errors, a_point_mass_on_a_set_that_is_not_there_names_those_that_are) {
  Description d = good();
  d.point_masses = {{"egde", 1.0, 0.0, false, line_7}};
  expect_one(errors_of(d), {"node set \"egde\"", "all, edge"});
}

TEST(build_errors, conditions_against_a_plane_of_symmetry_are_refused) {
  const auto with = [](const Vec3d& normal, const std::string& prescribed, const std::vector<std::string>& fixed) {
    Description d = good();
    d.symmetry = {{"edge", normal, line_7}};
    if (!prescribed.empty()) {
      d.prescribed = {{"edge", prescribed, 1.0, "", {}}};
    }
    if (!fixed.empty()) {
      d.fixed = {{"edge", fixed, {}}};
    }
    return errors_of(d);
  };
  EXPECT_TRUE(with({1.0, 0.0, 0.0}, "y", {"x", "rx"}).empty());
  EXPECT_TRUE(with({1.0, 0.0, 0.0}, "rx", {"z"}).empty());
  EXPECT_TRUE(with({1.0, 1.0, 0.0}, "z", {"rx", "ry", "rz"}).empty());
  expect_one(with({1.0, 0.0, 0.0}, "x", {}), {"\"edge\"", "prescribed against the plane of symmetry"});
  expect_one(with({1.0, 0.0, 0.0}, "rz", {}), {"prescribed against the plane of symmetry"});
  expect_one(with({1.0, 1.0, 0.0}, "", {"x"}), {"fixed against the plane of symmetry"});
}

TEST(build_errors, masses_that_are_no_positive_numbers_name_a_node_of_each_body) {
  Description d = good();
  d.bodies[0].scale = 1e-170;
  d.bodies[0].place = line_7;
  d.bodies[0].array = Array{{3, 1, 1}, {5e-170, 0.0, 0.0}};
  d.node_sets.clear();
  expect_one(errors_of(d), {"node 0 of body \"plate[0,0,0]\"", "units"});
}

TEST(build_errors, a_node_of_no_triangle_is_named_by_its_label) {
  Description d = good();
  d.bodies[0].place = line_7;
  expect_one(errors_of(d,
                       [](std::vector<Mesh>& meshes) {
                         meshes[0].position.push_back({9.0, 9.0, 9.0});
                         for (std::size_t n = 0; n < meshes[0].position.size(); ++n) {
                           meshes[0].node_label.push_back(static_cast<std::int64_t>(100 + n));
                         }
                       }),
             {"node 109", "belongs to no triangle"});
}

TEST(build_errors, conditions_on_a_part_of_a_rigid_body_are_refused) {
  Description d = good();
  d.bodies[0].rigid = true;
  d.fixed.push_back({"edge", {"x"}, line_7});
  expect_one(errors_of(d), {"\"edge\" has 3 of the 9 nodes", "\"plate\"", "rigid and held as a whole"});
  d.fixed.clear();
  d.prescribed.push_back({"edge", "x", 1.0, "", line_7});
  expect_one(errors_of(d), {"\"edge\" has 3 of the 9 nodes", "\"plate\"", "rigid and moved as a whole"});
  d.prescribed.clear();
  d.node_sets.back().box = {};
  d.fixed.push_back({"edge", {"x"}, line_7});
  EXPECT_TRUE(errors_of(d).empty()) << "all of its nodes";
  d.fixed.clear();
  d.symmetry.push_back({"edge", {0.0, 0.0, 1.0}, line_7});
  expect_one(errors_of(d), {"plane of symmetry", "\"plate\", which is rigid"});
}

TEST(build_errors, a_mass_of_a_body_that_deforms_is_refused) {
  Description d = good();
  d.bodies[1].mass = 2.0;
  d.bodies[1].place = line_7;
  expect_one(errors_of(d), {"\"ball\" is given a mass and is not rigid"});
  d.bodies[1].rigid = true;
  EXPECT_TRUE(errors_of(d).empty());
}

TEST(build_errors, independent_errors_are_reported_together) {
  Description d = good();
  d.bodies[0].section.clear();
  d.sections.push_back({"u", "wood", 0.1, {}});
  d.fixed = {{"edge", {"w"}, {}}};
  const auto errors = errors_of(d, [](std::vector<Mesh>& meshes) { meshes[1].triangle.clear(); });
  EXPECT_EQ(errors.size(), 4U);
}

}  // namespace
}  // namespace fexp::model
