// SPDX-License-Identifier: Apache-2.0
#include "cluster/body_notice.hpp"

#include <cmath>

namespace fexp::cluster {

BodyNotice notice_of(const model::Model& model, const model::State& before, const model::State& state, Index body) {
  BodyNotice notice;
  notice.extent = extent_of(model, state, body);
  notice.critical = solve::body_critical_step(model, state, body);
  notice.diagnostics = solve::body_diagnostics(model, state, body);
  if (model.run.is_static()) {
    notice.relaxation = relaxation_sums(model, before, state, body);
  }
  notice.contact_work = state.ledger[at(body)].contact_work;
  notice.tie_work = state.tie_work.empty() ? 0.0 : state.tie_work[at(body)];
  const IndexRange ties = model.bodies[at(body)].ties;
  for (Index t = ties.begin; t < ties.end; ++t) {
    notice.ties += state.ties[at(t)].broken == 0 ? 1 : 0;
  }
  notice.wall_dissipation = state.ledger[at(body)].wall_dissipation;
  for (const model::PairBook& book : state.pair_books[at(body)]) {
    notice.pairs_off += std::abs(book.open());
    if (notice.worst_pair.other == no_index || std::abs(book.open()) > std::abs(notice.worst_pair.open())) {
      notice.worst_pair = book;
    }
  }
  return notice;
}

}  // namespace fexp::cluster
