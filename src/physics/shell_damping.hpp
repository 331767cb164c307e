// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "physics/c0_triangle.hpp"

namespace fexp::physics {

/// What stiffness damping adds to resultants and drilling rotations, beta C times the rate of strain in the step, with
/// `per_step` = beta/dt and the elastic moduli whatever the section does; and in `energy` what it takes, that of the
/// mean of old and new over the area. Where an element is `deleted`, 1 in the step in which it fails and 2 from then
/// on, there is no damping, and of the energy only what the old resultants take in that one step, whatever became of
/// its geometry.
template <class T>
FEXP_INLINE void update_damping(const ShellStiffness& s, double per_step, const T& area, const ShellIncrement<T>& e,
                                const T& deleted, ShellResultants<T>& r) noexcept {
  const T scale(per_step), half(0.5), zero(0.0);
  T density(0.0);
  // Twice the mean goes into the sum.
  const auto renew = [&](T value, const T& strain, T& row, T& sum) {
    value = select_less(deleted, half, scale * value, zero);
    sum = sum + (row + value) * strain;
    row = value;
  };
  const auto renew_tensor = [&](const PlaneStressModuli& m, const std::array<T, 3>& strain, T& xx, T& yy, T& xy) {
    const T direct(m.direct), cross(m.cross), shear(m.shear);
    renew(direct * strain[0] + cross * strain[1], strain[0], xx, density);
    renew(cross * strain[0] + direct * strain[1], strain[1], yy, density);
    renew(shear * strain[2], strain[2], xy, density);
  };
  renew_tensor(s.membrane, {e.exx, e.eyy, e.gxy}, r.nxx, r.nyy, r.nxy);
  renew_tensor(s.bending, {e.kxx, e.kyy, e.kxy}, r.mxx, r.myy, r.mxy);
  renew(T(s.shear) * e.gxz, e.gxz, r.qxz, density);
  renew(T(s.shear) * e.gyz, e.gyz, r.qyz, density);
  T drill(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    renew(e.drill[i], e.drill[i], r.drill[i], drill);
  }
  const T taken = half * (area * density + drilling_stiffness(s, area) * drill);
  r.energy = select_less(deleted, T(1.5), r.energy + taken, r.energy);
}

}  // namespace fexp::physics
