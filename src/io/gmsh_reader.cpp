// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "io/mesh_builder.hpp"
#include "io/mesh_readers.hpp"
#include "io/text_scanner.hpp"

namespace fexp::io {

namespace {

constexpr std::int64_t largest_tag = std::int64_t{1} << 62;

/// What is known about the kinds of elements a surface mesh may hold, and the ones most often met by mistake.
struct ElementKind {
  int type;
  int dimension;
  int nodes;
  std::string_view name;
  std::string_view cure;  ///< Empty when it can be read.
};
constexpr std::string_view only_surfaces = "mesh and save surfaces only (gmsh -2), or remove the volumes";
constexpr std::string_view first_order = "mesh with elements of first order (gmsh -order 1)";
constexpr ElementKind element_kinds[] = {
    {15, 0, 1, "point", ""},
    {1, 1, 2, "line", ""},
    {2, 2, 3, "triangle", ""},
    {3, 2, 4, "quadrilateral", ""},
    {4, 3, 4, "tetrahedron", only_surfaces},
    {5, 3, 8, "hexahedron", only_surfaces},
    {6, 3, 6, "prism", only_surfaces},
    {7, 3, 5, "pyramid", only_surfaces},
    {8, 1, 3, "line of second order", first_order},
    {9, 2, 6, "triangle of second order", first_order},
    {10, 2, 9, "quadrilateral of second order", first_order},
    {16, 2, 8, "quadrilateral of second order", first_order},
};

/// Node index by the file's node tag: a plain table when tags are dense, else a sorted list.
class NodeTags {
 public:
  /// Builds the look-up; returns a tag that stands for two nodes, or 0.
  std::int64_t build(const std::vector<std::int64_t>& tags) {
    const std::int64_t highest = tags.empty() ? 0 : *std::max_element(tags.begin(), tags.end());
    if (static_cast<std::size_t>(highest) <= 8 * tags.size() + 1024) {
      table_.assign(static_cast<std::size_t>(highest) + 1, no_index);
      for (std::size_t i = 0; i < tags.size(); ++i) {
        Index& entry = table_[static_cast<std::size_t>(tags[i])];
        if (entry != no_index) {
          return tags[i];
        }
        entry = static_cast<Index>(i);
      }
      return 0;
    }
    for (std::size_t i = 0; i < tags.size(); ++i) {
      sorted_.emplace_back(tags[i], static_cast<Index>(i));
    }
    std::sort(sorted_.begin(), sorted_.end());
    const auto twice = std::adjacent_find(sorted_.begin(), sorted_.end(),
                                          [](const auto& a, const auto& b) { return a.first == b.first; });
    return twice == sorted_.end() ? 0 : twice->first;
  }
  [[nodiscard]] Index find(std::int64_t tag) const noexcept {
    if (!table_.empty()) {
      return static_cast<std::size_t>(tag) < table_.size() ? table_[static_cast<std::size_t>(tag)] : no_index;
    }
    const auto entry = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair{tag, Index{0}});
    return entry != sorted_.end() && entry->first == tag ? entry->second : no_index;
  }

 private:
  std::vector<Index> table_;
  std::vector<std::pair<std::int64_t, Index>> sorted_;
};

class GmshReader {
 public:
  GmshReader(std::string_view text, const std::string& file) : scanner_(text, file, TextScanner::Lines::flow) {}

  model::Mesh read() {
    read_format();
    do {
      const std::string_view section = scanner_.word();
      if (section.empty()) {
        break;
      }
      if (section == "$PhysicalNames") {
        read_physical_names();
      } else if (section == "$Entities" && version_ == 4) {
        read_entities();
      } else if (section == "$PartitionedEntities") {
        scanner_.fail("the mesh is partitioned", "a mesh in one piece", "mesh it again without partitions");
      } else if (section == "$Nodes") {
        read_nodes();
      } else if (section == "$Elements") {
        read_elements();
      } else if (section.front() == '$') {
        skip_section(section);
      }
    } while (scanner_.next_line());
    if (!elements_read_) {
      scanner_.fail("the file ends without a section $Elements", "sections $Nodes and $Elements",
                    "the file is cut off, or the geometry was saved before meshing (gmsh -2)");
    }
    return builder_.take();
  }

