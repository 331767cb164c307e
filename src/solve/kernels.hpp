// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "base/index.hpp"
#include "base/vec3.hpp"
#include "model/model.hpp"
#include "model/state.hpp"
#include "physics/c0_triangle.hpp"

namespace fexp::solve {

/// Internal force and moment that one corner of an element exerts on its node (to be subtracted).
struct CornerForce {
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
  CornerForce* corner_force{};                // [elements][3], from first_element on
  Index first_element{};
  double dt{};  ///< Step just taken [time]; 0 evaluates forces of the present state.
};

/// Updates resultants and writes corner forces of blocks [begin, end).
using ElementKernel = void (*)(const ElementKernelArguments& arguments, Index begin, Index end) noexcept;

/// What divides force and moment of a node.
struct InverseInertia {
  double mass{};     ///< [1/mass]
  double inertia{};  ///< [1/(mass*length^2)]
};

/// What the node kernels read and write.
struct NodeKernelArguments {
  const CornerForce* corner_force{};
  /// Corners of node n are corner[corner_start[n]] and so on, less first_corner. Without `corner`, the nodes' forces
  /// lie side by side: those of the i-th node begin at corner_start[i].
  const Index* corner{};
  const Index* corner_start{};
  Index first_corner{};
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

/// Sums corner forces at nodes[begin, end), accelerates them and takes the closing half step; where go_on also the
/// opening half of the next step and its motion.
using NodeKernel = NodeKernelReport (*)(const NodeKernelArguments& arguments, const Index* nodes, Index begin,
                                        Index end) noexcept;

/// Kernels compiled for one element at a time and for the packs of each instruction set. All give the same bits.
enum class KernelChoice { automatic, scalar, baseline, avx2, avx512 };

struct SelectedKernel {
  ElementKernel elements{};
  NodeKernel nodes{};
  std::string_view name;  ///< "scalar", "baseline", "avx2" or "avx512"
};

/// The kernel asked for, or the widest this processor runs; the kernels are null when it cannot run here.
[[nodiscard]] SelectedKernel select_element_kernel(KernelChoice choice) noexcept;

}  // namespace fexp::solve
