// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "cluster/shipment.hpp"
#include "cluster/simulation.hpp"
#include "parallel/parallel.hpp"

namespace fexp::cluster {

namespace {

constexpr std::uint64_t format_version = 4;

/// Step and time stand first in what is packed of a run.
bool same_moment(std::span<const std::byte> a, std::span<const std::byte> b) {
  constexpr std::size_t moment = sizeof(std::int64_t) + sizeof(double);
  return a.size() >= moment && b.size() >= moment && std::ranges::equal(a.first(moment), b.first(moment));
}

[[noreturn]] void refuse(const std::string& why) { throw ShipmentError("the snapshot cannot be taken up: " + why); }

}  // namespace

/// What is not of one body: the same on all ranks.
void Simulation::pack_run(ByteWriter& out) const {
  out.value(state_.step);
  out.value(state_.time);
  out.value(contact_frequency2_);
  out.value(start_);
  out.value(energy_scale_);
  out.value(relaxation_);
  out.value(linear_scale_);
  out.value(angular_scale_);
  out.value(extremes_);
  out.value(half_until_);
  watchdog_.pack(out);
  out.value(static_cast<std::uint64_t>(world_.machines.size()));
  for (const Machine& machine : world_.machines) {
    out.text(machine.name);
    out.value(machine.threads);
    out.value(machine.native_threads);
    out.value(machine.speed);
  }
  out.list(owner_);
  out.list(island_of_body_);
  ledger_.pack(out);
}

Bytes Simulation::piece(std::span<const Index> bodies) const {
  ByteWriter out;
  out.value(format_version);
  out.value(fingerprint_);
  ByteWriter run;
  pack_run(run);
  out.list(run.bytes());
  out.value(static_cast<std::uint64_t>(bodies.size()));
  for (const Index body : bodies) {
    out.value(notices_[at(body)]);
    append_sealed_body(model_, state_, body, out);
  }
  return out.take();
}

void Simulation::unpack_run(ByteReader& in) {
  state_.step = in.value<std::int64_t>();
  state_.time = in.value<double>();
  contact_frequency2_ = in.value<double>();
  start_ = in.value<solve::Diagnostics>();
  energy_scale_ = in.value<double>();
  relaxation_ = in.value<Relaxation>();
  linear_scale_ = in.value<double>();
  angular_scale_ = in.value<double>();
  extremes_ = in.value<RunExtremes>();
  half_until_ = in.value<double>();
  const bool fits = watchdog_.unpack(in);
  std::vector<Machine> known(static_cast<std::size_t>(std::min<std::uint64_t>(in.value<std::uint64_t>(), 1U << 20U)));
  for (Machine& machine : known) {
    machine.name = in.text();
    machine.threads = in.value<int>();
    machine.native_threads = in.value<int>();
    machine.speed = in.value<double>();
  }
  owner_ = in.list<MachineIndex>();
  const std::vector<Index> island_of_body = in.list<Index>();
  ledger_ = PlacementLedger::unpack(in);
  if (!in.sound() || !fits || owner_.size() != model_.bodies.size() || island_of_body.size() != model_.bodies.size()) {
    refuse("it ends too early");
  }
  adopt_machines(known);
  islands_.clear();
  for (Index b = 0; b < model_.body_count(); ++b) {
    if (const Index island = island_of_body[at(b)]; island != no_index) {
      islands_.resize(std::max(islands_.size(), at(island) + 1));
      islands_[at(island)].bodies.push_back(b);
    }
  }
  std::erase_if(islands_, [](const Island& island) { return island.bodies.empty(); });
  solvers_.clear();
  solvers_.resize(islands_.size());
  island_cost_.assign(islands_.size(), 0.0);
}

/// Machines keep their places in the list; those that are new come after them.
void Simulation::adopt_machines(const std::vector<Machine>& known) {
  std::vector<Machine> present = std::exchange(world_.machines, known);
  std::string text;
  const auto add = [&text](const std::string& what) { text += (text.empty() ? "" : "; ") + what; };
  for (Machine& machine : world_.machines) {
    const auto found = std::ranges::find(present, machine.name, &Machine::name);
    if (found == present.end()) {
      const auto index = static_cast<MachineIndex>(&machine - world_.machines.data());
      if (std::ranges::find(owner_, index) != owner_.end()) {
        add(machine.name + " left");
      }
    } else {
      machine = *found;
      present.erase(found);
    }
  }
  for (const Machine& machine : present) {
    world_.machines.push_back(machine);
  }
  pending_reason_ = text;
}

Simulation::Simulation(const model::Model& model, solve::KernelChoice kernel, World world,
                       std::span<const Bytes> pieces)
    : Simulation(model, kernel, std::move(world), Blank{}) {
  Bytes run;
  std::vector<Index> held;
  for (const Bytes& piece : pieces) {
    read_piece(piece, run, held);
  }
  const std::vector<int> holder = learn_holders(held, run);
  ByteReader in(run);
  unpack_run(in);
  place_the_homeless();
  std::vector<Shipment> shipments;
  for (Index b = 0; b < model_.body_count(); ++b) {
    if (owner_[at(b)] != no_machine) {
      if (holder[at(b)] < 0) {
        refuse(fmt::format("no rank has body \"{}\"", model_.bodies[at(b)].name));
      }
      shipments.push_back({b, holder[at(b)], rank_of(b)});
    }
  }
  moved_bytes_ += ship_bodies(*world_.communicator, model_, shipments, state_);
  find_own_bodies();
  critical_ = smallest_critical_step();
  begin_load();
}

/// Takes a piece's bodies into the state; `run` becomes or must be what the piece says of the run.
void Simulation::read_piece(std::span<const std::byte> piece, Bytes& run, std::vector<Index>& held) {
  ByteReader in(piece);
  if (in.value<std::uint64_t>() != format_version) {
    refuse("it is of another format");
  }
  if (in.value<std::uint64_t>() != fingerprint_) {
    refuse("it is of another model");
  }
  const Bytes of_run = in.list<std::byte>();
  if (!run.empty() && !same_moment(of_run, run)) {
    refuse("its pieces are of different moments");
  }
  run = of_run;
  const auto count = in.value<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto notice = in.value<BodyNotice>();
    const Index body = read_sealed_body(model_, in, state_);
    notices_[at(body)] = notice;
    held.push_back(body);
  }
}

