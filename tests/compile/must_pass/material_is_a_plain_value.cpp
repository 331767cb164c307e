// SPDX-License-Identifier: Apache-2.0
//
// A material is a trivially copyable value: it is sent to other machines as bytes.
#include <string>

#include "physics/linear_elastic.hpp"

struct NamedMaterial {
  static constexpr std::string_view kind = "named";
  static constexpr int fields = 0;
  double density{};
  int name{};

  [[nodiscard]] fexp::physics::PlaneStressModuli moduli() const noexcept { return {}; }
};

static_assert(fexp::physics::PlaneStressMaterial<NamedMaterial>);