 private:
  /// A physical group, as the mesh's parts and node groups will know it.
  struct Physical {
    std::size_t group;
    Index part;  ///< no_index unless of dimension 2
  };

  void read_format() {
    while (scanner_.peek() == "$Comments") {
      skip_section(scanner_.word());
      scanner_.next_line();
    }
    if (const std::string_view first = scanner_.word(); first != "$MeshFormat") {
      scanner_.fail(fmt::format("the file begins with \"{}\"", shown(first)), "\"$MeshFormat\", as Gmsh writes it",
                    "export the mesh as Gmsh .msh, version 2.2 or 4.1, ASCII");
    }
    const std::string_view version = scanner_.word();
    version_ = version == "4.1" ? 4 : (version == "2" || version.substr(0, 2) == "2.") ? 2 : 0;
    if (version_ == 0) {
      scanner_.fail(fmt::format("Gmsh format version {}", shown(version)), "2.2 or 4.1",
                    "convert it: gmsh FILE -save -format msh41 -o NEW_FILE");
    }
    if (scanner_.integer("the file type", 0, 1) == 1) {
      scanner_.fail("the file is binary", "ASCII (file type 0)",
                    "convert it: gmsh FILE -save -format msh41 -o NEW_FILE, or leave out -bin");
    }
    static_cast<void>(scanner_.integer("the data size", 1, 64));
    scanner_.expect("$EndMeshFormat");
  }

  void skip_section(std::string_view section) {
    const std::string end = "$End" + std::string(section.substr(1));
    while (scanner_.next_line()) {
      if (scanner_.peek() == end) {
        return;
      }
    }
    scanner_.fail(fmt::format("the file ends inside section {}", shown(section)), end,
                  "the file is cut off or damaged: export it again");
  }

  void read_physical_names() {
    const std::size_t count = scanner_.count("the number of physical names", 6);
    for (std::size_t i = 0; i < count; ++i) {
      const auto dimension = static_cast<int>(scanner_.integer("the physical group's dimension", 0, 3));
      const std::int64_t tag = scanner_.integer("the physical group's tag", 1, largest_tag);
      names_[{dimension, tag}] = scanner_.quoted("the physical group's name");
    }
    scanner_.expect("$EndPhysicalNames");
  }

  const Physical& physical(int dimension, std::int64_t tag) {
    // Gmsh marks surfaces whose orientation it turned by negative tags.
    const std::pair key{dimension, tag < 0 ? -tag : tag};
    const auto found = physicals_.find(key);
    if (found != physicals_.end()) {
      return found->second;
    }
    constexpr std::string_view kinds[] = {"point", "curve", "surface", "volume"};
    const auto named = names_.find(key);
    const std::string name = named != names_.end() && !named->second.empty()
                                 ? std::string(named->second)
                                 : fmt::format("{}_{}", kinds[dimension], key.second);
    const Physical made{builder_.group(name), dimension == 2 ? builder_.part(name) : no_index};
    return physicals_.emplace(key, made).first->second;
  }

  void read_entities() {
    constexpr std::string_view what = "the number of entities";
    std::size_t counts[4];
    for (std::size_t& count : counts) {
      count = scanner_.count(what, 4);
    }
    for (int dimension = 0; dimension < 4; ++dimension) {
      for (std::size_t i = 0; i < counts[dimension]; ++i) {
        const std::int64_t tag = scanner_.integer("the entity's tag", -largest_tag, largest_tag);
        for (int c = 0; c < (dimension == 0 ? 3 : 6); ++c) {
          static_cast<void>(scanner_.real("the entity's box"));
        }
        std::vector<std::int64_t>& tags = entities_[{dimension, tag}];
        for (std::int64_t n = scanner_.integer("the number of physical tags", 0, 1000); n > 0; --n) {
          tags.push_back(scanner_.integer("the physical tag", -largest_tag, largest_tag));
        }
        if (dimension > 0) {
          for (std::size_t n = scanner_.count("the number of bounding entities", 2); n > 0; --n) {
            static_cast<void>(scanner_.integer("the bounding entity's tag", -largest_tag, largest_tag));
          }
        }
      }
    }
    scanner_.expect("$EndEntities");
  }

