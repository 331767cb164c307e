// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "base/errors.hpp"
#include "base/field.hpp"
#include "io/expectation.hpp"
#include "io/history.hpp"
#include "io/input_files.hpp"
#include "io/refinement.hpp"
#include "model/description.hpp"
#include "model/mesh.hpp"
#include "model/model.hpp"

/// The deck: a TOML file that describes a run.
namespace fexp::io {

/// What to write and how often. Intervals are in time; whatever happens in between, frames and rows stand at their
/// multiples exactly, and at the start and the end.
struct OutputSettings {
  double results_interval{
      -1.0};  ///< Between frames of the results file [time]; negative: duration / 50, or ten steps if longer
  double history_interval{
      -1.0};  ///< Between rows of the histories [time]; negative: duration / 500, or ten steps if longer
  std::vector<std::string> nodes;     ///< Node sets whose nodes' motions are written
  std::vector<std::string> elements;  ///< Node sets; elements with all nodes in one are written
  std::vector<std::string> bodies;    ///< Bodies whose energies and motions are written
  int deflate{0};                     ///< Compression of the results file, 0 to 9
  Place place;

  static constexpr Range deflate_range{0.0, 9.0, true, true, "0 to 9"};
  static constexpr auto fields = std::tuple{
      Field{"results_interval", "time",
            "Time between frames of the results file; when left out duration / 50, or about ten steps if longer.",
            &OutputSettings::results_interval, positive},
      Field{"history_interval", "time",
            "Time between rows of the histories; when left out duration / 500, or about ten steps if longer.",
            &OutputSettings::history_interval, positive},
      Field{"nodes", "-", "Node sets whose nodes' motions are written as histories.", &OutputSettings::nodes},
      Field{"elements", "-",
            "Node sets; of the elements that have all their nodes in one, forces, moments and stresses are written as "
            "histories.",
            &OutputSettings::elements},
      Field{"bodies", "-", "Bodies whose energies, momenta and centres are written as histories.",
            &OutputSettings::bodies},
      Field{"deflate", "-", "Compression of the results file: 0 (none) to 9.", &OutputSettings::deflate, deflate_range},
  };
};

struct Deck {
  std::string title;
  UnitNames units;
  model::Description description;
  Refinement refinement;
  OutputSettings output;
  VerifySettings verify;
  std::vector<Expectation> expectations;
};

/// Reads a deck from text; its meshes are refined already. `file` is the name used in errors. Everything wrong is added
/// to `errors`; the deck is usable only when nothing was. Mesh files are not read here. References from one table to
/// another are left to model::build_model, unless something else is wrong and no model will be built.
[[nodiscard]] Deck parse_deck(std::string_view text, const std::string& file, ErrorList& errors);

/// Generates or reads the mesh of every body, in order; a path is relative to `directory`, that of the deck. A body
/// whose mesh cannot be had gets an empty one and an error. Models that cannot fit into the machine's memory are
/// refused before memory is asked for.
[[nodiscard]] std::vector<model::Mesh> load_meshes(const Deck& deck, const std::filesystem::path& directory,
                                                   InputFiles& files, ErrorList& errors);

/// Reports node sets and bodies that [output] names and the model, built from the deck, does not have.
void check_output(const OutputSettings& output, const model::Model& model, ErrorList& errors);

/// The reference of the deck in Markdown, generated from the same fields that the parser reads.
[[nodiscard]] std::string deck_reference();

}  // namespace fexp::io
