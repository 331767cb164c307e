// SPDX-License-Identifier: Apache-2.0
#include "model/state.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "support/descriptions.hpp"

namespace fexp::model {
namespace {

using test::steel;

/// Two plates of 18 triangles each: blocks of 8, 8 and 2 elements.
Model two_plates() {
  Description d = test::description(steel, 0.01);
  test::add_body(d, "p", Plate{1.0, 1.0, 3, 3, "one"}).array = Array{{2, 1, 1}, {3.0, 0.0, 0.0}};
  return test::build(d);
}

/// The same of a plastic material with 2 points through the thickness.
Model two_plastic_plates() {
  Description d = test::description(steel, 0.01);
  d.materials[0].law = physics::J2Linear{{7850.0, 2.1e11, 0.3}, 250e6, 2e9};
  d.sections[0].points = 2;
  test::add_body(d, "p", Plate{1.0, 1.0, 3, 3, "one"}).array = Array{{2, 1, 1}, {3.0, 0.0, 0.0}};
  return test::build(d);
}

/// The same on two walls with friction and one without.
Model two_plates_on_walls() {
  Description d = test::description(steel, 0.01);
  test::add_body(d, "p", Plate{1.0, 1.0, 3, 3, "one"}).array = Array{{2, 1, 1}, {3.0, 0.0, 0.0}};
  d.planes.push_back({{"a", -1.0, 0.1}, {}, {0.0, 0.0, 1.0}});
  d.planes.push_back({{"b"}, {}, {0.0, 0.0, 1.0}});
  d.planes.push_back({{"c", -1.0, 0.1}, {}, {0.0, 0.0, -1.0}});
  return test::build(d);
}

/// The same, one glued on the other; with a strength or without.
Model two_glued_plates(double strength) {
  Description d = test::description(steel, 0.01);
  test::add_body(d, "p", Plate{1.0, 1.0, 3, 3, "one"}).array = Array{{1, 1, 2}, {0.0, 0.0, 0.01}};
  d.node_sets.emplace_back().name = "upper";
  d.node_sets.back().bodies = {"p[0,0,1]"};
  TieDescription& tie = d.ties.emplace_back();
  tie.name = tie.set = "upper";
  tie.surface = {"p[0,0,0]"};
  tie.strength_normal = strength;
  return test::build(d);
}

/// Records of doubles alone as the doubles they are.
template <class Records>
double* numbers(Records& records) {
  return reinterpret_cast<double*>(records.data());
}

/// A state of the model with every value and every padding lane at random, and some sides.
State random_state(const Model& model, unsigned seed) {
  State state = initial_state(model);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const auto fill = [&](double* values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      values[i] = number(random);
    }
  };
  fill(numbers(state.motion), 9 * state.motion.size());
  fill(numbers(state.acceleration), 6 * state.acceleration.size());
  fill(state.history.data(), state.history.size());
  fill(state.layers.data(), state.layers.size());
  fill(numbers(state.wall_drag), 3 * state.wall_drag.size());
  fill(numbers(state.ledger), 13 * state.ledger.size());
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    for (Index i = 0; i < 4; ++i) {
      state.sides[b].push_back({model.bodies[b].nodes.begin + i,
                                3 * i,
                                static_cast<std::int8_t>(i % 2 == 0 ? 1 : -1),
                                {number(random), number(random), number(random)}});
    }
    const Index edge = 3 * model.bodies[b].elements.begin, last = 3 * model.element_count() - 1;
    state.edge_sides[b] = {{edge, edge + 5, 1, {number(random), 0.0, 1.0}}, {edge, last, -1, {}}};
    state.pair_books[b].push_back(
        {static_cast<Index>(b), number(random), number(random), number(random), number(random), number(random)});
  }
  return state;
}

std::vector<std::byte> bytes_of(const Model& model, const State& state, Index body) {
  std::vector<std::byte> bytes;
  append_body_bytes(model, state, body, bytes);
  return bytes;
}

