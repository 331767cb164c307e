// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "base/inline.hpp"

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
using Bits2 = std::uint64_t __attribute__((vector_size(16)));
using Bits4 = std::uint64_t __attribute__((vector_size(32)));
using Bits8 = std::uint64_t __attribute__((vector_size(64)));

template <int W>
struct NativeVector;
template <>
struct NativeVector<2> {
  using Type = Double2;
  using Bits = Bits2;
};
template <>
struct NativeVector<4> {
  using Type = Double4;
  using Bits = Bits4;
};
template <>
struct NativeVector<8> {
  using Type = Double8;
  using Bits = Bits8;
};

// Of binary64: the exponent field begins at bit 52; sums with 2^52 keep small whole numbers in the lowest bits.
inline constexpr std::uint64_t bits_of_root_half = 0x3fe6a09e667f3bcdULL;
inline constexpr std::uint64_t bits_of_two = 0x4000000000000000ULL;
inline constexpr std::uint64_t bits_of_two_to_52 = 0x4330000000000000ULL;
inline constexpr double two_to_52 = 0x1p52;

/// Splits the bits of a normal positive number into those of a fraction in [sqrt(1/2), sqrt(2)) and those of
/// 2^52 + 1024 + the exponent.
template <class Bits>
FEXP_INLINE void split_bits(Bits& number, Bits& exponent) noexcept {
  const Bits biased = (number - bits_of_root_half + bits_of_two) >> 52;
  number = number - (biased << 52) + bits_of_two;
  exponent = biased | bits_of_two_to_52;
}
}  // namespace detail

/// W doubles that every operation treats lane by lane, with the same rounding as scalar arithmetic.
template <int W, InstructionSet Set>
struct BasicPack {
  using Native = typename detail::NativeVector<W>::Type;
  using Bits = typename detail::NativeVector<W>::Bits;
  static constexpr int width = W;

  Native v{};

  BasicPack() = default;
  explicit BasicPack(Native native) noexcept : v(native) {}
  // Implicit on purpose: a literal in a formula reads the same for double and for packs.
  BasicPack(double s) noexcept : v(broadcast(s)) {}  // NOLINT(google-explicit-constructor)

  /// Without arithmetic: a sum with zeros would have to be taken in every lane.
  [[nodiscard]] static Native broadcast(double s) noexcept {
    if constexpr (W == 2) {
      return Native{s, s};
    } else if constexpr (W == 4) {
      return Native{s, s, s, s};
    } else {
      return Native{s, s, s, s, s, s, s, s};
    }
  }

  [[nodiscard]] static BasicPack load(const double* p) noexcept {
    BasicPack r;
    std::memcpy(&r.v, p, sizeof(r.v));
    return r;
  }
  void store(double* p) const noexcept { std::memcpy(p, &v, sizeof(v)); }
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
  friend bool all_equal(BasicPack a, BasicPack b) noexcept {
    bool equal = true;
    for (int i = 0; i < W; ++i) {
      equal = equal && a.v[i] == b.v[i];
    }
    return equal;
  }
  /// Bit i says whether a <= b in lane i.
  friend unsigned lanes_at_most(BasicPack a, BasicPack b) noexcept {
#if defined(__AVX512F__)
    if constexpr (W == 8) {
      return _mm512_cmp_pd_mask(reinterpret_cast<__m512d>(a.v), reinterpret_cast<__m512d>(b.v), _CMP_LE_OQ);
    }
#endif
#if defined(__AVX2__)
    if constexpr (W == 4) {
      return static_cast<unsigned>(_mm256_movemask_pd(
          _mm256_cmp_pd(reinterpret_cast<__m256d>(a.v), reinterpret_cast<__m256d>(b.v), _CMP_LE_OQ)));
    }
#endif
    unsigned lanes = 0;
    for (int i = 0; i < W; ++i) {
      lanes |= static_cast<unsigned>(a.v[i] <= b.v[i]) << static_cast<unsigned>(i);
    }
    return lanes;
  }
  /// Bit i says whether a == b in lane i.
  friend unsigned lanes_equal(BasicPack a, BasicPack b) noexcept {
#if defined(__AVX512F__)
    if constexpr (W == 8) {
      return _mm512_cmp_pd_mask(reinterpret_cast<__m512d>(a.v), reinterpret_cast<__m512d>(b.v), _CMP_EQ_OQ);
    }
#endif
    return lanes_at_most(a, b) & lanes_at_most(b, a);
  }
  /// Lane-wise smaller value; both operands must be free of NaN.
  friend BasicPack minimum(BasicPack a, BasicPack b) noexcept { return BasicPack(a.v < b.v ? a.v : b.v); }
  /// Lane-wise larger value; both operands must be free of NaN.
  friend BasicPack maximum(BasicPack a, BasicPack b) noexcept { return BasicPack(a.v > b.v ? a.v : b.v); }

