// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "physics/c0_triangle.hpp"
#include "physics/critical_step.hpp"
#include "physics/linear_elastic.hpp"
#include "support/verification_table.hpp"

namespace {

using fexp::Vec3d;
using fexp::physics::ShellIncrement;
using fexp::physics::ShellResultants;
using fexp::physics::ShellSection;
using fexp::physics::ShellStiffness;
using fexp::physics::TriangleFrame;
using fexp::test::verify;
using Corners = std::array<Vec3d, 3>;

/// Rotation of a vector by the Cayley map of `half` (half the rotation vector's tangent): exactly orthogonal in exact
/// arithmetic, and the finite rotation that a constant nodal rotation rate means to central differences.
Vec3d cayley(const Vec3d& half, const Vec3d& v) {
  const double d = 1.0 / (1.0 + fexp::dot(half, half));
  const Vec3d t = fexp::cross(half, v);
  return v + (2.0 * d) * (t + fexp::cross(half, t));
}

TriangleFrame<double> frame_of(const Corners& x) { return fexp::physics::triangle_frame(x[1] - x[0], x[2] - x[0]); }

/// The MacNeal-Harder patch: ten triangles over 0.24 x 0.12.
struct Patch {
  std::vector<Vec3d> x{{0, 0, 0},       {0.24, 0, 0},    {0.24, 0.12, 0}, {0, 0.12, 0},
                       {0.04, 0.02, 0}, {0.18, 0.03, 0}, {0.16, 0.08, 0}, {0.08, 0.08, 0}};
  std::vector<std::array<std::size_t, 3>> triangles{{0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5}, {2, 3, 7},
                                                    {2, 7, 6}, {3, 0, 4}, {3, 4, 7}, {4, 5, 6}, {4, 6, 7}};
  ShellSection section{0.001, fexp::physics::LinearElastic{1.0, 1.0e6, 0.25}.moduli(), 0.1};
};

struct PatchResult {
  std::vector<ShellResultants<double>> resultants;
  std::vector<Vec3d> force, moment;  // [nodes]
  double largest_force{};
};

/// A step so short that nothing turns or stretches: what accumulates in it, divided by it, is linear in the rates.
constexpr double short_step = 0x1p-60;

/// Rates of resultants and nodal forces for velocities and rotation rates given in the patch's own axes, with the patch
/// turned by `turn` (half Cayley vector).
PatchResult load_patch(const Patch& patch, const std::vector<Vec3d>& v, const std::vector<Vec3d>& w,
                       const Vec3d& turn) {
  PatchResult result;
  result.force.resize(patch.x.size());
  result.moment.resize(patch.x.size());
  for (const auto& t : patch.triangles) {
    Corners x, vt, wt;
    for (std::size_t c = 0; c < 3; ++c) {
      x[c] = cayley(turn, patch.x[t[c]]);
      vt[c] = cayley(turn, v[t[c]]);
      wt[c] = cayley(turn, w[t[c]]);
    }
    const auto frame = frame_of(x);
    ShellResultants<double> s{};
    const auto e = fexp::physics::strain_increment(frame, vt[1] - vt[0], vt[2] - vt[0], wt, short_step);
    fexp::physics::update_elastic(patch.section, 0.5 * frame.doubled_area, e, s);
    for (double* value :
         {&s.nxx, &s.nyy, &s.nxy, &s.mxx, &s.myy, &s.mxy, &s.qxz, &s.qyz, &s.drill[0], &s.drill[1], &s.drill[2]}) {
      *value /= short_step;
    }
    Corners f, m;
    fexp::physics::corner_forces(patch.section, frame, s, f, m);
    for (std::size_t c = 0; c < 3; ++c) {
      result.force[t[c]] += f[c];
      result.moment[t[c]] += m[c];
      result.largest_force = std::max({result.largest_force, fexp::norm(f[c]), fexp::norm(m[c])});
    }
    result.resultants.push_back(s);
  }
  return result;
}

/// Turns in-plane tensor components from the element's axes (e1 at `angle` from the patch's x axis) to the patch's.
std::array<double, 3> to_patch_axes(double xx, double yy, double xy, double cosine, double sine) {
  return {xx * cosine * cosine + yy * sine * sine - 2.0 * xy * sine * cosine,
          xx * sine * sine + yy * cosine * cosine + 2.0 * xy * sine * cosine,
          (xx - yy) * sine * cosine + xy * (cosine * cosine - sine * sine)};
}

std::array<double, 2> first_side(const Patch& patch, std::size_t triangle) {
  const auto& t = patch.triangles[triangle];
  const Vec3d side = patch.x[t[1]] - patch.x[t[0]];
  const double length = fexp::norm(side);
  return {side.x / length, side.y / length};
}

const std::array<Vec3d, 2> turns{Vec3d{0, 0, 0}, Vec3d{0.3, -0.7, 0.4}};

TEST(c0_triangle, membrane_patch_has_constant_stress_and_interior_equilibrium) {
  const Patch patch;
  for (const Vec3d& turn : turns) {
    std::vector<Vec3d> v, w(patch.x.size());
    for (const Vec3d& x : patch.x) {
      v.push_back({1e-3 * (x.x + x.y / 2), 1e-3 * (x.y + x.x / 2), 0});
      // The drilling tie sees no spin in this symmetric field.
    }
    const PatchResult r = load_patch(patch, v, w, turn);
    double sxx = 0, syy = 0, sxy = 0, residual = 0;
    for (std::size_t t = 0; t < r.resultants.size(); ++t) {
      const auto& s = r.resultants[t];
      const auto [c, sn] = first_side(patch, t);
      const auto stress = to_patch_axes(s.nxx, s.nyy, s.nxy, c, sn);
      const double h = patch.section.thickness;
      sxx = std::max(sxx, std::abs(stress[0] / h - 1333.3333333333333));
      syy = std::max(syy, std::abs(stress[1] / h - 1333.3333333333333));
      sxy = std::max(sxy, std::abs(stress[2] / h - 400.0));
    }
    for (std::size_t n = 4; n < 8; ++n) {
      residual = std::max({residual, fexp::norm(r.force[n]), fexp::norm(r.moment[n])});
    }
    const std::string title = turn == turns[0] ? "membrane patch, flat" : "membrane patch, turned";
    verify({"1", title, "stress xx (worst element)", 1333.3333333333333, 1333.3333333333333 + sxx, 1e-10, true,
            "closed form"});
    verify({"1", title, "stress yy (worst element)", 1333.3333333333333, 1333.3333333333333 + syy, 1e-10, true,
            "closed form"});
    verify({"1", title, "stress xy (worst element)", 400, 400 + sxy, 1e-10, true, "closed form"});
    verify({"1", title, "interior residual / force", 0, residual / r.largest_force, 1e-10, false, "equilibrium"});
  }
}

TEST(c0_triangle, bending_patch_has_constant_moments_and_no_shear) {
  const Patch patch;
  for (const Vec3d& turn : turns) {
    std::vector<Vec3d> v, w;
    for (const Vec3d& x : patch.x) {
      v.push_back({0, 0, 1e-3 * (x.x * x.x + x.x * x.y + x.y * x.y) / 2});
      w.push_back({1e-3 * (x.y + x.x / 2), -1e-3 * (x.x + x.y / 2), 0});
    }
    const PatchResult r = load_patch(patch, v, w, turn);
    const double m_reference = 1e6 * 1e-9 / 12 / (1 - 0.0625) * 1e-3 * 1.25;  // D (1 + nu) 1e-3
    const double mxy_reference = m_reference / 1.25 * 0.375;                  // D (1 - nu)/2 1e-3
    double mxx = 0, myy = 0, mxy = 0, shear = 0, residual = 0;
    for (std::size_t t = 0; t < r.resultants.size(); ++t) {
      const auto& s = r.resultants[t];
      const auto [c, sn] = first_side(patch, t);
      const auto m = to_patch_axes(s.mxx, s.myy, s.mxy, c, sn);
      mxx = std::max(mxx, std::abs(std::abs(m[0]) - m_reference));
      myy = std::max(myy, std::abs(std::abs(m[1]) - m_reference));
      mxy = std::max(mxy, std::abs(std::abs(m[2]) - mxy_reference));
      shear = std::max({shear, std::abs(s.qxz), std::abs(s.qyz)});
    }
    for (std::size_t n = 4; n < 8; ++n) {
      residual = std::max({residual, fexp::norm(r.moment[n]) / m_reference});
    }
    const std::string title = turn == turns[0] ? "bending patch, flat" : "bending patch, turned";
    verify({"2", title, "|Mxx| (worst element)", 1.1111111111111111e-7, m_reference + mxx, 1e-10, true, "closed form"});
    verify({"2", title, "|Myy| (worst element)", 1.1111111111111111e-7, m_reference + myy, 1e-10, true, "closed form"});
    verify(
        {"2", title, "|Mxy| (worst element)", 3.3333333333333333e-8, mxy_reference + mxy, 1e-10, true, "closed form"});
    verify(
        {"2", title, "Q over 5/6 G t 1e-3", 0, shear / (5.0 / 6.0 * 4e5 * 1e-3 * 1e-3), 1e-10, false, "closed form"});
    verify({"2", title, "interior residual / M", 0, residual, 1e-10, false, "equilibrium"});
  }
}

TEST(c0_triangle, constant_transverse_shear_is_exact) {
  const Patch patch;
  std::vector<Vec3d> v, w(patch.x.size());
  for (const Vec3d& x : patch.x) {
    v.push_back({0, 0, 1e-3 * (x.x + 2 * x.y)});
  }
  const PatchResult r = load_patch(patch, v, w, {});
  double qx = 0, qy = 0;
  for (std::size_t t = 0; t < r.resultants.size(); ++t) {
    const auto& s = r.resultants[t];
    const auto [c, sn] = first_side(patch, t);
    qx = std::max(qx, std::abs(s.qxz * c - s.qyz * sn - 1.0 / 3.0));
    qy = std::max(qy, std::abs(s.qxz * sn + s.qyz * c - 2.0 / 3.0));
  }
  verify(
      {"3", "constant transverse shear", "Qx (worst element)", 1.0 / 3.0, 1.0 / 3.0 + qx, 1e-12, true, "closed form"});
  verify(
      {"3", "constant transverse shear", "Qy (worst element)", 2.0 / 3.0, 2.0 / 3.0 + qy, 1e-12, true, "closed form"});
}

using Matrix18 = std::array<std::array<double, 18>, 18>;

/// Stiffness of one element, column by column from unit velocities.
Matrix18 element_stiffness(const ShellStiffness& section, const Corners& x) {
  const auto frame = frame_of(x);
  Matrix18 k{};
  for (std::size_t j = 0; j < 18; ++j) {
    Corners v{}, w{};
    Vec3d& target = j % 6 < 3 ? v[j / 6] : w[j / 6];
    (j % 3 == 0 ? target.x : j % 3 == 1 ? target.y : target.z) = 1.0;
    ShellResultants<double> s{};
    fexp::physics::update_elastic(section, 0.5 * frame.doubled_area,
                                  fexp::physics::strain_increment(frame, v[1] - v[0], v[2] - v[0], w, short_step), s);
    Corners f, m;
    fexp::physics::corner_forces(section, frame, s, f, m);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::array<double, 6> column{f[c].x, f[c].y, f[c].z, m[c].x, m[c].y, m[c].z};
      for (std::size_t d = 0; d < 6; ++d) {
        k[6 * c + d][j] = column[d] / short_step;
      }
    }
  }
  return k;
}

