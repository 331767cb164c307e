// SPDX-License-Identifier: Apache-2.0
#include "model/mesh_generators.hpp"

#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "base/trigonometry.hpp"

namespace fexp::model {

namespace {

/// Collects triangles of grid patches whose nodes are named by integer lattice points, so that shared edges weld
/// exactly.
class LatticeMesh {
 public:
  using Point = std::array<int, 3>;

  Index node(const Point& p, const Vec3d& position) {
    const auto [it, fresh] = nodes_.try_emplace(p, static_cast<Index>(mesh_.position.size()));
    if (fresh) {
      mesh_.position.push_back(position);
    }
    return it->second;
  }
  /// Two triangles of the quadrilateral a b c d, cut along a-c, or along b-d when `other`. Its corners come as a list,
  /// whose entries are evaluated in order: arguments may be evaluated in any order, which would number nodes otherwise
  /// with another compiler.
  void quad(const std::array<Index, 4>& corners, bool other) {
    const auto [a, b, c, d] = corners;
    if (other) {
      triangle(a, b, d);
      triangle(b, c, d);
    } else {
      triangle(a, b, c);
      triangle(a, c, d);
    }
  }
  void triangle(Index a, Index b, Index c) {
    mesh_.triangle.push_back({a, b, c});
    mesh_.part.push_back(0);
  }
  Mesh take() { return std::move(mesh_); }

 private:
  Mesh mesh_;
  std::map<Point, Index> nodes_;
};

/// The six sides of a cube as origin and two directions whose cross product points outwards, in lattice units of 0..1.
struct CubeSide {
  std::array<int, 3> origin, u, v;
};
constexpr std::array<CubeSide, 6> cube_sides{{
    {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}},  // x = 0
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},  // x = 1
    {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}},  // y = 0
    {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}},  // y = 1
    {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}},  // z = 0
    {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},  // z = 1
}};

Mesh make(const CubedSphere& s) {
  LatticeMesh mesh;
  const int n = s.cells;
  // Equal angles along the cube's edges keep the cells on the sphere even. The whole number 2 i - n changes its sign
  // alone from one side to the other, so mirrored nodes are mirrored to the last bit.
  const auto coordinate = [n](int i) { return tangent(std::numbers::pi / 4.0 * (2 * i - n) / n); };
  const auto node = [&](const CubeSide& side, int i, int j) {
    std::array<int, 3> p{};
    for (std::size_t d = 0; d < 3; ++d) {
      p[d] = n * side.origin[d] + i * side.u[d] + j * side.v[d];
    }
    const Vec3d cube{coordinate(p[0]), coordinate(p[1]), coordinate(p[2])};
    return mesh.node(p, (s.radius / norm(cube)) * cube);
  };
  for (const CubeSide& side : cube_sides) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        // Diagonals point to the middle of the side, which keeps the triangles' angles even.
        const bool other = (2 * i + 1 < n) == (2 * j + 1 < n);
        mesh.quad({node(side, i, j), node(side, i + 1, j), node(side, i + 1, j + 1), node(side, i, j + 1)}, !other);
      }
    }
  }
  return mesh.take();
}

Mesh make(const UvSphere& s) {
  LatticeMesh mesh;
  const auto node = [&](int ring, int segment) {
    const double polar = std::numbers::pi * ring / s.rings;
    const double azimuth = 2.0 * std::numbers::pi * segment / s.segments;
    const bool pole = ring == 0 || ring == s.rings;
    const double r = pole ? 0.0 : s.radius * sine(polar);
    const double z = pole ? (ring == 0 ? s.radius : -s.radius) : s.radius * cosine(polar);
    return mesh.node({ring, pole ? 0 : segment % s.segments, 0}, {r * cosine(azimuth), r * sine(azimuth), z});
  };
  for (int ring = 0; ring < s.rings; ++ring) {
    for (int k = 0; k < s.segments; ++k) {
      const Index a = node(ring, k), b = node(ring + 1, k), c = node(ring + 1, k + 1), d = node(ring, k + 1);
      if (ring == 0) {
        mesh.triangle(a, b, c);
      } else if (ring == s.rings - 1) {
        mesh.triangle(a, b, d);
      } else {
        mesh.quad({a, b, c, d}, false);
      }
    }
  }
  return mesh.take();
}

Mesh make(const Plate& p) {
  LatticeMesh mesh;
  const auto position = [&](int i, int j) -> Vec3d {
    const double x = p.length_x * i / (2.0 * p.cells_x), y = p.length_y * j / (2.0 * p.cells_y);
    if (p.twist_degrees == 0.0) {
      return {x, y, 0.0};
    }
    const double angle = p.twist_degrees * std::numbers::pi / 180.0 * i / (2.0 * p.cells_x);
    const double middle = 0.5 * p.length_y, beside = y - middle;
    return {x, middle + beside * cosine(angle), beside * sine(angle)};
  };
  // Lattice points are doubled so that centres of crossed cells have one of their own.
  const auto node = [&](int i, int j) { return mesh.node({i, j, 0}, position(i, j)); };
  for (int j = 0; j < p.cells_y; ++j) {
    for (int i = 0; i < p.cells_x; ++i) {
      const Index a = node(2 * i, 2 * j), b = node(2 * i + 2, 2 * j);
      const Index c = node(2 * i + 2, 2 * j + 2), d = node(2 * i, 2 * j + 2);
      if (p.diagonals == "crossed") {
        const Index m = node(2 * i + 1, 2 * j + 1);
        mesh.triangle(a, b, m);
        mesh.triangle(b, c, m);
        mesh.triangle(c, d, m);
        mesh.triangle(d, a, m);
      } else {
        mesh.quad({a, b, c, d}, p.diagonals == "alternating" && (i + j) % 2 == 1);
      }
    }
  }
  return mesh.take();
}

