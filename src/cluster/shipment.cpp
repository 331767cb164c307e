// SPDX-License-Identifier: Apache-2.0
#include "cluster/shipment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "base/hash.hpp"

namespace fexp::cluster {

namespace {

std::span<Vec3d> of_body(const model::Model& model, Index body, std::vector<Vec3d>& nodes) {
  const IndexRange range = model.bodies[at(body)].nodes;
  return std::span(nodes).subspan(at(range.begin), at(range.size()));
}

}  // namespace

void append_sealed_body(const model::Model& model, const model::State& state, Index body, ByteWriter& out) {
  Bytes bytes;
  model::append_body_bytes(model, state, body, bytes);
  out.value(body);
  out.value(hash_bytes(bytes));
  out.list(bytes);
}

Index read_sealed_body(const model::Model& model, ByteReader& in, model::State& state) {
  const auto body = in.value<Index>();
  const auto hash = in.value<std::uint64_t>();
  const auto bytes = in.raw(static_cast<std::size_t>(in.value<std::uint64_t>()));
  if (!in.sound() || body < 0 || body >= model.body_count() || hash_bytes(bytes) != hash ||
      !model::read_body_bytes(model, bytes, body, state)) {
    throw ShipmentError(fmt::format("the bytes of body {} were damaged on their way", body));
  }
  return body;
}

std::int64_t ship_bodies(Communicator& communicator, const model::Model& model, std::span<const Shipment> shipments,
                         model::State& state, std::vector<Vec3d>* contact_force) {
  std::map<int, ByteWriter> writers;
  std::set<int> sources;
  for (const Shipment& s : shipments) {
    if (s.from == communicator.rank() && s.to != s.from) {
      ByteWriter& writer = writers[s.to];
      append_sealed_body(model, state, s.body, writer);
      if (contact_force != nullptr) {
        writer.list(std::span<const Vec3d>(of_body(model, s.body, *contact_force)));
      }
    } else if (s.to == communicator.rank() && s.to != s.from) {
      sources.insert(s.from);
    }
  }
  std::vector<Parcel> parcels;
  std::int64_t sent = 0;
  for (auto& [rank, writer] : writers) {
    sent += static_cast<std::int64_t>(writer.bytes().size());
    parcels.push_back({rank, writer.take()});
  }
  const std::vector<int> from(sources.begin(), sources.end());
  for (const Parcel& parcel : communicator.exchange(parcels, from)) {
    for (ByteReader reader(parcel.bytes); !reader.at_end();) {
      const Index body = read_sealed_body(model, reader, state);
      if (contact_force != nullptr) {
        const std::vector<Vec3d> forces = reader.list<Vec3d>();
        const std::span<Vec3d> target = of_body(model, body, *contact_force);
        if (forces.size() != target.size()) {
          throw ShipmentError(fmt::format("the contact forces of body {} were damaged on their way", body));
        }
        std::copy(forces.begin(), forces.end(), target.begin());
      }
    }
  }
  return sent;
}

}  // namespace fexp::cluster