/// Eigenvalues of a symmetric matrix by cyclic Jacobi rotations, ascending.
std::array<double, 18> eigenvalues(Matrix18 a) {
  for (int sweep = 0; sweep < 60; ++sweep) {
    for (std::size_t p = 0; p < 18; ++p) {
      for (std::size_t q = p + 1; q < 18; ++q) {
        if (a[p][q] == 0.0) {
          continue;
        }
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (std::size_t i = 0; i < 18; ++i) {
          const double aip = a[i][p], aiq = a[i][q];
          a[i][p] = c * aip - s * aiq;
          a[i][q] = s * aip + c * aiq;
        }
        for (std::size_t i = 0; i < 18; ++i) {
          const double api = a[p][i], aqi = a[q][i];
          a[p][i] = c * api - s * aqi;
          a[q][i] = s * api + c * aqi;
        }
      }
    }
  }
  std::array<double, 18> values{};
  for (std::size_t i = 0; i < 18; ++i) {
    values[i] = a[i][i];
  }
  std::sort(values.begin(), values.end());
  return values;
}

TEST(c0_triangle, one_element_has_the_right_number_of_zero_modes) {
  const Corners x{Vec3d{0.1, 0.2, 0.3}, Vec3d{1.2, 0.1, 0.5}, Vec3d{0.4, 0.9, 0.1}};
  for (const auto& [drilling, expected] : {std::pair{0.0, 10.0}, std::pair{0.3, 7.0}}) {
    const ShellSection section{0.5, fexp::physics::LinearElastic{1.0, 1.0, 0.3}.moduli(), drilling};
    const auto values = eigenvalues(element_stiffness(section, x));
    const auto zero = static_cast<double>(
        std::count_if(values.begin(), values.end(), [&](double v) { return std::abs(v) < 1e-12 * values.back(); }));
    verify({"4", "one element", drilling > 0 ? "zero modes with drilling tie" : "zero modes", expected, zero, 0, true,
            "rank of B"});
  }
}

