// SPDX-License-Identifier: Apache-2.0
#include "model/state.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <utility>

#include "base/hash.hpp"
#include "model/tie_motion.hpp"
#include "parallel/parallel.hpp"

namespace fexp::model {

namespace {

static_assert(std::endian::native == std::endian::little, "the canonical bytes are written as they stand in memory");

/// Fills bytes that are already there, front to back.
class Writer {
 public:
  explicit Writer(std::byte* next) : next_(next) {}

  template <class T>
  void write(const T* records, std::size_t count) {
    if (count > 0) {  // Else there may be no records to point to
      std::memcpy(next_, records, count * sizeof(T));
    }
    next_ += count * sizeof(T);
  }

 private:
  std::byte* next_;
};

/// Takes bytes front to back; whoever reads has made sure that there are enough.
class Reader {
 public:
  explicit Reader(const std::byte* next) : next_(next) {}

  template <class T>
  void read(T* records, std::size_t count) {
    if (count > 0) {
      std::memcpy(records, next_, count * sizeof(T));
    }
    next_ += count * sizeof(T);
  }

 private:
  const std::byte* next_;
};

// Records of doubles alone have no padding and are copied whole.
static_assert(sizeof(NodeMotion) == 9 * sizeof(double) && sizeof(NodeAcceleration) == 6 * sizeof(double));
static_assert(sizeof(BodyLedger) == 13 * sizeof(double));
static_assert(sizeof(RigidMotion) == 19 * sizeof(double));
static_assert(sizeof(NodeInertia) == 2 * sizeof(double));
// Six doubles and a number of 64 bits.
static_assert(sizeof(TieState) == 7 * sizeof(double));

std::size_t row_offset(Index block, Index row) { return (at(block) * element_rows + at(row)) * at(block_lanes); }

/// Of a remembered side of either kind.
constexpr std::size_t side_bytes = 2 * sizeof(Index) + sizeof(std::int8_t) + sizeof(Vec3d);
constexpr std::size_t book_bytes = sizeof(Index) + 5 * sizeof(double);

Index layer_rows(const Model& model, const ElementBlock& block) {
  return block.layer_row == no_index ? 0 : model.sections[at(block.section)].layer_rows();
}

/// Rows of a block in the history and, with stiffness damping, as many of its share.
Index element_row_count(const Model& model) {
  return model.run.stiffness_damping > 0.0 ? 2 * element_rows : element_rows;
}

/// Calls `visit(rows, count)` for the used lanes of every row of a body's history, block by block.
template <class SomeState, class Visit>
void for_each_row(const Model& model, const Body& body, SomeState& state, const Visit& visit) {
  for (Index b = body.blocks.begin; b < body.blocks.end; ++b) {
    const ElementBlock& block = model.blocks[at(b)];
    for (Index row = 0; row < element_rows; ++row) {
      visit(state.history.data() + row_offset(b, row), at(block.count));
    }
    for (Index row = element_rows; row < element_row_count(model); ++row) {
      visit(state.damping.data() + row_offset(b, row - element_rows), at(block.count));
    }
    for (Index row = 0; row < layer_rows(model, block); ++row) {
      visit(state.layers.data() + at(block.layer_row + row) * at(block_lanes), at(block.count));
    }
  }
}

std::size_t bytes_of_ties(const Model& model, const Body& body) {
  return at(body.ties.size()) * sizeof(TieState) + (model.ties.empty() ? 0 : sizeof(double)) +
         (model.ties.can_break ? at(body.nodes.size()) * sizeof(NodeInertia) : 0);
}

/// Bytes in front of the numbers of sides.
std::size_t bytes_before_sides(const Model& model, const Body& body) {
  std::size_t numbers = 0;
  for (Index b = body.blocks.begin; b < body.blocks.end; ++b) {
    const ElementBlock& block = model.blocks[at(b)];
    numbers += at(block.count) * at(element_row_count(model) + layer_rows(model, block));
  }
  const std::size_t of_node = sizeof(NodeMotion) + sizeof(NodeAcceleration) + at(model.rubbing_walls) * sizeof(Vec3d);
  return at(body.nodes.size()) * of_node + numbers * sizeof(double) +
         (body.rigid == no_index ? 0 : sizeof(RigidMotion)) + bytes_of_ties(model, body);
}

/// Calls `visit(records, count)` for what ties have of a body.
template <class SomeState, class Visit>
void for_each_tie_record(const Model& model, const Body& owner, Index body, SomeState& state, const Visit& visit) {
  if (!model.ties.empty()) {
    visit(state.ties.data() + owner.ties.begin, at(owner.ties.size()));
    visit(state.tie_work.data() + body, std::size_t{1});
  }
  if (model.ties.can_break) {
    visit(state.moving.data() + owner.nodes.begin, at(owner.nodes.size()));
  }
}

/// `sides`: of both kinds together.
std::size_t bytes_of_body(const Model& model, const Body& body, std::size_t sides, std::size_t books) {
  return bytes_before_sides(model, body) + 3 * sizeof(std::int64_t) + sides * side_bytes + books * book_bytes +
         sizeof(BodyLedger);
}

std::pair<Index, Index> pair_of(const ContactSide& s) { return {s.node, s.element}; }
std::pair<Index, Index> pair_of(const EdgeSide& s) { return {s.first, s.second}; }

bool is_barrier_of_element(const Model& model, Index element) {
  return model.bodies[at(model.blocks[at(model.element_block[at(element)])].body)].barrier;
}

/// True when the side is one that the body can have: of its own node and any element, or of a barrier's node and its
/// own element.
bool is_side_of(const Model& model, const Body& body, const ContactSide& s) {
  return s.node >= 0 && s.node < model.node_count() && s.element >= 0 && s.element < model.element_count() &&
         (body.nodes.contains(s.node) ||
          (body.elements.contains(s.element) && model.bodies[at(model.node_body[at(s.node)])].barrier));
}

/// Likewise of two edges.
bool is_side_of(const Model& model, const Body& body, const EdgeSide& s) {
  const Index edges = 3 * model.element_count();
  return s.first >= 0 && s.first < s.second && s.second < edges &&
         (body.elements.contains(s.first / 3) ||
          (body.elements.contains(s.second / 3) && is_barrier_of_element(model, s.first / 3)));
}

template <class Side>
bool are_sides_of(const Model& model, const Body& body, const std::vector<Side>& sides) {
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Side& s = sides[i];
    const bool known = (s.side == 1 || s.side == -1) && is_side_of(model, body, s);
    if (!known || (i > 0 && pair_of(sides[i - 1]) >= pair_of(s))) {
      return false;
    }
  }
  return true;
}

/// True when they are in order and of bodies with which this one can keep books.
bool are_books_of(const Model& model, Index body, const std::vector<PairBook>& books) {
  for (std::size_t i = 0; i < books.size(); ++i) {
    const Index other = books[i].other;
    const bool known = other >= 0 && other < model.body_count() && (other >= body || model.bodies[at(other)].barrier);
    if (!known || (i > 0 && books[i - 1].other >= other)) {
      return false;
    }
  }
  return true;
}

template <class Side>
void write_sides(const std::vector<Side>& sides, Writer& writer) {
  for (const Side& side : sides) {
    const std::pair<Index, Index> pair = pair_of(side);
    writer.write(&pair.first, 1);
    writer.write(&pair.second, 1);
    writer.write(&side.side, 1);
    writer.write(&side.drag, 1);
  }
}

template <class Side>
std::vector<Side> read_sides(std::size_t count, Reader& reader) {
  std::vector<Side> sides;
  sides.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    Index first = 0, second = 0;
    std::int8_t side = 0;
    Vec3d drag;
    reader.read(&first, 1);
    reader.read(&second, 1);
    reader.read(&side, 1);
    reader.read(&drag, 1);
    sides.push_back({first, second, side, drag});
  }
  return sides;
}

