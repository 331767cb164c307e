// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/byte_stream.hpp"
#include "cluster/placement.hpp"
#include "model/model.hpp"

namespace fexp::cluster {

/// Who held what after a change of placement: a row of the paper's table 1.
struct PlacementFrame {
  std::int64_t step{};
  double time{};                  ///< [time]
  std::string reason;             ///< Why the placement changed, in words
  std::vector<Index> elements;    // [machines known by then]
  std::vector<Index> nodes;       // [machines known by then]
  std::int64_t moved_elements{};  ///< So far
  std::int64_t moved_nodes{};
};

/// A body's change of machine after the start.
struct LedgerMove {
  std::int64_t step{};
  double time{};  ///< [time]
  Move move;
};

/// So many frames are kept at either end of a run: snapshots hold them, and it may change its islands in every epoch.
constexpr std::size_t frames_kept = 500;

/// All changes of placement of a run. Bodies count as moved when their machine changes after the start.
class PlacementLedger {
 public:
  /// Takes note of a placement at the start of an epoch. A second one of the same step replaces the frame of the first.
  void note(const model::Model& model, std::int64_t step, double time, const Placement& placement,
            const std::vector<Machine>& machines, std::string reason);
  void add_bytes(std::int64_t bytes) noexcept { moved_bytes_ += bytes; }

  /// Of a run with very many of them the first and the last.
  [[nodiscard]] const std::vector<PlacementFrame>& frames() const noexcept { return frames_; }
  /// How many came between them.
  [[nodiscard]] std::int64_t frames_left_out() const noexcept { return frames_left_out_; }
  /// Moves since the last call.
  [[nodiscard]] std::vector<LedgerMove> take_moves() { return std::exchange(moves_, {}); }
  [[nodiscard]] std::int64_t moved_elements() const noexcept { return moved_elements_; }
  [[nodiscard]] std::int64_t moved_nodes() const noexcept { return moved_nodes_; }
  [[nodiscard]] std::int64_t moved_bytes() const noexcept { return moved_bytes_; }

  void pack(ByteWriter& out) const;
  [[nodiscard]] static PlacementLedger unpack(ByteReader& in);

 private:
  std::vector<PlacementFrame> frames_;
  std::int64_t frames_left_out_{};
  std::vector<LedgerMove> moves_;
  std::int64_t moved_elements_{};
  std::int64_t moved_nodes_{};
  std::int64_t moved_bytes_{};
};

/// "start", "merge", "split", "machine left" or "balance".
[[nodiscard]] const char* text_of(MoveReason reason) noexcept;

}  // namespace fexp::cluster
