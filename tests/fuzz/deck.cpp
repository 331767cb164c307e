// SPDX-License-Identifier: Apache-2.0
#include "io/deck.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "model/build.hpp"
#include "support/damage.hpp"
#include "support/decks.hpp"

namespace fexp::io {
namespace {

constexpr const char* nasty[] = {"0",
                                 "-1",
                                 "1e400",
                                 "1e200",
                                 "nan",
                                 "-inf",
                                 "9223372036854775807",
                                 "[",
                                 "]",
                                 "{",
                                 "}",
                                 "[[]]",
                                 "{}",
                                 "\"\"",
                                 "\"all\"",
                                 "true",
                                 "\"x",
                                 "'''",
                                 "1.5",
                                 "a.b.c",
                                 "[[body]]",
                                 "[run]",
                                 "2020-01-01T00:00:00",
                                 "\\u0000"};

void expect_told(const ErrorList& errors) {
  for (const InputError& error : errors.errors()) {
    EXPECT_FALSE(error.message.empty());
    EXPECT_FALSE(error.accepted.empty()) << error.text();
    EXPECT_FALSE(error.cure.empty()) << error.text();
    EXPECT_EQ(error.text().find('\n'), std::string::npos) << error.text();
  }
}

/// Whether a deck keeps what its fields promise; a few of every kind.
void expect_sound(const Deck& deck) {
  const model::Description& d = deck.description;
  EXPECT_TRUE(positive.contains(d.run.duration));
  EXPECT_TRUE(model::RunSettings::safety_range.contains(d.run.safety));
  for (const model::Section& section : d.sections) {
    EXPECT_TRUE(positive.contains(section.thickness));
  }
  for (const model::BodyDescription& body : d.bodies) {
    EXPECT_TRUE(positive.contains(body.scale));
    EXPECT_TRUE(std::isfinite(body.translate.x + body.translate.y + body.translate.z));
    EXPECT_GT(body.mesh_place.line, 0);
    if (const auto* generator = std::get_if<model::MeshGenerator>(&body.mesh)) {
      EXPECT_GT(model::triangle_count(*generator), 0.0);
    }
  }
}

TEST(damaged_decks, give_a_sound_deck_or_errors_with_their_places) {
  std::mt19937 random(20180624);
  int sound = 0, refused = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::string text = test::damaged(test::full_deck, random, nasty);
    ErrorList errors;
    const Deck deck = parse_deck(text, "fuzz", errors);
    expect_told(errors);
    for (const InputError& error : errors.errors()) {
      EXPECT_EQ(error.place.file, "fuzz");
      EXPECT_GT(error.place.line, 0) << error.text();
      EXPECT_GT(error.place.column, 0) << error.text();
    }
    if (errors.empty()) {
      expect_sound(deck);
    }
    ++(errors.empty() ? sound : refused);
    if (testing::Test::HasFailure()) {
      FAIL() << "deck " << i << ":\n" << text;
    }
  }
  EXPECT_GT(sound, 100) << "most damage went unread";
  EXPECT_GT(refused, 100) << "no damage was noticed";
}

TEST(damaged_decks, whose_parser_finds_nothing_wrong_build_a_model_or_errors) {
  std::mt19937 random(7);
  int models = 0, refused = 0;
  for (int i = 0; models + refused < 1000; ++i) {
    const std::string text = test::damaged(test::full_deck, random, nasty);
    ErrorList errors;
    const Deck deck = parse_deck(text, "fuzz", errors);
    double triangles = 0.0;
    for (const model::BodyDescription& body : deck.description.bodies) {
      const auto* generator = std::get_if<model::MeshGenerator>(&body.mesh);
      const auto count = body.array.value_or(model::Array{}).count;
      triangles += (generator != nullptr ? model::triangle_count(*generator) : 0.0) * count[0] * count[1] * count[2];
    }
    if (!errors.empty() || triangles > 1.0e5) {
      continue;
    }
    InputFiles files;
    const std::vector<model::Mesh> meshes = load_meshes(deck, "", files, errors);
    if (errors.empty()) {
      const model::Model model = model::build_model(deck.description, meshes, errors);
      if (errors.empty()) {
        check_output(deck.output, model, errors);
      }
    }
    expect_told(errors);
    ++(errors.empty() ? models : refused);
    if (testing::Test::HasFailure()) {
      FAIL() << "deck " << i << ":\n" << text;
    }
  }
  EXPECT_GT(models, 100);
  EXPECT_GT(refused, 100);
}

TEST(damaged_decks, random_bytes_are_refused) {
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    std::string bytes(random() % 600, '\0');
    for (char& c : bytes) {
      c = static_cast<char>(random() & 0xffU);
    }
    ErrorList errors;
    static_cast<void>(parse_deck(bytes, "fuzz", errors));
    EXPECT_FALSE(errors.empty());
    expect_told(errors);
  }
}

}  // namespace
}  // namespace fexp::io