void write_books(const std::vector<PairBook>& books, Writer& writer) {
  for (const PairBook& book : books) {
    const std::array<double, 5> sums{book.initial, book.energy, book.dissipated, book.work, book.work_other};
    writer.write(&book.other, 1);
    writer.write(sums.data(), sums.size());
  }
}

std::vector<PairBook> read_books(std::size_t count, Reader& reader) {
  std::vector<PairBook> books;
  books.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    Index other = 0;
    std::array<double, 5> sums{};
    reader.read(&other, 1);
    reader.read(sums.data(), sums.size());
    books.push_back({other, sums[0], sums[1], sums[2], sums[3], sums[4]});
  }
  return books;
}

}  // namespace

State initial_state(const Model& model) {
  State state;
  state.motion.reserve(model.reference_position.size());
  for (std::size_t n = 0; n < model.reference_position.size(); ++n) {
    state.motion.push_back({model.reference_position[n], model.initial_velocity[n], model.initial_rotation_rate[n]});
  }
  state.acceleration.resize(model.reference_position.size());
  for (const FixedNode& fixed : model.fixed) {
    NodeMotion& motion = state.motion[at(fixed.node)];
    double* const components[6] = {&motion.velocity.x,      &motion.velocity.y,      &motion.velocity.z,
                                   &motion.rotation_rate.x, &motion.rotation_rate.y, &motion.rotation_rate.z};
    for (unsigned d = 0; d < 6; ++d) {
      if ((fixed.mask >> d & 1U) != 0) {
        *components[d] = 0.0;
      }
    }
  }
  for (const SymmetryNode& symmetry : model.symmetry) {
    NodeMotion& motion = state.motion[at(symmetry.node)];
    motion.velocity -= dot(motion.velocity, symmetry.normal) * symmetry.normal;
    motion.rotation_rate = dot(motion.rotation_rate, symmetry.normal) * symmetry.normal;
  }
  for (const ObliqueNode& oblique : model.oblique) {
    NodeMotion& motion = state.motion[at(oblique.node)];
    Vec3d& rate = oblique.angular ? motion.rotation_rate : motion.velocity;
    rate -= dot(rate, oblique.direction) * oblique.direction;
  }
  state.history.assign(model.blocks.size() * element_rows * at(block_lanes), 0.0);
  if (model.run.stiffness_damping > 0.0) {
    state.damping.assign(state.history.size(), 0.0);
  }
  std::size_t rows = 0;
  for (const ElementBlock& block : model.blocks) {
    rows += at(layer_rows(model, block));
  }
  state.layers.assign(rows * at(block_lanes), 0.0);
  for (const ElementBlock& block : model.blocks) {
    if (block.layer_row != no_index) {
      const SectionData& section = model.sections[at(block.section)];
      const auto fill = [&](Index row, double value) {
        std::fill_n(state.layers.data() + at(block.layer_row + row) * at(block_lanes), block_lanes, value);
      };
      fill(physics::layer_thickness, section.thickness);
      for (int p = 0; p < (section.layered.plasticity.heat.heats() ? section.layered.points.count : 0); ++p) {
        fill(section.layered.temperature_row(p), section.layered.plasticity.heat.initial);
      }
    }
  }
  for (const RigidBody& rigid : model.rigid_bodies) {
    RigidMotion& motion = state.rigid.emplace_back();
    motion.centre = rigid.centre;
    motion.velocity = rigid.initial_velocity;
    motion.angular_momentum = inertia_times(rigid, rigid.initial_rotation_rate);
    const IndexRange nodes = model.bodies[at(rigid.body)].nodes;
    const Vec3d rate = rotation_rate(rigid, motion);
    for (Index n = nodes.begin; n < nodes.end; ++n) {
      NodeMotion& node = state.motion[at(n)];
      node.velocity = velocity_at(motion, rate, node.position);
      node.rotation_rate = rate;
    }
  }
  for (const Tie& tie : model.ties.ties) {
    rate_tied_node(tie, state);
  }
  state.ties.resize(model.ties.ties.size());
  state.tie_work.resize(model.ties.empty() ? 0 : model.bodies.size());
  for (Index n = 0; n < model.node_count() && model.ties.can_break; ++n) {
    state.moving.push_back({model.moving_mass(n), model.moving_inertia(n)});
  }
  state.sides.resize(model.bodies.size());
  state.edge_sides.resize(model.bodies.size());
  state.wall_drag.resize(model.reference_position.size() * at(model.rubbing_walls));
  state.ledger.resize(model.bodies.size());
  state.pair_books.resize(model.bodies.size());
  return state;
}

