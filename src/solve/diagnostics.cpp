// SPDX-License-Identifier: Apache-2.0
#include "solve/diagnostics.hpp"

#include <algorithm>
#include <vector>

#include "parallel/parallel.hpp"
#include "physics/critical_step.hpp"

namespace fexp::solve {

namespace {

constexpr Index piece = 1024;
constexpr Index body_grain = 4;

Diagnostics node_sums(const model::Model& model, const model::State& state, Index begin, Index end) {
  Diagnostics sum;
  for (Index n = begin; n < end; ++n) {
    const model::NodeMotion& motion = state.motion[at(n)];
    const double mass = model.mass[at(n)], inertia = model.inertia[at(n)];
    sum.energies.kinetic += 0.5 * (mass * dot(motion.velocity, motion.velocity) +
                                   inertia * dot(motion.rotation_rate, motion.rotation_rate));
    const Vec3d linear = mass * motion.velocity;
    const Vec3d orbital = cross(motion.position, linear);
    const Vec3d spin = inertia * motion.rotation_rate;
    sum.momenta.linear += linear;
    sum.momenta.angular += orbital + spin;
    sum.momenta.linear_scale += norm(linear);
    sum.momenta.angular_scale += norm(orbital) + norm(spin);
  }
  return sum;
}

double internal_energy(const model::Model& model, const model::State& state, Index begin, Index end) {
  double sum = 0.0;
  for (Index e = begin; e < end; ++e) {
    sum += element_value(model, state, e, model::row_energy);
  }
  return sum;
}

/// Sums `part(begin, end)` over pieces of a range: in parallel over pieces, added in ascending order.
template <class Sum, class Part>
Sum ordered_sum(IndexRange range, const Part& part) {
  const Index pieces = (range.size() + piece - 1) / piece;
  std::vector<Sum> sums(at(pieces));
  parallel::for_each(pieces, 4, [&](Index i) {
    const Index begin = range.begin + i * piece;
    sums[at(i)] = part(begin, std::min(begin + piece, range.end));
  });
  Sum total{};
  for (const Sum& sum : sums) {
    total += sum;
  }
  return total;
}

struct DiagnosticsSum : Diagnostics {
  DiagnosticsSum& operator+=(const DiagnosticsSum& other) noexcept {
    energies += other.energies;
    momenta += other.momenta;
    return *this;
  }
};

CriticalStep smaller(const CriticalStep& a, const CriticalStep& b) noexcept { return b.step < a.step ? b : a; }

}  // namespace

Energies& Energies::operator+=(const Energies& other) noexcept {
  kinetic += other.kinetic;
  internal += other.internal;
  contact += other.contact;
  barrier += other.barrier;
  external += other.external;
  damping += other.damping;
  return *this;
}

Momenta& Momenta::operator+=(const Momenta& other) noexcept {
  linear += other.linear;
  angular += other.angular;
  linear_scale += other.linear_scale;
  angular_scale += other.angular_scale;
  external_impulse += other.external_impulse;
  external_angular_impulse += other.external_angular_impulse;
  return *this;
}

Diagnostics body_diagnostics(const model::Model& model, const model::State& state, Index index) {
  const model::Body& body = model.bodies[at(index)];
  const model::BodyLedger& ledger = state.ledger[at(index)];
  Diagnostics sum = ordered_sum<DiagnosticsSum>(body.nodes, [&](Index begin, Index end) {
    return DiagnosticsSum{node_sums(model, state, begin, end)};
  });
  sum.energies.internal = ordered_sum<double>(
      body.elements, [&](Index begin, Index end) { return internal_energy(model, state, begin, end); });
  sum.energies.contact = ledger.contact_energy;
  sum.energies.barrier = ledger.barrier_energy;
  sum.energies.external = ledger.external_work;
  sum.energies.damping = ledger.damping_work;
  sum.momenta.external_impulse = ledger.external_impulse;
  sum.momenta.external_angular_impulse = ledger.external_angular_impulse;
  return sum;
}

Diagnostics diagnostics(const model::Model& model, const model::State& state) {
  std::vector<Diagnostics> bodies(model.bodies.size());
  parallel::for_each(model.body_count(), body_grain,
                     [&](Index body) { bodies[at(body)] = body_diagnostics(model, state, body); });
  Diagnostics total;
  for (const Diagnostics& body : bodies) {
    total.energies += body.energies;
    total.momenta += body.momenta;
  }
  return total;
}

CriticalStep critical_step(const model::Model& model, const model::State& state) {
  const Index pieces = (model.element_count() + piece - 1) / piece;
  std::vector<CriticalStep> smallest(at(pieces));
  parallel::for_each(pieces, 1, [&](Index i) {
    CriticalStep found;
    const Index end = std::min((i + 1) * piece, model.element_count());
    for (Index e = i * piece; e < end; ++e) {
      const auto& nodes = model.triangle[at(e)];
      const Vec3d& origin = state.motion[at(nodes[0])].position;
      const model::SectionData& section = model.section_of(e);
      const auto frame = physics::triangle_frame(state.motion[at(nodes[1])].position - origin,
                                                 state.motion[at(nodes[2])].position - origin);
      const double step = physics::element_critical_step({section.thickness, section.moduli, model.run.drilling},
                                                         section.density, frame);
      found = smaller(found, {step > 0.0 ? step : 0.0, e});
    }
    smallest[at(i)] = found;
  });
  CriticalStep found;
  for (const CriticalStep& candidate : smallest) {
    found = smaller(found, candidate);
  }
  return found;
}

}  // namespace fexp::solve
