// SPDX-License-Identifier: Apache-2.0
#include "cluster/watchdog.hpp"

#include <cmath>
#include <utility>

namespace fexp::cluster {

namespace {

/// How much something is off; what is not a number most of all.
double size_of_drift(double off) noexcept { return std::isnan(off) ? HUGE_VAL : std::abs(off); }

}  // namespace

Watchdog::Watchdog(std::size_t bodies) : off_(bodies, 0.0), off_before_(bodies, 0.0), rows_(bodies * slots) {}

/// Over an epoch, all of whose steps are of one length, central differences keep the kinetic energy less dt^2/8 times
/// the acceleration square: the rest is off.
void Watchdog::add(const EpochRow& epoch, std::span<const BodyNotice> before, std::span<const BodyNotice> after) {
  off_before_ = off_;
  epochs_[slot(count_)] = epoch;
  const double factor = 0.125 * epoch.dt * epoch.dt;
  for (std::size_t b = 0; b < off_.size(); ++b) {
    const solve::Diagnostics &was = before[b].diagnostics, &is = after[b].diagnostics;
    off_[b] +=
        after[b].own_balance() - before[b].own_balance() - factor * (is.acceleration_square - was.acceleration_square);
    const model::PairBook& pair = after[b].worst_pair;
    rows_[b * slots + slot(count_)] = {
        is.energies.kinetic, is.energies.internal, after[b].contact_work, off_[b], pair.other,
        pair.energy,         pair.open()};
  }
  ++count_;
}

void Watchdog::take_back() {
  off_ = off_before_;
  --count_;
}

Culprit Watchdog::worst(std::span<const BodyNotice> notices) const {
  Culprit worst;
  double sum = 0.0;
  for (std::size_t b = 0; b < off_.size(); ++b) {
    const auto body = static_cast<Index>(b);
    const model::PairBook& pair = notices[b].worst_pair;
    sum += size_of_drift(off_[b]) + size_of_drift(notices[b].pairs_off);
    if (worst.body == no_index || size_of_drift(off_[b]) > size_of_drift(worst.off)) {
      worst = {body, no_index, off_[b], 0.0};
    }
    if (pair.other != no_index && size_of_drift(pair.open()) > size_of_drift(worst.off)) {
      worst = {body, pair.other, pair.open(), 0.0};
    }
  }
  worst.share = std::isfinite(sum) && sum > 0.0 ? size_of_drift(worst.off) / sum : 1.0;
  return worst;
}

std::vector<EpochRow> Watchdog::epochs() const {
  std::vector<EpochRow> rows;
  for (std::int64_t e = first(); e < count_; ++e) {
    rows.push_back(epochs_[slot(e)]);
  }
  return rows;
}

std::vector<BodyRow> Watchdog::rows(Index body) const {
  std::vector<BodyRow> rows;
  for (std::int64_t e = first(); e < count_; ++e) {
    rows.push_back(rows_[at(body) * slots + slot(e)]);
  }
  return rows;
}

bool Watchdog::unpack(ByteReader& in) {
  std::vector<double> off = in.list<double>();
  if (off.size() != off_.size()) {
    return false;
  }
  off_ = std::move(off);
  return true;
}

}  // namespace fexp::cluster
