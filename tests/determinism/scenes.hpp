// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "cluster/simulation.hpp"
#include "support/descriptions.hpp"

/// Small scenes that meet as much of the solver as possible in a few hundred steps.
namespace fexp::test {

inline model::CubedSphere sphere(double radius, int cells) {
  model::CubedSphere s;
  s.radius = radius;
  s.cells = cells;
  return s;
}

inline model::Plate plate(double side, int cells) {
  model::Plate p;
  p.length_x = p.length_y = side;
  p.cells_x = p.cells_y = cells;
  return p;
}

inline model::Description with_contact(double thickness) {
  model::Description d = description(rubber, thickness);
  d.contact.enabled = true;
  d.run.epoch_steps = 16;
  return d;
}

/// Two pairs of spheres that meet, rebound and part. Each is large enough for several pieces of parallel work.
inline model::Description two_pairs_of_spheres() {
  model::Description d = with_contact(0.02);
  for (int i = 0; i < 4; ++i) {
    model::BodyDescription& body = add_body(d, "sphere " + std::to_string(i), sphere(0.5, 7));
    const double side = i % 2 == 0 ? -1.0 : 1.0;
    body.translate = {0.8 * side, i / 2 * 2.5, 0.03 * side};
    body.velocity = {-6.0 * side, 0.5 * side, 0.1 * i};
    body.angular_velocity = {0.0, 2.0 * side, 1.0};
  }
  return d;
}

/// Plates that sag under their weight until they rest, side by side, one of them on a fixed one. How all of them move
/// sets the damping of each.
inline model::Description resting_plates(const std::string& relaxation) {
  model::Description d = with_contact(0.02);
  d.run.relaxation = relaxation;
  d.run.analysis = "static";
  for (int i = 0; i < 3; ++i) {
    add_body(d, "plate " + std::to_string(i), plate(1.0 + 0.2 * i, 6 + 8 * i)).translate = {0.0, 3.0 * i, 0.0};
  }
  add_body(d, "table", plate(1.2, 5)).translate = {-0.1, -0.1, -0.022};
  d.node_sets.emplace_back().name = "rim";
  d.node_sets.back().bodies = {"plate 0", "plate 1", "plate 2", "table"};
  d.node_sets.back().boundary = true;
  fix(d, "rim", {"x", "y", "z"});
  d.node_sets.emplace_back().name = "table";
  d.node_sets.back().bodies = {"table"};
  fix(d, "table", {"x", "y", "z", "rx", "ry", "rz"});
  d.gravity.push_back({{0.0, 0.0, -9.81}, "", {}});
  return d;
}

inline model::Description plates_at_rest() { return resting_plates("automatic"); }

/// The same in jerks: all motion is stopped again and again, of a rigid body that is turned on the plates as well.
inline model::Description plates_that_stop() {
  model::Description d = resting_plates("kinetic");
  model::BodyDescription& block = add_body(d, "block", plate(0.4, 4));
  block.rigid = true;
  block.translate = {0.3, 0.3, 0.021};
  d.node_sets.emplace_back().name = "block";
  d.node_sets.back().bodies = {"block"};
  d.prescribed.push_back({"block", "rz", 0.5, "", {}});
  return d;
}

/// A sphere thrown onto a plate with a clamped and a driven edge, one that slides at an angle and one that is moved so
/// and carries a mass, everything under gravity and pressure with curves, a rigid plane below. Some elements have mass
/// added. The load that sets in suddenly has epochs rolled back.
inline model::Description sphere_on_plate() {
  model::Description d = with_contact(0.02);
  add_body(d, "plate", plate(2.0, 20));
  model::BodyDescription& ball = add_body(d, "ball", sphere(0.4, 8));
  ball.translate = {0.9, 1.1, 0.43};
  ball.velocity = {0.5, 0.0, -4.0};
  ball.rotate.push_back({{1.0, 1.0, 0.0}, 20.0, {0.9, 1.1, 0.0}});
  d.curves.push_back({"blow", {{0.0, 0.0}, {0.02, 0.1}, {0.021, 40.0}, {0.05, 0.0}}, {}});
  d.gravity.push_back({{0.0, 0.0, -9.81}, "", {}});
  d.gravity.push_back({{3.0, -2.0, -60.0}, "blow", {}});
  d.pressure.push_back({{"ball"}, "", 20.0, "blow", {}});
  d.planes.push_back({{"floor"}, {0.0, 0.0, -0.05}, {0.0, 0.1, 1.0}});
  add_box_set(d, "left", {-0.01, -0.01, -0.01}, {0.01, 2.01, 0.01});
  add_box_set(d, "right", {1.99, -0.01, -0.01}, {2.01, 2.01, 0.01});
  fix(d, "left", {"x", "y", "z", "rx", "ry", "rz"});
  d.prescribed.push_back({"right", "z", -0.3, "blow", {}});
  d.symmetry.push_back({"right", {0.0, 1.0, 0.0}, {}});
  add_box_set(d, "low", {0.15, -0.01, -0.01}, {1.85, 0.01, 0.01});
  add_box_set(d, "high", {0.15, 1.99, -0.01}, {1.85, 2.01, 0.01});
  const model::LocalAxes axes{{1.0, 0.0, 2.0}, {0.0, 1.0, 0.0}};
  d.fixed.push_back({"low", {"x", "rz"}, {}, axes});
  d.curves.push_back({"push", {{0.0, 0.0}, {0.03, 1.0}, {0.05, 0.7}}, {}});
  model::Prescribed push{"high", "z", {}, "push", {}};
  push.displacement = 0.02;
  push.axes = axes;
  d.prescribed.push_back(push);
  d.point_masses.push_back({"high", 2.0, 0.01, true, {}});
  d.run.minimum_step = 1.3e-3;
  d.run.damping = 2.0;
  d.run.energy_drift_limit = 1.0;
  return d;
}

/// A tube thrown against a plane so hard that its inner side meets itself.
inline model::Description tube_that_folds() {
  model::Description d = with_contact(0.03);
  d.contact.friction = 0.2;
  d.contact.damping = 0.1;
  model::Cylinder mesh;
  mesh.radius = 0.3;
  mesh.length = 1.0;
  mesh.cells_around = 40;
  mesh.cells_along = 14;
  model::BodyDescription& tube = add_body(d, "tube", mesh);
  tube.rotate.push_back({{1.0, 0.0, 0.0}, 90.0, {}});
  tube.translate = {0.0, 0.0, 0.33};
  tube.velocity = {0.0, 0.0, -14.0};
  d.planes.push_back({{"ground"}, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}});
  d.run.energy_drift_limit = 1.0;
  return d;
}

