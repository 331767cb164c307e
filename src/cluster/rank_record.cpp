// SPDX-License-Identifier: Apache-2.0
#include "cluster/rank_record.hpp"

#include <algorithm>

namespace fexp::cluster {

void RankRecord::add(const solve::IslandReport& island) {
  RankRecord one;
  one.good_steps = island.steps_done;
  one.left_box = island.stop == solve::StopReason::left_swept_box;
  if (island.stop == solve::StopReason::not_finite) {
    one.broken_steps = island.steps_done;
    one.broken_node = island.stop_node;
  }
  one.contact_frequency2 = island.contact_frequency2;
  one.stiffest_node = island.stiffest_node;
  one.stiffest_element = island.stiffest_element;
  one.stiffest_wall = island.stiffest_wall;
  one.active_pairs = island.active_pairs;
  one.candidates = island.candidates;
  one.searches = island.searches;
  one.deepest = island.deepest;
  one.deepest_node = island.deepest_node;
  one.deepest_element = island.deepest_element;
  add(one);
}

void RankRecord::add(const RankRecord& other) {
  good_steps = std::min(good_steps, other.good_steps);
  left_box = left_box || other.left_box;
  // The earliest failure counts; of several at one step, the lowest node.
  if (other.broken_node != no_index && (broken_node == no_index || other.broken_steps < broken_steps ||
                                        (other.broken_steps == broken_steps && other.broken_node < broken_node))) {
    broken_steps = other.broken_steps;
    broken_node = other.broken_node;
  }
  if (contact_frequency2 < other.contact_frequency2 ||
      (contact_frequency2 == other.contact_frequency2 && other.stiffest_node < stiffest_node)) {
    contact_frequency2 = other.contact_frequency2;
    stiffest_node = other.stiffest_node;
    stiffest_element = other.stiffest_element;
    stiffest_wall = other.stiffest_wall;
  }
  active_pairs += other.active_pairs;
  candidates += other.candidates;
  searches += other.searches;
  if (other.deepest > deepest || (other.deepest == deepest && other.deepest_node < deepest_node)) {
    deepest = other.deepest;
    deepest_node = other.deepest_node;
    deepest_element = other.deepest_element;
  }
  requests |= other.requests;
  moved_bytes += other.moved_bytes;
  messages += other.messages;
  message_bytes += other.message_bytes;
  busy_seconds = std::max(busy_seconds, other.busy_seconds);
  waiting_seconds += other.waiting_seconds;
}

}  // namespace fexp::cluster