/// Tells all ranks who holds what, with notices and the run's own data. Returns the lowest rank that holds each body,
/// or -1.
std::vector<int> Simulation::learn_holders(const std::vector<Index>& held, Bytes& run) {
  ByteWriter out;
  out.list(run);
  out.list(held);
  for (const Index body : held) {
    out.value(notices_[at(body)]);
  }
  std::vector<int> holder(model_.bodies.size(), -1);
  const std::vector<Bytes> all = world_.communicator->all_gather(out.bytes());
  // All ranks go by what the lowest says of the run.
  run.clear();
  for (std::size_t r = 0; r < all.size(); ++r) {
    ByteReader in(all[r]);
    Bytes of_run = in.list<std::byte>();
    if (!of_run.empty() && !run.empty() && !same_moment(of_run, run)) {
      refuse("its pieces are of different moments");
    }
    if (run.empty()) {
      run = std::move(of_run);
    }
    for (const Index body : in.list<Index>()) {
      const auto notice = in.value<BodyNotice>();
      if (holder[at(body)] < 0) {
        holder[at(body)] = static_cast<int>(r);
        notices_[at(body)] = notice;
      }
    }
  }
  if (run.empty()) {
    refuse("no rank has a piece of it");
  }
  return holder;
}

/// Islands whose machine has left get another one; the rest stay.
void Simulation::place_the_homeless() {
  const bool lost = std::ranges::any_of(owner_, [&](MachineIndex m) {
    return m != no_machine && !world_.machines[static_cast<std::size_t>(m)].present();
  });
  if (!lost) {
    return;
  }
  const std::vector<double> weight = elements_of(model_);
  const Placement placement = place_islands({world_.rule, islands_, islands_, owner_, weight, world_.machines});
  ledger_.note(model_, state_.step, state_.time, placement, world_.machines, std::exchange(pending_reason_, ""));
  owner_ = placement.owner;
}

}  // namespace fexp::cluster