  void read_nodes() {
    if (!builder_.position.empty()) {
      scanner_.fail("a second section $Nodes", "one section $Nodes", "save the mesh again with Gmsh");
    }
    if (version_ == 2) {
      const std::size_t count = scanner_.count("the number of nodes", 8);
      reserve_nodes(count);
      for (std::size_t i = 0; i < count; ++i) {
        builder_.node_label.push_back(scanner_.integer("the node's tag", 1, largest_tag));
        read_position();
      }
    } else {
      const std::size_t blocks = scanner_.count("the number of node blocks", 8);
      const std::size_t count = scanner_.count("the number of nodes", 6);
      static_cast<void>(scanner_.integer("the lowest node tag", 0, largest_tag));
      static_cast<void>(scanner_.integer("the highest node tag", 0, largest_tag));
      reserve_nodes(count);
      for (std::size_t b = 0; b < blocks; ++b) {
        read_node_block();
      }
      check_count("nodes", count, builder_.position.size());
    }
    if (const std::int64_t twice = node_of_tag_.build(builder_.node_label); twice != 0) {
      scanner_.fail(fmt::format("node tag {} stands for two nodes", twice), "every tag once",
                    "the file is damaged: export it again");
    }
    nodes_read_ = true;
    scanner_.expect("$EndNodes");
  }

  void reserve_nodes(std::size_t count) {
    if (count > MeshBuilder::most) {
      scanner_.fail(fmt::format("{} nodes", count), fmt::format("at most {}", MeshBuilder::most), "split the mesh");
    }
    builder_.position.reserve(count);
    builder_.node_label.reserve(count);
  }

  void read_node_block() {
    const std::int64_t dimension = scanner_.integer("the entity's dimension", 0, 3);
    static_cast<void>(scanner_.integer("the entity's tag", -largest_tag, largest_tag));
    const bool parametric = scanner_.integer("the mark of parametric nodes", 0, 1) == 1;
    const std::size_t count = scanner_.count("the number of nodes of the block", 8);
    for (std::size_t i = 0; i < count; ++i) {
      builder_.node_label.push_back(scanner_.integer("the node's tag", 1, largest_tag));
    }
    for (std::size_t i = 0; i < count; ++i) {
      read_position();
      for (std::int64_t d = 0; parametric && d < dimension; ++d) {
        static_cast<void>(scanner_.real("the node's parameter"));
      }
    }
  }

  void read_position() {
    const double x = scanner_.real("the node's x");
    const double y = scanner_.real("the node's y");
    const double z = scanner_.real("the node's z");
    builder_.position.push_back({x, y, z});
  }

  void check_count(std::string_view what, std::size_t announced, std::size_t found) const {
    if (announced != found) {
      scanner_.fail(fmt::format("the section announces {} {}, its blocks hold {}", announced, what, found),
                    "equal numbers", "the file is damaged: export it again");
    }
  }

  /// Room for as many triangles as there are said to be, but no more than the rest of the file has lines for.
  void reserve(std::size_t count) {
    constexpr std::size_t shortest_line = 8;  // "1 2 3 4\n"
    builder_.reserve_triangles(std::min(count, scanner_.remaining() / shortest_line));
  }

  void read_elements() {
    if (!nodes_read_) {
      scanner_.fail("section $Elements stands before $Nodes", "$Nodes first", "save the mesh again with Gmsh");
    }
    if (version_ == 2) {
      const std::size_t count = scanner_.count("the number of elements", 6);
      reserve(count);
      for (std::size_t i = 0; i < count; ++i) {
        read_element_2();
      }
    } else {
      const std::size_t blocks = scanner_.count("the number of element blocks", 8);
      const std::size_t count = scanner_.count("the number of elements", 4);
      static_cast<void>(scanner_.integer("the lowest element tag", 0, largest_tag));
      static_cast<void>(scanner_.integer("the highest element tag", 0, largest_tag));
      reserve(count);
      std::size_t found = 0;
      for (std::size_t b = 0; b < blocks; ++b) {
        found += read_element_block();
      }
      check_count("elements", count, found);
    }
    elements_read_ = true;
    scanner_.expect("$EndElements");
  }

