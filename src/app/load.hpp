// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/deck.hpp"
#include "io/input_files.hpp"
#include "io/summary.hpp"
#include "model/mesh.hpp"
#include "model/model.hpp"

namespace fexp::app {

/// A deck with all that comes of it before the first step.
struct Case {
  std::string deck_bytes;  ///< As read
  io::Deck deck;           ///< Output intervals filled in
  model::Model model;
  io::Summary::InitialPenetrations penetrations;  ///< As they were found, and what became of them
};

/// Reads a deck and its meshes and builds the model. Writes nothing. Throws InputErrors with everything that is wrong.
/// Afterwards `files` knows all that was read, the deck first.
[[nodiscard]] Case load_case(const std::filesystem::path& deck, io::InputFiles& files);
/// Likewise, from the disk.
[[nodiscard]] Case load_case(const std::filesystem::path& deck);
/// Likewise, with the meshes that the model was built from.
[[nodiscard]] Case load_case(const std::filesystem::path& deck, std::vector<model::Mesh>& meshes);
[[nodiscard]] Case load_case(const std::filesystem::path& deck, io::InputFiles& files,
                             std::vector<model::Mesh>& meshes);

}  // namespace fexp::app
