// SPDX-License-Identifier: Apache-2.0
#include "cluster/placement.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <queue>
#include <set>
#include <utility>

namespace fexp::cluster {

namespace {

/// measured_cost leaves islands where they are while the busiest machine is no more than this above the mean, ...
constexpr double tolerated_imbalance = 0.1;
/// ... and otherwise moves some until it is no more than this above the mean, so that noise does not move them again.
constexpr double aimed_imbalance = 0.05;
/// What saves less than this part of the time is not worth doing.
constexpr double worth_having = 0.01;

/// Loads of the machines, and the least and the most loaded one in logarithmic time. Loads are divided by speeds, but
/// under the paper's rule, which counts elements alone.
class Loads {
 public:
  Loads(std::span<const Machine> machines, PlacementRule rule)
      : machines_(machines), load_(machines.size(), 0.0), by_speed_(rule == PlacementRule::measured_cost) {
    for (std::size_t m = 0; m < machines_.size(); ++m) {
      enter(static_cast<MachineIndex>(m));
    }
  }

  void add(MachineIndex machine, double weight) {
    load_[index(machine)] += weight;
    enter(machine);
  }
  [[nodiscard]] double of(MachineIndex machine) const { return load_[index(machine)] / speed(machine); }
  [[nodiscard]] double with(MachineIndex machine, double weight) const {
    return (load_[index(machine)] + weight) / speed(machine);
  }
  /// The weight that makes both machines equally loaded when it moves from one to the other.
  [[nodiscard]] double evening(MachineIndex from, MachineIndex to) const {
    return (load_[index(from)] * speed(to) - load_[index(to)] * speed(from)) / (speed(from) + speed(to));
  }
  /// The present machine with the least load; ties go to the lowest.
  [[nodiscard]] MachineIndex least() { return first_of(ascending_, 1.0); }
  /// The present machine with the most load; ties go to the lowest.
  [[nodiscard]] MachineIndex most() { return first_of(descending_, -1.0); }
  [[nodiscard]] bool present(MachineIndex machine) const {
    return machine != no_machine && machines_[index(machine)].present();
  }

 private:
  using Queue = std::priority_queue<std::pair<double, MachineIndex>, std::vector<std::pair<double, MachineIndex>>,
                                    std::greater<>>;
  static std::size_t index(MachineIndex machine) { return static_cast<std::size_t>(machine); }
  [[nodiscard]] double speed(MachineIndex machine) const { return by_speed_ ? machines_[index(machine)].speed : 1.0; }
  void enter(MachineIndex machine) {
    if (present(machine)) {
      ascending_.emplace(of(machine), machine);
      descending_.emplace(-of(machine), machine);
    }
  }
  MachineIndex first_of(Queue& queue, double sign) const {
    while (queue.top().first != sign * of(queue.top().second)) {
      queue.pop();  // Its load has changed since.
    }
    return queue.top().second;
  }

  std::span<const Machine> machines_;
  std::vector<double> load_;
  bool by_speed_;
  Queue ascending_, descending_;
};

/// How an island came about.
enum class Origin { same, merged, piece, homeless };

struct Candidate {
  std::size_t island{};
  double weight{};
  Origin origin{Origin::same};
  MachineIndex host{no_machine};        ///< Where it is or gathers
  std::vector<MachineIndex> as_good{};  ///< Where a merged island could gather as well, if not only there
};

class Placer {
 public:
  explicit Placer(const PlacementTask& task) : task_(task), loads_(task.machines, task.rule) {
    placement_.owner.assign(task.owner.begin(), task.owner.end());
    reason_.resize(task.owner.size());
    find_candidates();
  }

  Placement place() {
    // Loads first, as far as they are settled, so that what is looked for a place sees them.
    for (const Candidate& c : candidates_) {
      if (c.origin == Origin::same || c.origin == Origin::piece) {
        settle(c, c.host, MoveReason::split);
      }
    }
    for (const Candidate& c : candidates_) {
      if (c.origin == Origin::merged) {
        settle(c, gathering_place(c), MoveReason::merge);
      }
    }
    std::vector<bool> first_stays(task_.machines.size(), false);
    for (const Candidate& c : candidates_) {
      if (c.origin == Origin::piece) {
        place_piece(c, first_stays);
      }
    }
    const bool start = task_.before.empty();
    for (const Candidate& c : candidates_) {
      if (c.origin == Origin::homeless) {
        settle(c, loads_.least(), start ? MoveReason::start : MoveReason::machine_left);
      }
    }
    if (task_.rule == PlacementRule::measured_cost) {
      balance();
    }
    for (std::size_t b = 0; b < placement_.owner.size(); ++b) {
      if (placement_.owner[b] != task_.owner[b]) {
        placement_.moves.push_back({static_cast<Index>(b), task_.owner[b], placement_.owner[b], reason_[b]});
      }
    }
    return std::move(placement_);
  }

