// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <variant>

#include "base/inline.hpp"
#include "base/pack.hpp"
#include "physics/layered_shell.hpp"
#include "physics/shell_damping.hpp"
#include "solve/kernels.hpp"
#include "solve/kernels/lanes.hpp"

namespace fexp::solve::kernels {

using model::block_lanes;

/// Rows of what an element needs of its corners' motion: sides 1-2 and 1-3 at the end of the step [length], velocities
/// of corners 2 and 3 relative to 1 [length/time], rotation rates [1/time].
enum MotionRow : Index { row_a = 0, row_b = 3, row_v12 = 6, row_v13 = 9, row_w = 12, motion_rows = 21 };

/// Gathers them for lane_count<T> triangles.
template <class T>
FEXP_INLINE void gather(const model::NodeMotion* motion, const std::array<Index, 3>* triangle, double* rows) noexcept {
  std::array<std::array<T, 9>, 3> corner;
  for (std::size_t c = 0; c < 3; ++c) {
    std::array<const double*, at(lane_count<T>)> nodes;
    for (std::size_t lane = 0; lane < nodes.size(); ++lane) {
      nodes[lane] = &motion[triangle[lane][c]].position.x;
    }
    load_rows(nodes, corner[c]);
  }
  const auto store = [rows](Index row, const T& value) { Lanes<T>::store(value, rows + at(row) * block_lanes); };
  for (Index i = 0; i < 3; ++i) {
    store(row_a + i, corner[1][at(i)] - corner[0][at(i)]);
    store(row_b + i, corner[2][at(i)] - corner[0][at(i)]);
    store(row_v12 + i, corner[1][at(i + 3)] - corner[0][at(i + 3)]);
    store(row_v13 + i, corner[2][at(i + 3)] - corner[0][at(i + 3)]);
    for (Index c = 0; c < 3; ++c) {
      store(row_w + 3 * c + i, corner[at(c)][at(i + 6)]);
    }
  }
}

/// Adds lane after lane to the forces on the corners' nodes.
template <int W, InstructionSet Set>
FEXP_INLINE void scatter(const std::array<std::array<BasicPack<W, Set>, 6>, 3>& corner, const std::uint16_t* place,
                         NodeForce* force) noexcept {
  using Lane = BasicPack<W, Set>;
  constexpr std::size_t width = W, pieces = (6 + width - 1) / width;
  std::array<std::array<std::array<typename Lane::Native, width>, pieces>, 3> rows;
  for (std::size_t c = 0; c < 3; ++c) {
    to_rows(corner[c], rows[c]);
  }
  for (std::size_t lane = 0; lane < width; ++lane) {
    for (std::size_t c = 0; c < 3; ++c) {
      double* p = &force[place[3 * lane + c]].force.x;
      for (std::size_t piece = 0; piece < pieces; ++piece) {
        (Lane::load(p + piece * width) + Lane(rows[c][piece][lane])).store(p + piece * width);
      }
    }
  }
}
FEXP_INLINE void scatter(const std::array<std::array<double, 6>, 3>& corner, const std::uint16_t* place,
                         NodeForce* force) noexcept {
  for (std::size_t c = 0; c < 3; ++c) {
    const std::array<double, 6>& f = corner[c];
    force[place[c]].force += Vec3d{f[0], f[1], f[2]};
    force[place[c]].moment += Vec3d{f[3], f[4], f[5]};
  }
}

/// Resultants, drilling rotations and energy of lane_count<T> elements, from their places in first rows.
template <class T>
[[nodiscard]] FEXP_INLINE physics::ShellResultants<T> load_resultants(const double* rows) noexcept {
  const auto row = [rows](Index r) { return Lanes<T>::load(rows + at(r) * block_lanes); };
  return {row(model::row_nxx),
          row(model::row_nyy),
          row(model::row_nxy),
          row(model::row_mxx),
          row(model::row_myy),
          row(model::row_mxy),
          row(model::row_qxz),
          row(model::row_qyz),
          {row(model::row_drill_1), row(model::row_drill_2), row(model::row_drill_3)},
          row(model::row_energy)};
}

template <class T>
FEXP_INLINE void store_resultants(const physics::ShellResultants<T>& s, double* rows) noexcept {
  const auto store = [rows](Index r, const T& value) { Lanes<T>::store(value, rows + at(r) * block_lanes); };
  store(model::row_nxx, s.nxx);
  store(model::row_nyy, s.nyy);
  store(model::row_nxy, s.nxy);
  store(model::row_mxx, s.mxx);
  store(model::row_myy, s.myy);
  store(model::row_mxy, s.mxy);
  store(model::row_qxz, s.qxz);
  store(model::row_qyz, s.qyz);
  store(model::row_drill_1, s.drill[0]);
  store(model::row_drill_2, s.drill[1]);
  store(model::row_drill_3, s.drill[2]);
  store(model::row_energy, s.energy);
}

/// Resultants and corner forces of lane_count<T> elements, of which the first is lane `first` of its block. `motion`
/// and `history` are their places in first rows. `law` says what a step does to the resultants and what acts besides
/// them, and has the last word on the corner forces.
template <class T, class Law>
FEXP_INLINE void update(const Law& law, Index first, double dt, const double* motion, double* history,
                        const std::uint16_t* place, NodeForce* node_force) noexcept {
  using Access = Lanes<T>;
  const auto load_vector = [motion](Index row) {
    const double* p = motion + at(row) * block_lanes;
    return Vec3<T>{Access::load(p), Access::load(p + block_lanes), Access::load(p + 2 * block_lanes)};
  };
  const Vec3<T> a = load_vector(row_a), b = load_vector(row_b);
  const Vec3<T> v12 = load_vector(row_v12), v13 = load_vector(row_v13);
  const std::array<Vec3<T>, 3> w{load_vector(row_w), load_vector(row_w + 3), load_vector(row_w + 6)};
  const T half_dt(0.5 * dt);
  const physics::TriangleFrame<T> middle = physics::triangle_frame(a - half_dt * v12, b - half_dt * v13);
  const physics::ShellIncrement<T> increment = physics::strain_increment(middle, v12, v13, w, T(dt));
  // Before the resultants, which do not need it, so that its roots and division are under way meanwhile.
  const physics::TriangleFrame<T> frame = physics::triangle_frame(a, b);

  physics::ShellResultants<T> s = load_resultants<T>(history);
  law.step(first, dt, T(0.5) * middle.doubled_area, increment, s);
  store_resultants(s, history);
  law.damp(first, dt, T(0.5) * middle.doubled_area, increment, s);

  std::array<Vec3<T>, 3> force, moment;
  physics::corner_forces(law.stiffness, frame, s, force, moment);
  std::array<std::array<T, 6>, 3> corner;
  for (std::size_t c = 0; c < 3; ++c) {
    corner[c] = {force[c].x, force[c].y, force[c].z, moment[c].x, moment[c].y, moment[c].z};
  }
  law.finish(first, corner);
  scatter(corner, place, node_force);
}

/// A linear elastic section.
struct ElasticLaw {
  const physics::ShellStiffness& stiffness;

