// SPDX-License-Identifier: Apache-2.0
#include "io/mesh_readers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "io/node_welding.hpp"
#include "model/mesh_generators.hpp"
#include "model/topology.hpp"
#include "support/mesh_files.hpp"
#include "support/temporary_directory.hpp"

namespace fexp::io {
namespace {

model::Mesh read_well(const std::filesystem::path& path, double weld_tolerance = -1.0) {
  ErrorList errors;
  InputFiles files;
  model::Mesh mesh = read_mesh(path, {weld_tolerance}, files, errors);
  for (const InputError& error : errors.errors()) {
    ADD_FAILURE() << error.text();
  }
  return mesh;
}

/// Writes and reads a mesh file.
model::Mesh read_text(const std::string& name, std::string_view content, double weld_tolerance = -1.0) {
  const test::TemporaryDirectory directory;
  return read_well(directory.write(name, content), weld_tolerance);
}

/// The one error that reading gives; its place is checked to name the file.
InputError error_of(const std::string& name, std::string_view content) {
  const test::TemporaryDirectory directory;
  ErrorList errors;
  InputFiles files;
  const model::Mesh mesh = read_mesh(directory.write(name, content), {}, files, errors);
  EXPECT_TRUE(mesh.triangle.empty());
  if (errors.size() != 1) {
    ADD_FAILURE() << errors.size() << " errors from " << name;
    return {};
  }
  const InputError& error = errors.errors().front();
  EXPECT_NE(error.place.file.find(name), std::string::npos);
  EXPECT_FALSE(error.accepted.empty());
  EXPECT_FALSE(error.cure.empty());
  return error;
}

testing::AssertionResult says(const InputError& error, const std::string& part, int line = 0, int column = 0) {
  if (error.text().find(part) == std::string::npos || (line > 0 && error.place.line != line) ||
      (column > 0 && error.place.column != column)) {
    return testing::AssertionFailure() << error.text();
  }
  return testing::AssertionSuccess();
}

std::vector<Index> nodes_of_group(const model::Mesh& mesh, const std::string& name) {
  for (const model::NodeGroup& group : mesh.node_groups) {
    if (group.name == name) {
      return group.nodes;
    }
  }
  return {};
}

/// Whether both meshes have the same triangles at the same places, whatever the numbers of their nodes.
void expect_same_surface(const model::Mesh& a, const model::Mesh& b, double tolerance) {
  ASSERT_EQ(a.triangle.size(), b.triangle.size());
  ASSERT_EQ(a.position.size(), b.position.size());
  for (std::size_t t = 0; t < a.triangle.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_LE(norm(a.position[at(a.triangle[t][c])] - b.position[at(b.triangle[t][c])]), tolerance);
    }
  }
}

const char* const gmsh_begin =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n"
    "$EndNodes\n";

TEST(mesh_readers, the_same_mesh_comes_out_of_every_format) {
  for (const model::MeshGenerator& generator :
       {model::MeshGenerator{model::CubedSphere{0.5, 5}}, model::MeshGenerator{model::OpenBox{1.0, 2.0, 1.0, 3, 2, 2}},
        model::MeshGenerator{model::Plate{1.0, 1.0, 4, 4, "crossed"}}}) {
    const model::Mesh mesh = model::generate_mesh(generator);
    expect_same_surface(mesh, read_text("a.msh", test::gmsh_2(mesh)), 0.0);
    expect_same_surface(mesh, read_text("a.msh", test::gmsh_4(mesh)), 0.0);
    expect_same_surface(mesh, read_text("a.msh", test::gmsh_4(mesh, 1000000)), 0.0);
    expect_same_surface(mesh, read_text("a.obj", test::obj(mesh)), 0.0);
    expect_same_surface(mesh, read_text("a.stl", test::stl_ascii(mesh)), 0.0);
    expect_same_surface(mesh, read_text("a.stl", test::stl_binary(mesh)), 1e-7);
    expect_same_surface(mesh, read_text("A.STL", test::stl_binary(mesh)), 1e-7);
    for (const std::string& text : {test::gmsh_2(mesh), test::gmsh_4(mesh), test::obj(mesh), test::stl_ascii(mesh)}) {
      const model::Mesh named = read_text(text[0] == '$' ? "a.msh" : text[0] == '#' ? "a.obj" : "a.stl", text);
      EXPECT_EQ(named.part_names, std::vector<std::string>{"body"});
      EXPECT_EQ(nodes_of_group(named, "body").size(), named.position.size());
    }
  }
}

TEST(mesh_readers, line_ends_of_other_systems_and_tabs_make_no_difference) {
  const model::Mesh mesh = model::generate_mesh(model::CubedSphere{1.0, 2});
  for (const std::string& text : {test::gmsh_2(mesh), test::gmsh_4(mesh), test::obj(mesh), test::stl_ascii(mesh)}) {
    std::string other;
    for (const char c : text) {
      other += c == '\n' ? " \t\r\n" : std::string(1, c);
    }
    const char* const name = text[0] == '$' ? "a.msh" : text[0] == '#' ? "a.obj" : "a.stl";
    expect_same_surface(mesh, read_text(name, other), 0.0);
    EXPECT_EQ(read_text(name, other).part_names, std::vector<std::string>{"body"});
  }
}

TEST(mesh_readers, the_example_profile_is_one_sheet_with_one_hole_and_its_groups) {
  model::Mesh mesh = read_well(FEXP_SOURCE_DIR "/examples/meshes/hat_profile.msh");
  ErrorList errors;
  model::check_mesh(mesh, {}, "hat", errors);
  EXPECT_TRUE(errors.empty());
  std::vector<std::string> parts = mesh.part_names;
  std::sort(parts.begin(), parts.end());
  EXPECT_EQ(parts, (std::vector<std::string>{"crown", "flanges"}));
  for (const Index n : nodes_of_group(mesh, "clamped_end")) {
    EXPECT_NEAR(mesh.position[at(n)].y, 0.0, 1e-12);
  }
  EXPECT_GE(nodes_of_group(mesh, "clamped_end").size(), 10U);
  EXPECT_GE(nodes_of_group(mesh, "hole").size(), 6U);
  auto neighbours = model::edge_neighbours(mesh.triangle);
  long free_edges = 0;
  for (const model::Triangle& n : neighbours) {
    free_edges += std::count(n.begin(), n.end(), no_index);
  }
  const auto triangles = static_cast<long>(mesh.triangle.size());
  const long edges = (3 * triangles + free_edges) / 2;
  EXPECT_EQ(static_cast<long>(mesh.position.size()) - edges + triangles, 0);
  std::vector<model::Triangle> oriented = mesh.triangle;
  EXPECT_TRUE(model::orient_consistently(oriented, neighbours));
  EXPECT_EQ(oriented, mesh.triangle);
}

TEST(gmsh_reader, curves_and_points_become_node_groups_and_unused_nodes_are_left_out) {
  const std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n0 1 \"corner\"\n1 2 \"edge one\"\n2 3 \"skin\"\n"
      "$EndPhysicalNames\n$Nodes\n5\n10 0 0 0\n20 1 0 0\n30 9 9 9\n40 1 1 0\n50 0 1 0\n$EndNodes\n"
      "$Elements\n5\n1 15 2 1 1 10\n2 1 2 2 1 10 20\n3 2 2 3 1 10 20 40\n4 2 2 3 1 10 40 50\n5 15 2 9 1 30\n"
      "$EndElements\n";
  const model::Mesh mesh = read_text("a.msh", text);
  EXPECT_EQ(mesh.node_label, (std::vector<std::int64_t>{10, 20, 40, 50}));
  EXPECT_EQ(mesh.triangle_label, (std::vector<std::int64_t>{3, 4}));
  EXPECT_EQ(nodes_of_group(mesh, "corner"), (std::vector<Index>{0}));
  EXPECT_EQ(nodes_of_group(mesh, "edge one"), (std::vector<Index>{0, 1}));
  EXPECT_EQ(nodes_of_group(mesh, "skin"), (std::vector<Index>{0, 1, 2, 3}));
  EXPECT_EQ(mesh.node_groups.size(), 3U) << "the group of an unused node alone is left out";
}

TEST(gmsh_reader, triangles_in_no_physical_group_are_read_too) {
  const model::Mesh mesh = read_text("a.msh", std::string(gmsh_begin) + "$Elements\n1\n1 2 0 1 2 3\n$EndElements\n");
  EXPECT_EQ(mesh.part_names, std::vector<std::string>{"shell"});
  EXPECT_TRUE(mesh.node_groups.empty());
  EXPECT_EQ(mesh.position.size(), 3U);
}

TEST(gmsh_reader, unnamed_groups_are_called_by_kind_and_tag) {
  const model::Mesh mesh =
      read_text("a.msh", std::string(gmsh_begin) + "$Elements\n2\n1 2 1 4 1 2 3\n2 1 1 6 1 2\n$EndElements\n");
  EXPECT_EQ(mesh.part_names, std::vector<std::string>{"surface_4"});
  EXPECT_EQ(nodes_of_group(mesh, "curve_6"), (std::vector<Index>{0, 1}));
}

TEST(gmsh_reader, a_quadrilateral_is_cut_along_its_shorter_diagonal) {
  const std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1.5 1.5 0\n4 0 1 0\n"
      "$EndNodes\n$Elements\n1\n8 3 0 1 2 3 4\n$EndElements\n";
  const model::Mesh mesh = read_text("a.msh", text);
  ASSERT_EQ(mesh.triangle.size(), 2U);
  EXPECT_EQ(mesh.triangle[0], (model::Triangle{0, 1, 3}));
  EXPECT_EQ(mesh.triangle[1], (model::Triangle{1, 2, 3}));
  EXPECT_EQ(mesh.triangle_label, (std::vector<std::int64_t>{8, 8}));
}

TEST(gmsh_reader, parametric_nodes_and_unknown_sections_are_passed_over) {
  const std::string text =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Comments\n$Nodes are not here\n$EndComments\n$Nodes\n2 3 1 3\n"
      "1 1 1 1\n1\n0 0 0 0.5\n2 1 1 2\n2\n3\n1 0 0 0.1 0.2\n0 1 0 0.3 0.4\n$EndNodes\n"
      "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n$Periodic\n0\n$EndPeriodic\n";
  const model::Mesh mesh = read_text("a.msh", text);
  EXPECT_EQ(mesh.position, (std::vector<Vec3d>{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}));
}

TEST(gmsh_reader, an_entity_in_two_groups_gives_nodes_to_both) {
  const std::string text =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 1 0\n1 0 0 0 1 1 0 2 5 -6 0\n$EndEntities\n"
      "$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n"
      "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n";
  const model::Mesh mesh = read_text("a.msh", text);
  EXPECT_EQ(mesh.part_names, std::vector<std::string>{"surface_5"});
  EXPECT_EQ(nodes_of_group(mesh, "surface_5").size(), 3U);
  EXPECT_EQ(nodes_of_group(mesh, "surface_6").size(), 3U);
}

TEST(gmsh_reader, wrong_files_are_refused_with_line_and_cure) {
  const std::string begin = gmsh_begin;
  EXPECT_TRUE(says(error_of("a.msh", begin + "$Elements\n1\n1 4 0 1 2 3 4\n$EndElements\n"), "tetrahedron", 13, 3));
  EXPECT_TRUE(says(error_of("a.msh", begin + "$Elements\n1\n1 9 0 1 2 3 4 1 2\n"), "-order 1", 13, 3));
  EXPECT_TRUE(says(error_of("a.msh", begin + "$Elements\n1\n1 2 0 1 2 99\n$EndElements\n"), "names node 99", 13, 11));
  EXPECT_TRUE(says(error_of("a.msh", begin + "$Elements\n1\n1 2 0 1 2 x\n$EndElements\n"), "not \"x\"", 13, 11));
  EXPECT_TRUE(says(error_of("a.msh", begin + "$Elements\n2\n1 2 0 1 2 3\n$EndElements\n"), "\"$EndElements\"", 14, 1));
  EXPECT_TRUE(says(error_of("a.msh", begin + "$Elements\n1000000000000\n1 2 0 1 2 3\n"), "1000000000000", 12, 1));
  EXPECT_TRUE(says(error_of("a.msh", begin + "$Elements\n2\n1 2 0 1 2 3\n2 2 0 1"), "is cut off"));
  EXPECT_TRUE(says(error_of("a.msh", begin), "without a section $Elements"));
  EXPECT_TRUE(says(error_of("a.msh", "$MeshFormat\n4.1 1 8\n"), "binary", 2, 5));
  EXPECT_TRUE(
      says(error_of("a.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PartitionedEntities\n3\n"), "partitioned"));
  EXPECT_TRUE(says(error_of("a.msh", "$MeshFormat\n4 0 8\n"), "version 4", 2, 1));
  EXPECT_TRUE(says(error_of("a.msh", "(0 \"Fluent\")\n"), "$MeshFormat", 1, 1));
  EXPECT_TRUE(says(error_of("a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2\n1 0 0 0\n1 1 0 0\n$EndNodes\n"),
                   "node tag 1 stands for two nodes"));
  EXPECT_TRUE(says(error_of("a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 nan 0\n$EndNodes\n"),
                   "not \"nan\"", 6, 5));
  EXPECT_TRUE(says(error_of("a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 1e200 0\n$EndNodes\n"),
                   "1e100", 6, 5));
  EXPECT_TRUE(says(error_of("a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Elements\n1\n"), "before $Nodes", 4));
}

TEST(stl_reader, a_binary_file_that_begins_with_solid_is_read_as_binary) {
  const model::Mesh mesh = model::generate_mesh(model::CubedSphere{1.0, 3});
  expect_same_surface(mesh, read_text("a.stl", test::stl_binary(mesh, "solid made by a program")), 1e-7);
}

TEST(stl_reader, several_solids_become_parts) {
  const model::Mesh mesh = model::generate_mesh(model::Plate{1.0, 1.0, 1, 1, "one"});
  const std::string text = test::stl_ascii(mesh, "left side") + test::stl_ascii(mesh, "") + test::stl_ascii(mesh, "");
  const model::Mesh read = read_text("a.stl", text);
  EXPECT_EQ(read.part_names, (std::vector<std::string>{"left side", "solid_2", "solid_3"}));
  EXPECT_EQ(read.part, (std::vector<Index>{0, 0, 1, 1, 2, 2}));
  EXPECT_EQ(read.position.size(), 4U) << "parts are welded to each other";
  EXPECT_EQ(nodes_of_group(read, "solid_2").size(), 4U);
}

TEST(stl_reader, keywords_may_be_upper_case_and_normals_unusual) {
  const model::Mesh mesh = read_text("a.stl",
                                     "SOLID\nFACET NORMAL nan 0 0\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\n"
                                     "VERTEX +0.0 1e0 0\nENDLOOP\nENDFACET\nENDSOLID\n");
  EXPECT_EQ(mesh.triangle.size(), 1U);
  EXPECT_EQ(mesh.triangle_label, std::vector<std::int64_t>{2}) << "the line of the facet";
}

TEST(stl_reader, wrong_files_are_refused) {
  const model::Mesh mesh = model::generate_mesh(model::CubedSphere{1.0, 2});
  const std::string ascii = test::stl_ascii(mesh), binary = test::stl_binary(mesh);
  EXPECT_TRUE(says(error_of("a.stl", std::string_view(ascii).substr(0, ascii.size() / 2)), "is cut off"));
  EXPECT_TRUE(says(error_of("a.stl", std::string_view(binary).substr(0, binary.size() - 7)),
                   "of 48 triangles it would have 2484 bytes, but it has 2477"));
  EXPECT_TRUE(says(error_of("a.stl", "hello"), "no STL file"));
  EXPECT_TRUE(says(error_of("a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\nvertex 1 0 0\n"),
                   "the vertex's z", 5, 1));
  std::string damaged = binary;
  damaged[84 + 12 + 3] = '\x7f';
  damaged[84 + 12 + 2] = '\xff';
  EXPECT_TRUE(says(error_of("a.stl", damaged), "triangle 1"));
  std::string huge = binary;
  huge[80] = huge[81] = huge[82] = huge[83] = '\xff';
  EXPECT_TRUE(says(error_of("a.stl", huge), "4294967295 triangles"));
}

TEST(node_welding, corners_within_the_tolerance_become_one_node_and_others_do_not) {
  model::Mesh mesh = model::generate_mesh(model::CubedSphere{1.0, 6});
  // Corners are shaken by less than half the tolerance each, differently in every triangle.
  model::Mesh shaken;
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    for (const Index n : mesh.triangle[t]) {
      const double shift = 1e-7 * static_cast<double>(t % 7);
      shaken.position.push_back(mesh.position[at(n)] + Vec3d{shift, -shift, 0.5 * shift});
    }
    const auto first = static_cast<Index>(3 * t);
    shaken.triangle.push_back({first, first + 1, first + 2});
  }
  const std::string text = test::stl_ascii(shaken);
  EXPECT_EQ(read_text("a.stl", text).position.size(), mesh.position.size());
  EXPECT_EQ(read_text("a.stl", text, 2e-6).position.size(), mesh.position.size());
  EXPECT_GT(read_text("a.stl", text, 1e-8).position.size(), 2 * mesh.position.size());
  EXPECT_GT(read_text("a.stl", text, 0.0).position.size(), 2 * mesh.position.size());
}