 private:
  /// Islands in the order of the rule: weight descending, then lowest body.
  void find_candidates() {
    std::vector<std::size_t> island_before(task_.owner.size(), none);
    for (std::size_t i = 0; i < task_.before.size(); ++i) {
      for (const Index body : task_.before[i].bodies) {
        island_before[at(body)] = i;
      }
    }
    for (std::size_t i = 0; i < task_.islands.size(); ++i) {
      candidates_.push_back(candidate(i, island_before));
    }
    std::stable_sort(candidates_.begin(), candidates_.end(),
                     [](const Candidate& a, const Candidate& b) { return a.weight > b.weight; });
  }

  [[nodiscard]] Candidate candidate(std::size_t i, const std::vector<std::size_t>& island_before) const {
    const std::vector<Index>& bodies = task_.islands[i].bodies;
    Candidate c;
    c.island = i;
    std::vector<std::pair<MachineIndex, double>> held;  // few: an island's bodies come from few machines
    bool one = true;
    for (const Index body : bodies) {
      c.weight += task_.weight[at(body)];
      one = one && island_before[at(body)] == island_before[at(bodies.front())];
      const MachineIndex owner = task_.owner[at(body)];
      if (loads_.present(owner)) {
        const auto found = std::ranges::find(held, owner, &std::pair<MachineIndex, double>::first);
        (found == held.end() ? held.emplace_back(owner, 0.0) : *found).second += task_.weight[at(body)];
      }
    }
    std::sort(held.begin(), held.end());
    double most = -1.0;
    for (const auto& [machine, weight] : held) {
      if (weight > most) {
        most = weight;
        c.host = machine;
      }
    }
    if (std::ranges::count(held, most, &std::pair<MachineIndex, double>::second) > 1) {
      for (const auto& [machine, weight] : held) {
        if (weight == most) {
          c.as_good.push_back(machine);
        }
      }
    }
    const std::size_t before = island_before[at(bodies.front())];
    if (c.host == no_machine) {
      c.origin = Origin::homeless;
    } else if (!one) {
      c.origin = Origin::merged;
    } else {
      c.origin = before != none && task_.before[before].bodies == bodies ? Origin::same : Origin::piece;
    }
    return c;
  }

  /// Moves the island's bodies to a machine and counts its weight there.
  void settle(const Candidate& c, MachineIndex machine, MoveReason reason) {
    assign(c, machine, reason);
    loads_.add(machine, c.weight);
  }

  void assign(const Candidate& c, MachineIndex machine, MoveReason reason) {
    for (const Index body : task_.islands[c.island].bodies) {
      const MachineIndex from = task_.owner[at(body)];
      reason_[at(body)] = from != no_machine && !loads_.present(from) ? MoveReason::machine_left : reason;
      placement_.owner[at(body)] = machine;
    }
  }

  /// Of machines that hold as much of a merged island the lowest, by the paper's tables. By cost the least loaded one
  /// before: where bodies are alike, ties are frequent, and one machine must not get them all.
  [[nodiscard]] MachineIndex gathering_place(const Candidate& c) const {
    MachineIndex best = c.host;
    if (task_.rule == PlacementRule::fewest_elements) {
      return best;
    }
    for (const MachineIndex machine : c.as_good) {
      best = loads_.of(machine) < loads_.of(best) ? machine : best;
    }
    return best;
  }

  void place_piece(const Candidate& c, std::vector<bool>& first_stays) {
    const auto host = static_cast<std::size_t>(c.host);
    if (!first_stays[host]) {
      first_stays[host] = true;
      return;
    }
    const MachineIndex target = loads_.least();
    if (loads_.with(target, c.weight) < loads_.of(c.host)) {
      loads_.add(c.host, -c.weight);
      settle(c, target, MoveReason::split);
    }
  }

  /// Weights and numbers of candidates that a machine holds, the lightest first.
  using Held = std::set<std::pair<double, std::size_t>>;

