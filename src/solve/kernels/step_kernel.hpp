// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "base/pack.hpp"
#include "physics/critical_step.hpp"
#include "solve/kernels.hpp"
#include "solve/kernels/lanes.hpp"

namespace fexp::solve::kernels {

/// Sides 1-2 and 1-3 of lane_count<T> elements from `first` on, of which none is behind `last`.
template <class T>
inline std::array<Vec3<T>, 2> sides(const StepKernelArguments& k, Index first, Index last) noexcept {
  std::array<std::array<const double*, at(lane_count<T>)>, 3> rows;
  for (Index lane = 0; lane < lane_count<T>; ++lane) {
    const std::array<Index, 3>& nodes = k.triangle[first + lane < last ? first + lane : last];
    for (std::size_t c = 0; c < 3; ++c) {
      rows[c][at(lane)] = &k.motion[nodes[c]].position.x;
    }
  }
  // More than the position, because whole rows are faster.
  std::array<std::array<T, 8>, 3> x;
  for (std::size_t c = 0; c < 3; ++c) {
    load_rows(rows[c], x[c]);
  }
  return {Vec3<T>{x[1][0] - x[0][0], x[1][1] - x[0][1], x[1][2] - x[0][2]},
          Vec3<T>{x[2][0] - x[0][0], x[2][1] - x[0][1], x[2][2] - x[0][2]}};
}

inline double lane_of(double value, int) noexcept { return value; }
template <int W, InstructionSet Set>
inline double lane_of(const BasicPack<W, Set>& value, int lane) noexcept {
  return value.lane(lane);
}

/// Critical steps of lane_count<T> elements of a block from `first` on.
template <class T>
FEXP_INLINE T elastic_steps(const StepKernelArguments& k, const model::ElementBlock& block, Index first) noexcept {
  const model::SectionData& section = k.sections[block.section];
  const std::array<Vec3<T>, 2> side = sides<T>(k, first, block.first + block.count - 1);
  return physics::element_critical_step({section.thickness, section.moduli, k.drilling}, section.density,
                                        physics::triangle_frame(side[0], side[1]));
}

/// The same of a layered block. Not inlined, to leave the loop over elastic blocks as small as it is.
template <class T>
[[gnu::noinline]] T layered_steps(const StepKernelArguments& k, const model::ElementBlock& block,
                                  Index first) noexcept {
  const model::SectionData& section = k.sections[block.section];
  const Index last = block.first + block.count - 1;
  const std::array<Vec3<T>, 2> side = sides<T>(k, first, last);
  // Behind the last element its area again.
  std::array<double, at(lane_count<T>)> areas;
  for (Index lane = 0; lane < lane_count<T>; ++lane) {
    areas[at(lane)] = k.reference_area[first + lane < last ? first + lane : last];
  }
  T thickness = Lanes<T>::load(k.layers + (at(block.layer_row) + physics::layer_thickness) * at(model::block_lanes) +
                               (first - block.first));
  if (k.damped) {
    thickness = maximum(thickness, T(section.thickness));
  }
  return physics::layered_critical_step({section.thickness, section.moduli, k.drilling}, section.density, thickness,
                                        Lanes<T>::load(areas.data()), physics::triangle_frame(side[0], side[1]));
}

template <class T>
inline CriticalStep smallest_step(const StepKernelArguments& k, Index begin, Index end) noexcept {
  constexpr Index width = lane_count<T>;
  CriticalStep found;
  for (Index index = begin; index < end; ++index) {
    const model::ElementBlock& block = k.blocks[index];
    const Index block_end = block.first + block.count;
    const double* const deleted =
        block.layer_row == no_index
            ? nullptr
            : k.layers + (at(block.layer_row) + physics::layer_deleted) * at(model::block_lanes) - block.first;
    for (Index e = block.first; e < block_end; e += width) {
      const T steps = deleted == nullptr ? elastic_steps<T>(k, block, e) : layered_steps<T>(k, block, e);
      for (int lane = 0; lane < width && e + lane < block_end; ++lane) {
        if (deleted != nullptr && deleted[e + lane] != 0.0) {
          continue;
        }
        // A collapsed element has none, which the comparison takes for zero.
        const double factor = k.step_factor == nullptr ? 1.0 : k.step_factor[e + lane];
        const double step = factor * lane_of(steps, lane), usable = step > 0.0 ? step : 0.0;
        if (usable < found.step) {
          found = {usable, e + lane};
        }
      }
    }
  }
  return found;
}

CriticalStep smallest_step_scalar(const StepKernelArguments& k, Index begin, Index end) noexcept;
CriticalStep smallest_step_baseline(const StepKernelArguments& k, Index begin, Index end) noexcept;
CriticalStep smallest_step_avx2(const StepKernelArguments& k, Index begin, Index end) noexcept;
CriticalStep smallest_step_avx512(const StepKernelArguments& k, Index begin, Index end) noexcept;

}  // namespace fexp::solve::kernels