TEST(node_welding, finds_what_brute_force_finds) {
  std::vector<Vec3d> points;
  std::uint32_t random = 1;
  const auto next = [&random] {
    return static_cast<double>((random = random * 1664525U + 1013904223U) >> 8U) / (1 << 24);
  };
  for (int i = 0; i < 1500; ++i) {
    points.push_back({next(), next(), 0.05 * next()});
  }
  for (const double tolerance : {0.0, 1e-3, 0.01, 0.05, 0.5, 100.0}) {
    const WeldedNodes welded = weld_nodes(points, tolerance);
    std::vector<Vec3d> nodes;
    for (std::size_t p = 0; p < points.size(); ++p) {
      std::size_t n = 0;
      while (n < nodes.size() && norm(nodes[n] - points[p]) > tolerance) {
        ++n;
      }
      if (n == nodes.size()) {
        nodes.push_back(points[p]);
      }
      ASSERT_EQ(welded.node[p], static_cast<Index>(n)) << "tolerance " << tolerance;
    }
    EXPECT_EQ(welded.position, nodes);
  }
}

TEST(node_welding, points_that_all_coincide_become_one_node) {
  EXPECT_EQ(weld_nodes(std::vector<Vec3d>(5, {1.0, 2.0, 3.0}), -1.0).position.size(), 1U);
  EXPECT_TRUE(weld_nodes({}, -1.0).position.empty());
}