TEST(state_bytes, initial_state_is_at_rest_where_fixed_and_moves_as_told_elsewhere) {
  Description d = test::description(steel, 0.01);
  BodyDescription& body = test::add_body(d, "p", Plate{1.0, 1.0, 3, 3, "one"});
  body.velocity = {1.0, 2.0, 3.0};
  body.angular_velocity = {4.0, 5.0, 6.0};
  test::add_box_set(d, "edge", {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0});
  test::fix(d, "edge", {"y", "rz"});
  const Model m = test::build(d);
  const State s = initial_state(m);
  EXPECT_EQ(s.step, 0);
  EXPECT_EQ(s.time, 0.0);
  ASSERT_EQ(s.history.size(), static_cast<std::size_t>(3 * element_rows * block_lanes));
  EXPECT_EQ(s.sides.size(), 1U);
  EXPECT_EQ(s.ledger.size(), 1U);
  for (const double value : s.history) {
    EXPECT_EQ(value, 0.0);
  }
  for (Index n = 0; n < m.node_count(); ++n) {
    const bool fixed = m.reference_position[at(n)].x == 0.0;
    Vec3d velocity = m.initial_velocity[at(n)], rate = body.angular_velocity;
    if (fixed) {
      velocity.y = 0.0;
      rate.z = 0.0;
    }
    EXPECT_EQ(s.motion[at(n)].position, m.reference_position[at(n)]);
    EXPECT_EQ(s.motion[at(n)].velocity, velocity);
    EXPECT_EQ(s.motion[at(n)].rotation_rate, rate);
    EXPECT_EQ(s.acceleration[at(n)].linear, Vec3d{});
    EXPECT_EQ(s.acceleration[at(n)].angular, Vec3d{});
  }
}

TEST(state_bytes, what_is_written_is_read_back_bit_for_bit_and_only_into_its_body) {
  const Model m = two_plates();
  State from = random_state(m, 1);
  const std::size_t node = at(m.bodies[1].nodes.begin);
  from.motion[node].velocity.x = -0.0;
  from.acceleration[node].linear.y = std::numeric_limits<double>::quiet_NaN();
  State to = random_state(m, 2);
  const auto other_before = bytes_of(m, to, 0);
  const auto bytes = bytes_of(m, from, 1);
  ASSERT_TRUE(read_body_bytes(m, bytes, 1, to));
  EXPECT_EQ(bytes_of(m, to, 1), bytes);
  EXPECT_EQ(bytes_of(m, to, 0), other_before);
  EXPECT_TRUE(std::signbit(to.motion[node].velocity.x));
  EXPECT_TRUE(std::isnan(to.acceleration[node].linear.y));
  EXPECT_EQ(to.sides[1], from.sides[1]);
  EXPECT_EQ(to.edge_sides[1], from.edge_sides[1]);
  EXPECT_EQ(to.pair_books[1], from.pair_books[1]);
  EXPECT_EQ(body_hash(m, to, 1), body_hash(m, from, 1));
}

TEST(state_bytes, the_layout_is_the_documented_one) {
  const Model m = two_plates();
  const State s = random_state(m, 3);
  const auto bytes = bytes_of(m, s, 1);
  const auto number_at = [&](std::size_t offset) {
    double value;
    std::memcpy(&value, bytes.data() + offset, sizeof(value));
    return value;
  };
  const Body& body = m.bodies[1];
  ASSERT_EQ(bytes.size(), 16U * 15U * 8U + 18U * 12U * 8U + 24U + 6U * 33U + 44U + 104U);
  EXPECT_EQ(number_at(0), s.motion[at(body.nodes.begin)].position.x);
  EXPECT_EQ(number_at(72), s.motion[at(body.nodes.begin + 1)].position.x);
  EXPECT_EQ(number_at(16 * 72), s.acceleration[at(body.nodes.begin)].linear.x);
  const std::size_t rows = 16U * 15U * 8U;
  EXPECT_EQ(number_at(rows + 8), element_value(m, s, body.elements.begin + 1, row_nxx));
  EXPECT_EQ(number_at(rows + 64), element_value(m, s, body.elements.begin, row_nyy));
  // The last block has two lanes.
  EXPECT_EQ(number_at(rows + 16 * 12 * 8 + 16), element_value(m, s, body.elements.begin + 16, row_nyy));
  const std::size_t sides = rows + 18U * 12U * 8U;
  EXPECT_EQ(std::to_integer<int>(bytes[sides]), 4);
  EXPECT_EQ(std::to_integer<int>(bytes[sides + 8]), 2);
  EXPECT_EQ(std::to_integer<int>(bytes[sides + 24]), body.nodes.begin);
  EXPECT_EQ(std::to_integer<int>(bytes[sides + 24 + 33 + 4]), 3);
  EXPECT_EQ(std::to_integer<int>(bytes[sides + 24 + 33 + 8]), 0xFF);
  EXPECT_EQ(number_at(sides + 24 + 33 + 9 + 8), s.sides[1][1].drag.y);
  EXPECT_EQ(std::to_integer<int>(bytes[sides + 24 + 4 * 33 + 8]), 1);
  EXPECT_EQ(std::to_integer<int>(bytes[sides + 16]), 1);
  const std::size_t books = sides + 24 + 6 * 33;
  EXPECT_EQ(std::to_integer<int>(bytes[books]), 1);
  EXPECT_EQ(number_at(books + 4 + 8), s.pair_books[1][0].energy);
  EXPECT_EQ(number_at(bytes.size() - 104), s.ledger[1].external_work);
}