/// Many small spheres on their way to each other: islands join and part, bodies are shared out among threads.
inline model::Description swarm() {
  model::Description d = with_contact(0.02);
  d.run.epoch_steps = 4;
  for (int i = 0; i < 27; ++i) {
    model::BodyDescription& body = add_body(d, "sphere " + std::to_string(i), sphere(0.2, 2));
    const Vec3d place{0.6 * (i % 3 - 1), 0.6 * (i / 3 % 3 - 1), 0.6 * (i / 9 - 1)};
    body.translate = place;
    body.velocity = -6.0 * place;
    body.angular_velocity = {1.0, 0.3 * i, -2.0};
  }
  return d;
}

/// A shell of metal that buckles against a plate of another one, fast enough for both to flow everywhere, with all
/// kinds of hardening: parts of the plate harden by a table and linearly, and the law of the ball depends on the rate.
inline model::Description metals() {
  model::Description d = with_contact(0.01);
  d.contact.friction = 0.3;
  d.run.energy_drift_limit = 1.0;
  const physics::J2Law lead{1.0e3, 1.0e6, 0.4};
  physics::JohnsonCook fast;
  static_cast<physics::J2Power&>(fast) = physics::J2Power{{1.0e3, 1.0e6, 0.4, 0.05, 0.1}, 3.0e3, 4.0e3, 0.3};
  physics::J2Table table{lead, {}};
  table.table.append({0.0, 2.0e3});
  table.table.append({0.01, 4.0e3});
  table.table.append({0.05, 4.5e3});
  d.materials[0].law = fast;
  d.materials.push_back({"table", table, {}});
  d.materials.push_back({"linear", physics::J2Linear{lead, 3.0e3, 1.0e4}, {}});
  d.sections[0].points = 3;
  d.sections.push_back({"table", "table", 0.01, {}, 5, "lobatto"});
  d.sections.push_back({"linear", "linear", 0.012, {}, 2, "gauss"});
  model::BodyDescription& ball = add_body(d, "ball", sphere(0.4, 7));
  ball.translate = {0.05, 0.02, 0.43};
  ball.velocity = {0.5, 0.0, -5.0};
  for (const char* name : {"table", "linear"}) {
    model::BodyDescription& half = add_body(d, name, plate(1.0, 12));
    half.section = name;
    half.translate = {name[0] == 't' ? -1.05 : 0.0, -0.5, 0.0};
    half.angular_velocity = {0.0, 0.0, 1.0};
  }
  return d;
}

