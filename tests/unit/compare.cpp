// SPDX-License-Identifier: Apache-2.0
#include "io/compare.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "io/hash_log.hpp"
#include "io/output_error.hpp"
#include "io/run_directory.hpp"
#include "io/vtkhdf.hpp"
#include "support/hand_model.hpp"
#include "support/temporary_directory.hpp"

namespace fexp {
namespace {

using test::TemporaryDirectory;

constexpr Index bodies = 3;
constexpr Index cells = 5;

/// A run of made-up frames; `change` may alter each before it is written.
template <class Change>
void write_run(const std::filesystem::path& path, std::int64_t frames, const Change& change) {
  const io::RunDirectory run = io::RunDirectory::create("d.toml", "", path, false);
  const model::Model model = test::strips(bodies, cells);
  io::ResultsWriter writer(run.results(), model);
  for (std::int64_t f = 0; f < frames; ++f) {
    model::Frame frame = model::capture(model, test::strip_state(model, f), {}, {});
    change(f, frame);
    writer.append(frame);
  }
}

void write_run(const std::filesystem::path& path, std::int64_t frames) {
  write_run(path, frames, [](std::int64_t, model::Frame&) {});
}

void write_hashes(const std::filesystem::path& path, std::int64_t steps, std::int64_t from = -1, Index body = 0) {
  std::filesystem::create_directories(path);
  io::HashLogWriter writer(io::RunDirectory(path).hashes());
  for (std::int64_t step = 0; step < steps; ++step) {
    for (Index b = 0; b < bodies; ++b) {
      const bool changed = from >= 0 && step >= from && b >= body;
      writer.append({step, b, static_cast<std::uint64_t>(step * 100 + b) + (changed ? 1000000U : 0U)});
    }
  }
}

TEST(compare, equal_runs_are_the_same) {
  const TemporaryDirectory directory;
  for (const char* name : {"a", "b"}) {
    write_run(directory / name, 4);
    write_hashes(directory / name, 20);
  }
  const io::Comparison result = io::compare_runs(directory / "a", directory / "b");
  EXPECT_TRUE(result.comparable);
  EXPECT_TRUE(result.same) << result.text();
  EXPECT_EQ(result.text().substr(0, 10), "The same.\n");
}

TEST(compare, names_the_first_step_and_body_whose_hash_differs) {
  const TemporaryDirectory directory;
  write_hashes(directory / "a", 20);
  write_hashes(directory / "b", 20, 7, 2);
  const io::Comparison result = io::compare_runs(directory / "a", directory / "b");
  EXPECT_FALSE(result.same);
  ASSERT_TRUE(result.hash);
  EXPECT_EQ(result.hash->step, 7);
  EXPECT_EQ(result.hash->body, 2);
  EXPECT_EQ(result.hash->hash_a, "00000000000002be");
  EXPECT_NE(result.hash->hash_b, result.hash->hash_a);
}

TEST(compare, a_log_that_ends_earlier_is_the_same_as_far_as_it_goes) {
  const TemporaryDirectory directory;
  write_hashes(directory / "a", 20);
  write_hashes(directory / "b", 11);
  const io::Comparison result = io::compare_runs(directory / "a", directory / "b");
  EXPECT_TRUE(result.same);
  EXPECT_NE(result.text().find("60 and 33 entries"), std::string::npos) << result.text();
}

TEST(compare, a_hash_that_one_run_lacks_is_named) {
  const TemporaryDirectory directory;
  write_hashes(directory / "a", 3);
  std::filesystem::create_directories(directory / "b");
  io::HashLogWriter writer(io::RunDirectory(directory / "b").hashes());
  writer.append({0, 0, 0});
  writer.append({0, 2, 2});
  writer.close();
  const io::Comparison result = io::compare_runs(directory / "a", directory / "b");
  ASSERT_TRUE(result.hash);
  EXPECT_EQ(result.hash->body, 1);
  EXPECT_EQ(result.hash->hash_b, "missing");
}

TEST(compare, names_frame_node_and_body_where_one_bit_differs) {
  const TemporaryDirectory directory;
  constexpr std::size_t node = 17;  // of the second strip, which has nodes 12 to 23
  write_run(directory / "a", 4);
  write_run(directory / "b", 4, [](std::int64_t f, model::Frame& frame) {
    if (f >= 2) {
      frame.position[node].z = std::nextafter(frame.position[node].z, 1e9);
      frame.position[node + 3].x += 1.0;
      frame.velocity[0][0] += 1.0F;
    }
  });
  const io::Comparison result = io::compare_runs(directory / "a", directory / "b");
  EXPECT_FALSE(result.same);
  ASSERT_TRUE(result.value) << result.text();
  EXPECT_EQ(result.value->frame, 2);
  EXPECT_EQ(result.value->step, 20);
  EXPECT_TRUE(result.value->at_node);
  EXPECT_EQ(result.value->index, static_cast<Index>(node));
  EXPECT_EQ(result.value->field, "position");
  EXPECT_EQ(result.value->body_name, "strip[1]");
  EXPECT_NE(result.value->a[2], result.value->b[2]);
  EXPECT_EQ(result.value->a[0], result.value->b[0]);
}

TEST(compare, names_the_element_and_its_body_when_only_a_field_differs) {
  const TemporaryDirectory directory;
  write_run(directory / "a", 2);
  write_run(directory / "b", 2, [](std::int64_t f, model::Frame& frame) {
    if (f == 1) {
      frame.shear_force[23][1] += 0.5F;
    }
  });
  const io::Comparison result = io::compare_runs(directory / "a", directory / "b");
  ASSERT_TRUE(result.value);
  EXPECT_EQ(result.value->field, "shear_force");
  EXPECT_FALSE(result.value->at_node);
  EXPECT_EQ(result.value->index, 23);
  EXPECT_EQ(result.value->body_name, "strip[2]");
  EXPECT_NE(result.text().find("element 23"), std::string::npos);
}

TEST(compare, a_run_killed_earlier_is_compared_as_far_as_it_goes) {
  const TemporaryDirectory directory;
  write_run(directory / "a", 4);
  write_run(directory / "b", 2);
  const io::Comparison result = io::compare_runs(directory / "a", directory / "b");
  EXPECT_TRUE(result.same);
  EXPECT_NE(result.text().find("4 and 2 frames"), std::string::npos);
}

TEST(compare, other_models_are_different) {
  const TemporaryDirectory directory;
  write_run(directory / "a", 1);
  io::ResultsWriter(directory / "b.vtkhdf", test::strips(1, 1)).close();
  EXPECT_FALSE(io::compare_runs(directory / "a", directory / "b.vtkhdf").same);
}

TEST(compare, a_positive_and_a_negative_zero_differ) {
  const TemporaryDirectory directory;
  write_run(directory / "a", 1, [](std::int64_t, model::Frame& frame) { frame.position[0].x = 0.0; });
  write_run(directory / "b", 1, [](std::int64_t, model::Frame& frame) { frame.position[0].x = -0.0; });
  EXPECT_FALSE(io::compare_runs(directory / "a", directory / "b").same);
}

TEST(compare, nothing_in_common_is_not_the_same) {
  const TemporaryDirectory directory;
  write_run(directory / "a", 1);
  write_hashes(directory / "b", 3);
  const io::Comparison result = io::compare_runs(directory / "a", directory / "b");
  EXPECT_FALSE(result.comparable);
  EXPECT_FALSE(result.same);
}

TEST(compare, a_path_that_is_not_there_is_an_error_that_names_it) {
  EXPECT_THROW((void)io::compare_runs("/nowhere/a", "/nowhere/b"), io::OutputError);
}

}  // namespace
}  // namespace fexp
