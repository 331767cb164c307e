// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "io/compare.hpp"
#include "support/temporary_directory.hpp"

namespace fexp {
namespace {

/// Two bodies under way; the second one's velocity is the test's.
std::string deck(double velocity) {
  return fmt::format(R"(
[run]
duration = 0.01

[output]
results_interval = 0.001
history_interval = 0.001

[[material]]
name = "rubber"
density = 1000.0
young = 1.0e6
poisson = 0.4

[[section]]
name = "skin"
material = "rubber"
thickness = 0.02

[[body]]
name = "first"
section = "skin"
mesh = {{ kind = "plate", length_x = 1.0, length_y = 1.0, cells_x = 3, cells_y = 3 }}
velocity = [0.1, 0.0, 0.0]

[[body]]
name = "second"
section = "skin"
mesh = {{ kind = "plate", length_x = 1.0, length_y = 1.0, cells_x = 3, cells_y = 3 }}
translate = [3.0, 0.0, 0.0]
angular_velocity = [1.0, 2.0, 3.0]

[[curve]]
name = "one"
points = [[0.0, 1.0], [1.0, 1.0]]

[[node_set]]
name = "corner"
box = {{ low = [3.9, 0.9, -0.1], high = [4.1, 1.1, 0.1] }}

[[prescribed]]
set = "corner"
dof = "z"
velocity = {:.17g}
curve = "one"
)",
                     velocity);
}

int run_program(const std::string& arguments) {
  const int status = std::system((std::string(FEXP_PROGRAM) + " " + arguments + " >/dev/null 2>&1").c_str());
  return WEXITSTATUS(status);
}

TEST(compare_runs, tells_apart_runs_that_differ_in_one_bit_of_one_nodes_velocity) {
  const test::TemporaryDirectory directory;
  // From 1 to the next number the step times the velocity changes whatever the step.
  for (const auto& [name, velocity] :
       {std::pair{"a", 1.0}, std::pair{"b", std::nextafter(1.0, 2.0)}, std::pair{"c", 1.0}}) {
    const auto file = directory.write(std::string(name) + ".toml", deck(velocity));
    ASSERT_EQ(
        run_program(fmt::format("run {} --out {} --hash-every 1 --quiet", file.string(), (directory / name).string())),
        0);
  }
  EXPECT_TRUE(io::compare_runs(directory / "a", directory / "c").same);
  EXPECT_EQ(run_program(fmt::format("compare {} {}", (directory / "a").string(), (directory / "c").string())), 0);

  const io::Comparison result = io::compare_runs(directory / "a", directory / "b");
  EXPECT_FALSE(result.same);
  EXPECT_NE(run_program(fmt::format("compare {} {}", (directory / "a").string(), (directory / "b").string())), 0);
  ASSERT_TRUE(result.hash) << result.text();
  EXPECT_EQ(result.hash->step, 1);
  EXPECT_EQ(result.hash->body_name, "second");
  // Every step is a frame here. The corner is the last of the plates' 32 nodes, and after one step it alone has another
  // place.
  ASSERT_TRUE(result.value) << result.text();
  EXPECT_EQ(result.value->step, 1);
  EXPECT_EQ(result.value->body_name, "second");
  EXPECT_TRUE(result.value->at_node);
  EXPECT_EQ(result.value->index, 31);
  EXPECT_EQ(result.value->field, "position");
}

}  // namespace
}  // namespace fexp