/// The same of metals that heat, with rates that are filtered; one half of the plate melts and fails where it is hit.
inline model::Description hot_metals() {
  model::Description d = metals();
  auto& fast = std::get<physics::JohnsonCook>(d.materials[0].law);
  fast.heating = physics::AdiabaticHeating{1.0, 20.0, 0.0, 1.0, 1.1};
  fast.rate_cutoff = 50.0;
  auto& table = std::get<physics::J2Table>(d.materials[1].law);
  table.heating = physics::AdiabaticHeating{0.1, 10.0, 0.0, 0.0};
  table.failure_strain = 0.3;
  auto& linear = std::get<physics::J2Linear>(d.materials[2].law);
  linear.cowper_symonds = physics::CowperSymonds{10.0, 4.0};
  linear.rate_cutoff = 200.0;
  return d;
}

/// A ball of metal that is shot through a plate, whose elements fail and are deleted, and meets itself.
inline model::Description shot() {
  model::Description d = with_contact(0.01);
  d.run.energy_drift_limit = 1.0;
  d.run.step_collapse = 0.0;
  physics::J2Law metal{1.0e3, 1.0e6, 0.3};
  physics::J2Law brittle = metal;
  brittle.failure_strain = 0.15;
  d.materials[0].law = physics::J2Linear{metal, 2.0e4, 1.0e4};
  d.materials.push_back({"brittle", physics::J2Power{brittle, 2.0e3, 3.0e3, 0.5}, {}});
  d.sections[0].points = 3;
  d.sections.push_back({"brittle", "brittle", 0.01, {}, 2, "gauss"});
  model::BodyDescription& ball = add_body(d, "ball", sphere(0.25, 4));
  ball.translate = {0.03, 0.02, 0.27};
  ball.velocity = {1.0, 0.0, -25.0};
  model::BodyDescription& sheet = add_body(d, "sheet", plate(1.2, 14));
  sheet.section = "brittle";
  sheet.translate = {-0.6, -0.6, 0.0};
  d.pressure.push_back({{"sheet"}, "", 50.0, "", {}});
  return d;
}

/// The same, damped by mass and stiffness.
inline model::Description damped_shot() {
  model::Description d = shot();
  d.run.stiffness_damping = 2.0e-4;
  d.run.damping = 3.0;
  return d;
}

/// A rigid ball and a rigid box, which tumble, meet each other and a soft sphere. Nothing acts from outside. The
/// penalty is stiff enough to stop bodies that do not give way.
inline model::Description rigid_and_soft() {
  model::Description d = with_contact(0.02);
  d.contact.penalty_scale = 20.0;
  d.run.safety = 0.25;
  for (int i = 0; i < 3; ++i) {
    const model::MeshGenerator mesh =
        i == 1 ? model::MeshGenerator(model::SquareTube{0.6, 0.9, 6, 9}) : model::MeshGenerator(sphere(0.4, 7));
    model::BodyDescription& body = add_body(d, "body " + std::to_string(i), mesh);
    body.rigid = i < 2;
    body.translate = {0.8 * (i - 1), i == 1 ? -0.1 : 0.05 * i, i == 1 ? -0.45 : 0.0};
    body.velocity = {-2.0 * (i - 1), 0.3 * i, 0.0};
    body.angular_velocity = {3.0 - i, 2.0 * i, 5.0};
  }
  return d;
}

