// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "base/index.hpp"
#include "base/vec3.hpp"
#include "model/model.hpp"
#include "model/state.hpp"
#include "physics/c0_triangle.hpp"

namespace fexp::solve {

/// Internal force and moment that elements exert on a node (to be subtracted), on a cache line of its own.
struct alignas(64) NodeForce {
  Vec3d force;   ///< [force]
  Vec3d moment;  ///< [force*length]
};

/// What the element kernels read and write. Plain pointers: the kernels are compiled for several instruction sets and
/// must not share inline code with the rest of the program.
struct ElementKernelArguments {
  const model::NodeMotion* motion{};          // [nodes]: x(n+1), v(n+1/2), omega(n+1/2)
  const std::array<Index, 3>* triangle{};     // [elements]
  const model::ElementBlock* blocks{};        // [blocks]
  const physics::ShellStiffness* sections{};  // [sections]
  double* history{};                          // [blocks][element_rows][block_lanes]
  /// Which of `force` the corners of a block's lanes add to, [blocks][block_lanes][3]; lanes without an element have
  /// one that nobody reads.
  const std::uint16_t* place{};
  NodeForce* force{};
  double dt{};                               ///< Step just taken [time]; 0 evaluates forces of the present state.
  const model::SectionData* section_data{};  // [sections]; read for layered blocks
  double* layers{};                          // [layered blocks][physics::layer_rows][block_lanes]
  double* damping{};                         // As `history`; none: no stiffness damping
  double stiffness_damping{};                ///< Its coefficient [time]
};

/// Updates resultants of blocks [begin, end) and adds their corner forces, element by element.
using ElementKernel = void (*)(const ElementKernelArguments& arguments, Index begin, Index end) noexcept;

/// What divides force and moment of a node.
struct InverseInertia {
  double mass{};     ///< [1/mass]
  double inertia{};  ///< [1/(mass*length^2)]
};

/// What the node kernels read and write.
struct NodeKernelArguments {
  /// Forces on the i-th node are force[force_start[i]] and so on; without `force_start` there is one for each, and that
  /// of the first node is force[0].
  const NodeForce* force{};
  const Index* force_start{};
  const Vec3d* contact_force{};             // [nodes]; none: nothing touches
  const InverseInertia* inverse_inertia{};  // [nodes]
  model::NodeMotion* motion{};              // [nodes]
  model::NodeAcceleration* acceleration{};  // [nodes]; written unless go_on
  double half_dt{};                         ///< [time]
  double dt{};                              ///< [time]
  bool go_on{};
};

struct NodeKernelReport {
  double largest_speed2{};    ///< At the middle of the next step, when go_on [length^2/time^2]
  bool closing_finite{true};  ///< Velocities at the end of the step
  bool opening_finite{true};  ///< Velocities at the middle of the next step
};

/// Sums the forces at nodes[begin, end), accelerates them and takes the closing half step; where go_on also the
/// opening half of the next step and its motion.
using NodeKernel = NodeKernelReport (*)(const NodeKernelArguments& arguments, const Index* nodes, Index begin,
                                        Index end) noexcept;

/// Smallest critical step of a range of elements and the lowest element that has it.
struct CriticalStep {
  double step{HUGE_VAL};  ///< [time]; zero or NaN-free: a collapsed element reports 0
  Index element{no_index};
};

/// What the step kernels read.
struct StepKernelArguments {
  const model::NodeMotion* motion{};       // [nodes]
  const std::array<Index, 3>* triangle{};  // [elements]
  const model::ElementBlock* blocks{};     // [blocks]
  const model::SectionData* sections{};    // [sections]
  double drilling{};                       ///< Drilling factor beta [-]
  const double* step_factor{};             // [elements]: by which mass scaling lengthens the step; none: by nothing
  const double* layers{};                  // As those of the element kernel; deleted elements have no step
  const double* reference_area{};          // [elements] [length^2]; read for layered blocks
  /// With stiffness damping, which has the thickness of the deck, thinner elements count as of that thickness.
  bool damped{};
};

/// Smallest critical step over blocks [begin, end) in the present geometry.
using StepKernel = CriticalStep (*)(const StepKernelArguments& arguments, Index begin, Index end) noexcept;

/// Kernels compiled for one element at a time and for the packs of each instruction set. All give the same bits.
enum class KernelChoice { automatic, scalar, baseline, avx2, avx512 };

struct SelectedKernel {
  ElementKernel elements{};
  NodeKernel nodes{};
  StepKernel steps{};
  std::string_view name;  ///< "scalar", "baseline", "avx2" or "avx512"
};

/// The kernel asked for, or the widest this processor runs; the kernels are null when it cannot run here.
[[nodiscard]] SelectedKernel select_element_kernel(KernelChoice choice) noexcept;

}  // namespace fexp::solve