TEST(obj_reader, every_form_of_face_corner_is_read_and_polygons_are_cut_into_fans) {
  const std::string text =
      "mtllib x.mtl\nvt 0 0\nvn 0 0 1\nf 1 2 3\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0 # comment\nv 0 1 0\n"
      "g first  group\nusemtl steel\nf 1/1 2/1 3/1\nf 1//1 3//1 4//1 # comment\no second\nf -4/1/1 -3/1/1 -2/1/1 "
      "-1/1/1\n"
      "f 1 2 \\\n 3\n";
  const model::Mesh mesh = read_text("a.obj", text);
  EXPECT_EQ(mesh.triangle,
            (std::vector<model::Triangle>{{0, 1, 2}, {0, 1, 2}, {0, 2, 3}, {0, 1, 2}, {0, 2, 3}, {0, 1, 2}}));
  EXPECT_EQ(mesh.part_names, (std::vector<std::string>{"shell", "first  group", "second"}));
  EXPECT_EQ(mesh.part, (std::vector<Index>{0, 1, 1, 2, 2, 2}));
  EXPECT_EQ(mesh.triangle_label, (std::vector<std::int64_t>{4, 11, 12, 14, 14, 15}));
}

TEST(obj_reader, wrong_files_are_refused_with_line_and_column) {
  const std::string begin = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_TRUE(says(error_of("a.obj", begin + "f 1 2 4\n"), "names vertex 4", 4));
  EXPECT_TRUE(says(error_of("a.obj", begin + "f 1 2 0\n"), "not \"0\"", 4, 7));
  EXPECT_TRUE(says(error_of("a.obj", begin + "f 1 2 -4\n"), "not \"-4\"", 4, 7));
  EXPECT_TRUE(says(error_of("a.obj", begin + "f 1 2 3.5\n"), "not \"3.5\"", 4, 7));
  EXPECT_TRUE(says(error_of("a.obj", begin + "f 1 2\n"), "2 corner(s)", 4));
  EXPECT_TRUE(says(error_of("a.obj", begin + "f 1 2 99999999999999999999\n"), "99999999999999999999", 4, 7));
  EXPECT_TRUE(says(error_of("a.obj", "v 0 0\nv 1 0 0\n"), "the line ends where the vertex's z", 1));
  EXPECT_TRUE(says(error_of("a.obj", "v 0 0 1,5\n"), "\"1,5\"", 1, 7));
}