/// Rigid bodies that are loaded, driven and held: a ball of given mass thrown onto a damped plate under gravity between
/// walls of all shapes that move, and a stamp that is lowered by a curve and turned, and may slide in one direction.
inline model::Description rigid_machine() {
  model::Description d = with_contact(0.02);
  d.contact.friction = 0.1;
  d.contact.damping = 0.2;
  d.contact.penalty_scale = 4.0;
  d.run.safety = 0.25;
  model::BodyDescription& ball = add_body(d, "ball", sphere(0.3, 8));
  ball.rigid = true;
  ball.mass = 40.0;
  ball.translate = {0.5, 0.5, 0.34};
  ball.velocity = {0.5, 0.0, -6.0};
  ball.angular_velocity = {3.0, -2.0, 9.0};
  add_body(d, "plate", plate(2.0, 20));
  model::BodyDescription& stamp = add_body(d, "stamp", plate(0.8, 9));
  stamp.rigid = true;
  stamp.translate = {1.05, 1.05, 0.06};
  d.node_sets.emplace_back().name = "stamp";
  d.node_sets.back().bodies = {"stamp"};
  d.node_sets.emplace_back().name = "rim";
  d.node_sets.back().boundary = true;
  d.node_sets.back().bodies = {"plate"};
  fix(d, "rim", {"x", "y", "z"});
  fix(d, "stamp", {"y", "rx"});
  d.curves.push_back({"press", {{0.0, 0.0}, {0.05, 1.0}}, {}});
  model::Prescribed down{"stamp", "z", {}, "press", {}};
  down.displacement = -0.15;
  model::Prescribed turn{"stamp", "rz", {}, "press", {}};
  turn.displacement = 0.4;
  d.prescribed = {down, turn};
  d.gravity.push_back({{0.0, 0.0, -9.81}, "", {}});
  d.pressure.push_back({{"ball"}, "", 30.0, "press", {}});
  d.planes.push_back({{"floor"}, {0.0, 0.0, -0.05}, {0.0, 0.1, 1.0}});
  d.planes.back().displacement = {0.0, 0.0, 0.04};
  d.planes.back().curve = "press";
  model::RigidSphere& bowl = d.spheres.emplace_back();
  bowl.name = "bowl";
  bowl.centre = {1.0, 1.0, 0.4};
  bowl.radius = 1.6;
  bowl.inside = true;
  bowl.velocity = {2.0, 0.0, 0.0};
  model::RigidCylinder& roll = d.cylinders.emplace_back();
  roll.name = "roll";
  roll.point = {-0.05, 0.3, 0.3};
  roll.axis = {0.1, 1.0, 0.0};
  roll.radius = 0.2;
  roll.displacement = {0.0, 0.0, -0.15};
  roll.curve = "press";
  d.run.damping = 1.0;
  d.run.energy_drift_limit = 1.0;
  return d;
}

/// Walls with mass that rub: a table at rest on which a soft and a rigid ball fall, and high above two soft balls with
/// a heavy sphere between them, one of which it throws down to the others.
inline model::Description walls_with_mass() {
  model::Description d = with_contact(0.02);
  d.contact.friction = 0.2;
  d.contact.damping = 0.1;
  const std::vector<Vec3d> places{{0.0, 0.0, 0.35}, {1.2, 0.0, 0.37}, {0.1, 0.0, 1.75}, {0.0, 0.1, 2.9}};
  for (std::size_t i = 0; i < places.size(); ++i) {
    model::BodyDescription& ball = add_body(d, "ball " + std::to_string(i), sphere(0.3, i == 0 ? 7 : 4));
    ball.translate = places[i];
    ball.rigid = i == 1;
    ball.velocity = {0.3, 0.0, i < 2 ? -5.0 : 0.0};
    ball.angular_velocity = {0.0, 3.0, 0.0};
  }
  model::RigidPlane& table = d.planes.emplace_back();
  table.name = "table";
  table.normal = {0.0, 0.1, 1.0};
  table.mass = 30.0;
  table.free = {"x", "y", "z"};
  model::RigidSphere& shot = d.spheres.emplace_back();
  shot.name = "shot";
  shot.centre = {0.0, 0.0, 2.3};
  shot.radius = 0.2;
  shot.mass = 60.0;
  shot.initial_velocity = {0.0, 0.0, -15.0};
  shot.force = {0.0, 50.0, 0.0};
  d.gravity.push_back({{0.0, 0.0, -9.81}, "", {}});
  d.run.energy_drift_limit = 1.0;
  return d;
}

