// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <tuple>
#include <variant>

#include "base/field.hpp"
#include "model/mesh.hpp"

/// Meshes that the deck can ask for by name. Normals of closed surfaces point outwards.
namespace fexp::model {

inline constexpr Range cell_range{1.0, 10000.0, true, true, "1 to 10000"};
inline constexpr Range ring_range{3.0, 100000.0, true, true, "3 to 100000"};
inline constexpr std::array<std::string_view, 3> diagonal_names{"one", "alternating", "crossed"};
inline constexpr Range angle_range{0.0, 360.0, false, true, "> 0 and <= 360"};
inline constexpr Range cap_range{0.0, 170.0, false, true, "> 0 and <= 170"};

/// Sphere projected from a cube: 12 cells^2 triangles, 6 cells^2 + 2 nodes.
struct CubedSphere {
  static constexpr std::string_view kind = "cubed_sphere";
  double radius{};
  int cells{4};

  static constexpr auto fields = std::tuple{
      Field{"radius", "length", "Radius of the mid-surface.", &CubedSphere::radius, positive, Presence::required},
      Field{"cells", "-", "Cells along each side of the cube; 4 gives 192 triangles.", &CubedSphere::cells, cell_range},
  };
};

/// Sphere from rings of latitude and segments of longitude, poles on the z axis.
struct UvSphere {
  static constexpr std::string_view kind = "uv_sphere";
  double radius{};
  int segments{16};
  int rings{8};

  static constexpr auto fields = std::tuple{
      Field{"radius", "length", "Radius of the mid-surface.", &UvSphere::radius, positive, Presence::required},
      Field{"segments", "-", "Segments round the equator.", &UvSphere::segments, ring_range},
      Field{"rings", "-", "Bands from pole to pole.", &UvSphere::rings,
            Range{2.0, 100000.0, true, true, "2 to 100000"}},
  };
};

/// Rectangle [0, length_x] x [0, length_y] in z = 0, normal +z; or twisted about the line y = length_y / 2, evenly from
/// nothing at x = 0.
struct Plate {
  static constexpr std::string_view kind = "plate";
  double length_x{};
  double length_y{};
  int cells_x{8};
  int cells_y{8};
  std::string diagonals{"one"};
  double twist_degrees{0.0};  ///< At x = length_x, about +x

  static constexpr auto fields = std::tuple{
      Field{"length_x", "length", "Extent along x.", &Plate::length_x, positive, Presence::required},
      Field{"length_y", "length", "Extent along y.", &Plate::length_y, positive, Presence::required},
      Field{"cells_x", "-", "Cells along x.", &Plate::cells_x, cell_range},
      Field{"cells_y", "-", "Cells along y.", &Plate::cells_y, cell_range},
      Field{"diagonals", "-", "How cells are cut: all the one way, the ways alternating, or crossed into four.",
            &Plate::diagonals, Choices(diagonal_names)},
      Field{"twist_degrees", "degree",
            "Angle by which the end at length_x is twisted about the middle line along x, against that at 0.",
            &Plate::twist_degrees},
  };
};

/// Circular cylinder or open panel about the z axis from z = 0, without caps.
struct Cylinder {
  static constexpr std::string_view kind = "cylinder";
  double radius{};
  double length{};
  int cells_around{16};
  int cells_along{8};
  double angle_degrees{360.0};

  static constexpr auto fields = std::tuple{
      Field{"radius", "length", "Radius of the mid-surface.", &Cylinder::radius, positive, Presence::required},
      Field{"length", "length", "Extent along z.", &Cylinder::length, positive, Presence::required},
      Field{"cells_around", "-", "Cells round the axis.", &Cylinder::cells_around, ring_range},
      Field{"cells_along", "-", "Cells along the axis.", &Cylinder::cells_along, cell_range},
      Field{"angle_degrees", "degree", "Angle covered, from the x axis; less than 360 gives an open panel.",
            &Cylinder::angle_degrees, angle_range},
  };
};

/// Cap of a sphere about the origin with its pole on +z: a square of cells drawn onto it, the square's sides on the
/// rim. Normals point away from the origin.
struct SphericalCap {
  static constexpr std::string_view kind = "spherical_cap";
  double radius{};
  double angle_degrees{};
  int cells{8};

  static constexpr auto fields = std::tuple{
      Field{"radius", "length", "Radius of the mid-surface.", &SphericalCap::radius, positive, Presence::required},
      Field{"angle_degrees", "degree", "Angle from the pole to the rim.", &SphericalCap::angle_degrees, cap_range,
            Presence::required},
      Field{"cells", "-", "Cells from rim to rim.", &SphericalCap::cells, cell_range},
  };
};

/// Square tube about the z axis from z = 0, open at both ends.
struct SquareTube {
  static constexpr std::string_view kind = "square_tube";
  double width{};
  double length{};
  int cells_across{8};
  int cells_along{16};

  static constexpr auto fields = std::tuple{
      Field{"width", "length", "Side of the mid-surface's cross section.", &SquareTube::width, positive,
            Presence::required},
      Field{"length", "length", "Extent along z.", &SquareTube::length, positive, Presence::required},
      Field{"cells_across", "-", "Cells along each side of the section.", &SquareTube::cells_across, cell_range},
      Field{"cells_along", "-", "Cells along the axis.", &SquareTube::cells_along, cell_range},
  };
};

/// Floor at z = 0 and four walls, centred on the z axis, open at the top.
struct OpenBox {
  static constexpr std::string_view kind = "open_box";
  double length_x{};
  double length_y{};
  double height{};
  int cells_x{8};
  int cells_y{8};
  int cells_z{8};

  static constexpr auto fields = std::tuple{
      Field{"length_x", "length", "Extent along x.", &OpenBox::length_x, positive, Presence::required},
      Field{"length_y", "length", "Extent along y.", &OpenBox::length_y, positive, Presence::required},
      Field{"height", "length", "Height of the walls.", &OpenBox::height, positive, Presence::required},
      Field{"cells_x", "-", "Cells along x.", &OpenBox::cells_x, cell_range},
      Field{"cells_y", "-", "Cells along y.", &OpenBox::cells_y, cell_range},
      Field{"cells_z", "-", "Cells up the walls.", &OpenBox::cells_z, cell_range},
  };
};

using MeshGenerator = std::variant<CubedSphere, UvSphere, Plate, Cylinder, SphericalCap, SquareTube, OpenBox>;

/// Number of triangles a generator would make; lets absurd requests be refused before memory is asked for.
[[nodiscard]] double triangle_count(const MeshGenerator& generator);

/// Makes the mesh. Parameters must lie in their ranges.
[[nodiscard]] Mesh generate_mesh(const MeshGenerator& generator);

}  // namespace fexp::model
