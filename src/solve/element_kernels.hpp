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
  const model::NodeMotion* motion{};        // [nodes]: x(n+1), v(n+1/2), omega(n+1/2)
  const std::array<Index, 3>* triangle{};   // [elements]
  const model::ElementBlock* blocks{};      // [blocks]
  const physics::ShellSection* sections{};  // [sections]
  double* history{};                        // [blocks][element_rows][block_lanes]
  CornerForce* corner_force{};              // [elements][3]
  double dt{};                              ///< Step just taken [time]; 0 evaluates forces of the present state.
};

/// Updates resultants and writes corner forces of blocks [begin, end).
using ElementKernel = void (*)(const ElementKernelArguments& arguments, Index begin, Index end) noexcept;

/// Kernels compiled for one element at a time and for the packs of each instruction set. All give the same bits.
enum class KernelChoice { automatic, scalar, baseline, avx2, avx512 };

struct SelectedKernel {
  ElementKernel function{};
  std::string_view name;  ///< "scalar", "baseline", "avx2" or "avx512"
};

/// The kernel asked for, or the widest this processor runs; function is null when it cannot run here.
[[nodiscard]] SelectedKernel select_element_kernel(KernelChoice choice) noexcept;

}  // namespace fexp::solve
