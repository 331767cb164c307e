// SPDX-License-Identifier: Apache-2.0
#include "app/histories.hpp"

#include <algorithm>
#include <set>

#include "app/tie_history.hpp"
#include "solve/diagnostics.hpp"

namespace fexp::app {

namespace {

using io::Cell;
using io::Column;

constexpr const char* energy = "force*length";
constexpr const char* momentum = "force*time";
constexpr const char* angular_momentum = "force*length*time";

/// Columns that every history begins with.
std::vector<Column> first_columns(const io::UnitNames& units) { return {{"step", ""}, {"time", units.of("time")}}; }

std::vector<Column> energy_columns(const io::UnitNames& units) {
  std::vector<Column> columns = first_columns(units);
  for (const char* name :
       {"kinetic", "internal", "contact", "barrier", "external", "damping", "friction", "dissipated", "balance"}) {
    columns.push_back({name, units.of(energy)});
  }
  columns.push_back({"relative_error", ""});
  return columns;
}

std::vector<Column> momenta_columns(const io::UnitNames& units) {
  std::vector<Column> columns = first_columns(units);
  io::add_vector_columns(columns, "linear", units.of(momentum));
  io::add_vector_columns(columns, "angular", units.of(angular_momentum));
  io::add_vector_columns(columns, "external_impulse", units.of(momentum));
  io::add_vector_columns(columns, "external_angular_impulse", units.of(angular_momentum));
  columns.push_back({"linear_relative_error", ""});
  columns.push_back({"angular_relative_error", ""});
  return columns;
}

std::vector<Column> steps_columns(const io::UnitNames& units) {
  std::vector<Column> columns = first_columns(units);
  columns.push_back({"dt", units.of("time")});
  columns.push_back({"critical_step", units.of("time")});
  for (const char* name : {"islands", "largest_island_elements", "candidates", "contacts", "searches", "rollbacks",
                           "deepest_penetration", "deleted"}) {
    columns.push_back({name, ""});
  }
  return columns;
}

std::vector<Column> walls_columns(const io::UnitNames& units, const model::Model& model) {
  std::vector<Column> columns = first_columns(units);
  for (const model::Wall& wall : model.walls) {
    io::add_vector_columns(columns, wall.name, units.of("force"));
    if (wall.body != no_index) {
      io::add_vector_columns(columns, wall.name + "_displacement", units.of("length"));
      io::add_vector_columns(columns, wall.name + "_velocity", units.of("length/time"));
    }
  }
  return columns;
}

std::vector<Column> nodes_columns(const io::UnitNames& units) {
  std::vector<Column> columns = first_columns(units);
  columns.insert(columns.end(), {{"set", ""}, {"body", ""}, {"node", ""}});
  io::add_vector_columns(columns, "displacement", units.of("length"));
  io::add_vector_columns(columns, "velocity", units.of("length/time"));
  io::add_vector_columns(columns, "acceleration", units.of("length/time^2"));
  io::add_vector_columns(columns, "rotation_rate", units.of("1/time"));
  io::add_vector_columns(columns, "contact_force", units.of("force"));
  return columns;
}

std::vector<Column> bodies_columns(const io::UnitNames& units) {
  std::vector<Column> columns = first_columns(units);
  columns.push_back({"body", ""});
  io::add_vector_columns(columns, "centre", units.of("length"));
  io::add_vector_columns(columns, "velocity", units.of("length/time"));
  io::add_vector_columns(columns, "spin", units.of(angular_momentum));
  io::add_vector_columns(columns, "contact_force", units.of("force"));
  for (const char* name : {"kinetic", "internal", "contact", "barrier", "external", "damping", "friction"}) {
    columns.push_back({name, units.of(energy)});
  }
  return columns;
}

std::vector<Cell> first_cells(const model::State& state) { return {Cell(state.step), Cell(state.time)}; }

Cell count(std::int64_t value) { return {value}; }

bool is_named(const model::Body& body, const std::vector<std::string>& names) {
  return std::ranges::any_of(names, [&](const std::string& name) { return name == body.name || name == body.family; });
}

/// The body's centre of mass, the velocity of that and the contact force on the body, summed in the order of its nodes.
struct BodySums {
  Vec3d centre;
  Vec3d velocity;  ///< Ties give its momentum to others, or those of others to it
  Vec3d contact_force;
};

BodySums sums_of(const cluster::Simulation& simulation, const model::Body& body) {
  const model::Model& model = simulation.model();
  BodySums sums;
  for (Index n = body.nodes.begin; n < body.nodes.end; ++n) {
    const model::NodeMotion& motion = simulation.state().motion[at(n)];
    sums.centre += (model.mass[at(n)] / body.mass) * motion.position;
    sums.velocity += (model.mass[at(n)] / body.mass) * motion.velocity;
    sums.contact_force += simulation.workspace().contact.force[at(n)];
  }
  return sums;
}

io::CsvWriter open(std::filesystem::path path, std::vector<Column> columns, const OutputMark* mark) {
  if (mark == nullptr) {
    return {std::move(path), std::move(columns)};
  }
  const std::uint64_t bytes = mark->bytes_of(path);
  return io::CsvWriter::resume(std::move(path), std::move(columns), bytes);
}

}  // namespace

Histories::Histories(const io::RunDirectory& directory, const Case& loaded, const OutputMark* mark)
    : model_(loaded.model),
      energies_(open(directory.history("energies"), energy_columns(loaded.deck.units), mark)),
      momenta_(open(directory.history("momenta"), momenta_columns(loaded.deck.units), mark)),
      steps_(open(directory.history("steps"), steps_columns(loaded.deck.units), mark)),
      element_history_(model_, loaded.deck.output.elements) {
  const io::UnitNames& units = loaded.deck.units;
  const io::OutputSettings& output = loaded.deck.output;
  for (const model::NamedNodes& set : model_.node_sets) {
    if (std::ranges::find(output.nodes, set.name) != output.nodes.end()) {
      sets_.push_back(&set);
    }
  }
  for (Index b = 0; b < model_.body_count(); ++b) {
    if (is_named(model_.bodies[at(b)], output.bodies)) {
      chosen_.push_back(b);
    }
  }
  if (!model_.walls.empty()) {
    walls_ = open(directory.history("walls"), walls_columns(units, model_), mark);
  }
  if (!model_.ties.empty()) {
    ties_ = open(directory.history("ties"), tie_columns(model_, units), mark);
  }
  if (!sets_.empty()) {
    nodes_ = open(directory.history("nodes"), nodes_columns(units), mark);
  }
  if (!element_history_.empty()) {
    elements_ = open(directory.history("elements"), ElementHistory::columns(units), mark);
  }
  if (!chosen_.empty()) {
    bodies_ = open(directory.history("bodies"), bodies_columns(units), mark);
  }
  if (mark != nullptr) {
    searches_ = mark->searches;
    rollbacks_ = mark->rollbacks;
    deepest_ = mark->deepest;
  }
}

std::vector<Index> Histories::bodies_needed(const Case& loaded) {
  const model::Model& model = loaded.model;
  const io::OutputSettings& output = loaded.deck.output;
  const std::vector<Index> of_elements = ElementHistory(model, output.elements).bodies();
  std::set<Index> bodies(of_elements.begin(), of_elements.end());
  const std::vector<Index> of_ties = bodies_of_ties(model);
  bodies.insert(of_ties.begin(), of_ties.end());
  for (const model::NamedNodes& set : model.node_sets) {
    if (std::ranges::find(output.nodes, set.name) != output.nodes.end()) {
      for (const Index node : set.nodes) {
        bodies.insert(model.node_body[at(node)]);
      }
    }
  }
  for (Index b = 0; b < model.body_count(); ++b) {
    if (model.bodies[at(b)].wall != no_index || is_named(model.bodies[at(b)], output.bodies)) {
      bodies.insert(b);
    }
  }
  return {bodies.begin(), bodies.end()};
}

void Histories::add(const cluster::EpochReport& report) {
  searches_ += report.searches;
  rollbacks_ += report.rollbacks;
  deepest_ = std::max(deepest_, report.deepest);
}

void Histories::write(const cluster::Simulation& simulation, const cluster::EpochReport& report) {
  write_energies(simulation, report);
  write_momenta(simulation, report);
  write_steps(simulation, report);
  write_walls(simulation);
  if (ties_) {
    write_ties(model_, simulation.state(), *ties_);
  }
  write_nodes(simulation);
  if (elements_) {
    element_history_.write(simulation.state(), *elements_);
  }
  write_bodies(simulation);
}

void Histories::write_energies(const cluster::Simulation& simulation, const cluster::EpochReport& report) {
  const solve::Energies& e = report.diagnostics.energies;
  energies_.row({Cell(simulation.state().step), simulation.state().time, e.kinetic, e.internal, e.contact, e.barrier,
                 e.external, e.damping, e.friction, e.dissipated, e.balance(), report.energy_error});
}

void Histories::write_momenta(const cluster::Simulation& simulation, const cluster::EpochReport& report) {
  const solve::Momenta& m = report.diagnostics.momenta;
  std::vector<Cell> cells = first_cells(simulation.state());
  io::add_vector_cells(cells, m.linear);
  io::add_vector_cells(cells, m.angular);
  io::add_vector_cells(cells, m.external_impulse);
  io::add_vector_cells(cells, m.external_angular_impulse);
  cells.insert(cells.end(), {Cell(report.linear_momentum_error), Cell(report.angular_momentum_error)});
  momenta_.row(cells);
}

void Histories::write_steps(const cluster::Simulation& simulation, const cluster::EpochReport& report) {
  steps_.row({Cell(simulation.state().step), simulation.state().time, report.dt, report.critical.step,
              count(report.islands), count(report.largest_island_elements), count(report.candidates),
              count(report.active_pairs), searches_, rollbacks_, deepest_, count(report.diagnostics.deleted)});
  searches_ = rollbacks_ = 0;
  deepest_ = 0.0;
}

void Histories::write_walls(const cluster::Simulation& simulation) {
  if (!walls_) {
    return;
  }
  std::vector<Cell> cells = first_cells(simulation.state());
  for (std::size_t w = 0; w < model_.walls.size(); ++w) {
    const model::Wall& wall = model_.walls[w];
    Vec3d force;
    for (Index b = 0; b < model_.meshed_body_count(); ++b) {
      force += simulation.workspace().actions[at(b)].wall_force[w];
    }
    io::add_vector_cells(cells, force);
    if (wall.body != no_index) {
      const Index node = model_.bodies[at(wall.body)].nodes.begin;
      const model::NodeMotion& motion = simulation.state().motion[at(node)];
      io::add_vector_cells(cells, motion.position - model_.reference_position[at(node)]);
      io::add_vector_cells(cells, motion.velocity);
    }
  }
  walls_->row(cells);
}

void Histories::write_nodes(const cluster::Simulation& simulation) {
  const model::State& state = simulation.state();
  for (const model::NamedNodes* set : sets_) {
    for (const Index n : set->nodes) {
      const model::NodeMotion& motion = state.motion[at(n)];
      std::vector<Cell> cells = first_cells(state);
      cells.insert(cells.end(), {Cell(std::string_view(set->name)),
                                 Cell(std::string_view(model_.bodies[at(model_.node_body[at(n)])].name)),
                                 Cell(model_.node_label[at(n)])});
      io::add_vector_cells(cells, motion.position - model_.reference_position[at(n)]);
      io::add_vector_cells(cells, motion.velocity);
      io::add_vector_cells(cells, state.acceleration[at(n)].linear);
      io::add_vector_cells(cells, motion.rotation_rate);
      io::add_vector_cells(cells, simulation.workspace().contact.force[at(n)]);
      nodes_->row(cells);
    }
  }
}

void Histories::write_bodies(const cluster::Simulation& simulation) {
  for (const Index b : chosen_) {
    const model::Body& body = model_.bodies[at(b)];
    const solve::Diagnostics diagnostics = solve::body_diagnostics(model_, simulation.state(), b);
    const BodySums sums = sums_of(simulation, body);
    std::vector<Cell> cells = first_cells(simulation.state());
    cells.emplace_back(std::string_view(body.name));
    io::add_vector_cells(cells, sums.centre);
    io::add_vector_cells(cells, model_.ties.empty() ? (1.0 / body.mass) * diagnostics.momenta.linear : sums.velocity);
    // About the centre of mass.
    io::add_vector_cells(cells, diagnostics.momenta.angular - cross(sums.centre, diagnostics.momenta.linear));
    io::add_vector_cells(cells, sums.contact_force);
    const solve::Energies& e = diagnostics.energies;
    cells.insert(cells.end(), {e.kinetic, e.internal, e.contact, e.barrier, e.external, e.damping, e.friction});
    bodies_->row(cells);
  }
}

std::vector<io::CsvWriter*> Histories::files() {
  std::vector<io::CsvWriter*> all{&energies_, &momenta_, &steps_};
  for (std::optional<io::CsvWriter>* file : {&walls_, &ties_, &nodes_, &elements_, &bodies_}) {
    if (*file) {
      all.push_back(&**file);
    }
  }
  return all;
}

void Histories::flush() {
  for (io::CsvWriter* file : files()) {
    file->flush();
  }
}

void Histories::sync() {
  for (io::CsvWriter* file : files()) {
    file->sync();
  }
}

void Histories::mark(OutputMark& mark) {
  for (const io::CsvWriter* file : files()) {
    mark.note(file->path(), file->bytes());
  }
  mark.searches = searches_;
  mark.rollbacks = rollbacks_;
  mark.deepest = deepest_;
}

void Histories::close() {
  for (io::CsvWriter* file : files()) {
    file->close();
  }
}

}  // namespace fexp::app
