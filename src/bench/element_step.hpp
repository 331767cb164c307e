// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "base/vec3.hpp"
#include "bench/counted.hpp"
#include "model/model.hpp"
#include "physics/c0_triangle.hpp"

namespace fexp::bench {

/// Motion of a triangle's corners, as an element's step finds it, and its history.
template <class T>
struct TriangleMotion {
  std::array<Vec3<T>, 3> position;       // At the end of the step [length]
  std::array<Vec3<T>, 3> velocity;       // At mid-step [length/time]
  std::array<Vec3<T>, 3> rotation_rate;  // At mid-step [1/time]
  physics::ShellResultants<T> resultants;
};

template <class T>
struct CornerActions {
  std::array<Vec3<T>, 3> force;   // [force]
  std::array<Vec3<T>, 3> moment;  // [force*length]
};

/// The step of one element, as the element kernel takes it from the templates of `physics`; `law(area, increment)` is
/// what it does to the resultants.
template <class T, class Law>
CornerActions<T> step_element(const physics::ShellStiffness& stiffness, TriangleMotion<T>& m, const T& dt,
                              const Law& law) {
  const Vec3<T> a = m.position[1] - m.position[0], b = m.position[2] - m.position[0];
  const Vec3<T> v12 = m.velocity[1] - m.velocity[0], v13 = m.velocity[2] - m.velocity[0];
  const T half_dt = dt * T(0.5);
  const physics::TriangleFrame<T> middle = physics::triangle_frame(a - half_dt * v12, b - half_dt * v13);
  const T middle_area = T(0.5) * middle.doubled_area;
  const physics::ShellIncrement<T> increment = physics::strain_increment(middle, v12, v13, m.rotation_rate, dt);
  law(middle_area, increment);
  const physics::TriangleFrame<T> frame = physics::triangle_frame(a, b);
  CornerActions<T> actions;
  physics::corner_forces(stiffness, frame, m.resultants, actions.force, actions.moment);
  return actions;
}

/// The same of a linear elastic section.
template <class T>
CornerActions<T> step_element(const physics::ShellStiffness& stiffness, TriangleMotion<T>& m, const T& dt) {
  return step_element(stiffness, m, dt, [&](const T& area, const physics::ShellIncrement<T>& increment) {
    physics::update_elastic(stiffness, area, increment, m.resultants);
  });
}

/// What one step of one element needs at the least in a model without contact, loads and conditions.
struct ElementStepCost {
  OperationCount element;  ///< Of the element's kernel and the sums of its corner forces
  OperationCount node;     ///< Of each node: its acceleration and both half steps
  double nodes{};          ///< Per element [-]
  double history_bytes{};  ///< Of an element [byte]

  [[nodiscard]] double flops() const noexcept {
    return static_cast<double>(element.flops()) + nodes * static_cast<double>(node.flops());
  }
  /// What must be read and written where nothing is left in a cache from the step before: the element's history twice,
  /// its corners' numbers once, the motion of its share of nodes twice, their inverse masses once [byte].
  [[nodiscard]] double least_bytes() const noexcept;
  /// The same, each once: what a program must hold [byte].
  [[nodiscard]] double least_memory() const noexcept;
};

/// Of a model whose sections are alike. Points through the thickness are counted as when all of them flow, which takes
/// Newton's method as many steps as in a typical explicit step.
[[nodiscard]] ElementStepCost element_step_cost(const model::Model& model);

}  // namespace fexp::bench
