// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/byte_stream.hpp"

namespace fexp::cluster {

/// What a rank has sent so far, and how long it has waited in calls of its communicator.
struct Traffic {
  std::int64_t messages{};
  std::int64_t bytes{};
  double seconds{};

  Traffic& operator+=(const Traffic& other) noexcept {
    messages += other.messages;
    bytes += other.bytes;
    seconds += other.seconds;
    return *this;
  }
};

/// Bytes on their way to a rank, or come from one.
struct Parcel {
  int rank{};
  Bytes bytes;
};

/// What the ranks of a world say to each other. All ranks make the same calls in the same order. A lost rank is not
/// reported here: the world ends, and whoever launched it starts another.
class Communicator {
 public:
  Communicator() = default;
  Communicator(const Communicator&) = delete;
  Communicator& operator=(const Communicator&) = delete;
  virtual ~Communicator() = default;

  [[nodiscard]] virtual int rank() const noexcept = 0;
  [[nodiscard]] virtual int size() const noexcept = 0;

  /// Every rank's bytes side by side, in order of rank. `sizes`: how many each rank gives, shape [ranks], known to all.
  [[nodiscard]] Bytes all_gather(std::span<const std::byte> own, std::span<const std::size_t> sizes);
  /// The same where nobody knows the others' sizes.
  [[nodiscard]] std::vector<Bytes> all_gather(std::span<const std::byte> own);
  /// Sends parcels, at most one to each other rank, and returns those that have come, in the order of `sources`: the
  /// ranks that send one to this rank, which it knows.
  [[nodiscard]] std::vector<Parcel> exchange(const std::vector<Parcel>& parcels, std::span<const int> sources);

  [[nodiscard]] const Traffic& traffic() const noexcept { return traffic_; }

 protected:
  /// The work of all_gather and exchange; messages counted as this rank sends them.
  virtual Bytes do_all_gather(std::span<const std::byte> own, std::span<const std::size_t> sizes) = 0;
  virtual std::vector<Parcel> do_exchange(const std::vector<Parcel>& parcels, std::span<const int> sources) = 0;

 private:
  Traffic traffic_;
};

/// A world of one rank: nothing is sent.
class LoneCommunicator final : public Communicator {
 public:
  [[nodiscard]] int rank() const noexcept override { return 0; }
  [[nodiscard]] int size() const noexcept override { return 1; }

 protected:
  Bytes do_all_gather(std::span<const std::byte> own, std::span<const std::size_t> sizes) override;
  std::vector<Parcel> do_exchange(const std::vector<Parcel>& parcels, std::span<const int> sources) override;
};

/// Another communicator on a slow network: every message takes `latency` longer. An exchange sends all of its messages
/// at the same time; a gathering among n ranks takes ceil(log2 n) messages one after the other, as with recursive
/// doubling.
class SlowCommunicator final : public Communicator {
 public:
  SlowCommunicator(std::unique_ptr<Communicator> inner, std::chrono::duration<double> latency)
      : inner_(std::move(inner)), latency_(latency) {}
  [[nodiscard]] int rank() const noexcept override { return inner_->rank(); }
  [[nodiscard]] int size() const noexcept override { return inner_->size(); }

 protected:
  Bytes do_all_gather(std::span<const std::byte> own, std::span<const std::size_t> sizes) override;
  std::vector<Parcel> do_exchange(const std::vector<Parcel>& parcels, std::span<const int> sources) override;

 private:
  std::unique_ptr<Communicator> inner_;
  std::chrono::duration<double> latency_;
};

}  // namespace fexp::cluster
