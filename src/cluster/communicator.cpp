// SPDX-License-Identifier: Apache-2.0
#include "cluster/communicator.hpp"

#include <bit>
#include <cstring>
#include <thread>

#include "base/stopwatch.hpp"

namespace fexp::cluster {

Bytes Communicator::all_gather(std::span<const std::byte> own, std::span<const std::size_t> sizes) {
  const auto start = Clock::now();
  Bytes all = do_all_gather(own, sizes);
  const int others = size() - 1;
  traffic_ += {others, others * static_cast<std::int64_t>(own.size()), seconds_since(start)};
  return all;
}

std::vector<Bytes> Communicator::all_gather(std::span<const std::byte> own) {
  const std::uint64_t count = own.size();
  const std::vector<std::size_t> same(static_cast<std::size_t>(size()), sizeof(count));
  const Bytes counts = all_gather(std::as_bytes(std::span(&count, 1)), same);
  std::vector<std::size_t> sizes(same.size());
  for (std::size_t r = 0; r < sizes.size(); ++r) {
    std::uint64_t one = 0;
    std::memcpy(&one, counts.data() + r * sizeof(one), sizeof(one));
    sizes[r] = static_cast<std::size_t>(one);
  }
  const Bytes all = all_gather(own, sizes);
  std::vector<Bytes> parts(sizes.size());
  std::size_t offset = 0;
  for (std::size_t r = 0; r < sizes.size(); ++r) {
    const std::span<const std::byte> part = std::span(all).subspan(offset, sizes[r]);
    parts[r].assign(part.begin(), part.end());
    offset += sizes[r];
  }
  return parts;
}

std::vector<Parcel> Communicator::exchange(const std::vector<Parcel>& parcels, std::span<const int> sources) {
  const auto start = Clock::now();
  std::vector<Parcel> come = do_exchange(parcels, sources);
  traffic_.messages += static_cast<std::int64_t>(parcels.size());
  for (const Parcel& parcel : parcels) {
    traffic_.bytes += static_cast<std::int64_t>(parcel.bytes.size());
  }
  traffic_.seconds += seconds_since(start);
  return come;
}

Bytes LoneCommunicator::do_all_gather(std::span<const std::byte> own, std::span<const std::size_t> /*sizes*/) {
  return {own.begin(), own.end()};
}

std::vector<Parcel> LoneCommunicator::do_exchange(const std::vector<Parcel>& /*parcels*/,
                                                  std::span<const int> /*sources*/) {
  return {};
}

Bytes SlowCommunicator::do_all_gather(std::span<const std::byte> own, std::span<const std::size_t> sizes) {
  const auto rounds = static_cast<int>(std::bit_width(static_cast<unsigned>(size() - 1)));
  std::this_thread::sleep_for(rounds * latency_);
  return inner_->all_gather(own, sizes);
}

std::vector<Parcel> SlowCommunicator::do_exchange(const std::vector<Parcel>& parcels, std::span<const int> sources) {
  if (!parcels.empty() || !sources.empty()) {
    std::this_thread::sleep_for(latency_);
  }
  return inner_->exchange(parcels, sources);
}

}  // namespace fexp::cluster