  /// Takes islands from the busiest machine to the least busy one until the loads are even, or it no longer helps.
  void balance() {
    double sum = 0.0, speed = 0.0;
    for (const Candidate& c : candidates_) {
      sum += c.weight;
    }
    for (const Machine& machine : task_.machines) {
      speed += machine.present() ? machine.speed : 0.0;
    }
    const double high = loads_.of(loads_.most());
    if (high <= (1.0 + tolerated_imbalance) * sum / speed) {
      return;
    }
    std::vector<Held> held(task_.machines.size());
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
      held[static_cast<std::size_t>(owner_of(candidates_[k]))].emplace(candidates_[k].weight, k);
    }
    std::vector<std::pair<std::size_t, MachineIndex>> changes;
    // Each change makes two machines more alike, so this ends; the number of rounds is bounded for rounding's sake.
    while (changes.size() < 2 * candidates_.size() &&
           loads_.of(loads_.most()) > (1.0 + aimed_imbalance) * sum / speed) {
      const MachineIndex busiest = loads_.most(), target = loads_.least();
      Held& islands = held[static_cast<std::size_t>(busiest)];
      const auto best = best_to_move(islands, busiest, target);
      if (best == islands.end()) {
        break;
      }
      loads_.add(busiest, -best->first);
      loads_.add(target, best->first);
      changes.emplace_back(best->second, target);
      held[static_cast<std::size_t>(target)].insert(islands.extract(best));
    }
    if (loads_.of(loads_.most()) < (1.0 - worth_having) * high) {
      for (const auto& [candidate, machine] : changes) {
        assign(candidates_[candidate], machine, MoveReason::balance);
      }
    }
  }

  /// The island that leaves the two machines most alike; none when every one would leave them less alike than now.
  [[nodiscard]] Held::const_iterator best_to_move(const Held& islands, MachineIndex from, MachineIndex to) const {
    auto best = islands.end();
    double best_high = loads_.of(from);
    const auto consider = [&](Held::const_iterator c) {
      const double high = std::max(loads_.with(to, c->first), loads_.with(from, -c->first));
      if (high < best_high) {
        best_high = high;
        best = c;
      }
    };
    // The nearest below and above what would even them out; of equally heavy ones the first in the order of the rule.
    const auto above = islands.lower_bound({loads_.evening(from, to), 0});
    if (above != islands.begin()) {
      consider(islands.lower_bound({std::prev(above)->first, 0}));
    }
    if (above != islands.end()) {
      consider(above);
    }
    return best;
  }

  [[nodiscard]] MachineIndex owner_of(const Candidate& c) const {
    return placement_.owner[at(task_.islands[c.island].bodies.front())];
  }

  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  const PlacementTask& task_;
  Loads loads_;
  std::vector<Candidate> candidates_;
  std::vector<MoveReason> reason_;  // [bodies]: of the last change
  Placement placement_;
};

/// Load of the busiest of `count` equal machines when each cost, the largest first, goes to the least loaded one:
/// within a third of the best [GRA69].
double longest_load(const std::vector<double>& descending, int count) {
  std::priority_queue<double, std::vector<double>, std::greater<>> loads;
  for (int m = 0; m < count; ++m) {
    loads.push(0.0);
  }
  double longest = 0.0;
  for (const double one : descending) {
    const double load = loads.top() + one;
    loads.pop();
    loads.push(load);
    longest = std::max(longest, load);
  }
  return longest;
}

/// Machines that it takes to hold the costs with no more than `room` on each: each cost, the largest first, goes to the
/// fullest machine that has room for it.
int fewest_bins(const std::vector<double>& descending, double room) {
  std::multiset<double> free;
  for (const double one : descending) {
    auto bin = free.lower_bound(one);
    double left = room;
    if (bin != free.end()) {
      left = *bin;
      free.erase(bin);
    }
    free.insert(left - one);
  }
  return static_cast<int>(std::max<std::size_t>(free.size(), 1));
}

}  // namespace

Placement place_islands(const PlacementTask& task) { return Placer(task).place(); }

BalanceReport judge_balance(std::span<const double> cost, std::span<const MachineIndex> owner,
                            std::span<const Machine> machines) {
  BalanceReport report;
  std::vector<double> busy(machines.size(), 0.0);
  double sum = 0.0, largest = 0.0, speed = 0.0;
  for (std::size_t i = 0; i < cost.size(); ++i) {
    sum += cost[i];
    largest = std::max(largest, cost[i]);
    busy[static_cast<std::size_t>(owner[i])] += cost[i];
  }
  int present = 0;
  double busiest = 0.0;
  for (std::size_t m = 0; m < machines.size(); ++m) {
    if (machines[m].present()) {
      ++present;
      speed += machines[m].speed;
      busiest = std::max(busiest, busy[m] / machines[m].speed);
    }
  }
  if (!(sum > 0.0) || present == 0) {
    return report;
  }
  const double mean_speed = speed / present;
  report.largest_share = largest / sum;
  report.imbalance = busiest / (sum / speed) - 1.0;
  std::vector<double> sorted(cost.begin(), cost.end());
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  report.with_one_more = std::min(1.0, longest_load(sorted, present + 1) / mean_speed / busiest);
  report.useful_machines = fewest_bins(sorted, largest / (1.0 - worth_having));
  return report;
}

}  // namespace fexp::cluster
