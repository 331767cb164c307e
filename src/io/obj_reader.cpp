// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <charconv>

#include "io/mesh_builder.hpp"
#include "io/mesh_readers.hpp"
#include "io/text_scanner.hpp"

namespace fexp::io {

namespace {

/// The vertex of a face corner "i", "i/j", "i//k" or "i/j/k": texture and normal are not used here. Positive numbers
/// may name vertices that follow later; they are checked when all is read.
Index corner_vertex(const TextScanner& scanner, std::string_view word, std::size_t vertices) {
  const std::size_t slash = std::min(word.find('/'), word.size());
  const std::string_view rest = word.substr(slash);
  std::int64_t number = 0;
  const auto [stop, code] = std::from_chars(word.data(), word.data() + slash, number);
  const bool whole = code == std::errc{} && stop == word.data() + slash &&
                     rest.find_first_not_of("/-0123456789") == std::string_view::npos;
  const auto known = static_cast<std::int64_t>(vertices);
  if (!whole || number == 0 || number < -known || number > static_cast<std::int64_t>(MeshBuilder::most)) {
    scanner.fail_unexpected("the number of a vertex", word,
                            fmt::format("1 to the number of vertices, or -{} to -1 counted from here", known));
  }
  return static_cast<Index>(number > 0 ? number - 1 : known + number);
}

class ObjReader {
 public:
  ObjReader(std::string_view text, const std::string& file)
      : scanner_(text, file, TextScanner::Lines::end_statements), file_(file) {}

  model::Mesh read() {
    do {
      const std::string_view keyword = scanner_.word();
      if (keyword == "v") {
        read_vertex();
      } else if (keyword == "f") {
        read_face();
      } else if (keyword == "g" || keyword == "o") {
        part_ = builder_.part(scanner_.rest_of_line());
      } else if (keyword.find('\0') != std::string_view::npos) {
        scanner_.fail("this is no text", "a Wavefront OBJ file", "export the surface as OBJ again");
      }
    } while (scanner_.next_line());
    check_corners();
    return builder_.take();
  }

 private:
  void read_vertex() {
    if (builder_.position.size() >= MeshBuilder::most) {
      scanner_.fail("too many vertices", fmt::format("at most {}", MeshBuilder::most), "split the file");
    }
    const double x = scanner_.real("the vertex's x");
    const double y = scanner_.real("the vertex's y");
    const double z = scanner_.real("the vertex's z");
    builder_.position.push_back({x, y, z});
    builder_.node_label.push_back(static_cast<std::int64_t>(builder_.position.size()));
  }

  void read_face() {
    const int line = scanner_.line();
    corners_.clear();
    for (std::string_view word = scanner_.word(); !word.empty() && word.front() != '#'; word = scanner_.word()) {
      corners_.push_back(corner_vertex(scanner_, word, builder_.position.size()));
    }
    if (corners_.size() < 3) {
      scanner_.fail(fmt::format("a face with {} corner(s)", corners_.size()), "3 or more corners",
                    "remove the face, or export lines as \"l\"");
    }
    if (builder_.triangles() + corners_.size() > MeshBuilder::most) {
      scanner_.fail("too many triangles", fmt::format("at most {}", MeshBuilder::most), "split the file");
    }
    if (part_ == no_index) {
      part_ = builder_.part("");
    }
    for (std::size_t c = 2; c < corners_.size(); ++c) {
      builder_.add_triangle(corners_[0], corners_[c - 1], corners_[c], part_, line);
    }
  }

  void check_corners() const {
    const model::Mesh& mesh = builder_.mesh();
    const auto vertices = static_cast<Index>(builder_.position.size());
    for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
      for (const Index n : mesh.triangle[t]) {
        if (n >= vertices) {
          throw InputErrors({{{file_, static_cast<int>(mesh.triangle_label[t]), 0},
                              fmt::format("the face names vertex {}, but the file has {} vertices", n + 1, vertices),
                              fmt::format("1 to {}", vertices),
                              "the file is cut off or damaged: export it again"}});
        }
      }
    }
  }

  TextScanner scanner_;
  std::string file_;
  MeshBuilder builder_;
  std::vector<Index> corners_;
  Index part_{no_index};
};

}  // namespace

model::Mesh read_obj(std::string_view text, const std::string& file) { return ObjReader(text, file).read(); }

}  // namespace fexp::io