TEST(state_bytes, drag_of_walls_follows_the_accelerations_and_is_part_of_the_hash) {
  const Model m = two_plates_on_walls();
  State from = random_state(m, 6), to = random_state(m, 7);
  ASSERT_EQ(from.wall_drag.size(), 32U * 2U);
  const auto bytes = bytes_of(m, from, 1), other = bytes_of(m, to, 0);
  ASSERT_EQ(bytes.size(), 16U * (15U + 6U) * 8U + 18U * 12U * 8U + 24U + 6U * 33U + 44U + 104U);
  double value{};
  std::memcpy(&value, bytes.data() + 16 * 15 * 8 + 6 * 8 + 3 * 8 + 8, sizeof(value));
  EXPECT_EQ(value, from.wall_drag[2 * (16 + 1) + 1].y);
  ASSERT_TRUE(read_body_bytes(m, bytes, 1, to));
  EXPECT_EQ(bytes_of(m, to, 1), bytes);
  EXPECT_EQ(bytes_of(m, to, 0), other);
  State copied = random_state(m, 8);
  copy_body(m, from, 1, copied);
  EXPECT_EQ(bytes_of(m, copied, 1), bytes);
  EXPECT_NE(copied.wall_drag[31], from.wall_drag[31]);
  const std::uint64_t before = state_hash(m, from);
  for (Vec3d& drag : from.wall_drag) {
    drag.z = -drag.z;
    EXPECT_NE(state_hash(m, from), before);
    drag.z = -drag.z;
  }
}

TEST(state_bytes, padding_lanes_do_not_reach_the_hash) {
  const Model m = two_plates();
  State s = random_state(m, 4);
  const std::uint64_t before = state_hash(m, s);
  for (Index b = 0; b < m.block_count(); ++b) {
    for (Index row = 0; row < element_rows; ++row) {
      for (Index lane = m.blocks[at(b)].count; lane < block_lanes; ++lane) {
        s.history[(at(b) * element_rows + at(row)) * at(block_lanes) + at(lane)] += 1.0;
      }
    }
  }
  EXPECT_EQ(state_hash(m, s), before);
}

TEST(state_bytes, every_used_number_reaches_the_hash) {
  const Model m = two_plates();
  const State s = random_state(m, 5);
  const std::uint64_t before = state_hash(m, s);
  const auto changed = [&](auto change) {
    State other = s;
    change(other);
    return state_hash(m, other) != before;
  };
  const auto flip = [](double& value) { value = -value; };
  for (std::size_t i = 0; i < 9 * s.motion.size(); ++i) {
    EXPECT_TRUE(changed([&](State& o) { flip(numbers(o.motion)[i]); }));
  }
  for (std::size_t i = 0; i < 6 * s.acceleration.size(); ++i) {
    EXPECT_TRUE(changed([&](State& o) { flip(numbers(o.acceleration)[i]); }));
  }
  for (std::size_t i = 0; i < 12 * s.ledger.size(); ++i) {
    EXPECT_TRUE(changed([&](State& o) { flip(numbers(o.ledger)[i]); }));
  }
  for (Index e = 0; e < m.element_count(); ++e) {
    for (Index row = 0; row < element_rows; ++row) {
      const Index block = m.element_block[at(e)], lane = e - m.blocks[at(block)].first;
      EXPECT_TRUE(changed(
          [&](State& o) { flip(o.history[(at(block) * element_rows + at(row)) * at(block_lanes) + at(lane)]); }));
    }
  }
  EXPECT_TRUE(changed([](State& o) { ++o.step; }));
  EXPECT_TRUE(changed([](State& o) { o.time = 1.0; }));
  EXPECT_TRUE(changed([](State& o) { o.sides[1][2].side = -1; }));
  EXPECT_TRUE(changed([](State& o) { o.sides[1][2].drag.z = 9.0; }));
  EXPECT_TRUE(changed([](State& o) { o.sides[0].pop_back(); }));
  EXPECT_TRUE(changed([](State& o) { o.edge_sides[1][0].side = -1; }));
  EXPECT_TRUE(changed([](State& o) { o.edge_sides[0].pop_back(); }));
  for (double PairBook::*const sum :
       {&PairBook::initial, &PairBook::energy, &PairBook::dissipated, &PairBook::work, &PairBook::work_other}) {
    EXPECT_TRUE(changed([&](State& o) { flip(o.pair_books[1][0].*sum); }));
  }
  EXPECT_TRUE(changed([](State& o) { o.pair_books[0][0].other = 1; }));
  EXPECT_TRUE(changed([](State& o) { o.pair_books[1].clear(); }));
  EXPECT_TRUE(changed([](State& o) { std::swap(o.ledger[0], o.ledger[1]); }));
}