TEST(c0_triangle, stiffness_is_symmetric_and_does_not_depend_on_the_first_corner) {
  const Corners x{Vec3d{0.1, 0.2, 0.3}, Vec3d{1.2, 0.1, 0.5}, Vec3d{0.4, 0.9, 0.1}};
  const ShellSection section{0.05, fexp::physics::LinearElastic{1.0, 1.0, 0.3}.moduli(), 0.3};
  const Matrix18 k = element_stiffness(section, x);
  double largest = 0, asymmetry = 0, change = 0;
  for (std::size_t shift = 1; shift < 3; ++shift) {
    const Matrix18 other = element_stiffness(section, {x[shift], x[(shift + 1) % 3], x[(shift + 2) % 3]});
    for (std::size_t i = 0; i < 18; ++i) {
      for (std::size_t j = 0; j < 18; ++j) {
        largest = std::max(largest, std::abs(k[i][j]));
        asymmetry = std::max(asymmetry, std::abs(k[i][j] - k[j][i]));
        change = std::max(change, std::abs(k[i][j] - other[(i + 18 - 6 * shift) % 18][(j + 18 - 6 * shift) % 18]));
      }
    }
  }
  verify({"4", "one element", "asymmetry of K / largest entry", 0, asymmetry / largest, 1e-15, false, "exact"});
  verify({"4", "one element", "change of K by renumbering", 0, change / largest, 1e-15, false, "exact"});
}