/// A doubler that is glued on a panel, which a ball tears off in part, and a strap that hangs as by hinges on a block
/// that is held, until its weight is too much. Two glued plates far away spin apart.
inline model::Description torn_panel() {
  model::Description d = with_contact(0.02);
  const auto glue = [&](const std::string& body, const std::string& surface, double normal, double shear) {
    d.node_sets.emplace_back().name = body;
    d.node_sets.back().bodies = {body};
    model::TieDescription& tie = d.ties.emplace_back();
    tie.name = tie.set = body;
    tie.surface = {surface};
    tie.strength_normal = normal;
    tie.strength_shear = shear;
  };
  add_body(d, "panel", plate(1.2, 12));
  add_body(d, "doubler", plate(0.6, 8)).translate = {0.3, 0.3, 0.02};
  add_body(d, "block", plate(0.5, 3)).translate = {2.0, 0.0, 0.0};
  add_body(d, "strap", plate(0.3, 5)).translate = {2.1, 0.1, -0.02};
  model::BodyDescription& ball = add_body(d, "ball", sphere(0.3, 6));
  ball.translate = {0.5, 0.5, -0.33};
  ball.velocity = {0.5, 0.0, 8.0};
  add_body(d, "lower", plate(0.6, 6)).translate = {5.0, 0.0, 0.0};
  add_body(d, "upper", plate(0.4, 5)).translate = {5.4, 0.1, 0.02};
  d.bodies[5].angular_velocity = d.bodies[6].angular_velocity = {0.0, 2.0, 40.0};
  d.bodies[6].velocity = {0.04, 12.0, -0.6};
  glue("doubler", "panel", 6.0e4, 4.0e4);
  glue("strap", "block", 3.0e3, 3.0e3);
  d.ties.back().rotations = false;
  glue("upper", "lower", 1.0e3, 1.0e3);
  d.node_sets.emplace_back().name = "block";
  d.node_sets.back().bodies = {"block"};
  fix(d, "block", {"x", "y", "z", "rx", "ry", "rz"});
  d.curves.push_back({"jerk", {{0.0, 0.0}, {0.1, 1.0}}, {}});
  d.gravity.push_back({{0.0, 0.0, -200.0}, "jerk", {}});
  add_box_set(d, "rim", {-0.01, -0.01, -0.01}, {0.01, 1.21, 0.01});
  fix(d, "rim", {"x", "y", "z"});
  d.run.energy_drift_limit = 1.0;
  return d;
}

