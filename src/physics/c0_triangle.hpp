// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "base/inline.hpp"
#include "base/pack.hpp"
#include "base/vec3.hpp"
#include "physics/plane_stress_material.hpp"

/// Belytschko's C0 triangle with one-point quadrature: T. Belytschko, H. Stolarski, N. Carpenter, A C0 triangular plate
/// element with one-point quadrature, IJNME 20 (1984) 787-802 [BSC84], in rate form in a co-rotated frame.
///
/// Deviations from the paper: strain increments use the geometry at mid-step and forces the geometry at the end of the
/// step (the first keeps rigid rotation free of strain, the second conserves angular momentum); resultants turn with
/// the material, not with the side the frame is tied to, so that results do not depend on which corner comes first; a
/// drilling tie and an isotropic scaled rotary inertia are added. docs/theory.md derives all of it.
namespace fexp::physics {

/// What a shell section means to the element.
struct ShellSection {
  double thickness{};  ///< t [length]
  PlaneStressModuli moduli{};
  double drilling{};  ///< Drilling factor beta [-]

  static constexpr double shear_factor = 5.0 / 6.0;
};

/// What the kernels need of a section, made ready once for many elements.
struct ShellStiffness {
  PlaneStressModuli membrane;  ///< t C [force/length]
  PlaneStressModuli bending;   ///< t^3/12 C [force*length]
  double shear;                ///< 5/6 t G [force/length]
  double drilling;             ///< beta G t / 3 [force/length]
  double thickness2;           ///< t^2 [length^2]

  FEXP_INLINE ShellStiffness(const ShellSection& s) noexcept  // NOLINT(google-explicit-constructor)
      : membrane(times(s.thickness, s.moduli)),
        bending(times(s.thickness * s.thickness * s.thickness / 12.0, s.moduli)),
        shear(ShellSection::shear_factor * s.thickness * s.moduli.shear),
        drilling(s.drilling * s.moduli.shear * s.thickness / 3.0),
        thickness2(s.thickness * s.thickness) {}

 private:
  FEXP_INLINE static PlaneStressModuli times(double factor, const PlaneStressModuli& m) noexcept {
    return {factor * m.direct, factor * m.cross, factor * m.shear};
  }
};

/// Local frame and coordinates of a triangle: nodes (0,0), (x2,0), (x3,y3) in the plane of e1, e2.
template <class T>
struct TriangleFrame {
  Vec3<T> e1, e2, e3;
  T x2, x3, y3;                          // [length]
  T doubled_area;                        // [length^2]
  T inverse_side, inverse_doubled_area;  // 1/x2, 1/(x2 y3)
};

/// Frame with e1 along side 1-2 and e3 along the normal. `a` = X2 - X1 and `b` = X3 - X1 [length].
template <class T>
[[nodiscard]] FEXP_INLINE TriangleFrame<T> triangle_frame(const Vec3<T>& a, const Vec3<T>& b) noexcept {
  const Vec3<T> n = cross(a, b);
  TriangleFrame<T> frame;
  frame.x2 = square_root(dot(a, a));
  frame.doubled_area = square_root(dot(n, n));
  // One division for both inverses: it takes as long as a dozen products.
  const T inverse = T(1.0) / (frame.x2 * frame.doubled_area);
  frame.inverse_side = inverse * frame.doubled_area;
  frame.inverse_doubled_area = inverse * frame.x2;
  frame.e1 = frame.inverse_side * a;
  frame.e3 = frame.inverse_doubled_area * n;
  frame.e2 = cross(frame.e3, frame.e1);
  frame.x3 = dot(b, frame.e1);
  frame.y3 = frame.doubled_area * frame.inverse_side;
  return frame;
}

/// Shape function derivatives b_i = dN_i/dx, c_i = dN_i/dy of corners 2 and 3; b3 = 0, and corner 1 is minus the sum.
template <class T>
struct ShapeDerivatives {
  T b2, c2, c3;  // [1/length]

  FEXP_INLINE explicit ShapeDerivatives(const TriangleFrame<T>& f) noexcept
      : b2(f.inverse_side), c2(-(f.x3 * f.inverse_doubled_area)), c3(f.x2 * f.inverse_doubled_area) {}
};

/// Six times Bs, the assumed transverse shear of [BSC84] as it acts on (thx1, thy1, thx2, thy2, thx3, thy3), by ratios
/// of the local coordinates. Rotations enter through differences where that saves products.
template <class T>
struct AssumedShear {
  T p, r, s, u, z;  // x3/x2, x2/y3, 2 x3/y3, y3/x2, -x3^2/(x2 y3) [-]

