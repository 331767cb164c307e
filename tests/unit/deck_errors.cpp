// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/deck.hpp"
#include "model/build.hpp"
#include "support/decks.hpp"

namespace fexp::io {
namespace {

std::vector<std::string> errors_of(std::string_view text) {
  ErrorList errors;
  static_cast<void>(parse_deck(text, "d", errors));
  std::vector<std::string> texts;
  for (const InputError& error : errors.errors()) {
    EXPECT_EQ(error.place.file, "d");
    EXPECT_GT(error.place.line, 0) << error.text();
    EXPECT_GT(error.place.column, 0) << error.text();
    EXPECT_FALSE(error.accepted.empty()) << error.text();
    EXPECT_FALSE(error.cure.empty()) << error.text();
    texts.push_back(error.text());
  }
  return texts;
}

/// The full deck with one text replaced. What replaces it must not change the number of lines before the place.
std::string changed(const std::string& from, const std::string& to) {
  std::string text = test::full_deck;
  const std::size_t position = text.find(from);
  if (position == std::string::npos) {
    ADD_FAILURE() << "the deck lacks " << from;
    return text;
  }
  return text.replace(position, from.size(), to);
}

struct Wrong {
  const char* name;
  const char* from;
  const char* to;
  const char* begin;  ///< Of the error: place, what is wrong, in most cases what is accepted.
  const char* end;    ///< The cure.
};

class WrongDeck : public testing::TestWithParam<Wrong> {};

TEST_P(WrongDeck, gives_one_error_with_place_value_accepted_and_cure) {
  const std::vector<std::string> errors = errors_of(changed(GetParam().from, GetParam().to));
  ASSERT_EQ(errors.size(), 1U) << (errors.empty() ? "none" : errors[1]);
  EXPECT_EQ(errors[0].find(GetParam().begin), std::string("d:").size()) << errors[0] << "\n" << GetParam().begin;
  EXPECT_TRUE(errors[0].ends_with(GetParam().end)) << errors[0] << "\n" << GetParam().end;
}

const Wrong wrong_decks[] = {
    {"unknown_section", "[contact]", "[contcat]", "126:2: error: unknown section or key \"contcat\"",
     "cure: did you mean \"contact\"?"},
    {"unknown_key", "safety =", "sfaety =", "11:1: error: unknown key \"sfaety\" in run",
     "cure: did you mean \"safety\"?"},
    {"unknown_key_without_likeness", "safety =", "zzzzzz =", "11:1: error: unknown key \"zzzzzz\" in run",
     "cure: use one of these, or remove it"},
    {"unknown_key_of_a_mesh", "cells = 3", "cell = 3",
     "36:47: error: unknown key \"cell\" in body.mesh; accepted: radius, cells, kind", "cure: did you mean \"cells\"?"},
    {"text_for_number", "safety = 0.8", "safety = \"0.8\"",
     "11:10: error: run.safety is the text \"0.8\"; accepted: a number (> 0 and <= 1)",
     "cure: write it without quotes"},
    {"real_for_whole", "cells = 3", "cells = 3.0",
     "36:55: error: body.mesh.cells is the number 3.0; accepted: a whole number (1 to 10000)",
     "cure: write it without a decimal point"},
    {"number_for_truth", "self = false", "self = 0",
     "128:8: error: contact.self is the whole number 0; accepted: true or false", "cure: write true or false"},
    {"number_for_text", "name = \"steel\"", "name = 5",
     "23:8: error: material.name is the whole number 5; accepted: a text", "cure: write it in quotes"},
    {"date_for_number", "duration = 2", "duration = 2020-01-01",
     "10:12: error: run.duration is a date or time; accepted: a number (> 0)", "cure: write a number (> 0)"},
    {"number_too_large", "safety = 0.8", "safety = 1.5",
     "11:10: error: run.safety is 1.5; accepted: a number (> 0 and <= 1)", "cure: correct the number"},
    {"number_not_positive", "thickness = 0.5", "thickness = -0.5",
     "32:13: error: section.thickness is -0.5; accepted: a number (> 0)", "cure: correct the number"},
    {"poisson_of_one_half", "poisson = 0.3", "poisson = 0.5",
     "27:11: error: material.poisson is 0.5; accepted: a number (> -1 and < 0.5)", "cure: correct the number"},
    {"not_a_number", "young = 210", "young = nan",
     "26:9: error: material.young is nan; accepted: a finite number (> 0)", "cure: correct the number"},
    {"infinity", "velocity = 3", "velocity = inf",
     "79:12: error: prescribed.velocity is inf; accepted: a finite number", "cure: correct the number"},
    {"beyond_all_bounds", "velocity = 3", "velocity = 1e200",
     "79:12: error: prescribed.velocity is 1e+200; accepted: 0, or a number from 1e-100 to 1e+100 in size",
     "cure: correct the number, or choose other units"},
    {"too_small_to_be_squared", "thickness = 0.5", "thickness = 1e-200",
     "32:13: error: section.thickness is 1e-200; accepted: a number from 1e-100 to 1e+100 in size",
     "cure: correct the number, or choose other units"},
    {"count_beyond_range", "count = [2, 1, 3]", "count = [2, 100000000, 3]",
     "56:13: error: body.array.count[2] is 100000000", "cure: correct the number"},
    {"count_beyond_integers", "cells = 3", "cells = 9000000000000000000",
     "36:55: error: body.mesh.cells is 9000000000000000000; accepted: a whole number (1 to 10000)",
     "cure: correct the number"},
    {"vector_of_two", "translate = [1.0, 2, 3.5]", "translate = [1.0, 2]",
     "40:13: error: body.translate is a list of 2 values; accepted: three numbers [x, y, z]",
     "cure: write three numbers [x, y, z]"},
    {"vector_with_text", "translate = [1.0, 2, 3.5]", "translate = [1.0, \"2\", 3.5]",
     "40:19: error: body.translate.y is the text \"2\"; accepted: a number", "cure: write it without quotes"},
    {"pair_of_three", "[1.5, 2]", "[1.5, 2, 3]",
     "20:21: error: curve.points[2] is a list of 3 values; accepted: 2 numbers", "cure: write 2 numbers"},
    {"list_of_numbers_for_texts", "bodies = [\"plate\"]", "bodies = [1]",
     "61:11: error: node_set.bodies[1] is the whole number 1; accepted: a text", "cure: write it in quotes"},
    {"text_for_list", "bodies = [\"plate\"]", "bodies = \"plate\"",
     "61:10: error: node_set.bodies is the text \"plate\"; accepted: a list of texts", "cure: write a list of texts"},
    {"unknown_degree_of_freedom", "dofs = [\"x\", \"rz\"]", "dofs = [\"x\", \"w\"]",
     "74:14: error: fixed.dofs[2] is the text \"w\"; accepted: one of x, y, z, rx, ry, rz", "cure: use one of these"},
    {"unknown_diagonals", "\"crossed\"", "\"cross\"",
     "54:13: error: body.mesh.diagonals is the text \"cross\"; accepted: one of one, alternating, crossed",
     "cure: did you mean \"crossed\"?"},
    {"unknown_mesh", "kind = \"cubed_sphere\"", "kind = \"cube_sphere\"",
     "36:17: error: body.mesh.kind is the text \"cube_sphere\"",
     "cure: did you mean \"cubed_sphere\" or \"uv_sphere\"?"},
    {"mesh_without_kind", "kind = \"cubed_sphere\", ", "", "36:8: error: body.mesh lacks \"kind\"",
     "cure: add kind = ... (the parameters follow from it)"},
    {"mesh_by_name", "mesh = { kind = \"cubed_sphere\", radius = 0.5, cells = 3 }", "mesh = \"sphere.msh\"",
     "36:8: error: body.mesh is the text \"sphere.msh\"; accepted: a table",
     "cure: write a table, { key = value, ... }, or give it a header of its own"},
    {"unknown_law", "law = \"linear_elastic\"", "law = \"elastic\"",
     "24:7: error: material.law is the text \"elastic\"; accepted: one of linear_elastic", "cure: use one of these"},
    {"missing_key", "thickness = 0.5", "", "29:1: error: section lacks \"thickness\"; accepted: a number (> 0)",
     "cure: add thickness = ... (Shell thickness)"},
    {"missing_key_of_a_law", "young = 210", "", "22:1: error: material lacks \"young\"; accepted: a number (> 0)",
     "cure: add young = ... (Young's modulus)"},
    {"missing_key_of_a_mesh", "radius = 0.5, ", "", "36:8: error: body.mesh lacks \"radius\"; accepted: a number (> 0)",
     "cure: add radius = ... (Radius of the mid-surface)"},
    {"single_brackets", "[[plane]]", "[plane]", "103:1: error: plane is a table; accepted: a list of tables",
     "cure: write the header of each with double brackets, [[plane]]"},
    {"double_brackets", "[run]", "[[run]]", "9:1: error: run is a list of 1 value; accepted: a table",
     "cure: give it once, with single brackets, [run]"},
    {"section_twice", "[contact]", "[run]",
     "126:1: error: this is no TOML: Error while parsing table header: cannot redefine existing table 'run'; accepted: "
     "TOML 1.0 (toml.io)",
     "cure: give each key and each [table] once; things of which there can be several are [[tables]]"},
    {"key_twice", "safety = 0.8", "duration = 3",
     "11:12: error: this is no TOML: Error while parsing key-value pair: cannot redefine existing integer 'duration'; "
     "accepted: TOML 1.0 (toml.io)",
     "cure: give each key and each [table] once; things of which there can be several are [[tables]]"},
    {"text_without_end", "name = \"steel\"", "name = \"steel", "23:14: error: this is no TOML: ",
     "cure: end the text with a quote in the same line, and write \\\\ for a backslash in double quotes"},
    {"no_toml", "safety = 0.8", "safety: 0.8",
     "11:7: error: this is no TOML: Error while parsing key-value pair: expected '=', saw ':'; accepted: TOML 1.0 "
     "(toml.io)",
     "cure: correct the deck at this place"},
    {"number_that_overflows", "safety = 0.8", "safety = 1e400",
     "11:15: error: this is no TOML: Error while parsing floating-point: '1e400' could not be interpreted as a value; "
     "accepted: TOML 1.0 (toml.io)",
     "cure: write a number that is 0 or from 1e-100 to 1e100 in size"},
    {"line_break_in_a_name", "name = \"floor\"", "name = \"fl\\noor\"",
     "104:8: error: plane.name holds a line break or a control character; accepted: printable text in one line",
     "cure: remove the character"},
};

INSTANTIATE_TEST_SUITE_P(deck_errors, WrongDeck, testing::ValuesIn(wrong_decks),
                         [](const auto& wrong) { return std::string(wrong.param.name); });

TEST(deck_errors, an_empty_deck_lacks_its_run_and_a_body) {
  const std::vector<std::string> errors = errors_of("");
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_NE(errors[0].find("d:1:1: error: the deck has no [run]"), std::string::npos) << errors[0];
  EXPECT_NE(errors[1].find("d:1:1: error: the deck has no [[body]]"), std::string::npos) << errors[1];
}

TEST(deck_errors, binary_files_and_other_encodings_are_no_toml) {
  const std::string utf_16("\xff\xfe[\0r\0u\0n\0]\0", 12);
  for (const std::string& text : {std::string("\x7f"
                                              "ELF\x01\x02\x00",
                                              7),
                                  utf_16, std::string(100, '\0')}) {
    const std::vector<std::string> errors = errors_of(text);
    ASSERT_EQ(errors.size(), 1U);
    EXPECT_NE(errors[0].find("no TOML"), std::string::npos) << errors[0];
  }
  EXPECT_NE(errors_of(utf_16).at(0).find("save the deck as UTF-8"), std::string::npos);
}

TEST(deck_errors, all_independent_errors_come_at_once_in_the_order_of_the_deck) {
  std::string text = changed("safety = 0.8", "sfaety = 0.8");
  const auto change = [&text](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  change("poisson = 0.3", "poisson = 0.6");
  change("cells = 3", "cells = \"3\"");
  change("angle_degrees = 30", "angle = 30");
  change("dofs = [\"x\", \"rz\"]", "dofs = [\"u\", \"v\"]");
  change("[output]", "[output]\nnods = 1");
  const std::vector<std::string> errors = errors_of(text);
  const std::vector<std::string> expected = {
      "d:11:1: error: unknown key \"sfaety\"", "d:27:11: error: material.poisson is 0.6",
      "d:36:55: error: body.mesh.cells is",    "d:39:53: error: body.rotate[2] lacks \"angle_degrees\"",
      "d:39:73: error: unknown key \"angle\"", "d:74:9: error: fixed.dofs[1]",
      "d:74:14: error: fixed.dofs[2]",         "d:134:1: error: unknown key \"nods\""};
  ASSERT_EQ(errors.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(errors[i].find(expected[i]), 0U) << errors[i];
  }
}

TEST(deck_errors, names_that_are_not_there_come_with_the_errors_of_other_tables) {
  std::string text = changed("material = \"steel\"", "material = \"steal\"");
  EXPECT_TRUE(errors_of(text).empty()) << "references alone are left to the model's building";
  const auto change = [&text](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  change("safety = 0.8", "safety = 8");
  change("acceleration = [0, 0, -9.81e-3]\ncurve = \"ramp\"", "acceleration = [0, 0, -9.81e-3]\ncurve = \"rmap\"");
  const std::vector<std::string> errors = errors_of(text);
  ASSERT_EQ(errors.size(), 3U);
  EXPECT_NE(errors[0].find("run.safety"), std::string::npos);
  EXPECT_NE(errors[1].find("names material \"steal\""), std::string::npos);
  EXPECT_NE(errors[2].find("there is no curve \"rmap\""), std::string::npos);
}

TEST(deck_errors, one_mistake_gives_no_second_error_where_others_refer_to_it) {
  EXPECT_EQ(errors_of(changed("[[material]]", "[[materail]]")).size(), 1U);
  EXPECT_EQ(errors_of(changed("name = \"ramp\"", "nmae = \"ramp\"")).size(), 2U) << "the key and its lack";
  EXPECT_EQ(errors_of(changed("normal = [1, 0, 0]", "normal = 1")).size(), 1U);
  EXPECT_EQ(errors_of(changed("[0, 0.0]", "[0, \"0\"]")).size(), 1U);
}

TEST(deck_errors, no_more_than_a_hundred_errors_are_shown) {
  std::string text = "[run]\nduration = 1\n";
  for (int i = 0; i < 3000; ++i) {
    text += "key_" + std::to_string(i) + " = 1\n";
  }
  ErrorList errors;
  static_cast<void>(parse_deck(text, "d", errors));
  ASSERT_EQ(errors.size(), 101U);
  EXPECT_EQ(errors.errors().back().text(),
            "d: error: there may be more errors; accepted: 100 are shown; cure: correct these first");
}

TEST(deck_errors, keys_of_a_million_parts_are_refused_and_not_followed) {
  std::string key = "a";
  for (int i = 0; i < 1000000; ++i) {
    key += ".a";
  }
  for (const std::string& text : {key + " = 1", "[" + key + "]", "x = {" + key + " = 1}"}) {
    const std::vector<std::string> errors = errors_of(text);
    ASSERT_EQ(errors.size(), 1U);
    EXPECT_NE(errors[0].find("nested too deep"), std::string::npos) << errors[0];
  }
}

TEST(deck_errors, output_of_sets_and_bodies_that_are_not_there_is_told_at_its_section) {
  ErrorList errors;
  Deck deck = parse_deck(
      "[run]\nduration = 1\n[[material]]\nname = \"m\"\ndensity = 1\nyoung = 1\npoisson = 0\n"
      "[[section]]\nname = \"s\"\nmaterial = \"m\"\nthickness = 0.1\n[[body]]\nname = \"ball\"\n"
      "section = \"s\"\nmesh = {kind = \"cubed_sphere\", radius = 1}\n"
      "array = {count = [2, 1, 1], pitch = [3, 0, 0]}\n[output]\n"
      "nodes = [\"all\", \"rim\"]\nelements = [\"hub\", \"all\"]\nbodies = [\"ball\", \"ball[1,0,0]\", "
      "\"ball[2,0,0]\"]\n",
      "d", errors);
  InputFiles files;
  const std::vector<model::Mesh> meshes = load_meshes(deck, "", files, errors);
  const model::Model model = model::build_model(deck.description, meshes, errors);
  ASSERT_TRUE(errors.empty()) << errors.errors()[0].text();
  check_output(deck.output, model, errors);
  ASSERT_EQ(errors.size(), 3U);
  EXPECT_EQ(errors.errors()[0].text(),
            "d:17:1: error: output.nodes names node set \"rim\", which is not there; accepted: all; cure: define it or "
            "correct the name");
  EXPECT_EQ(errors.errors()[1].text(),
            "d:17:1: error: output.elements names node set \"hub\", which is not there; accepted: all; cure: define it "
            "or correct the name");
  EXPECT_NE(errors.errors()[2].text().find("d:17:1: error: output.bodies names body \"ball[2,0,0]\""),
            std::string::npos);
}

}  // namespace
}  // namespace fexp::io