  template <class T>
  FEXP_INLINE void step(Index, double, const T& area, const physics::ShellIncrement<T>& increment,
                        physics::ShellResultants<T>& resultants) const noexcept {
    physics::update_elastic(stiffness, area, increment, resultants);
  }
  template <class T>
  FEXP_INLINE void damp(Index, double, const T&, const physics::ShellIncrement<T>&,
                        physics::ShellResultants<T>&) const noexcept {}
  template <class T>
  [[nodiscard]] FEXP_INLINE T deleted(Index) const noexcept {
    return T(0.0);
  }
  template <class T>
  FEXP_INLINE void finish(Index, std::array<std::array<T, 6>, 3>&) const noexcept {}
};

/// A section with points through the thickness, which harden by `curve` and have conditions or none; `layers` are the
/// block's rows.
template <class Curve, bool Conditions>
struct LayeredLaw {
  const physics::ShellStiffness& stiffness;
  const physics::LayeredSection& section;
  Curve curve;  // A copy, as compilers cannot know that what is stored of points leaves it alone
  double* layers;

  template <class T>
  FEXP_INLINE void step(Index first, double dt, const T& area, const physics::ShellIncrement<T>& increment,
                        physics::ShellResultants<T>& resultants) const noexcept {
    if (dt > 0.0) {
      const auto load = [&](int row) { return Lanes<T>::load(layers + at(row) * block_lanes + first); };
      const auto store = [&](int row, const T& value) {
        Lanes<T>::store(value, layers + at(row) * block_lanes + first);
      };
      physics::update_layered<Conditions>(stiffness, section, curve, dt, area, increment, load, store, resultants);
    }
  }
  template <class T>
  FEXP_INLINE void damp(Index, double, const T&, const physics::ShellIncrement<T>&,
                        physics::ShellResultants<T>&) const noexcept {}
  template <class T>
  [[nodiscard]] FEXP_INLINE T deleted(Index first) const noexcept {
    return Lanes<T>::load(layers + at(physics::layer_deleted) * block_lanes + first);
  }
  /// Deleted elements exert no force, whatever their geometry.
  template <class T>
  FEXP_INLINE void finish(Index first, std::array<std::array<T, 6>, 3>& corner) const noexcept {
    if (section.plasticity.can_fail()) {
      const T failed = deleted<T>(first);
      for (std::array<T, 6>& actions : corner) {
        for (T& value : actions) {
          value = select_less(failed, T(0.5), value, T(0.0));
        }
      }
    }
  }
};

/// A law with stiffness damping, whose share of the resultants is in `rows`, those of the block.
template <class Law>
struct DampedLaw {
  Law law;
  double coefficient;  ///< [time]
  double* rows;
  const physics::ShellStiffness& stiffness = law.stiffness;