  /// `yes` in lanes where a < b, else `no`.
  friend BasicPack select_less(BasicPack a, BasicPack b, BasicPack yes, BasicPack no) noexcept {
    return BasicPack(a.v < b.v ? yes.v : no.v);
  }
  /// Whether a < b in any lane.
  friend bool any_less(BasicPack a, BasicPack b) noexcept {
#if defined(__AVX512F__)
    if constexpr (W == 8) {
      return _mm512_cmp_pd_mask(reinterpret_cast<__m512d>(a.v), reinterpret_cast<__m512d>(b.v), _CMP_LT_OQ) != 0;
    }
#endif
#if defined(__AVX2__)
    if constexpr (W == 4) {
      return _mm256_movemask_pd(
                 _mm256_cmp_pd(reinterpret_cast<__m256d>(a.v), reinterpret_cast<__m256d>(b.v), _CMP_LT_OQ)) != 0;
    }
#endif
    bool any = false;
    for (int i = 0; i < W; ++i) {
      any = any || a.v[i] < b.v[i];
    }
    return any;
  }

  /// x = fraction * 2^exponent with the fraction, which is returned, in [sqrt(1/2), sqrt(2)); x must be positive and
  /// normal.
  friend BasicPack split_exponent(BasicPack x, BasicPack& exponent) noexcept {
    auto fraction = reinterpret_cast<Bits>(x.v);
    Bits biased;
    detail::split_bits(fraction, biased);
    exponent = BasicPack(reinterpret_cast<Native>(biased)) - BasicPack(detail::two_to_52 + 1024.0);
    return BasicPack(reinterpret_cast<Native>(fraction));
  }
  /// x * 2^exponent for whole exponents from -1022 to 1023.
  friend BasicPack times_power_of_two(BasicPack x, BasicPack exponent) noexcept {
    const Native shifted = (exponent + BasicPack(detail::two_to_52 + 1023.0)).v;
    return x * BasicPack(reinterpret_cast<Native>(reinterpret_cast<Bits>(shifted) << 52));
  }
};

