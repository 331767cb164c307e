// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace fexp::solve::kernels {

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

}  // namespace fexp::solve::kernels