  template <class T>
  FEXP_INLINE void step(Index first, double dt, const T& area, const physics::ShellIncrement<T>& increment,
                        physics::ShellResultants<T>& resultants) const noexcept {
    law.step(first, dt, area, increment, resultants);
  }
  template <class T>
  FEXP_INLINE void damp(Index first, double dt, const T& area, const physics::ShellIncrement<T>& increment,
                        physics::ShellResultants<T>& resultants) const noexcept {
    physics::ShellResultants<T> share = load_resultants<T>(rows + first);
    if (dt > 0.0) {
      physics::update_damping(stiffness, coefficient / dt, area, increment, law.template deleted<T>(first), share);
      store_resultants(share, rows + first);
    }
    resultants.nxx = resultants.nxx + share.nxx;
    resultants.nyy = resultants.nyy + share.nyy;
    resultants.nxy = resultants.nxy + share.nxy;
    resultants.mxx = resultants.mxx + share.mxx;
    resultants.myy = resultants.myy + share.myy;
    resultants.mxy = resultants.mxy + share.mxy;
    resultants.qxz = resultants.qxz + share.qxz;
    resultants.qyz = resultants.qyz + share.qyz;
    for (std::size_t i = 0; i < 3; ++i) {
      resultants.drill[i] = resultants.drill[i] + share.drill[i];
    }
  }
  template <class T>
  FEXP_INLINE void finish(Index first, std::array<std::array<T, 6>, 3>& corner) const noexcept {
    law.finish(first, corner);
  }
};

/// Blocks of a group: their motion is gathered first and all at once, as the loads for one block would otherwise wait
/// behind the arithmetic of the one before.
inline constexpr Index group_blocks = 8;

/// Has the history of a block fetched; one behind the last does no harm.
FEXP_INLINE void prefetch_history(const ElementKernelArguments& k, Index block) noexcept {
  const double* const history = k.history + at(block) * model::element_rows * block_lanes;
  for (Index row = 0; row < model::element_rows; ++row) {
    __builtin_prefetch(history + at(row) * block_lanes, 1);
  }
}

/// The triangles of lane_count<T> lanes, of which the first `used` have one: as they are stored, or the last of them
/// again and again behind.
template <class T>
FEXP_INLINE const std::array<Index, 3>* full_lanes(
    const std::array<Index, 3>* triangle, Index used,
    std::array<std::array<Index, 3>, at(lane_count<T>)>& filled_up) noexcept {
  if (used >= lane_count<T>) {
    return triangle;
  }
  for (Index lane = 0; lane < lane_count<T>; ++lane) {
    filled_up[at(lane)] = triangle[lane < used ? lane : used - 1];
  }
  return filled_up.data();
}

/// The elements of a block, from the motion of its first one on.
template <class T, class Law>
FEXP_INLINE void update_block(const ElementKernelArguments& k, Index index, const double* motion,
                              const Law& law) noexcept {
  const model::ElementBlock& block = k.blocks[index];
  for (Index first = 0; first < block.count; first += lane_count<T>) {
    update<T>(law, first, k.dt, motion + first, k.history + at(index) * model::element_rows * block_lanes + first,
              k.place + 3 * (at(index) * block_lanes + at(first)), k.force);
  }
}

/// The same, with stiffness damping or without.
template <class T, bool Damped, class Law>
FEXP_INLINE void update_block_by(const ElementKernelArguments& k, Index index, const double* motion,
                                 const Law& law) noexcept {
  if constexpr (Damped) {
    update_block<T>(
        k, index, motion,
        DampedLaw<Law>{law, k.stiffness_damping, k.damping + at(index) * model::element_rows * block_lanes});
  } else {
    update_block<T>(k, index, motion, law);
  }
}

/// Not inlined, to leave the loop over elastic blocks as small as it is.
template <class T, bool Damped, bool Conditions>
[[gnu::noinline]] void update_points_of_block(const ElementKernelArguments& k, Index index,
                                              const double* motion) noexcept {
  const model::ElementBlock& block = k.blocks[index];
  const physics::LayeredSection& section = k.section_data[block.section].layered;
  const physics::ShellStiffness& stiffness = k.sections[block.section];
  double* const layers = k.layers + at(block.layer_row) * block_lanes;
  const auto update_by = [&]<class Curve>(const Curve* curve) {
    if (curve != nullptr) {
      update_block_by<T, Damped>(k, index, motion, LayeredLaw<Curve, Conditions>{stiffness, section, *curve, layers});
    }
  };
  const physics::Hardening& hardening = section.plasticity.hardening;
  update_by(std::get_if<physics::LinearHardening>(&hardening));
  update_by(std::get_if<physics::PowerHardening>(&hardening));
  update_by(std::get_if<physics::TableHardening>(&hardening));
}

template <class T, bool Damped>
FEXP_INLINE void update_layered_block(const ElementKernelArguments& k, Index index, const double* motion) noexcept {
  if (k.section_data[k.blocks[index].section].layered.has_conditions()) {
    update_points_of_block<T, Damped, true>(k, index, motion);
  } else {
    update_points_of_block<T, Damped, false>(k, index, motion);
  }
}

/// Likewise.
template <class T>
[[gnu::noinline]] void update_damped_block(const ElementKernelArguments& k, Index index,
                                           const double* motion) noexcept {
  if (k.blocks[index].layer_row != no_index) {
    update_layered_block<T, true>(k, index, motion);
  } else {
    update_block_by<T, true>(k, index, motion, ElasticLaw{k.sections[k.blocks[index].section]});
  }
}

template <class T>
inline void update_blocks(const ElementKernelArguments& k, Index begin, Index end) noexcept {
  constexpr Index width = lane_count<T>;
  constexpr std::size_t block_motion = at(motion_rows) * block_lanes;
  // Bytes, because an array of doubles would be set to zero first.
  alignas(64) std::array<std::byte, at(group_blocks) * block_motion * sizeof(double)> storage;
  auto* const motion = reinterpret_cast<double*>(storage.data());
  for (Index group = begin; group < end; group += group_blocks) {
    const Index group_end = end - group < group_blocks ? end : group + group_blocks;
    for (Index index = group; index < group_end; ++index) {
      const model::ElementBlock& block = k.blocks[index];
      for (Index first = 0; first < block.count; first += width) {
        std::array<std::array<Index, 3>, at(width)> filled_up;
        gather<T>(k.motion, full_lanes<T>(k.triangle + block.first + first, block.count - first, filled_up),
                  motion + at(index - group) * block_motion + first);
      }
    }
    for (Index index = group; index < group_end; ++index) {
      const double* const block_rows = motion + at(index - group) * block_motion;
      prefetch_history(k, index + group_blocks);
      if (k.damping != nullptr) {
        update_damped_block<T>(k, index, block_rows);
        continue;
      }
      if (k.blocks[index].layer_row != no_index) {
        update_layered_block<T, false>(k, index, block_rows);
        continue;
      }
      update_block<T>(k, index, block_rows, ElasticLaw{k.sections[k.blocks[index].section]});
    }
  }
}

void update_blocks_scalar(const ElementKernelArguments& k, Index begin, Index end) noexcept;
void update_blocks_baseline(const ElementKernelArguments& k, Index begin, Index end) noexcept;
void update_blocks_avx2(const ElementKernelArguments& k, Index begin, Index end) noexcept;
void update_blocks_avx512(const ElementKernelArguments& k, Index begin, Index end) noexcept;

}  // namespace fexp::solve::kernels