namespace detail {
/// Exchanges rows and columns of W vectors of W doubles, stage by stage. Templates over the
/// instruction set for the same reason as the packs.
template <InstructionSet>
inline void transpose(std::array<Double2, 2>& r) noexcept {
  const Double2 a = r[0], b = r[1];
  r[0] = __builtin_shufflevector(a, b, 0, 2);
  r[1] = __builtin_shufflevector(a, b, 1, 3);
}
template <InstructionSet>
inline void transpose(std::array<Double4, 4>& r) noexcept {
  const Double4 a = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6),
                b = __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7);
  const Double4 c = __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6),
                d = __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7);
  r[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
  r[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
  r[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
  r[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}
template <InstructionSet>
inline void transpose(std::array<Double8, 8>& r) noexcept {
  std::array<Double8, 8> a, b;
  for (std::size_t i = 0; i < 8; i += 2) {
    a[i] = __builtin_shufflevector(r[i], r[i + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    a[i + 1] = __builtin_shufflevector(r[i], r[i + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  for (std::size_t i = 0; i < 8; i += 4) {
    for (std::size_t k = 0; k < 2; ++k) {
      b[i + k] = __builtin_shufflevector(a[i + k], a[i + k + 2], 0, 1, 8, 9, 4, 5, 12, 13);
      b[i + k + 2] = __builtin_shufflevector(a[i + k], a[i + k + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  }
  for (std::size_t k = 0; k < 4; ++k) {
    r[k] = __builtin_shufflevector(b[k], b[k + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    r[k + 4] = __builtin_shufflevector(b[k], b[k + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}
}  // namespace detail

/// Reads `Count` consecutive doubles from each of W rows into `Count` packs, one lane per row.
template <std::size_t Count, int W, InstructionSet Set>
inline void load_rows(const std::array<const double*, std::size_t(W)>& rows,
                      std::array<BasicPack<W, Set>, Count>& packs) noexcept {
  constexpr auto width = static_cast<std::size_t>(W);
  constexpr std::size_t whole = Count / width * width;
  for (std::size_t first = 0; first < whole; first += width) {
    std::array<typename BasicPack<W, Set>::Native, width> square;
    for (std::size_t lane = 0; lane < width; ++lane) {
      std::memcpy(&square[lane], rows[lane] + first, sizeof(square[lane]));
    }
    detail::transpose<Set>(square);
    for (std::size_t i = 0; i < width; ++i) {
      packs[first + i].v = square[i];
    }
  }
  for (std::size_t i = whole; i < Count; ++i) {
    for (std::size_t lane = 0; lane < width; ++lane) {
      packs[i].v[lane] = rows[lane][i];
    }
  }
}
template <std::size_t Count>
inline void load_rows(const std::array<const double*, 1>& rows, std::array<double, Count>& values) noexcept {
  std::memcpy(values.data(), rows[0], sizeof(values));
}

/// Lane k of `Count` packs becomes row k, filled up with zeros to whole packs: rows[piece][k].
template <std::size_t Count, int W, InstructionSet Set, std::size_t Pieces>
inline void to_rows(const std::array<BasicPack<W, Set>, Count>& packs,
                    std::array<std::array<typename BasicPack<W, Set>::Native, std::size_t(W)>, Pieces>& rows) noexcept {
  constexpr auto width = static_cast<std::size_t>(W);
  static_assert(Pieces == (Count + width - 1) / width);
  for (std::size_t piece = 0; piece < Pieces; ++piece) {
    for (std::size_t i = 0; i < width; ++i) {
      rows[piece][i] = piece * width + i < Count ? packs[piece * width + i].v : BasicPack<W, Set>::broadcast(0.0);
    }
    detail::transpose<Set>(rows[piece]);
  }
}

/// The pack of W doubles of this translation unit's instruction set.
template <int W>
using Pack = BasicPack<W, compiled_instruction_set>;

[[nodiscard]] inline double square_root(double a) noexcept { return std::sqrt(a); }
[[nodiscard]] inline bool all_equal(double a, double b) noexcept { return a == b; }
[[nodiscard]] inline double minimum(double a, double b) noexcept { return a < b ? a : b; }
[[nodiscard]] inline double maximum(double a, double b) noexcept { return a > b ? a : b; }
[[nodiscard]] FEXP_INLINE double select_less(double a, double b, double yes, double no) noexcept {
  return a < b ? yes : no;
}
[[nodiscard]] FEXP_INLINE bool any_less(double a, double b) noexcept { return a < b; }
[[nodiscard]] FEXP_INLINE double split_exponent(double x, double& exponent) noexcept {
  std::uint64_t fraction = 0, biased = 0;
  std::memcpy(&fraction, &x, sizeof(x));
  detail::split_bits(fraction, biased);
  std::memcpy(&exponent, &biased, sizeof(x));
  exponent = exponent - (detail::two_to_52 + 1024.0);
  std::memcpy(&x, &fraction, sizeof(x));
  return x;
}
[[nodiscard]] FEXP_INLINE double times_power_of_two(double x, double exponent) noexcept {
  const double shifted = exponent + (detail::two_to_52 + 1023.0);
  std::uint64_t bits = 0;
  std::memcpy(&bits, &shifted, sizeof(bits));
  bits = bits << 52;
  double power = 0.0;
  std::memcpy(&power, &bits, sizeof(power));
  return x * power;
}

/// Number of doubles in T.
template <class T>
struct LaneCount : std::integral_constant<int, 1> {};
template <int W, InstructionSet Set>
struct LaneCount<BasicPack<W, Set>> : std::integral_constant<int, W> {};
template <class T>
inline constexpr int lane_count = LaneCount<T>::value;

}  // namespace fexp
