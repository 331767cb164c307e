// SPDX-License-Identifier: Apache-2.0
#include "cluster/body_notice.hpp"

namespace fexp::cluster {

BodyNotice notice_of(const model::Model& model, const model::State& before, const model::State& state, Index body) {
  return {extent_of(model, state, body), solve::body_critical_step(model, state, body),
          solve::body_diagnostics(model, state, body),
          model.run.is_static() ? relaxation_sums(model, before, state, body) : RelaxationSums{}};
}

}  // namespace fexp::cluster
