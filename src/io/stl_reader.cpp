// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "io/mesh_builder.hpp"
#include "io/mesh_readers.hpp"
#include "io/node_welding.hpp"
#include "io/text_scanner.hpp"

namespace fexp::io {

namespace {

constexpr std::size_t header_bytes = 84;
constexpr std::size_t facet_bytes = 50;

static_assert(std::endian::native == std::endian::little, "binary STL is read without byte swapping");

std::size_t announced_facets(std::string_view bytes) noexcept {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + header_bytes - sizeof count, sizeof count);
  return count;
}

/// Corners of facets, three each, before welding.
struct Facets {
  std::vector<Vec3d> corner;        // [length]
  std::vector<Index> part;          // [facets]
  std::vector<std::int64_t> label;  // [facets]
};

model::Mesh welded_mesh(const Facets& facets, MeshBuilder& builder, double weld_tolerance) {
  WeldedNodes welded = weld_nodes(facets.corner, weld_tolerance);
  builder.position = std::move(welded.position);
  builder.reserve_triangles(facets.label.size());
  for (std::size_t f = 0; f < facets.label.size(); ++f) {
    builder.add_triangle(welded.node[3 * f], welded.node[3 * f + 1], welded.node[3 * f + 2], facets.part[f],
                         facets.label[f]);
  }
  return builder.take();
}

[[noreturn]] void fail(const std::string& file, std::string message, std::string accepted, std::string cure) {
  throw InputErrors({{{file, 0, 0}, std::move(message), std::move(accepted), std::move(cure)}});
}

model::Mesh read_binary(std::string_view bytes, const std::string& file, double weld_tolerance) {
  const std::size_t count = announced_facets(bytes);
  if (count > MeshBuilder::most) {
    fail(file, fmt::format("{} triangles", count), fmt::format("at most {}", MeshBuilder::most), "split the file");
  }
  Facets facets;
  facets.corner.reserve(3 * count);
  facets.label.reserve(count);
  facets.part.assign(count, 0);
  for (std::size_t f = 0; f < count; ++f) {
    float value[12];  // normal and three corners; the normal follows from the corners
    std::memcpy(value, bytes.data() + header_bytes + facet_bytes * f, sizeof value);
    for (std::size_t c = 1; c < 4; ++c) {
      const Vec3d p{value[3 * c], value[3 * c + 1], value[3 * c + 2]};
      if (!std::isfinite(p.x + p.y + p.z)) {
        fail(file, fmt::format("a corner of triangle {} is not a finite number", f + 1), "finite coordinates",
             "the file is damaged: export it again");
      }
      facets.corner.push_back(p);
    }
    facets.label.push_back(static_cast<std::int64_t>(f) + 1);
  }
  MeshBuilder builder;
  static_cast<void>(builder.part(""));
  return welded_mesh(facets, builder, weld_tolerance);
}

/// One facet, whose keyword "facet" was taken.
void read_facet(TextScanner& scanner, Facets& facets) {
  facets.label.push_back(scanner.line());
  scanner.expect("normal");
  for (int i = 0; i < 3; ++i) {
    // The normal follows from the corners; some programs write words like "nan" for it.
    if (const std::string_view value = scanner.word(); value.empty()) {
      scanner.fail_unexpected("the facet's normal", value, "three numbers");
    }
  }
  scanner.expect("outer");
  scanner.expect("loop");
  for (int c = 0; c < 3; ++c) {
    scanner.expect("vertex");
    const double x = scanner.real("the vertex's x");
    const double y = scanner.real("the vertex's y");
    const double z = scanner.real("the vertex's z");
    facets.corner.push_back({x, y, z});
  }
  scanner.expect("endloop");
  scanner.expect("endfacet");
}

model::Mesh read_ascii(std::string_view text, const std::string& file, double weld_tolerance) {
  TextScanner scanner(text, file, TextScanner::Lines::flow);
  MeshBuilder builder;
  Facets facets;
  int solids = 0;
  while (!scanner.peek().empty()) {
    scanner.expect("solid");
    const std::string name(scanner.rest_of_line());
    ++solids;
    const Index part = builder.part(name.empty() && solids > 1 ? fmt::format("solid_{}", solids) : name);
    std::string_view word = scanner.word();
    while (same_but_case(word, "facet")) {
      if (facets.label.size() >= MeshBuilder::most) {
        scanner.fail("too many triangles", fmt::format("at most {}", MeshBuilder::most), "split the file");
      }
      read_facet(scanner, facets);
      facets.part.push_back(part);
      word = scanner.word();
    }
    if (!same_but_case(word, "endsolid")) {
      scanner.fail_unexpected("\"facet\" or \"endsolid\"", word, "\"facet\" or \"endsolid\"");
    }
    static_cast<void>(scanner.rest_of_line());
  }
  return welded_mesh(facets, builder, weld_tolerance);
}

}  // namespace

bool is_binary_stl(std::string_view bytes) noexcept {
  return bytes.size() >= header_bytes && bytes.size() == header_bytes + facet_bytes * announced_facets(bytes);
}

model::Mesh read_stl(std::string_view bytes, const std::string& file, double weld_tolerance) {
  // Binary headers may begin with "solid" too, so the size decides first.
  if (is_binary_stl(bytes)) {
    return read_binary(bytes, file, weld_tolerance);
  }
  const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
  const bool solid = begin != std::string_view::npos && same_but_case(bytes.substr(begin, 5), "solid");
  const bool text = bytes.substr(0, 4096).find('\0') == std::string_view::npos;
  if (solid && text) {
    return read_ascii(bytes, file, weld_tolerance);
  }
  if (bytes.size() >= header_bytes && !text) {
    const std::size_t count = announced_facets(bytes);
    fail(file,
         fmt::format("as a binary STL file of {} triangles it would have {} bytes, but it has {}", count,
                     header_bytes + facet_bytes * count, bytes.size()),
         "STL, ASCII or binary", "the file is cut off, damaged or of another format: export it again");
  }
  fail(file, fmt::format("this is no STL file ({} bytes, not beginning with \"solid\")", bytes.size()),
       "STL, ASCII or binary", "export the surface as STL again");
}

}  // namespace fexp::io