void copy_body(const Model& model, const State& from, Index body, State& to) {
  const Body& owner = model.bodies[at(body)];
  const auto copy = [](const auto& source, auto& target, std::size_t begin, std::size_t end) {
    std::copy(source.begin() + static_cast<std::ptrdiff_t>(begin), source.begin() + static_cast<std::ptrdiff_t>(end),
              target.begin() + static_cast<std::ptrdiff_t>(begin));
  };
  copy(from.motion, to.motion, at(owner.nodes.begin), at(owner.nodes.end));
  copy(from.acceleration, to.acceleration, at(owner.nodes.begin), at(owner.nodes.end));
  copy(from.wall_drag, to.wall_drag, at(owner.nodes.begin) * at(model.rubbing_walls),
       at(owner.nodes.end) * at(model.rubbing_walls));
  copy(from.history, to.history, row_offset(owner.blocks.begin, 0), row_offset(owner.blocks.end, 0));
  if (!from.damping.empty()) {
    copy(from.damping, to.damping, row_offset(owner.blocks.begin, 0), row_offset(owner.blocks.end, 0));
  }
  for (Index b = owner.blocks.begin; b < owner.blocks.end; ++b) {
    const ElementBlock& block = model.blocks[at(b)];
    const std::size_t first = at(block.layer_row) * at(block_lanes);
    if (block.layer_row != no_index) {
      copy(from.layers, to.layers, first, first + at(layer_rows(model, block)) * at(block_lanes));
    }
  }
  if (owner.rigid != no_index) {
    to.rigid[at(owner.rigid)] = from.rigid[at(owner.rigid)];
  }
  copy(from.ties, to.ties, at(owner.ties.begin), at(owner.ties.end));
  if (!from.moving.empty()) {
    copy(from.moving, to.moving, at(owner.nodes.begin), at(owner.nodes.end));
  }
  if (!from.tie_work.empty()) {
    to.tie_work[at(body)] = from.tie_work[at(body)];
  }
  to.sides[at(body)] = from.sides[at(body)];
  to.edge_sides[at(body)] = from.edge_sides[at(body)];
  to.ledger[at(body)] = from.ledger[at(body)];
  to.pair_books[at(body)] = from.pair_books[at(body)];
}