/// Critical step 2/omega of one free element from all 18 degrees of freedom, with the mass of a section and an area.
double exact_critical_step(const ShellStiffness& stiffness, const ShellSection& section, double density, double area,
                           const Corners& x) {
  Matrix18 k = element_stiffness(stiffness, x);
  const double mass = fexp::physics::corner_mass(density, section.thickness, area);
  const double inertia = fexp::physics::corner_inertia(mass, section.thickness, area);
  for (std::size_t i = 0; i < 18; ++i) {
    for (std::size_t j = 0; j < 18; ++j) {
      k[i][j] /= std::sqrt((i % 6 < 3 ? mass : inertia) * (j % 6 < 3 ? mass : inertia));
    }
  }
  return 2.0 / std::sqrt(eigenvalues(k).back());
}

double exact_critical_step(const ShellSection& section, double density, const Corners& x) {
  return exact_critical_step(section, section, density, 0.5 * frame_of(x).doubled_area, x);
}

TEST(critical_step, of_a_thin_right_isosceles_triangle_is_the_exact_one) {
  const auto moduli = fexp::physics::LinearElastic{1.0, 1.0, 0.0}.moduli();
  // b_i and c_i of a triangle with legs 1: (-1, 1, 0) and (-1, 0, 1).
  const double membrane = 2.0 / std::sqrt(3.0 * fexp::physics::membrane_eigenvalue(moduli, 2.0, 2.0, 1.0));
  verify({"9", "right isosceles triangle, leg 1", "membrane step c / leg", 2.0 / 3.0, membrane, 1e-12, true,
          "closed form"});
  const Corners x{Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}};
  for (const double thickness : {0.001, 0.01}) {
    const ShellSection section{thickness, moduli, 0.1};
    verify({"9", "right isosceles triangle, leg 1", fmt::format("step c / leg, t = {}", thickness),
            exact_critical_step(section, 1.0, x), fexp::physics::element_critical_step(section, 1.0, frame_of(x)), 1e-4,
            true, "18 degrees of freedom"});
  }
}

TEST(critical_step, is_safe_and_close_for_triangles_of_any_shape) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  double boldest = 0.0, shyest = 1.0;
  for (int i = 0; i < 2000; ++i) {
    Corners x;
    for (Vec3d& corner : x) {
      corner = {unit(random), unit(random), unit(random)};
    }
    const double side = std::sqrt(0.5 * frame_of(x).doubled_area);
    const double thickness = 0.3 * side * std::pow(10.0, -1.5 * (1.0 + unit(random)));
    const fexp::physics::LinearElastic law{1.0, 1.0, 0.24 + 0.24 * unit(random)};
    const ShellSection section{thickness, law.moduli(), 0.5 * (1.0 + unit(random))};
    const double ratio = fexp::physics::element_critical_step(section, law.density, frame_of(x)) /
                         exact_critical_step(section, law.density, x);
    boldest = std::max(boldest, ratio);
    shyest = std::min(shyest, ratio);
  }
  EXPECT_LE(boldest, 1.0 + 1e-12);
  verify(
      {"9", "2000 random triangles", "smallest bound / exact step", 1.0, shyest, 0.03, true, "18 degrees of freedom"});
}

