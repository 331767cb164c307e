// SPDX-License-Identifier: Apache-2.0
#include "io/mesh_readers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "model/mesh_generators.hpp"
#include "model/topology.hpp"
#include "support/damage.hpp"
#include "support/mesh_files.hpp"

namespace fexp::io {
namespace {

constexpr const char* nasty[] = {
    "0",  "-1", "2147483648", "9223372036854775807", "99999999999999999999", "1e400", "nan", "-inf", "$End",
    "\"", "\n", "solid"};

/// Index checks that every mesh must pass, whatever its file was.
void expect_sound(const model::Mesh& mesh) {
  const auto nodes = static_cast<Index>(mesh.position.size());
  ASSERT_EQ(mesh.part.size(), mesh.triangle.size());
  ASSERT_EQ(mesh.triangle_label.size(), mesh.triangle.size());
  ASSERT_TRUE(mesh.node_label.empty() || mesh.node_label.size() == mesh.position.size());
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    for (const Index n : mesh.triangle[t]) {
      ASSERT_TRUE(n >= 0 && n < nodes);
    }
    ASSERT_TRUE(mesh.part[t] >= 0 && at(mesh.part[t]) < mesh.part_names.size());
  }
  for (const Vec3d& p : mesh.position) {
    ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  }
  for (const model::NodeGroup& group : mesh.node_groups) {
    for (std::size_t i = 0; i < group.nodes.size(); ++i) {
      ASSERT_TRUE(group.nodes[i] >= 0 && group.nodes[i] < nodes);
      ASSERT_TRUE(i == 0 || group.nodes[i - 1] < group.nodes[i]);
    }
  }
}

struct Outcome {
  int meshes{0};
  int refused{0};
};

Outcome read_damaged(const std::vector<std::string>& files, const std::function<model::Mesh(std::string_view)>& read) {
  Outcome outcome;
  std::mt19937 random(20180624);
  for (int i = 0; i < 20000; ++i) {
    const std::string text = test::damaged(files[static_cast<std::size_t>(i) % files.size()], random, nasty);
    try {
      const model::Mesh mesh = read(text);
      expect_sound(mesh);
      ErrorList errors;
      model::check_mesh(mesh, {}, "fuzz", errors);
      ++outcome.meshes;
    } catch (const InputErrors& errors) {
      EXPECT_FALSE(errors.errors().empty());
      for (const InputError& error : errors.errors()) {
        EXPECT_FALSE(error.message.empty());
        EXPECT_FALSE(error.cure.empty());
      }
      ++outcome.refused;
    }
    if (testing::Test::HasFatalFailure()) {
      ADD_FAILURE() << "file " << i << ":\n" << text;
      break;
    }
  }
  return outcome;
}

std::vector<model::Mesh> meshes() {
  return {model::generate_mesh(model::CubedSphere{1.0, 2}), model::generate_mesh(model::Plate{1.0, 1.0, 1, 1, "one"})};
}

void expect_both(const Outcome& outcome) {
  EXPECT_GT(outcome.meshes, 100) << "most damage went unread";
  EXPECT_GT(outcome.refused, 100) << "no damage was noticed";
}

TEST(damaged_meshes, gmsh_files_give_a_sound_mesh_or_errors) {
  std::vector<std::string> files;
  for (const model::Mesh& mesh : meshes()) {
    files.push_back(test::gmsh_2(mesh));
    files.push_back(test::gmsh_4(mesh));
  }
  expect_both(read_damaged(files, [](std::string_view text) { return read_gmsh(text, "fuzz"); }));
}

TEST(damaged_meshes, stl_files_give_a_sound_mesh_or_errors) {
  std::vector<std::string> files;
  for (const model::Mesh& mesh : meshes()) {
    files.push_back(test::stl_ascii(mesh));
    files.push_back(test::stl_binary(mesh));
  }
  expect_both(read_damaged(files, [](std::string_view text) { return read_stl(text, "fuzz", -1.0); }));
}

TEST(damaged_meshes, obj_files_give_a_sound_mesh_or_errors) {
  std::vector<std::string> files{"g a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1/1/1 2//2 -2 \\\n -1\nf 1 2 3 # x\n"};
  for (const model::Mesh& mesh : meshes()) {
    files.push_back(test::obj(mesh));
  }
  expect_both(read_damaged(files, [](std::string_view text) { return read_obj(text, "fuzz"); }));
}

TEST(damaged_meshes, random_bytes_are_refused_or_empty_in_every_format) {
  std::mt19937 random(1);
  for (int i = 0; i < 500; ++i) {
    std::string bytes(random() % 600, '\0');
    for (char& c : bytes) {
      c = static_cast<char>(random() & 0xffU);
    }
    EXPECT_THROW(static_cast<void>(read_gmsh(bytes, "fuzz")), InputErrors);
    EXPECT_THROW(static_cast<void>(read_stl(bytes, "fuzz", -1.0)), InputErrors);
    try {
      expect_sound(read_obj(bytes, "fuzz"));
    } catch (const InputErrors&) {
    }
  }
}

}  // namespace
}  // namespace fexp::io