  FEXP_INLINE AssumedShear(const TriangleFrame<T>& f, const ShapeDerivatives<T>& d) noexcept
      : p(f.x3 * d.b2), r(f.x2 * d.c3), s(f.x3 * (d.c3 + d.c3)), u(f.y3 * d.b2), z(f.x3 * d.c2) {}

  [[nodiscard]] std::array<T, 6> row_xz() const noexcept { return {-u, T(2.0) + p, u, T(3.0) - p, T(0.0), T(1.0)}; }
  [[nodiscard]] std::array<T, 6> row_yz() const noexcept {
    return {p - T(2.0), r + z, -(T(1.0) + p), -(s + z), T(-3.0), s - r};
  }

  /// Six times the shear strains of corner rotations.
  [[nodiscard]] FEXP_INLINE std::array<T, 2> strain(const std::array<T, 3>& tx,
                                                    const std::array<T, 3>& ty) const noexcept {
    const T tx2 = tx[1] - tx[0], ty2 = ty[1] - ty[0], ty3 = ty[2] - ty[0];
    const T sum_x = tx[0] + tx[1] + tx[2], sum_y = ty[0] + ty[1] + ty[2];
    return {(u * tx2 - p * ty2) + (sum_y + ty[0] + (ty[1] + ty[1])),
            ((s - r) * ty3 - p * tx2 - (s + z) * ty2) - (sum_x + tx[0] + (tx[2] + tx[2]))};
  }

  /// The transpose: moments of the corners for shear resultants, which are to be given times A/6.
  FEXP_INLINE void moments(const T& qx, const T& qy, std::array<T, 3>& mx, std::array<T, 3>& my) const noexcept {
    const T pqx = p * qx, pqy = p * qy, uqx = u * qx, zqy = z * qy, sqy = s * qy;
    const T sr = sqy - r * qy;
    mx = {(pqy - uqx) - (qy + qy), (uqx - pqy) - qy, -(qy + qy + qy)};
    my = {(pqx + qx + qx) + (zqy - sr + sqy), (qx + qx + qx - pqx) - (sqy + zqy), qx + sr};
  }
};

/// Strain increments of one step: membrane, curvature, transverse shear, relative drilling of the corners.
template <class T>
struct ShellIncrement {
  T exx, eyy, gxy;
  T kxx, kyy, kxy;
  T gxz, gyz;
  std::array<T, 3> drill;
};

/// Resultants and drilling rotations, accumulated in the co-rotated frame, and the internal energy.
template <class T>
struct ShellResultants {
  T nxx, nyy, nxy;         ///< [force/length]
  T mxx, myy, mxy;         ///< [force]
  T qxz, qyz;              ///< [force/length]
  std::array<T, 3> drill;  ///< [-]
  T energy;                ///< [force*length]
};

/// Components of a strain (engineering shear xy) in a frame turned forwards by a small angle.
template <class T>
FEXP_INLINE void turn_strain(const T& angle, T& xx, T& yy, T& xy) noexcept {
  const T change = angle * xy;
  xy = xy - (angle + angle) * (xx - yy);
  xx = xx + change;
  yy = yy - change;
}

/// Strain increments dt x rate for velocities v12, v13 of corners 2 and 3 relative to corner 1 and rotation rates w, in
/// the frame of the mid-step geometry.
template <class T>
[[nodiscard]] FEXP_INLINE ShellIncrement<T> strain_increment(const TriangleFrame<T>& f, const Vec3<T>& v12,
                                                             const Vec3<T>& v13, const std::array<Vec3<T>, 3>& w,
                                                             const T& dt) noexcept {
  const ShapeDerivatives<T> d(f);
  const AssumedShear<T> shear(f, d);
  // Projections of rates on these are increments.
  const Vec3<T> e1 = dt * f.e1, e2 = dt * f.e2, e3 = dt * f.e3;
  const T u2 = dot(v12, e1), v2 = dot(v12, e2), w2 = dot(v12, e3);
  const T u3 = dot(v13, e1), v3 = dot(v13, e2), w3 = dot(v13, e3);
  std::array<T, 3> tx, ty, tz;
  for (std::size_t i = 0; i < 3; ++i) {
    tx[i] = dot(w[i], e1);
    ty[i] = dot(w[i], e2);
    tz[i] = dot(w[i], e3);
  }
  const T tx2 = tx[1] - tx[0], tx3 = tx[2] - tx[0];
  const T ty2 = ty[1] - ty[0], ty3 = ty[2] - ty[0];

  ShellIncrement<T> e;
  e.exx = d.b2 * u2;
  e.eyy = d.c2 * v2 + d.c3 * v3;
  const T u_y = d.c2 * u2 + d.c3 * u3;
  const T v_x = d.b2 * v2;
  e.gxy = u_y + v_x;
  e.kxx = d.b2 * ty2;
  e.kyy = -(d.c2 * tx2 + d.c3 * tx3);
  e.kxy = (d.c2 * ty2 + d.c3 * ty3) - d.b2 * tx2;

  const std::array<T, 2> assumed = shear.strain(tx, ty);
  const T w_x = d.b2 * w2;
  const T w_y = d.c2 * w2 + d.c3 * w3;
  e.gxz = w_x + T(1.0 / 6.0) * assumed[0];
  e.gyz = w_y + T(1.0 / 6.0) * assumed[1];

  // Corners move along chords, so that the mid-step triangle is smaller than those at either end by an eighth of the
  // square of the turn, and side 1-2 lies in it turned back by `chord` from their mean.
  const T chord = T(0.125) * ((e.exx * u_y + v_x * e.eyy) + w_x * w_y);
  turn_strain(chord, e.exx, e.eyy, e.gxy);
  turn_strain(chord, e.kxx, e.kyy, e.kxy);
  const T gxz = e.gxz;
  e.gxz = gxz + chord * e.gyz;
  e.gyz = e.gyz - chord * gxz;

  const T spin = T(0.5) * (v_x - u_y);
  for (std::size_t i = 0; i < 3; ++i) {
    e.drill[i] = tz[i] - spin;
  }
  return e;
}

/// Drilling stiffness k_d = beta G t (A/3) min(1, t^2/A) [force*length].
template <class T>
[[nodiscard]] FEXP_INLINE T drilling_stiffness(const ShellStiffness& s, const T& area) noexcept {
  return T(s.drilling) * minimum(area, T(s.thickness2));
}

/// The in-plane turn of one step that carries resultants from side 1-2, to which the frame is tied, to the material:
/// the frame turns by v,x, the material by (v,x - u,y)/2, so that resultants turn by -gxy/2 in the frame. It is taken
/// about the mean of old and new, S(n+1) - S(n) = dS + phi J (S(n) + S(n+1))/2, which keeps their length and can be run
/// backwards. All corrections are exactly zero where gxy is.
template <class T>
struct MaterialTurn {
  T phi, half;                   // phi = gxy/2 and phi/2 [-]
  T tensor_scale, vector_scale;  // 1/(1 + phi^2) and 1/(1 + phi^2/4)

