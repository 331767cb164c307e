// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/deck.hpp"
#include "model/mesh_generators.hpp"
#include "support/mesh_files.hpp"
#include "support/temporary_directory.hpp"

namespace fexp::io {
namespace {

/// A deck whose bodies have these meshes; that of body "b1" stands in line 5, of "b2" in line 8 and so on.
Deck deck_with(const std::vector<std::string>& meshes) {
  std::string text = "[run]\nduration = 1\n";
  int number = 0;
  for (const std::string& mesh : meshes) {
    text += "[[body]]\nname = \"b" + std::to_string(++number) + "\"\n" + mesh + "\n";
  }
  ErrorList errors;
  Deck deck = parse_deck(text, "d", errors);
  for (const InputError& error : errors.errors()) {
    ADD_FAILURE() << error.text();
  }
  return deck;
}

std::vector<InputError> errors_of(const std::vector<std::string>& meshes, const std::filesystem::path& directory) {
  ErrorList errors;
  InputFiles files;
  const std::vector<model::Mesh> loaded = load_meshes(deck_with(meshes), directory, files, errors);
  EXPECT_EQ(loaded.size(), meshes.size());
  return errors.errors();
}

const std::string small_sphere = "mesh = {kind = \"cubed_sphere\", radius = 1, cells = 2}";

TEST(deck_meshes, are_generated_and_read_relative_to_the_deck_in_the_order_of_bodies) {
  const test::TemporaryDirectory directory;
  const model::Mesh plate = model::generate_mesh(model::Plate{1.0, 1.0, 2, 1, "one"});
  std::filesystem::create_directory(directory / "sub");
  directory.write("sub/plate.msh", test::gmsh_2(plate));
  ErrorList errors;
  InputFiles files;
  const std::string file = "mesh = {kind = \"file\", path = \"sub/plate.msh\"}";
  const auto meshes = load_meshes(deck_with({file, small_sphere, file}), directory.path(), files, errors);
  ASSERT_TRUE(errors.empty()) << errors.errors()[0].text();
  ASSERT_EQ(meshes.size(), 3U);
  EXPECT_EQ(meshes[0].triangle, plate.triangle);
  EXPECT_EQ(meshes[1].triangle.size(), 48U);
  EXPECT_EQ(meshes[2].triangle, plate.triangle);
}

TEST(deck_meshes, the_weld_tolerance_reaches_the_reader) {
  const test::TemporaryDirectory directory;
  const model::Mesh plate = model::generate_mesh(model::Plate{1.0, 1.0, 10, 1, "one"});
  directory.write("plate.stl", test::stl_ascii(plate));
  ErrorList errors;
  InputFiles files;
  const auto meshes = load_meshes(deck_with({"mesh = {kind = \"file\", path = \"plate.stl\"}",
                                             "mesh = {kind = \"file\", path = \"plate.stl\", weld_tolerance = 0.15}"}),
                                  directory.path(), files, errors);
  EXPECT_EQ(meshes[0].position.size(), plate.position.size());
  EXPECT_LT(meshes[1].position.size(), plate.position.size()) << "neighbours 0.1 apart were not joined";
}

TEST(deck_meshes, a_missing_file_is_an_error_of_the_deck_with_the_nearest_name) {
  const test::TemporaryDirectory directory;
  directory.write("plate.msh", "");
  const auto errors = errors_of({small_sphere, "mesh = {kind = \"file\", path = \"plaet.msh\"}"}, directory.path());
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_EQ(errors[0].place.text(), "d:8:8");
  EXPECT_NE(errors[0].message.find("plaet.msh\" is not there (mesh of body \"b2\")"), std::string::npos);
  EXPECT_EQ(errors[0].cure, "did you mean \"plate.msh\"?");
}

TEST(deck_meshes, an_error_in_a_file_keeps_its_place_names_the_body_and_comes_once) {
  const test::TemporaryDirectory directory;
  directory.write("a.obj", "v 0 0 0\nv 1 0 zero\n");
  const std::string file = "mesh = {kind = \"file\", path = \"a.obj\"}";
  const auto errors = errors_of({file, file}, directory.path());
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_EQ(errors[0].place.file, (directory / "a.obj").string());
  EXPECT_EQ(errors[0].place.line, 2);
  EXPECT_NE(errors[0].message.find("(mesh of body \"b1\", d:5:8)"), std::string::npos) << errors[0].text();
}

TEST(deck_meshes, several_bad_files_are_all_told) {
  const test::TemporaryDirectory directory;
  directory.write("a.obj", "v 0 0 zero\n");
  directory.write("empty.msh", "");
  EXPECT_EQ(errors_of({"mesh = {kind = \"file\", path = \"a.obj\"}", "mesh = {kind = \"file\", path = \"none.stl\"}",
                       "mesh = {kind = \"file\", path = \"empty.msh\"}", "mesh = {kind = \"file\", path = \".\"}"},
                      directory.path())
                .size(),
            4U);
}

TEST(deck_meshes, models_beyond_memory_or_indices_are_refused_before_meshes_are_made) {
  const std::string largest =
      "mesh = {kind = \"plate\", length_x = 1, length_y = 1, cells_x = 10000, cells_y = 10000,"
      " diagonals = \"crossed\"}";
  for (const std::string& mesh :
       {small_sphere + "\narray = {count = [100000, 100000, 100000], pitch = [3, 3, 3]}",
        largest + "\narray = {count = [1, 2, 1], pitch = [3, 3, 3]}",
        small_sphere + "\narray = {count = [10000000, 10000000, 10000000], pitch = [3, 3, 3]}"}) {
    const auto errors = errors_of({small_sphere, mesh}, "");
    ASSERT_EQ(errors.size(), 1U);
    EXPECT_EQ(errors[0].place.text(), "d:6:1");
    EXPECT_NE(errors[0].message.find("of them in body \"b2\""), std::string::npos) << errors[0].text();
    EXPECT_NE(errors[0].accepted.find("at most"), std::string::npos);
  }
}

TEST(deck_meshes, the_sum_over_bodies_counts) {
  const std::string large = small_sphere + "\narray = {count = [10000, 1000, 1], pitch = [3, 3, 3]}";
  const auto errors = errors_of({large, large}, "");
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_NE(errors[0].message.find("9.6e+08 triangles, 4.8e+08 of them in body \"b1\""), std::string::npos)
      << errors[0].text();
}

}  // namespace
}  // namespace fexp::io