// Order: motion of the nodes (x, v, omega), their accelerations (a, alpha), the drag of rubbing walls node by node,
// rows of the elements, of their damping where there is any and of their layers block by block (used lanes only), the
// motion of a rigid body, its ties (force, moment, whether broken), where there are ties their work on the body, where
// they can break what its nodes' accelerations move (mass, inertia), the numbers of sides of nodes, of sides of edges
// and of books (64 bits each), the sides of nodes (node, element, side: 32, 32 and 8 bits, drag), those of edges
// (first, second, side, drag), the books (other body: 32 bits, five sums), the ledger. All numbers are little-endian
// and stand side by side.
void append_body_bytes(const Model& model, const State& state, Index body, std::vector<std::byte>& bytes) {
  const Body& owner = model.bodies[at(body)];
  const std::vector<ContactSide>& sides = state.sides[at(body)];
  const std::vector<EdgeSide>& edge_sides = state.edge_sides[at(body)];
  const std::size_t before = bytes.size();
  const std::vector<PairBook>& books = state.pair_books[at(body)];
  bytes.resize(before + bytes_of_body(model, owner, sides.size() + edge_sides.size(), books.size()));
  Writer writer(bytes.data() + before);
  writer.write(state.motion.data() + owner.nodes.begin, at(owner.nodes.size()));
  writer.write(state.acceleration.data() + owner.nodes.begin, at(owner.nodes.size()));
  writer.write(state.wall_drag.data() + at(owner.nodes.begin) * at(model.rubbing_walls),
               at(owner.nodes.size()) * at(model.rubbing_walls));
  for_each_row(model, owner, state, [&](const double* row, std::size_t count) { writer.write(row, count); });
  if (owner.rigid != no_index) {
    writer.write(&state.rigid[at(owner.rigid)], 1);
  }
  for_each_tie_record(model, owner, body, state, [&](const auto* records, std::size_t n) { writer.write(records, n); });
  const std::array<std::int64_t, 3> counts{static_cast<std::int64_t>(sides.size()),
                                           static_cast<std::int64_t>(edge_sides.size()),
                                           static_cast<std::int64_t>(books.size())};
  writer.write(counts.data(), counts.size());
  write_sides(sides, writer);
  write_sides(edge_sides, writer);
  write_books(books, writer);
  writer.write(&state.ledger[at(body)], 1);
}

