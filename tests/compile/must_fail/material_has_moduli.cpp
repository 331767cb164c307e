// SPDX-License-Identifier: Apache-2.0
//
// A material that cannot say its moduli is refused where it is defined, not deep inside a kernel.
#include "physics/linear_elastic.hpp"

struct Material {
  static constexpr std::string_view kind = "a_material";
  static constexpr int fields = 0;
  double density{};

  [[nodiscard]] double moduli() const noexcept { return {}; }
};

static_assert(fexp::physics::PlaneStressMaterial<Material>);
