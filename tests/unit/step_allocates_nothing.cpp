// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "model/tie_forces.hpp"
#include "parallel/parallel.hpp"
#include "support/models.hpp"

namespace {

std::atomic<bool> counting{false};
std::atomic<long> allocations{0};

void* counted(std::size_t size, std::size_t alignment) {
  if (counting.load(std::memory_order_relaxed)) {
    ++allocations;
  }
  void* p = alignment > alignof(std::max_align_t)
                ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                : std::malloc(size);
  if (p == nullptr) {
    throw std::bad_alloc();
  }
  return p;
}

}  // namespace

// All of the program's allocations come through here, those of the standard library too.
void* operator new(std::size_t size) { return counted(size, 1); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }

namespace {

using namespace fexp;

/// Counts what `work` allocates.
template <class Work>
long allocations_of(const Work& work) {
  allocations = 0;
  counting = true;
  work();
  counting = false;
  return allocations;
}

/// A vibrating plate on which everything acts that a deck can ask for, but nothing that needs a contact search, and a
/// rigid one that is driven.
model::Model busy_plate() {
  auto d = test::description({1000.0, 1.0e6, 0.4}, 0.02);
  model::Plate mesh;
  mesh.length_x = mesh.length_y = 1.0;
  mesh.cells_x = mesh.cells_y = 40;
  model::BodyDescription& body = test::add_body(d, "plate", mesh);
  body.velocity = {0.0, 0.0, -1.0};
  d.run.damping = 1.0;
  d.curves.push_back({"ramp", {{0.0, 0.0}, {1.0, 1.0}}, {}});
  d.gravity.push_back({{0.0, 0.0, -9.81}, "ramp", {}});
  d.pressure.push_back({{"plate"}, "", 10.0, "ramp", {}});
  d.planes.push_back({{"floor"}, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}});
  d.planes.push_back({{"lid"}, {0.0, 0.0, 3.005}, {0.0, 0.0, -1.0}});
  d.planes.back().mass = 2.0;
  d.planes.back().initial_velocity = {0.0, 0.0, -1.0};
  test::add_box_set(d, "left", {0.0, 0.0, -1.0}, {0.0, 1.0, 1.0});
  test::add_box_set(d, "right", {1.0, 0.0, -1.0}, {1.0, 1.0, 1.0});
  test::add_box_set(d, "middle", {0.4, 0.4, -1.0}, {0.6, 0.6, 1.0});
  test::fix(d, "left", {"x", "ry"});
  d.prescribed.push_back({"right", "y", 0.1, "ramp", {}});
  d.symmetry.push_back({"middle", {0.0, 1.0, 0.0}, {}});
  model::BodyDescription& stamp = test::add_body(d, "stamp", mesh);
  stamp.rigid = true;
  stamp.translate = {0.0, 0.0, 3.0};
  d.node_sets.emplace_back().name = "stamp";
  d.node_sets.back().bodies = {"stamp"};
  test::fix(d, "stamp", {"x", "rx"});
  d.prescribed.push_back({"stamp", "z", -0.1, "ramp", {}});
  d.prescribed.push_back({"stamp", "rz", 0.2, "ramp", {}});
  d.planes[0].velocity = {0.0, 0.0, 0.1};
  d.forces.push_back({"middle", {0.0, 0.0, 1.0}, {0.0, 0.1, 0.0}, true, "ramp", {}});
  return test::build(d);
}

/// A plate that is glued to one that is held, and pulled off by a pressure that reaches the strength after 25 steps.
model::Model glued_plate() {
  auto d = test::description({1000.0, 1.0e6, 0.4}, 0.02);
  const model::Plate mesh{1.0, 1.0, 20, 20, "one"};
  test::add_body(d, "block", mesh);
  test::add_body(d, "plate", mesh).translate = {0.0, 0.0, -0.02};
  for (const char* name : {"block", "plate"}) {
    d.node_sets.emplace_back().name = name;
    d.node_sets.back().bodies = {name};
  }
  test::fix(d, "block", {"x", "y", "z", "rx", "ry", "rz"});
  model::TieDescription& tie = d.ties.emplace_back();
  tie.name = tie.set = "plate";
  tie.surface = {"block"};
  tie.strength_normal = 1.0;
  d.pressure.push_back({{"plate"}, "", 1.0, "ramp", {}});
  d.curves.push_back({"ramp", {{0.0, 0.0}, {1.0, 1.0}}, {}});
  const double dt = 0.5 * test::build(d).first_critical_step;
  d.curves[0].points[1] = {25.0 * dt, 1.0};
  return test::build(d);
}

TEST(step, allocates_nothing_when_ties_break) {
  const model::Model model = glued_plate();
  test::DirectRun run(model);
  const double dt = 0.5 * model.first_critical_step;
  run.advance(dt, 1);
  EXPECT_EQ(allocations_of([&] { run.advance(dt, 50); }), 0);
  EXPECT_EQ(model::broken_ties(model, run.state, 0), 441);
}

TEST(step, allocates_nothing_after_its_first_call) {
  const model::Model model = busy_plate();
  test::DirectRun run(model);
  EXPECT_GT(run.state.ledger[0].barrier_energy, 0.0) << "the plane is touched";
  const double dt = 0.5 * model.first_critical_step;
  EXPECT_GT(allocations_of([&] { test::DirectRun another(model); }), 0);
  for (const int threads : {1, 4}) {
    parallel::with_threads(threads, [&] {
      run.advance(dt, 1);
      EXPECT_EQ(allocations_of([&] { run.advance(dt, 50); }), 0) << threads << " threads";
    });
  }
}

}  // namespace
