// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <type_traits>

#if defined(__AVX512F__) || defined(__AVX2__)
#include <immintrin.h>
#endif

namespace fexp {

/// Instruction set this translation unit is compiled for. It is a template argument of every pack, so that kernels
/// compiled for different instruction sets are different types and the linker cannot mix them up.
enum class InstructionSet { baseline, avx2, avx512 };

#if defined(__AVX512F__)
constexpr InstructionSet compiled_instruction_set = InstructionSet::avx512;
#elif defined(__AVX2__)
constexpr InstructionSet compiled_instruction_set = InstructionSet::avx2;
#else
constexpr InstructionSet compiled_instruction_set = InstructionSet::baseline;
#endif

namespace detail {
// One named vector type per width: g++ 12 ignores vector_size(N) when N depends on a template parameter.
using Double2 = double __attribute__((vector_size(16)));
using Double4 = double __attribute__((vector_size(32)));
using Double8 = double __attribute__((vector_size(64)));

template <int W>
struct NativeVector;
template <>
struct NativeVector<2> {
  using Type = Double2;
};
template <>
struct NativeVector<4> {
  using Type = Double4;
};
template <>
struct NativeVector<8> {
  using Type = Double8;
};
}  // namespace detail

/// W doubles that every operation treats lane by lane, with the same rounding as scalar arithmetic.
template <int W, InstructionSet Set>
struct BasicPack {
  using Native = typename detail::NativeVector<W>::Type;
  static constexpr int width = W;

  Native v{};

  BasicPack() = default;
  explicit BasicPack(Native native) noexcept : v(native) {}
  // Implicit on purpose: a literal in a formula reads the same for double and for packs.
  BasicPack(double s) noexcept : v(Native{} + s) {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] static BasicPack load(const double* p) noexcept {
    BasicPack r;
    for (int i = 0; i < W; ++i) {
      r.v[i] = p[i];
    }
    return r;
  }
  void store(double* p) const noexcept {
    for (int i = 0; i < W; ++i) {
      p[i] = v[i];
    }
  }
  [[nodiscard]] double lane(int i) const noexcept { return v[i]; }
  void set_lane(int i, double value) noexcept { v[i] = value; }

  friend BasicPack operator+(BasicPack a, BasicPack b) noexcept { return BasicPack(a.v + b.v); }
  friend BasicPack operator-(BasicPack a, BasicPack b) noexcept { return BasicPack(a.v - b.v); }
  friend BasicPack operator*(BasicPack a, BasicPack b) noexcept { return BasicPack(a.v * b.v); }
  friend BasicPack operator/(BasicPack a, BasicPack b) noexcept { return BasicPack(a.v / b.v); }
  friend BasicPack operator-(BasicPack a) noexcept { return BasicPack(-a.v); }
  BasicPack& operator+=(BasicPack b) noexcept {
    v += b.v;
    return *this;
  }

  friend BasicPack square_root(BasicPack a) noexcept {
#if defined(__AVX512F__)
    if constexpr (W == 8) {
      return BasicPack(reinterpret_cast<Native>(_mm512_sqrt_pd(reinterpret_cast<__m512d>(a.v))));
    }
#endif
#if defined(__AVX2__)
    if constexpr (W == 4) {
      return BasicPack(reinterpret_cast<Native>(_mm256_sqrt_pd(reinterpret_cast<__m256d>(a.v))));
    }
#endif
    BasicPack r;
    for (int i = 0; i < W; ++i) {
      r.v[i] = std::sqrt(a.v[i]);
    }
    return r;
  }
  /// Lane-wise smaller value; both operands must be free of NaN.
  friend BasicPack minimum(BasicPack a, BasicPack b) noexcept { return BasicPack(a.v < b.v ? a.v : b.v); }
  /// Lane-wise larger value; both operands must be free of NaN.
  friend BasicPack maximum(BasicPack a, BasicPack b) noexcept { return BasicPack(a.v > b.v ? a.v : b.v); }
};

/// The pack of W doubles of this translation unit's instruction set.
template <int W>
using Pack = BasicPack<W, compiled_instruction_set>;

[[nodiscard]] inline double square_root(double a) noexcept { return std::sqrt(a); }
[[nodiscard]] inline double minimum(double a, double b) noexcept { return a < b ? a : b; }
[[nodiscard]] inline double maximum(double a, double b) noexcept { return a > b ? a : b; }

/// Number of doubles in T.
template <class T>
struct LaneCount : std::integral_constant<int, 1> {};
template <int W, InstructionSet Set>
struct LaneCount<BasicPack<W, Set>> : std::integral_constant<int, W> {};
template <class T>
inline constexpr int lane_count = LaneCount<T>::value;

}  // namespace fexp