TEST(state_bytes, bytes_that_do_not_fit_are_refused_and_change_nothing) {
  const Model m = two_plates();
  const auto good = bytes_of(m, random_state(m, 6), 1);
  State s = random_state(m, 7);
  const std::uint64_t before = state_hash(m, s);
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_FALSE(read_body_bytes(m, std::span(good).first(size), 1, s)) << size;
  }
  auto bytes = good;
  bytes.push_back(std::byte{0});
  EXPECT_FALSE(read_body_bytes(m, bytes, 1, s));
  const std::size_t sides = 16U * 15U * 8U + 18U * 12U * 8U;
  for (const std::int64_t count :
       {std::int64_t{3}, std::int64_t{5}, std::int64_t{-1}, std::numeric_limits<std::int64_t>::max(),
        std::numeric_limits<std::int64_t>::min()}) {
    bytes = good;
    std::memcpy(bytes.data() + sides, &count, sizeof(count));
    EXPECT_FALSE(read_body_bytes(m, bytes, 1, s)) << count;
  }
  EXPECT_EQ(state_hash(m, s), before);
}

TEST(state_bytes, sides_that_the_body_cannot_have_are_refused) {
  const Model m = two_plates();
  const State good = random_state(m, 8);
  const Index first = m.bodies[1].nodes.begin;
  State s = random_state(m, 9);
  const std::uint64_t before = state_hash(m, s);
  for (const std::vector<ContactSide>& sides :
       std::vector<std::vector<ContactSide>>{{{first - 1, 0, 1}},                // another body's node
                                             {{m.node_count(), 0, 1}},           // no node
                                             {{first, -1, 1}},                   // no element
                                             {{first, m.element_count(), 1}},    // no element
                                             {{first, 0, 0}},                    // no side
                                             {{first, 2, 1}, {first, 1, 1}},     // out of order
                                             {{first, 1, 1}, {first, 1, 1}}}) {  // twice
    State bad = good;
    bad.sides[1] = sides;
    EXPECT_FALSE(read_body_bytes(m, bytes_of(m, bad, 1), 1, s));
  }
  const Index edge = 3 * m.bodies[1].elements.begin, count = 3 * m.element_count();
  for (const std::vector<EdgeSide>& sides :
       std::vector<std::vector<EdgeSide>>{{{edge - 1, edge, 1}},                          // another body's edge
                                          {{edge, count, 1}},                             // no edge
                                          {{-1, edge, 1}},                                // no edge
                                          {{edge, edge, 1}},                              // one edge
                                          {{edge + 1, edge, 1}},                          // the higher number first
                                          {{edge, edge + 1, 0}},                          // no side
                                          {{edge, edge + 5, 1}, {edge, edge + 4, 1}},     // out of order
                                          {{edge, edge + 5, 1}, {edge, edge + 5, 1}}}) {  // twice
    State bad = good;
    bad.edge_sides[1] = sides;
    EXPECT_FALSE(read_body_bytes(m, bytes_of(m, bad, 1), 1, s));
  }
  EXPECT_EQ(state_hash(m, s), before);
}

