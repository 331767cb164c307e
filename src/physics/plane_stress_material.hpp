// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <string_view>
#include <type_traits>

namespace fexp::physics {

/// Elastic moduli of an isotropic plane-stress law.
struct PlaneStressModuli {
  double direct;  ///< C11 = C22 [force/length^2]
  double cross;   ///< C12 [force/length^2]
  double shear;   ///< G, in-plane and transverse [force/length^2]
};

/// What a material must offer to be used by a shell section: a trivially copyable value with documented fields, a
/// density and its elastic moduli (they set the step, the drilling tie and the transverse shear).
template <class M>
concept PlaneStressMaterial = std::is_trivially_copyable_v<M> && requires(const M m) {
  { M::kind } -> std::convertible_to<std::string_view>;
  { m.density } -> std::convertible_to<double>;
  { m.moduli() }
  noexcept->std::same_as<PlaneStressModuli>;
  M::fields;
};

}  // namespace fexp::physics