bool read_body_bytes(const Model& model, std::span<const std::byte> bytes, Index body, State& state) {
  const Body& owner = model.bodies[at(body)];
  const std::size_t front = bytes_before_sides(model, owner);
  const std::size_t least = bytes_of_body(model, owner, 0, 0);
  if (bytes.size() < least) {
    return false;
  }
  std::array<std::int64_t, 3> counts{};
  Reader(bytes.data() + front).read(counts.data(), counts.size());
  const std::size_t room = bytes.size() - least;
  const auto fits = [room](std::int64_t count) { return count >= 0 && static_cast<std::uint64_t>(count) <= room; };
  if (!std::ranges::all_of(counts, fits)) {
    return false;
  }
  const auto side_count = static_cast<std::size_t>(counts[0] + counts[1]);
  if (bytes.size() != bytes_of_body(model, owner, side_count, static_cast<std::size_t>(counts[2]))) {
    return false;
  }
  Reader rear(bytes.data() + front + sizeof(counts));
  std::vector<ContactSide> sides = read_sides<ContactSide>(static_cast<std::size_t>(counts[0]), rear);
  std::vector<EdgeSide> edge_sides = read_sides<EdgeSide>(static_cast<std::size_t>(counts[1]), rear);
  std::vector<PairBook> books = read_books(static_cast<std::size_t>(counts[2]), rear);
  if (!are_sides_of(model, owner, sides) || !are_sides_of(model, owner, edge_sides) ||
      !are_books_of(model, body, books)) {
    return false;
  }
  state.sides[at(body)] = std::move(sides);
  state.edge_sides[at(body)] = std::move(edge_sides);
  state.pair_books[at(body)] = std::move(books);
  rear.read(&state.ledger[at(body)], 1);
  Reader reader(bytes.data());
  reader.read(state.motion.data() + owner.nodes.begin, at(owner.nodes.size()));
  reader.read(state.acceleration.data() + owner.nodes.begin, at(owner.nodes.size()));
  reader.read(state.wall_drag.data() + at(owner.nodes.begin) * at(model.rubbing_walls),
              at(owner.nodes.size()) * at(model.rubbing_walls));
  for_each_row(model, owner, state, [&](double* row, std::size_t lanes) { reader.read(row, lanes); });
  if (owner.rigid != no_index) {
    reader.read(&state.rigid[at(owner.rigid)], 1);
  }
  for_each_tie_record(model, owner, body, state, [&](auto* records, std::size_t n) { reader.read(records, n); });
  return true;
}

std::uint64_t body_hash(const Model& model, const State& state, Index body) {
  std::vector<std::byte> bytes;
  append_body_bytes(model, state, body, bytes);
  return hash_bytes(bytes);
}

std::uint64_t state_hash(const Model& model, const State& state) {
  std::vector<std::uint64_t> hashes(model.bodies.size());
  parallel::for_each(model.body_count(), 1, [&](Index body) { hashes[at(body)] = body_hash(model, state, body); });
  std::vector<std::byte> bytes(sizeof(state.step) + sizeof(state.time) + hashes.size() * sizeof(std::uint64_t));
  Writer writer(bytes.data());
  writer.write(&state.step, 1);
  writer.write(&state.time, 1);
  writer.write(hashes.data(), hashes.size());
  return hash_bytes(bytes);
}

}  // namespace fexp::model
