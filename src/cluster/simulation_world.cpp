// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <thread>

#include "base/stopwatch.hpp"
#include "cluster/shipment.hpp"
#include "cluster/simulation.hpp"
#include "parallel/parallel.hpp"

namespace fexp::cluster {

namespace {

std::string counted(std::size_t count, const char* one, const char* several) {
  return fmt::format("{} {}", count, count == 1 ? one : several);
}

/// "2 islands merged, 1 split off" and the like.
std::string reason_of(const std::vector<Move>& moves, const std::vector<Island>& before,
                      const std::vector<Island>& after) {
  if (before.empty()) {
    return "start";
  }
  std::string text = before.size() == after.size()
                         ? counted(after.size(), "island", "islands")
                         : fmt::format("{} become {}", counted(before.size(), "island", "islands"), after.size());
  std::vector<std::pair<MoveReason, std::size_t>> counts;
  for (const Move& move : moves) {
    const auto found = std::ranges::find(counts, move.reason, &std::pair<MoveReason, std::size_t>::first);
    ++(found == counts.end() ? counts.emplace_back(move.reason, 0) : *found).second;
  }
  for (const auto& [reason, count] : counts) {
    text += fmt::format(", {} moved: {}", counted(count, "body", "bodies"), text_of(reason));
  }
  return text;
}

bool same_bodies(const std::vector<Island>& a, const std::vector<Island>& b) {
  return std::ranges::equal(a, b, [](const Island& x, const Island& y) { return x.bodies == y.bodies; });
}

}  // namespace

World World::alone() {
  World world;
  world.communicator = std::make_shared<LoneCommunicator>();
  Machine machine;
  machine.name = "localhost";
  machine.rank = 0;
  machine.threads = parallel::thread_count();
  machine.native_threads = static_cast<int>(std::thread::hardware_concurrency());
  world.machines.push_back(machine);
  return world;
}

int Simulation::rank_of(Index body) const {
  const MachineIndex owner = owner_[at(body)];
  return owner == no_machine ? -1 : world_.machines[static_cast<std::size_t>(owner)].rank;
}

/// Places the islands when they are others than before, or when their machines have changed.
void Simulation::place(const std::vector<Island>& islands) {
  const bool measured = world_.rule == PlacementRule::measured_cost && load_.epochs > 0;
  if (same_bodies(islands, islands_) && pending_reason_.empty() && !measured) {
    return;
  }
  std::vector<double> weight = elements_of(model_);
  if (measured) {
    // What an island took is spread over its bodies by their elements.
    for (std::size_t i = 0; i < islands_.size(); ++i) {
      double elements = 0.0;
      for (const Index body : islands_[i].bodies) {
        elements += weight[at(body)];
      }
      for (const Index body : islands_[i].bodies) {
        weight[at(body)] *= island_cost_[i] / elements;
      }
    }
  }
  const Placement placement = place_islands({world_.rule, islands, islands_, owner_, weight, world_.machines});
  const bool changed = !same_bodies(islands, islands_) || !placement.moves.empty() || !pending_reason_.empty();
  if (changed) {
    std::string reason = reason_of(placement.moves, islands_, islands);
    if (!pending_reason_.empty()) {
      reason = pending_reason_ + "; " + reason;
      pending_reason_.clear();
    }
    ledger_.note(model_, state_.step, state_.time, placement, world_.machines, std::move(reason));
  }
  if (!placement.moves.empty()) {
    move_bodies(placement.owner);
  }
}

/// Sends bodies to their new machines.
void Simulation::move_bodies(const std::vector<MachineIndex>& owner) {
  const std::vector<MachineIndex> before = std::exchange(owner_, owner);
  const auto rank_at = [&](MachineIndex machine) { return world_.machines[static_cast<std::size_t>(machine)].rank; };
  std::vector<Shipment> shipments;
  for (Index b = 0; b < model_.body_count(); ++b) {
    const MachineIndex from = before[at(b)], to = owner_[at(b)];
    if (from != to && from != no_machine) {
      shipments.push_back({b, rank_at(from), rank_at(to)});
      arrived_[at(b)] = arrived_[at(b)] || rank_at(to) == rank();
    }
  }
  moved_bytes_ += ship_bodies(*world_.communicator, model_, shipments, state_);
}

void Simulation::find_own_bodies() {
  own_bodies_.clear();
  for (Index b = 0; b < model_.body_count(); ++b) {
    if (is_own(b)) {
      own_bodies_.push_back(b);
    }
  }
}

/// Keeps the solver of every island of this machine that is still the same, makes the others, and has the forces of
/// bodies that came from elsewhere evaluated.
void Simulation::take_up_solvers(std::vector<Island> islands) {
  find_own_bodies();
  std::vector<std::unique_ptr<solve::IslandSolver>> solvers(islands.size());
  std::vector<double> cost(islands.size(), 0.0);
  std::vector<Index> fresh;
  // Both lists are in ascending order of their islands' lowest bodies.
  std::size_t old = 0;
  for (std::size_t i = 0; i < islands.size(); ++i) {
    const std::vector<Index>& bodies = islands[i].bodies;
    while (old < islands_.size() && islands_[old].bodies.front() < bodies.front()) {
      ++old;
    }
    const bool same = old < islands_.size() && islands_[old] == islands[i];
    if (same) {
      cost[i] = island_cost_[old];
    }
    if (!is_own(bodies.front())) {
      continue;
    }
    const bool stayed = std::ranges::none_of(bodies, [&](Index body) { return arrived_[at(body)]; });
    if (same && stayed && solvers_[old]) {
      solvers[i] = std::move(solvers_[old]);
    } else {
      fresh.push_back(static_cast<Index>(i));
    }
  }
  islands_ = std::move(islands);
  solvers_ = std::move(solvers);
  island_cost_ = std::move(cost);
  parallel::for_each(static_cast<Index>(fresh.size()), 1, [&](Index k) {
    const std::size_t i = at(fresh[at(k)]);
    solvers_[i] = std::make_unique<solve::IslandSolver>();
    solvers_[i]->assign(model_, workspace_.patches, state_, islands_[i].bodies, islands_[i].barriers);
    if (std::ranges::any_of(islands_[i].bodies, [&](Index body) { return arrived_[at(body)]; })) {
      solvers_[i]->evaluate(model_, state_, workspace_);
    } else {
      solvers_[i]->recall(model_, state_);
    }
  });
  arrived_.assign(model_.bodies.size(), false);
  island_of_body_.assign(model_.bodies.size(), no_index);
  for (std::size_t i = 0; i < islands_.size(); ++i) {
    for (const Index body : islands_[i].bodies) {
      island_of_body_[at(body)] = static_cast<Index>(i);
    }
  }
}

/// Tells all ranks this rank's record, the cost of its islands, and notices and wall forces of its bodies, in one
/// message; returns what all records come to.
RankRecord Simulation::share(const RankRecord& own, std::span<const double> island_seconds) {
  const std::size_t walls = model_.walls.size();
  const std::size_t body_bytes = sizeof(BodyNotice) + walls * sizeof(Vec3d);
  std::vector<std::size_t> sizes(static_cast<std::size_t>(world_.communicator->size()), sizeof(RankRecord));
  for (const Island& island : islands_) {
    sizes[static_cast<std::size_t>(rank_of(island.bodies.front()))] +=
        sizeof(double) + island.bodies.size() * body_bytes;
  }
  parallel::for_each(static_cast<Index>(own_bodies_.size()), 1, [&](Index k) {
    notices_[at(own_bodies_[at(k)])] = notice_of(model_, backup_, state_, own_bodies_[at(k)]);
  });
  RankRecord record = own;
  const Traffic& traffic = world_.communicator->traffic();
  record.moved_bytes = std::exchange(moved_bytes_, 0);
  record.messages = traffic.messages - told_.messages;
  record.message_bytes = traffic.bytes - told_.bytes;
  record.waiting_seconds = traffic.seconds - told_.seconds;
  told_ = traffic;
  ByteWriter out;
  out.value(record);
  for (std::size_t i = 0; i < islands_.size(); ++i) {
    if (is_own(islands_[i].bodies.front())) {
      out.value(island_seconds[i]);
      for (const Index body : islands_[i].bodies) {
        out.value(notices_[at(body)]);
        for (const Vec3d& force : workspace_.actions[at(body)].wall_force) {
          out.value(force);
        }
      }
    }
  }
  const Bytes all = world_.communicator->all_gather(out.bytes(), sizes);
  std::vector<std::vector<std::size_t>> held(sizes.size());  // [ranks]: islands
  for (std::size_t i = 0; i < islands_.size(); ++i) {
    held[static_cast<std::size_t>(rank_of(islands_[i].bodies.front()))].push_back(i);
  }
  std::vector<RankRecord> records(sizes.size());
  RankRecord sum;
  std::size_t offset = 0;
  for (std::size_t r = 0; r < sizes.size(); ++r) {
    ByteReader in(std::span<const std::byte>(all).subspan(offset, sizes[r]));
    records[r] = in.value<RankRecord>();
    sum.add(records[r]);
    take_in(held[r], in);
    offset += sizes[r];
  }
  for (std::size_t m = 0; m < world_.machines.size(); ++m) {
    if (const Machine& machine = world_.machines[m]; machine.present()) {
      const RankRecord& told = records[static_cast<std::size_t>(machine.rank)];
      const double seconds = told.busy_seconds;
      scale_cost(held[static_cast<std::size_t>(machine.rank)], seconds * machine.speed);
      if (m < load_.busy_seconds.size()) {
        load_.busy_seconds[m] += seconds;
        load_.running_threads[m] = told.running_threads > 0 ? told.running_threads : load_.running_threads[m];
      }
    }
  }
  ledger_.add_bytes(sum.moved_bytes);
  load_.messages += sum.messages;
  load_.message_bytes += sum.message_bytes;
  load_.waiting_seconds += sum.waiting_seconds / world_.communicator->size();
  return sum;
}

/// Costs of the islands of one rank, and notices and wall forces of their bodies.
void Simulation::take_in(std::span<const std::size_t> islands, ByteReader& in) {
  for (const std::size_t i : islands) {
    island_cost_[i] = in.value<double>();
    for (const Index body : islands_[i].bodies) {
      notices_[at(body)] = in.value<BodyNotice>();
      for (Vec3d& force : workspace_.actions[at(body)].wall_force) {
        force = in.value<Vec3d>();
      }
    }
  }
}

/// Islands are stepped side by side, and one may keep several threads busy: what they took by the clock is scaled to
/// what their machine took for all of them.
void Simulation::scale_cost(std::span<const std::size_t> islands, double cost) {
  double sum = 0.0;
  for (const std::size_t i : islands) {
    sum += island_cost_[i];
  }
  for (const std::size_t i : islands) {
    island_cost_[i] *= sum > 0.0 ? cost / sum : 0.0;
  }
}

/// Brings the hashes of all ranks to all ranks, in order.
void Simulation::share_hashes(EpochReport& report) {
  const std::vector<Bytes> all =
      world_.communicator->all_gather(std::as_bytes(std::span<const solve::HashRecord>(report.hashes)));
  report.hashes.clear();
  for (const Bytes& bytes : all) {
    const std::size_t before = report.hashes.size();
    report.hashes.resize(before + bytes.size() / sizeof(solve::HashRecord));
    if (!bytes.empty()) {
      std::memcpy(static_cast<void*>(report.hashes.data() + before), bytes.data(), bytes.size());
    }
  }
  std::sort(report.hashes.begin(), report.hashes.end(), [](const solve::HashRecord& a, const solve::HashRecord& b) {
    return a.step != b.step ? a.step < b.step : a.body < b.body;
  });
}

void Simulation::collect(std::span<const Index> bodies) {
  std::vector<Shipment> shipments;
  for (const Index body : bodies) {
    if (const int from = rank_of(body); from > 0) {
      shipments.push_back({body, from, 0});
    }
  }
  if (!shipments.empty()) {
    ship_bodies(*world_.communicator, model_, shipments, state_, &workspace_.contact.force);
  }
}

void Simulation::collect() {
  std::vector<Index> all(model_.bodies.size());
  for (std::size_t b = 0; b < all.size(); ++b) {
    all[b] = static_cast<Index>(b);
  }
  collect(all);
}

void Simulation::collect_epoch_start() {
  std::vector<Shipment> shipments;
  for (Index body = 0; body < model_.body_count(); ++body) {
    if (const int from = rank_of(body); from > 0) {
      shipments.push_back({body, from, 0});
    }
  }
  if (!shipments.empty()) {
    ship_bodies(*world_.communicator, model_, shipments, backup_);
  }
}

/// What was said while the world was set up does not count.
void Simulation::begin_load() {
  load_ = {};
  load_.busy_seconds.assign(world_.machines.size(), 0.0);
  load_.running_threads.assign(world_.machines.size(), 0);
  began_ = Clock::now();
  told_ = world_.communicator->traffic();
}

WorldLoad Simulation::load() const {
  WorldLoad load = load_;
  load.seconds = seconds_since(began_);
  std::vector<MachineIndex> owner;
  for (const Island& island : islands_) {
    owner.push_back(owner_[at(island.bodies.front())]);
  }
  load.balance = judge_balance(island_cost_, owner, world_.machines);
  return load;
}

}  // namespace fexp::cluster