/// Elements that have become thicker or thinner, larger or smaller: membrane and bending have their present thickness,
/// the mass is what it was.
TEST(critical_step, is_safe_and_close_for_elements_whose_thickness_has_changed) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  double boldest = 0.0, shyest = 1.0, boldest_before = 0.0;
  for (int i = 0; i < 2000; ++i) {
    Corners x;
    for (Vec3d& corner : x) {
      corner = {unit(random), unit(random), unit(random)};
    }
    const double area = 0.5 * frame_of(x).doubled_area, growth = std::pow(2.0, unit(random));
    const double reference_area = area * growth * std::pow(1.05, unit(random));  // Elastic volume
    const double before = 3.0 * std::sqrt(reference_area) * std::pow(10.0, -1.5 * (1.0 + unit(random)));
    const fexp::physics::LinearElastic law{1.0, 1.0, 0.24 + 0.24 * unit(random)};
    const ShellSection section{before, law.moduli(), 0.5 * (1.0 + unit(random))};
    const double now = before * growth;
    ShellStiffness stiffness(section);
    stiffness.membrane = ShellStiffness(ShellSection{now, law.moduli(), 0.0}).membrane;
    stiffness.bending = ShellStiffness(ShellSection{now, law.moduli(), 0.0}).bending;
    const double exact = exact_critical_step(stiffness, section, law.density, reference_area, x);
    const double ratio =
        fexp::physics::layered_critical_step(section, law.density, now, reference_area, frame_of(x)) / exact;
    boldest = std::max(boldest, ratio);
    shyest = std::min(shyest, ratio);
    boldest_before =
        std::max(boldest_before, fexp::physics::element_critical_step(section, law.density, frame_of(x)) / exact);
    EXPECT_EQ(fexp::physics::layered_critical_step(section, law.density, before, area, frame_of(x)),
              fexp::physics::element_critical_step(section, law.density, frame_of(x)))
        << "the same as long as nothing has changed";
  }
  EXPECT_LE(boldest, 1.0 + 1e-12);
  EXPECT_GT(boldest_before, 1.02) << "the thickness of the deck would not do";
  verify({"74", "2000 triangles, thickness changed", "smallest bound / exact step", 1.0, shyest, 0.2, true,
          "18 degrees of freedom"});
}

TEST(c0_triangle, finite_rigid_rotation_in_one_step_gives_no_strain) {
  const Corners start{Vec3d{0.3, -0.2, 0.1}, Vec3d{1.3, 0.1, 0.2}, Vec3d{0.5, 0.8, -0.1}};
  for (const Vec3d& axis : {Vec3d{0, 0, 1}, Vec3d{1, 0, 0}, Vec3d{0.36, 0.48, 0.8}}) {
    for (const double angle : {0.1, 0.01, 0.001}) {
      const Vec3d rate = angle * axis;  // over a unit step
      Corners end, middle, v, w;
      for (std::size_t c = 0; c < 3; ++c) {
        end[c] = cayley(0.5 * rate, start[c]);
        v[c] = end[c] - start[c];
        middle[c] = end[c] - 0.5 * v[c];
        w[c] = rate;
      }
      const ShellIncrement<double> e =
          fexp::physics::strain_increment(frame_of(middle), v[1] - v[0], v[2] - v[0], w, 1.0);
      const double largest = std::max({std::abs(e.exx), std::abs(e.eyy), std::abs(e.gxy), std::abs(e.kxx),
                                       std::abs(e.kyy), std::abs(e.kxy), std::abs(e.gxz), std::abs(e.gyz),
                                       std::abs(e.drill[0]), std::abs(e.drill[1]), std::abs(e.drill[2])});
      verify({"5", "rigid rotation in one step",
              fmt::format("strain, {} rad about ({}, {}, {})", angle, axis.x, axis.y, axis.z), 0, largest, 1e-14, false,
              "exact"});
    }
  }
}

}  // namespace
