// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "io/deck.hpp"
#include "model/build.hpp"

namespace fexp::io {
namespace {

TEST(deck_reference, the_page_in_docs_is_up_to_date) {
  std::ifstream file(FEXP_SOURCE_DIR "/docs/deck.md", std::ios::binary);
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  EXPECT_TRUE(page == deck_reference()) << "docs/deck.md is not what the parser reads: renew it with\n"
                                           "  ./fexp reference > docs/deck.md";
}

TEST(deck_reference, its_example_builds_a_model) {
  const std::string page = deck_reference(), opening = "```toml\n";
  const std::size_t begin = page.find(opening);
  ASSERT_NE(begin, std::string::npos);
  const std::string text = page.substr(begin + opening.size(), page.find("```", begin + 1) - begin - opening.size());
  ErrorList errors;
  const Deck deck = parse_deck(text, "docs/deck.md", errors);
  InputFiles files;
  const std::vector<model::Mesh> meshes = load_meshes(deck, ".", files, errors);
  const model::Model model = model::build_model(deck.description, meshes, errors);
  check_output(deck.output, model, errors);
  for (const InputError& error : errors.errors()) {
    ADD_FAILURE() << error.text();
  }
  EXPECT_EQ(model.body_count(), 2);
}

TEST(deck_reference, names_every_field_of_inner_tables_laws_and_meshes) {
  const std::string page = deck_reference();
  for (const char* key : {"title", "duration", "points", "thickness", "poisson", "angle_degrees", "pitch", "low",
                          "weld_tolerance", "cells_around", "exclude", "deflate", "part"}) {
    EXPECT_NE(page.find("\n| `" + std::string(key) + "` |"), std::string::npos) << key;
  }
}

TEST(deck_reference, gives_defaults_of_the_program_and_none_for_what_is_left_to_it) {
  const std::string page = deck_reference();
  EXPECT_NE(page.find("| `safety` | a number | - | `0.9` | > 0 and <= 1 |"), std::string::npos);
  EXPECT_NE(page.find("| `results_interval` | a number | time |  | > 0 |"), std::string::npos);
  EXPECT_NE(page.find("| `duration` | a number | time | **required** | > 0 |"), std::string::npos);
}

}  // namespace
}  // namespace fexp::io