TEST(state_bytes, books_that_the_body_cannot_keep_are_refused) {
  Model m = two_plates();
  const State good = random_state(m, 14);
  State s = random_state(m, 15);
  const std::uint64_t before = state_hash(m, s);
  const auto with = [&](Index body, const std::vector<Index>& others) {
    State state = good;
    state.pair_books[at(body)].clear();
    for (const Index other : others) {
      state.pair_books[at(body)].push_back({other, 0.0, 1.0, 0.0, 0.0, 0.0});
    }
    return bytes_of(m, state, body);
  };
  EXPECT_FALSE(read_body_bytes(m, with(1, {0}), 1, s)) << "the lower body keeps them";
  EXPECT_FALSE(read_body_bytes(m, with(0, {-1}), 0, s));
  EXPECT_FALSE(read_body_bytes(m, with(0, {2}), 0, s));
  EXPECT_FALSE(read_body_bytes(m, with(0, {1, 0}), 0, s)) << "out of order";
  EXPECT_FALSE(read_body_bytes(m, with(0, {1, 1}), 0, s)) << "twice";
  EXPECT_EQ(state_hash(m, s), before);
  EXPECT_TRUE(read_body_bytes(m, with(0, {0, 1}), 0, s));
  m.bodies[0].barrier = true;
  EXPECT_TRUE(read_body_bytes(m, with(1, {0, 1}), 1, s)) << "a barrier keeps none";
}

TEST(state_bytes, layers_begin_with_the_thickness_alone) {
  const Model m = two_plastic_plates();
  const State s = initial_state(m);
  const Index rows = m.sections[0].layer_rows();
  ASSERT_EQ(s.layers.size(), at(6 * rows * block_lanes));
  for (Index e = 0; e < m.element_count(); ++e) {
    for (Index row = 0; row < rows; ++row) {
      EXPECT_EQ(layer_value(m, s, e, row), row == physics::layer_thickness ? 0.01 : 0.0);
    }
  }
}

TEST(state_bytes, points_begin_at_their_temperature_and_without_a_rate) {
  Description d = test::description(steel, 0.01);
  physics::J2Linear law{{7850.0, 2.1e11, 0.3, 0.01}, 250e6, 2e9};
  law.heating = physics::AdiabaticHeating{477.0, 1793.0, 293.0, 350.0};
  law.rate_cutoff = 1e3;
  d.materials[0].law = law;
  d.sections[0].points = 2;
  test::add_body(d, "p", Plate{1.0, 1.0, 3, 3, "one"});
  const Model m = test::build(d);
  State s = initial_state(m);
  const physics::LayeredSection& section = m.sections[0].layered;
  ASSERT_EQ(section.rows(), physics::layer_points + 2 * (physics::point_rows + 2));
  for (Index e = 0; e < m.element_count(); ++e) {
    for (Index row = physics::layer_points; row < section.rows(); ++row) {
      const bool is_temperature = row == section.temperature_row(0) || row == section.temperature_row(1);
      EXPECT_EQ(layer_value(m, s, e, row), is_temperature ? 350.0 : 0.0);
    }
  }
  const std::uint64_t before = state_hash(m, s);
  for (const Index row : {section.temperature_row(1), section.rate_row(0)}) {
    double& value = s.layers[at(m.blocks[0].layer_row + row) * at(block_lanes)];
    value += 1.0;
    EXPECT_NE(state_hash(m, s), before) << "both are part of the canonical bytes";
    value -= 1.0;
  }
  EXPECT_EQ(state_hash(m, s), before);
}

TEST(state_bytes, layers_follow_the_rows_of_their_block) {
  const Model m = two_plastic_plates();
  const State s = random_state(m, 11);
  const auto bytes = bytes_of(m, s, 1);
  const std::size_t nodes = 16U * 15U * 8U, rows = 12U + 11U;
  ASSERT_EQ(bytes.size(), nodes + 18U * rows * 8U + 24U + 6U * 33U + 44U + 104U);
  const auto number_at = [&](std::size_t offset) {
    double value;
    std::memcpy(&value, bytes.data() + offset, sizeof(value));
    return value;
  };
  const Index first = m.bodies[1].elements.begin;
  EXPECT_EQ(number_at(nodes + 12 * 64), layer_value(m, s, first, physics::layer_thickness));
  EXPECT_EQ(number_at(nodes + 15 * 64 + 8),
            layer_value(m, s, first + 1, physics::layer_points + Index{physics::point_sum}));
  EXPECT_EQ(number_at(nodes + rows * 64), element_value(m, s, first + 8, row_nxx));
}

