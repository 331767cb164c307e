// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/inline.hpp"
#include "base/pack.hpp"
#include "solve/kernels.hpp"

namespace fexp::solve::kernels {

using model::block_lanes;

/// Lane access that reads the same for double and for packs.
template <class T>
struct Lanes {
  static T load(const double* p) noexcept { return T::load(p); }
  static void store(const T& v, double* p) noexcept { v.store(p); }
};
template <>
struct Lanes<double> {
  static double load(const double* p) noexcept { return *p; }
  static void store(const double& v, double* p) noexcept { *p = v; }
};

/// What the first half of an element's update hands to the second.
template <class T>
struct Strained {
  physics::ShellIncrement<T> increment;
  T middle_area;  // Of the mid-step triangle [length^2]
  Vec3<T> a, b;   // Sides 1-2 and 1-3 at the end of the step [length]
};

/// Motion of the corners and strain increments of lane_count<T> consecutive lanes of a block.
template <class T>
FEXP_INLINE void strain_lanes(const ElementKernelArguments& k, const model::ElementBlock& block, Index first,
                              Strained<T>& strained) noexcept {
  constexpr Index width = lane_count<T>;
  std::array<Vec3<T>, 3> x, v, w;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    std::array<const double*, at(width)> rows;
    for (Index lane = 0; lane < width; ++lane) {
      const Index used = first + lane < block.count ? first + lane : block.count - 1;
      rows[at(lane)] = &k.motion[k.triangle[block.first + used][corner]].position.x;
    }
    std::array<T, 9> motion;
    load_rows(rows, motion);
    x[corner] = {motion[0], motion[1], motion[2]};
    v[corner] = {motion[3], motion[4], motion[5]};
    w[corner] = {motion[6], motion[7], motion[8]};
  }
  strained.a = x[1] - x[0];
  strained.b = x[2] - x[0];
  const T half_dt(0.5 * k.dt);
  const physics::TriangleFrame<T> middle =
      physics::triangle_frame(strained.a - half_dt * (v[1] - v[0]), strained.b - half_dt * (v[2] - v[0]));
  strained.middle_area = T(0.5) * middle.doubled_area;
  strained.increment = physics::strain_increment(middle, v, w, T(k.dt));
}

/// Resultants and corner forces of the same lanes. `row` is their place in the first row of the block's history.
template <class T>
FEXP_INLINE void stress_lanes(const physics::ShellStiffness& stiffness, const Strained<T>& strained, double* row,
                              CornerForce* corner_force, std::size_t used) noexcept {
  using Access = Lanes<T>;
  // Before the resultants, which do not need it, so that its roots and division are under way meanwhile.
  const physics::TriangleFrame<T> frame = physics::triangle_frame(strained.a, strained.b);

  const auto load_row = [row](Index r) { return Access::load(row + at(r) * block_lanes); };
  const auto store_row = [row](Index r, const T& value) { Access::store(value, row + at(r) * block_lanes); };
  physics::ShellResultants<T> s{
      load_row(model::row_nxx),
      load_row(model::row_nyy),
      load_row(model::row_nxy),
      load_row(model::row_mxx),
      load_row(model::row_myy),
      load_row(model::row_mxy),
      load_row(model::row_qxz),
      load_row(model::row_qyz),
      {load_row(model::row_drill_1), load_row(model::row_drill_2), load_row(model::row_drill_3)},
      load_row(model::row_energy)};
  physics::update_elastic(stiffness, strained.middle_area, strained.increment, s);
  store_row(model::row_nxx, s.nxx);
  store_row(model::row_nyy, s.nyy);
  store_row(model::row_nxy, s.nxy);
  store_row(model::row_mxx, s.mxx);
  store_row(model::row_myy, s.myy);
  store_row(model::row_mxy, s.mxy);
  store_row(model::row_qxz, s.qxz);
  store_row(model::row_qyz, s.qyz);
  store_row(model::row_drill_1, s.drill[0]);
  store_row(model::row_drill_2, s.drill[1]);
  store_row(model::row_drill_3, s.drill[2]);
  store_row(model::row_energy, s.energy);

  std::array<Vec3<T>, 3> force, moment;
  physics::corner_forces(stiffness, frame, s, force, moment);
  std::array<T, 18> corners;
  for (std::size_t c = 0; c < 3; ++c) {
    corners[6 * c] = force[c].x;
    corners[6 * c + 1] = force[c].y;
    corners[6 * c + 2] = force[c].z;
    corners[6 * c + 3] = moment[c].x;
    corners[6 * c + 4] = moment[c].y;
    corners[6 * c + 5] = moment[c].z;
  }
  store_rows(corners, &corner_force->force.x, 18, used);
}

template <class T>
inline void update_blocks(const ElementKernelArguments& k, Index begin, Index end) noexcept {
  constexpr Index width = lane_count<T>;
  for (Index index = begin; index < end; ++index) {
    const model::ElementBlock& block = k.blocks[index];
    for (Index first = 0; first < block.count; first += width) {
      const Index used = block.count - first < width ? block.count - first : width;
      Strained<T> strained;
      strain_lanes<T>(k, block, first, strained);
      stress_lanes<T>(k.sections[block.section], strained,
                      k.history + (at(index) * model::element_rows * block_lanes + at(first)),
                      k.corner_force + 3 * at(block.first + first - k.first_element), at(used));
    }
  }
}

void update_blocks_scalar(const ElementKernelArguments& k, Index begin, Index end) noexcept;
void update_blocks_baseline(const ElementKernelArguments& k, Index begin, Index end) noexcept;
void update_blocks_avx2(const ElementKernelArguments& k, Index begin, Index end) noexcept;
void update_blocks_avx512(const ElementKernelArguments& k, Index begin, Index end) noexcept;

}  // namespace fexp::solve::kernels