  const ElementKind& read_kind() {
    const std::int64_t type = scanner_.integer("the element's type", 1, 1000);
    for (const ElementKind& kind : element_kinds) {
      if (kind.type == type && kind.cure.empty()) {
        return kind;
      }
      if (kind.type == type) {
        scanner_.fail(fmt::format("element type {} ({})", type, kind.name),
                      "triangles and quadrilaterals of first order (types 2 and 3), lines, points",
                      std::string(kind.cure));
      }
    }
    scanner_.fail(fmt::format("element type {}", type),
                  "triangles and quadrilaterals of first order (types 2 and 3), lines, points",
                  std::string(first_order));
  }

  void read_element_2() {
    const std::int64_t tag = scanner_.integer("the element's tag", 0, largest_tag);
    const ElementKind& kind = read_kind();
    const std::int64_t tags = scanner_.integer("the number of element tags", 0, 1000);
    physicals_here_.clear();
    for (std::int64_t i = 0; i < tags; ++i) {
      const std::int64_t value = scanner_.integer("the element's tag", -largest_tag, largest_tag);
      if (i == 0 && value != 0) {  // the first is the physical group; the others name geometry
        physicals_here_.push_back(physical(kind.dimension, value));
      }
    }
    read_element(kind, tag);
  }

  std::size_t read_element_block() {
    const auto dimension = static_cast<int>(scanner_.integer("the entity's dimension", 0, 3));
    const std::int64_t entity = scanner_.integer("the entity's tag", -largest_tag, largest_tag);
    const ElementKind& kind = read_kind();
    const std::size_t count = scanner_.count("the number of elements of the block", 4);
    physicals_here_.clear();
    if (const auto found = entities_.find({dimension, entity}); found != entities_.end()) {
      for (const std::int64_t tag : found->second) {
        physicals_here_.push_back(physical(dimension, tag));
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      read_element(kind, scanner_.integer("the element's tag", 0, largest_tag));
    }
    return count;
  }

  /// The nodes of an element, which belongs to the groups in physicals_here_.
  void read_element(const ElementKind& kind, std::int64_t tag) {
    Index node[4] = {};
    for (int i = 0; i < kind.nodes; ++i) {
      const std::int64_t node_tag = scanner_.integer("the element's node", 1, largest_tag);
      node[i] = node_of_tag_.find(node_tag);
      if (node[i] == no_index) {
        scanner_.fail(fmt::format("element {} names node {}, which the file does not have", tag, node_tag),
                      "tags of section $Nodes", "the file is damaged: export it again");
      }
    }
    Index part = no_index;
    for (const Physical& physical : physicals_here_) {
      for (int i = 0; i < kind.nodes; ++i) {
        builder_.add_to_group(physical.group, node[i]);
      }
      part = part == no_index ? physical.part : part;
    }
    if (kind.dimension < 2) {
      return;
    }
    if (builder_.triangles() + 2 > MeshBuilder::most) {
      scanner_.fail("too many triangles", fmt::format("at most {}", MeshBuilder::most), "split the mesh");
    }
    if (part == no_index) {
      part = builder_.part("");
    }
    if (kind.nodes == 3) {
      builder_.add_triangle(node[0], node[1], node[2], part, tag);
    } else {
      builder_.add_quadrilateral(node[0], node[1], node[2], node[3], part, tag);
    }
  }

  TextScanner scanner_;
  int version_{0};
  bool nodes_read_{false};
  bool elements_read_{false};
  MeshBuilder builder_;
  NodeTags node_of_tag_;
  using Key = std::pair<int, std::int64_t>;  // dimension, tag
  std::map<Key, std::string_view> names_;
  std::map<Key, Physical> physicals_;
  std::map<Key, std::vector<std::int64_t>> entities_;
  std::vector<Physical> physicals_here_;
};

}  // namespace

model::Mesh read_gmsh(std::string_view text, const std::string& file) { return GmshReader(text, file).read(); }

}  // namespace fexp::io
