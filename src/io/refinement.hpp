// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tuple>
#include <vector>

#include "base/errors.hpp"
#include "base/field.hpp"
#include "model/description.hpp"

namespace fexp::io {

/// Other meshes than those that a deck's bodies describe, all by the same factor.
struct Refinement {
  double factor{1.0};
  Place place;

  static constexpr auto fields = std::tuple{
      Field{"factor", "-",
            "Factor on every number of cells of the generated meshes, each of which must come out whole; meshes from "
            "files cannot be refined.",
            &Refinement::factor, positive},
  };
};

/// Multiplies the cells of the bodies' meshes. Meshes from files, and cells that come out not whole or out of their
/// range, are errors.
void refine_meshes(const Refinement& refinement, std::vector<model::BodyDescription>& bodies, ErrorList& errors);

}  // namespace fexp::io
