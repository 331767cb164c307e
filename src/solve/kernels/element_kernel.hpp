// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/pack.hpp"
#include "solve/element_kernels.hpp"

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

/// Element update for lane_count<T> consecutive lanes of a block, starting at lane `first`.
template <class T>
inline void update_lanes(const ElementKernelArguments& k, Index block_index, Index first) noexcept {
  constexpr Index width = lane_count<T>;
  using Access = Lanes<T>;
  const model::ElementBlock& block = k.blocks[block_index];
  const physics::ShellSection& section = k.sections[block.section];

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

  double* row = k.history + (at(block_index) * model::element_rows * block_lanes + at(first));
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

  const Vec3<T> a = x[1] - x[0], b = x[2] - x[0];
  const T dt(k.dt), half_dt(0.5 * k.dt);
  const physics::TriangleFrame<T> middle =
      physics::triangle_frame(a - half_dt * (v[1] - v[0]), b - half_dt * (v[2] - v[0]));
  const physics::ShellIncrement<T> increment = physics::strain_increment(middle, v, w, dt);
  physics::update_elastic(section, T(0.5) * middle.doubled_area(), increment, s);

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
  physics::corner_forces(section, physics::triangle_frame(a, b), s, force, moment);
  std::array<T, 18> corners;
  for (std::size_t c = 0; c < 3; ++c) {
    corners[6 * c] = force[c].x;
    corners[6 * c + 1] = force[c].y;
    corners[6 * c + 2] = force[c].z;
    corners[6 * c + 3] = moment[c].x;
    corners[6 * c + 4] = moment[c].y;
    corners[6 * c + 5] = moment[c].z;
  }
  const Index used = block.count - first < width ? block.count - first : width;
  store_rows(corners, &k.corner_force[3 * at(block.first + first)].force.x, 18, at(used));
}

template <class T>
inline void update_blocks(const ElementKernelArguments& k, Index begin, Index end) noexcept {
  for (Index block = begin; block < end; ++block) {
    for (Index first = 0; first < k.blocks[block].count; first += lane_count<T>) {
      update_lanes<T>(k, block, first);
    }
  }
}

void update_blocks_scalar(const ElementKernelArguments& k, Index begin, Index end) noexcept;
void update_blocks_baseline(const ElementKernelArguments& k, Index begin, Index end) noexcept;
void update_blocks_avx2(const ElementKernelArguments& k, Index begin, Index end) noexcept;
void update_blocks_avx512(const ElementKernelArguments& k, Index begin, Index end) noexcept;

}  // namespace fexp::solve::kernels