/// What must be the same however a scene is computed, and what proves that the scene is worth computing.
/// A panel with a web welded to it, a flap that hangs on it by a hinge and on a rigid block at the other end; the panel
/// is driven along one edge and hit by a ball.
inline model::Description tied_panel() {
  model::Description d = with_contact(0.02);
  const auto seam = [&](const std::string& name, const std::string& body, const Vec3d& low, const Vec3d& high,
                        const std::string& surface) -> model::TieDescription& {
    add_box_set(d, name, low, high);
    d.node_sets.back().bodies = {body};
    model::TieDescription& tie = d.ties.emplace_back();
    tie.name = tie.set = name;
    tie.surface = {surface};
    return tie;
  };
  add_body(d, "panel", plate(1.2, 16));
  model::BodyDescription& web = add_body(d, "web", plate(0.8, 12));
  web.rotate.push_back({{1.0, 0.0, 0.0}, 90.0, {}});
  web.translate = {0.2, 0.63, 0.01};
  add_body(d, "flap", plate(0.6, 5)).translate = {1.2, 0.3, 0.0};
  model::BodyDescription& block = add_body(d, "block", plate(0.4, 4));
  block.translate = {1.8, 0.4, 0.0};
  block.rigid = true;
  model::BodyDescription& ball = add_body(d, "ball", sphere(0.3, 6));
  ball.translate = {0.5, 0.4, -0.33};
  ball.velocity = {0.5, 0.0, 5.0};
  seam("weld", "web", {-1.0, -1.0, 0.0}, {3.0, 3.0, 0.02}, "panel");
  seam("hinge", "flap", {1.19, -1.0, -1.0}, {1.21, 3.0, 1.0}, "panel").rotations = false;
  seam("end", "flap", {1.79, -1.0, -1.0}, {1.81, 3.0, 1.0}, "block");
  d.gravity.push_back({{0.0, 0.0, -9.81}, "", {}});
  d.curves.push_back({"shake", {{0.0, 0.0}, {0.02, 1.0}, {0.05, -1.0}, {0.1, 0.0}}, {}});
  add_box_set(d, "rim", {-0.01, -0.01, -0.01}, {0.01, 1.21, 0.01});
  d.prescribed.push_back({"rim", "z", 1.0, "shake", {}});
  return d;
}

struct Outcome {
  std::uint64_t state_hash{};
  std::vector<solve::HashRecord> hashes;
  cluster::RunExtremes extremes;
  double plastic_strain{};  ///< Largest at the end [-]
  double temperature{};     ///< Likewise [temperature]
  Index deleted{};          ///< At the end
  double damping{};         ///< Energy that stiffness damping has taken in all
  int stops{};              ///< Epochs after which motion was stopped
  std::int64_t broken{};    ///< Ties at the end
  std::size_t own_sides{};  ///< Sides between nodes and triangles of one body, seen at ends of epochs
};

inline Outcome run_scene(const model::Model& model, double duration, solve::KernelChoice kernel,
                         std::int64_t hash_every = 16) {
  cluster::Simulation simulation(model, kernel);
  Outcome outcome;
  while (simulation.state().time < duration) {
    const cluster::EpochReport report = simulation.run_epoch(duration, hash_every);
    EXPECT_EQ(report.fault.kind, cluster::FaultKind::none) << report.fault.message;
    if (report.fault.kind != cluster::FaultKind::none) {
      break;
    }
    outcome.hashes.insert(outcome.hashes.end(), report.hashes.begin(), report.hashes.end());
    outcome.stops += simulation.relaxation().stops() ? 1 : 0;
    for (const auto& sides : simulation.state().sides) {
      for (const model::ContactSide& side : sides) {
        const Index body = model.blocks[at(model.element_block[at(side.element)])].body;
        outcome.own_sides += model.node_body[at(side.node)] == body ? 1U : 0U;
      }
    }
  }
  for (Index e = 0; e < model.element_count(); ++e) {
    outcome.damping += model.run.stiffness_damping > 0.0 ? model::damping_work(model, simulation.state(), e) : 0.0;
    outcome.deleted += model::is_deleted(model, simulation.state().layers.data(), e) ? 1 : 0;
    const physics::LayeredSection& section = model.section_of(e).layered;
    for (Index p = 0; p < section.points.count; ++p) {
      if (section.plasticity.heat.heats()) {
        outcome.temperature =
            std::max(outcome.temperature, model::layer_value(model, simulation.state(), e, section.temperature_row(p)));
      }
      const Index row = physics::layer_points + p * physics::point_rows + physics::point_strain;
      outcome.plastic_strain = std::max(outcome.plastic_strain, model::layer_value(model, simulation.state(), e, row));
    }
  }
  for (const model::TieState& tie : simulation.state().ties) {
    outcome.broken += tie.broken;
  }
  outcome.state_hash = model::state_hash(model, simulation.state());
  outcome.extremes = simulation.extremes();
  return outcome;
}

}  // namespace fexp::test