Mesh make(const Cylinder& c) {
  LatticeMesh mesh;
  const bool closed = c.angle_degrees >= 360.0;
  const auto node = [&](int i, int k) {
    const double angle = c.angle_degrees * std::numbers::pi / 180.0 * i / c.cells_around;
    return mesh.node({closed ? i % c.cells_around : i, k, 0},
                     {c.radius * cosine(angle), c.radius * sine(angle), c.length * k / c.cells_along});
  };
  for (int k = 0; k < c.cells_along; ++k) {
    for (int i = 0; i < c.cells_around; ++i) {
      mesh.quad({node(i, k), node(i + 1, k), node(i + 1, k + 1), node(i, k + 1)}, false);
    }
  }
  return mesh.take();
}

Mesh make(const SphericalCap& c) {
  LatticeMesh mesh;
  const int n = c.cells;
  const auto node = [&](int i, int j) {
    // The square onto the unit disc, lines onto ellipses.
    const double p = static_cast<double>(2 * i - n) / n, q = static_cast<double>(2 * j - n) / n;
    const double u = p * std::sqrt(1.0 - 0.5 * q * q), v = q * std::sqrt(1.0 - 0.5 * p * p);
    const double r = std::sqrt(u * u + v * v);
    const double polar = c.angle_degrees * std::numbers::pi / 180.0 * r;
    const double across = r > 0.0 ? c.radius * sine(polar) / r : 0.0;
    return mesh.node({i, j, 0}, {across * u, across * v, c.radius * cosine(polar)});
  };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      // Diagonals point to the middle: at the square's corners, two sides lie in line on the rim.
      const bool other = (2 * i + 1 < n) == (2 * j + 1 < n);
      mesh.quad({node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)}, !other);
    }
  }
  return mesh.take();
}

Mesh make(const SquareTube& t) {
  LatticeMesh mesh;
  const int n = t.cells_across;
  const auto node = [&](int i, int k) {
    const int side = (i / n) % 4, along = i % n;
    const double a = t.width * (static_cast<double>(along) / n - 0.5), h = 0.5 * t.width;
    const std::array<std::array<double, 2>, 4> xy{{{a, -h}, {h, a}, {-a, h}, {-h, -a}}};
    const auto& p = xy[static_cast<std::size_t>(side)];
    return mesh.node({i % (4 * n), k, 0}, {p[0], p[1], t.length * k / t.cells_along});
  };
  for (int k = 0; k < t.cells_along; ++k) {
    for (int i = 0; i < 4 * n; ++i) {
      mesh.quad({node(i, k), node(i + 1, k), node(i + 1, k + 1), node(i, k + 1)}, (i + k) % 2 == 1);
    }
  }
  return mesh.take();
}

Mesh make(const OpenBox& b) {
  LatticeMesh mesh;
  const std::array<int, 3> cells{b.cells_x, b.cells_y, b.cells_z};
  for (std::size_t s = 0; s < 5; ++s) {  // the last side of cube_sides is the lid
    const CubeSide& side = cube_sides[s];
    int nu = 0, nv = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      nu += side.u[d] * cells[d];
      nv += side.v[d] * cells[d];
    }
    const auto node = [&](int i, int j) {
      std::array<int, 3> p{};
      for (std::size_t d = 0; d < 3; ++d) {
        p[d] = cells[d] * side.origin[d] + i * side.u[d] + j * side.v[d];
      }
      return mesh.node(p, {b.length_x * (static_cast<double>(p[0]) / cells[0] - 0.5),
                           b.length_y * (static_cast<double>(p[1]) / cells[1] - 0.5), b.height * p[2] / cells[2]});
    };
    for (int j = 0; j < nv; ++j) {
      for (int i = 0; i < nu; ++i) {
        mesh.quad({node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)}, (i + j) % 2 == 1);
      }
    }
  }
  return mesh.take();
}

double count(const CubedSphere& s) { return 12.0 * s.cells * s.cells; }
double count(const UvSphere& s) { return 2.0 * s.segments * (s.rings - 1.0); }
double count(const Plate& p) { return (p.diagonals == "crossed" ? 4.0 : 2.0) * p.cells_x * p.cells_y; }
double count(const Cylinder& c) { return 2.0 * c.cells_around * c.cells_along; }
double count(const SphericalCap& c) { return 2.0 * c.cells * c.cells; }
double count(const SquareTube& t) { return 8.0 * t.cells_across * t.cells_along; }
double count(const OpenBox& b) {
  return 2.0 * b.cells_x * b.cells_y + 4.0 * b.cells_z * (static_cast<double>(b.cells_x) + b.cells_y);
}

}  // namespace

double triangle_count(const MeshGenerator& generator) {
  return std::visit([](const auto& g) { return count(g); }, generator);
}

Mesh generate_mesh(const MeshGenerator& generator) {
  return std::visit([](const auto& g) { return make(g); }, generator);
}

}  // namespace fexp::model