TEST(state_bytes, layers_are_read_back_copied_and_hashed_with_their_body) {
  const Model m = two_plastic_plates();
  const State from = random_state(m, 12);
  State read = random_state(m, 13), copied = read;
  const auto other = bytes_of(m, read, 0);
  ASSERT_TRUE(read_body_bytes(m, bytes_of(m, from, 1), 1, read));
  copy_body(m, from, 1, copied);
  for (const State* s : {&read, &copied}) {
    EXPECT_EQ(bytes_of(m, *s, 1), bytes_of(m, from, 1));
    EXPECT_EQ(bytes_of(m, *s, 0), other);
  }
  const std::uint64_t before = state_hash(m, from);
  for (const ElementBlock& block : m.blocks) {
    for (Index row = 0; row < m.sections[0].layer_rows(); ++row) {
      for (Index lane = 0; lane < block_lanes; ++lane) {
        State changed = from;
        double& value = changed.layers[(at(block.layer_row) + at(row)) * at(block_lanes) + at(lane)];
        value = -value;
        EXPECT_EQ(state_hash(m, changed) != before, lane < block.count) << "a padding lane must not count";
      }
    }
  }
}

TEST(state_bytes, ties_follow_the_rows_and_are_read_back_copied_and_hashed_with_their_body) {
  for (const double strength : {-1.0, 1.0}) {
    const Model m = two_glued_plates(strength);
    ASSERT_EQ(m.bodies[1].ties.size(), 16);
    State from = random_state(m, 1);
    for (std::size_t t = 0; t < from.ties.size(); ++t) {
      from.ties[t] = {{0.5 + static_cast<double>(t), 2.0, 3.0}, {4.0, 5.0, 6.0}, static_cast<std::int64_t>(t % 2)};
    }
    from.tie_work = {7.0, 8.0};
    for (NodeInertia& node : from.moving) {
      node = {9.0, 10.0};
    }
    const auto bytes = bytes_of(m, from, 1);
    State to = initial_state(m);
    ASSERT_TRUE(read_body_bytes(m, bytes, 1, to));
    EXPECT_EQ(bytes_of(m, to, 1), bytes);
    EXPECT_EQ(to.ties[3].force.x, 3.5);
    EXPECT_EQ(to.ties[3].broken, 1);
    EXPECT_EQ(to.tie_work[1], 8.0);
    EXPECT_EQ(to.tie_work[0], 0.0);
    State copied = initial_state(m);
    copy_body(m, from, 1, copied);
    EXPECT_EQ(bytes_of(m, copied, 1), bytes);
    // Behind the rows: 15 doubles a node, 12 rows of 18 elements.
    const std::size_t place = (15 * 16 + 12 * 18) * sizeof(double);
    double force = 0.0, work = 0.0;
    std::memcpy(&force, bytes.data() + place, sizeof(force));
    std::memcpy(&work, bytes.data() + place + 16 * sizeof(TieState), sizeof(work));
    EXPECT_EQ(force, 0.5);
    EXPECT_EQ(work, 8.0);
    EXPECT_EQ(from.moving.empty(), strength < 0.0);
    if (strength > 0.0) {
      std::memcpy(&work, bytes.data() + place + 16 * sizeof(TieState) + 2 * sizeof(double), sizeof(work));
      EXPECT_EQ(work, 10.0);
    }
    for (const auto change : {0, 1, 2}) {
      State other = from;
      other.ties[5].broken += change == 0 ? 1 : 0;
      other.tie_work[1] += change == 1 ? 1.0 : 0.0;
      if (change == 2 && !other.moving.empty()) {
        other.moving[at(m.bodies[1].nodes.begin)].mass = 11.0;
      }
      EXPECT_EQ(body_hash(m, other, 1) != body_hash(m, from, 1), change < 2 || strength > 0.0);
      EXPECT_EQ(body_hash(m, other, 0), body_hash(m, from, 0));
    }
  }
}

TEST(state_bytes, appending_keeps_what_is_there) {
  const Model m = two_plates();
  const State s = random_state(m, 10);
  std::vector<std::byte> both{std::byte{7}};
  append_body_bytes(m, s, 0, both);
  append_body_bytes(m, s, 1, both);
  const auto first = bytes_of(m, s, 0), second = bytes_of(m, s, 1);
  ASSERT_EQ(both.size(), 1 + first.size() + second.size());
  EXPECT_EQ(std::to_integer<int>(both[0]), 7);
  EXPECT_TRUE(std::equal(first.begin(), first.end(), both.begin() + 1));
}

}  // namespace
}  // namespace fexp::model
