// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/byte_stream.hpp"
#include "cluster/body_notice.hpp"

namespace fexp::cluster {

/// Who is off the most: a body, or the contact of two bodies or of one with itself.
struct Culprit {
  Index body{no_index};
  Index other{no_index};  ///< The second body of a pair; no_index where the body alone is off
  double off{};           ///< Energy that came from nowhere (> 0) or went there [force*length]
  double share{};         ///< Of the sum of moduli of what bodies and pairs are off [-]
};

/// Quantities of a body at the end of an epoch [force*length].
struct BodyRow {
  double kinetic{};
  double internal{};
  double contact_work{};  ///< Of contact forces on it since the start
  double off{};           ///< What its own balance is off
  Index other{no_index};  ///< With whom it has the pair that is off the most of those it keeps the books of
  double stored{};        ///< Potential of that pair
  double pair_off{};
};

struct EpochRow {
  std::int64_t step{};
  double time{};
  double dt{};
  double energy_error{};
};

/// Keeps the energy balance of every body and every pair of bodies. What the whole model is off is the sum of what
/// these are off: bodies by the difference of what elements store and what their forces do, pairs by that of potential
/// and work. All ranks keep the same, from what notices tell.
class Watchdog {
 public:
  static constexpr int most_rows = 6;

  explicit Watchdog(std::size_t bodies);

  /// Takes note of an epoch that began with the notices `before`.
  void add(const EpochRow& epoch, std::span<const BodyNotice> before, std::span<const BodyNotice> after);
  /// Forgets the epoch that was added last; not twice in a row.
  void take_back();

  /// What each body's own balance is off since the start [force*length], shape [bodies].
  [[nodiscard]] std::span<const double> off() const noexcept { return off_; }
  /// The lowest of those that are off the most.
  [[nodiscard]] Culprit worst(std::span<const BodyNotice> notices) const;

  /// Ends of the last epochs of this world, the oldest first, at most `most_rows`.
  [[nodiscard]] std::vector<EpochRow> epochs() const;
  /// The body at these.
  [[nodiscard]] std::vector<BodyRow> rows(Index body) const;

  /// What the run needs, without the rows.
  void pack(ByteWriter& out) const { out.list(off_); }
  /// False when it does not fit.
  [[nodiscard]] bool unpack(ByteReader& in);

 private:
  /// One more than are told, as the last epoch may be taken back.
  static constexpr int slots = most_rows + 1;
  [[nodiscard]] static std::size_t slot(std::int64_t epoch) { return static_cast<std::size_t>(epoch % slots); }
  [[nodiscard]] std::int64_t first() const { return count_ > most_rows ? count_ - most_rows : 0; }

  std::vector<double> off_;               // [bodies]
  std::vector<double> off_before_;        // [bodies]: before the last epoch
  std::array<EpochRow, slots> epochs_{};  // [slots]
  std::vector<BodyRow> rows_;             // [bodies][slots]
  std::int64_t count_{};                  // Epochs of this world
};

}  // namespace fexp::cluster
