// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <stdexcept>
#include <vector>

#include "cluster/communicator.hpp"
#include "model/model.hpp"
#include "model/state.hpp"

namespace fexp::cluster {

/// A body whose state goes from one rank to another.
struct Shipment {
  Index body{};
  int from{};
  int to{};
};

/// Bytes that came are not those that were sent, or not those of the body. The world cannot go on.
class ShipmentError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Sends the canonical bytes of bodies, each with a checksum, and takes up those that are for this rank. All ranks give
/// the same list, sorted by body. Nothing but what moves is sent. `contact_force`: the nodes' contact forces go along,
/// shape [nodes]; null: they do not. Returns the bytes that this rank has sent.
std::int64_t ship_bodies(Communicator& communicator, const model::Model& model, std::span<const Shipment> shipments,
                         model::State& state, std::vector<Vec3d>* contact_force = nullptr);

/// One body's bytes with its number, length and checksum.
void append_sealed_body(const model::Model& model, const model::State& state, Index body, ByteWriter& out);
/// Takes such bytes into the state and returns the body; throws ShipmentError.
Index read_sealed_body(const model::Model& model, ByteReader& in, model::State& state);

}  // namespace fexp::cluster