TEST(mesh_readers, missing_empty_and_unknown_files_are_named_with_what_to_do) {
  const test::TemporaryDirectory directory;
  directory.write("bumper.msh", "x");
  ErrorList errors;
  InputFiles files;
  static_cast<void>(read_mesh(directory.path() / "bumpre.msh", {}, files, errors));
  static_cast<void>(read_mesh(directory.path() / "nowhere" / "bumper.msh", {}, files, errors));
  static_cast<void>(read_mesh(directory.path(), {}, files, errors));
  static_cast<void>(read_mesh(directory.write("empty.stl", ""), {}, files, errors));
  static_cast<void>(read_mesh(directory.write("part.step", "ISO-10303-21;"), {}, files, errors));
  ASSERT_EQ(errors.size(), 5U);
  EXPECT_TRUE(says(errors.errors()[0], "did you mean \"bumper.msh\"?"));
  EXPECT_TRUE(says(errors.errors()[0], "bumpre.msh"));
  EXPECT_TRUE(says(errors.errors()[1], "nowhere\" is not there either"));
  EXPECT_TRUE(says(errors.errors()[2], "is no file"));
  EXPECT_TRUE(says(errors.errors()[3], "is empty"));
  EXPECT_TRUE(says(errors.errors()[4], "format"));
}

TEST(mesh_readers, the_content_decides_where_the_extension_does_not) {
  const model::Mesh mesh = model::generate_mesh(model::CubedSphere{1.0, 2});
  expect_same_surface(mesh, read_text("a.dat", test::gmsh_4(mesh)), 0.0);
  expect_same_surface(mesh, read_text("a.dat", test::stl_binary(mesh)), 1e-7);
  expect_same_surface(mesh, read_text("a.dat", test::stl_ascii(mesh)), 0.0);
}

}  // namespace
}  // namespace fexp::io
