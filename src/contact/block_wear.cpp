// SPDX-License-Identifier: Apache-2.0
#include "contact/block_wear.hpp"

#include <algorithm>
#include <cmath>

#include "contact/near_pairs.hpp"
#include "parallel/parallel.hpp"

namespace fexp::contact {

namespace {

constexpr Index wear_grain = 512;
/// What is worn so much is due.
constexpr double worn_part = 0.5;
/// Where so many are, nothing that is more worn than this stays, so that the next search may come the later.
constexpr double many_part = 0.25;
constexpr double fresh_part = 0.1;

double largest_coordinate(const Box& box) noexcept {
  return std::max({std::abs(box.low.x), std::abs(box.low.y), std::abs(box.low.z), std::abs(box.high.x),
                   std::abs(box.high.y), std::abs(box.high.z)});
}

}  // namespace

void BlockWear::begin(const BlockPairs& pairs, const Positions& x) {
  const std::span<const Index> nodes = pairs.nodes();
  at_.resize(nodes.size());
  ways_.assign(at(pairs.count()), {});
  farthest_ = 0.0;
  for (Index block = 0; block < pairs.count(); ++block) {
    Box& place = ways_[at(block)].place;
    const IndexRange own = pairs.nodes_of(block);
    for (Index k = own.begin; k < own.end; ++k) {
      at_[at(k)] = x(nodes[at(k)]);
      place.include(at_[at(k)]);
    }
    farthest_ = std::max(farthest_, largest_coordinate(place));
  }
  used_.assign(pairs.partners().size(), 0.0);
  due_.assign(pairs.partners().size(), Due::near);
  last_ = 0.0;
  whole_ = 0.0;
}

void BlockWear::add(const BlockPairs& pairs, const Positions& x, double rounding) {
  const std::span<const Index> nodes = pairs.nodes();
  parallel::for_each(pairs.count(), wear_grain, [&](Index block) {
    Way way;
    const IndexRange own = pairs.nodes_of(block);
    for (Index k = own.begin; k < own.end; ++k) {
      const Vec3d point = x(nodes[at(k)]);
      way.way.include(point - at_[at(k)]);
      way.place.include(point);
      at_[at(k)] = point;
    }
    ways_[at(block)] = way;
  });
  parallel::for_each(pairs.count(), wear_grain, [&](Index block) {
    Way& own = ways_[at(block)];
    const IndexRange partners = pairs.partners_of(block);
    for (Index k = partners.begin; k < partners.end; ++k) {
      Box way = own.way;
      way.include(ways_[at(pairs.partners()[at(k)])].way);
      const double added = norm(way.high - way.low) + rounding;
      own.added = std::max(own.added, added);
      used_[at(k)] += added;
      due_[at(k)] = Due::no;
    }
  });
  Box whole;
  last_ = 0.0;
  farthest_ = 0.0;
  for (const Way& way : ways_) {
    whole.include(way.way);
    last_ = std::max(last_, way.added);
    farthest_ = std::max(farthest_, largest_coordinate(way.place));
  }
  whole_ += norm(whole.high - whole.low) + rounding;
}

void BlockWear::take_over(const BlockPairs& pairs) {
  old_used_.swap(used_);
  const std::span<const Index> before = pairs.before();
  used_.resize(before.size());
  due_.resize(before.size());
  for (std::size_t k = 0; k < before.size(); ++k) {
    used_[k] = before[k] == no_index ? 0.0 : old_used_[at(before[k])];
    due_[k] = before[k] == no_index ? Due::near : Due::no;
  }
  whole_ = 0.0;
}

Box BlockWear::reached_by(const BlockPairs& pairs, Index block, double skin) const {
  return ways_[at(block)].place.grown((pairs.reach(block) + 0.5 * skin) * (1.0 + distance_rounding));
}

std::vector<Index> BlockWear::take_due(const BlockPairs& pairs, double skin) {
  const auto worn = std::ranges::count_if(used_, [&](double used) { return used > worn_part * skin; });
  const bool many = static_cast<double>(worn) > many_part * static_cast<double>(used_.size());
  const double limit = (many ? fresh_part : worn_part) * skin;
  std::vector<Index> blocks;
  for (Index block = 0; block < pairs.count(); ++block) {
    const IndexRange partners = pairs.partners_of(block);
    bool any = false;
    for (Index k = partners.begin; k < partners.end; ++k) {
      if (used_[at(k)] > limit || due_[at(k)] != Due::no) {
        const Index partner = pairs.partners()[at(k)];
        const bool near = reached_by(pairs, block, skin).overlaps(reached_by(pairs, partner, skin));
        due_[at(k)] = near ? Due::near : Due::apart;
        used_[at(k)] = 0.0;
        any = true;
      }
    }
    if (any) {
      blocks.push_back(block);
    }
  }
  return blocks;
}

double BlockWear::most_used() const noexcept {
  double most = 0.0;
  for (const double used : used_) {
    most = std::max(most, used);
  }
  return most;
}

}  // namespace fexp::contact
