// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstring>
#include <string>

#include "model/mesh.hpp"

/// The same mesh in every format that fexp reads.
namespace fexp::test {

/// `normals` are written as zeros: readers take them from the corners.
inline std::string stl_ascii(const model::Mesh& mesh, const std::string& name = "body") {
  std::string text = "solid " + name + "\n";
  for (const auto& t : mesh.triangle) {
    text += "  facet normal 0 0 0\n    outer loop\n";
    for (const Index n : t) {
      const Vec3d& p = mesh.position[at(n)];
      text += fmt::format("      vertex {} {} {}\n", p.x, p.y, p.z);
    }
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid " + name + "\n";
}

inline std::string stl_binary(const model::Mesh& mesh, const std::string& header = "binary") {
  std::string bytes = header;
  bytes.resize(80, ' ');
  const auto append = [&bytes](const auto& value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
  };
  append(static_cast<std::uint32_t>(mesh.triangle.size()));
  for (const auto& t : mesh.triangle) {
    for (int i = 0; i < 3; ++i) {
      append(0.0F);
    }
    for (const Index n : t) {
      const Vec3d& p = mesh.position[at(n)];
      append(static_cast<float>(p.x));
      append(static_cast<float>(p.y));
      append(static_cast<float>(p.z));
    }
    append(std::uint16_t{0});
  }
  return bytes;
}

inline std::string obj(const model::Mesh& mesh) {
  std::string text = "# a comment\no body\n";
  for (const Vec3d& p : mesh.position) {
    text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
  }
  for (const auto& t : mesh.triangle) {
    text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
  return text;
}

inline std::string gmsh_2(const model::Mesh& mesh) {
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 7 \"body\"\n$EndPhysicalNames\n";
  text += fmt::format("$Nodes\n{}\n", mesh.position.size());
  for (std::size_t n = 0; n < mesh.position.size(); ++n) {
    const Vec3d& p = mesh.position[n];
    text += fmt::format("{} {} {} {}\n", n + 1, p.x, p.y, p.z);
  }
  text += fmt::format("$EndNodes\n$Elements\n{}\n", mesh.triangle.size());
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    const auto& n = mesh.triangle[t];
    text += fmt::format("{} 2 2 7 1 {} {} {}\n", t + 1, n[0] + 1, n[1] + 1, n[2] + 1);
  }
  return text + "$EndElements\n";
}

/// Its node tags have gaps, as Gmsh leaves them.
inline std::string gmsh_4(const model::Mesh& mesh, int tag_step = 3) {
  std::string text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 7 \"body\"\n$EndPhysicalNames\n";
  text += "$Entities\n0 0 1 0\n5 -1 -1 -1 1 1 1 1 7 0\n$EndEntities\n";
  const std::size_t nodes = mesh.position.size(), triangles = mesh.triangle.size();
  text += fmt::format("$Nodes\n1 {} 1 {}\n2 5 0 {}\n", nodes, static_cast<std::size_t>(tag_step) * nodes, nodes);
  for (std::size_t n = 0; n < nodes; ++n) {
    text += fmt::format("{}\n", static_cast<std::size_t>(tag_step) * n + 1);
  }
  for (const Vec3d& p : mesh.position) {
    text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
  }
  text += fmt::format("$EndNodes\n$Elements\n1 {} 1 {}\n2 5 2 {}\n", triangles, triangles, triangles);
  for (std::size_t t = 0; t < triangles; ++t) {
    const auto& n = mesh.triangle[t];
    text += fmt::format("{} {} {} {}\n", t + 1, tag_step * n[0] + 1, tag_step * n[1] + 1, tag_step * n[2] + 1);
  }
  return text + "$EndElements\n";
}

}  // namespace fexp::test