  FEXP_INLINE explicit MaterialTurn(const T& gxy) noexcept
      : phi(T(0.5) * gxy), half(T(0.25) * gxy), tensor_scale(), vector_scale() {
    const T tensor = T(1.0) + phi * phi, vector = T(1.0) + half * half;
    const T inverse = T(1.0) / (tensor * vector);
    tensor_scale = inverse * vector;
    vector_scale = inverse * tensor;
  }

  /// Turns the components of a mean plane tensor; returns twice the change of xx and of xy, which the new tensor gets.
  [[nodiscard]] FEXP_INLINE std::array<T, 2> turn_tensor(T& xx, T& yy, T& xy) const noexcept {
    const T difference = T(0.5) * (xx - yy);
    const T change = phi * (tensor_scale * (xy - phi * difference));
    const T shear = -(phi * (difference + change));
    xx = xx + change;
    yy = yy - change;
    xy = xy + shear;
    return {change + change, shear + shear};
  }

  /// The same for a vector: changes of x and of y.
  [[nodiscard]] FEXP_INLINE std::array<T, 2> turn_vector(T& x, T& y) const noexcept {
    const T change_x = half * (vector_scale * (y - half * x));
    const T change_y = -(half * (x + change_x));
    x = x + change_x;
    y = y + change_y;
    return {change_x + change_x, change_y + change_y};
  }
};

/// Transverse shear and drilling rotations of an elastic update, and the energy of the whole: that of the mean of old
/// and new resultants over the area, to which `density` brings what membrane and bending have.
template <class T>
FEXP_INLINE void update_shear_and_drilling(const ShellStiffness& s, const T& area, const ShellIncrement<T>& e,
                                           const MaterialTurn<T>& turn, T density, ShellResultants<T>& r) noexcept {
  const T cs(s.shear);
  const T kd = drilling_stiffness(s, area);
  const T dqx = cs * e.gxz, dqy = cs * e.gyz;
  T mean_x = r.qxz + T(0.5) * dqx, mean_y = r.qyz + T(0.5) * dqy;
  const auto [turned_x, turned_y] = turn.turn_vector(mean_x, mean_y);
  density = density + (mean_x * e.gxz + mean_y * e.gyz);
  r.qxz = r.qxz + (dqx + turned_x);
  r.qyz = r.qyz + (dqy + turned_y);

  T drill(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    drill = drill + (r.drill[i] + T(0.5) * e.drill[i]) * e.drill[i];
    r.drill[i] = r.drill[i] + e.drill[i];
  }
  r.energy = r.energy + (area * density + kd * drill);
}

/// Linear elastic update S += C de of resultants that turn with the material, and of the energy.
template <class T>
FEXP_INLINE void update_elastic(const ShellStiffness& s, const T& area, const ShellIncrement<T>& e,
                                ShellResultants<T>& r) noexcept {
  const MaterialTurn<T> turn(e.gxy);
  T density(0.0);
  const auto add_tensor = [&](const PlaneStressModuli& m, const std::array<T, 3>& strain, T& xx, T& yy, T& xy) {
    const T direct(m.direct), cross(m.cross), shear(m.shear);
    const T dxx = direct * strain[0] + cross * strain[1];
    const T dyy = cross * strain[0] + direct * strain[1];
    const T dxy = shear * strain[2];
    T mean_xx = xx + T(0.5) * dxx, mean_yy = yy + T(0.5) * dyy, mean_xy = xy + T(0.5) * dxy;
    const auto [turned, sheared] = turn.turn_tensor(mean_xx, mean_yy, mean_xy);
    density = density + (mean_xx * strain[0] + mean_yy * strain[1] + mean_xy * strain[2]);
    xx = xx + (dxx + turned);
    yy = yy + (dyy - turned);
    xy = xy + (dxy + sheared);
  };
  add_tensor(s.membrane, {e.exx, e.eyy, e.gxy}, r.nxx, r.nyy, r.nxy);
  add_tensor(s.bending, {e.kxx, e.kyy, e.kxy}, r.mxx, r.myy, r.mxy);
  update_shear_and_drilling(s, area, e, turn, density, r);
}

/// Internal corner forces and moments A B^T S in global directions, in the frame of the geometry at the step's end.
template <class T>
FEXP_INLINE void corner_forces(const ShellStiffness& s, const TriangleFrame<T>& f, const ShellResultants<T>& r,
                               std::array<Vec3<T>, 3>& force, std::array<Vec3<T>, 3>& moment) noexcept {
  const T area = T(0.5) * f.doubled_area;
  const T kd = drilling_stiffness(s, area);
  const T half_drill = T(0.5) * (kd * (r.drill[0] + r.drill[1] + r.drill[2]));
  // A b2, A c2, A c3 [length]
  const T ab2 = T(0.5) * f.y3, ac2 = T(-0.5) * f.x3, ac3 = T(0.5) * f.x2;
  const ShapeDerivatives<T> d(f);
  const AssumedShear<T> shear(f, d);

  const T f2x = ab2 * r.nxx + ac2 * r.nxy + half_drill * d.c2;
  const T f2y = ac2 * r.nyy + ab2 * r.nxy - half_drill * d.b2;
  const T f2z = ab2 * r.qxz + ac2 * r.qyz;
  const T f3x = ac3 * r.nxy + half_drill * d.c3;
  const T f3y = ac3 * r.nyy;
  const T f3z = ac3 * r.qyz;

  const T m2x = -(ac2 * r.myy) - ab2 * r.mxy;
  const T m2y = ab2 * r.mxx + ac2 * r.mxy;
  const T m3x = -(ac3 * r.myy);
  const T m3y = ac3 * r.mxy;
  std::array<T, 3> mx, my;
  const T sixth_area = T(1.0 / 6.0) * area;
  shear.moments(sixth_area * r.qxz, sixth_area * r.qyz, mx, my);
  mx = {mx[0] - (m2x + m3x), mx[1] + m2x, mx[2] + m3x};
  my = {my[0] - (m2y + m3y), my[1] + m2y, my[2] + m3y};

  force[1] = f2x * f.e1 + f2y * f.e2 + f2z * f.e3;
  force[2] = f3x * f.e1 + f3y * f.e2 + f3z * f.e3;
  force[0] = -(force[1] + force[2]);
  for (std::size_t i = 0; i < 3; ++i) {
    moment[i] = mx[i] * f.e1 + my[i] * f.e2 + (kd * r.drill[i]) * f.e3;
  }
}

/// Lumped translational mass m = rho t A / 3 of one corner [mass].
[[nodiscard]] constexpr double corner_mass(double density, double thickness, double area) noexcept {
  return density * thickness * area / 3.0;
}

/// Scaled isotropic rotary inertia m (A/4.5 + t^2/12) of one corner [mass*length^2]; the physical m t^2/12 alone would
/// make the critical step far too small.
[[nodiscard]] constexpr double corner_inertia(double mass, double thickness, double area) noexcept {
  return mass * (area / 4.5 + thickness * thickness / 12.0);
}

}  // namespace fexp::physics
