// SPDX-License-Identifier: Apache-2.0
#include "io/input_files.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "app/load.hpp"
#include "base/byte_stream.hpp"
#include "io/output_error.hpp"
#include "io/section_file.hpp"
#include "model/mesh_generators.hpp"
#include "model/state.hpp"
#include "support/mesh_files.hpp"
#include "support/sections.hpp"
#include "support/temporary_directory.hpp"

namespace fexp::io {
namespace {

using test::TemporaryDirectory;

/// A deck of two bodies with the same mesh file in a folder beside it, welded differently, and one generated.
const std::string deck_text = R"(
[run]
duration = 1
[[material]]
name = "m"
density = 1.0
young = 1.0
poisson = 0.3
[[section]]
name = "s"
material = "m"
thickness = 0.1
[[body]]
name = "first"
section = "s"
mesh = {kind = "file", path = "meshes/../meshes/plate.stl"}
[[body]]
name = "second"
section = "s"
translate = [0, 0, 3]
mesh = {kind = "file", path = "meshes/plate.stl", weld_tolerance = 0.01}
[[body]]
name = "third"
section = "s"
translate = [0, 0, 6]
mesh = {kind = "cubed_sphere", radius = 1, cells = 2}
)";

std::filesystem::path write_case(const TemporaryDirectory& directory) {
  std::filesystem::create_directory(directory / "meshes");
  directory.write("meshes/plate.stl", test::stl_ascii(model::generate_mesh(model::Plate{1.0, 1.0, 3, 2, "one"})));
  return directory.write("deck.toml", deck_text);
}

TEST(input_files, build_the_same_model_where_there_are_no_files) {
  const TemporaryDirectory directory;
  InputFiles here;
  const app::Case original = app::load_case(write_case(directory), here);
  const std::vector<std::byte> packed = here.pack();
  std::filesystem::remove_all(directory.path());

  InputFiles there = InputFiles::unpack(packed, "packed");
  EXPECT_EQ(there.deck(), directory / "deck.toml");
  const app::Case copy = app::load_case(there.deck(), there);
  EXPECT_EQ(copy.deck_bytes, deck_text);
  EXPECT_EQ(copy.model.triangle, original.model.triangle);
  EXPECT_EQ(copy.model.reference_position, original.model.reference_position);
  EXPECT_EQ(copy.model.mass, original.model.mass);
  EXPECT_EQ(model::state_hash(copy.model, model::initial_state(copy.model)),
            model::state_hash(original.model, model::initial_state(original.model)));
  EXPECT_EQ(there.pack(), packed) << "whoever got the files cannot pass them on";
}

TEST(input_files, relative_names_are_found_from_another_current_directory) {
  const TemporaryDirectory directory;
  write_case(directory);
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(directory.path());
  InputFiles here;
  const Index nodes = app::load_case("deck.toml", here).model.node_count();
  const std::vector<std::byte> packed = here.pack();
  std::filesystem::current_path(before);
  InputFiles there = InputFiles::unpack(packed, "packed");
  EXPECT_EQ(there.deck(), "deck.toml");
  EXPECT_EQ(app::load_case(there.deck(), there).model.node_count(), nodes);
}

TEST(input_files, the_same_errors_have_the_same_places_from_packed_bytes) {
  const TemporaryDirectory directory;
  const std::filesystem::path deck = write_case(directory);
  directory.write("meshes/plate.stl", "solid s\nfacet normal 0 0 0\nouter loop\nvertex 0 0 zero\n");
  InputFiles here;
  const auto errors_of = [&](InputFiles& files) -> std::string {
    try {
      static_cast<void>(app::load_case(deck, files));
    } catch (const InputErrors& errors) {
      return errors.what();
    }
    return "";
  };
  const std::string errors = errors_of(here);
  EXPECT_NE(errors.find("plate.stl:4:"), std::string::npos) << errors;
  InputFiles there = InputFiles::unpack(here.pack(), "packed");
  std::filesystem::remove_all(directory.path());
  EXPECT_EQ(errors_of(there), errors);
}

TEST(input_files, a_mesh_that_was_not_packed_is_missing_even_where_the_disk_has_it) {
  const TemporaryDirectory directory;
  const std::filesystem::path deck = write_case(directory);
  InputFiles here;
  static_cast<void>(here.read(deck));
  InputFiles there = InputFiles::unpack(here.pack(), "packed");
  EXPECT_EQ(there.kind(directory / "meshes/plate.stl"), InputFiles::Kind::missing);
  EXPECT_THROW(static_cast<void>(there.read(directory / "meshes/plate.stl")), OutputError);
  try {
    static_cast<void>(app::load_case(deck, there));
    FAIL() << "a model without its mesh";
  } catch (const InputErrors& errors) {
    const InputError& error = errors.errors().front();
    EXPECT_EQ(error.place.file, deck.string());
    EXPECT_NE(error.message.find("plate.stl\" is not there (mesh of body \"first\")"), std::string::npos)
        << error.text();
    EXPECT_NE(error.cure.find("run the deck again from the start"), std::string::npos) << error.text();
  }
}

TEST(input_files, a_file_that_changes_after_it_was_read_is_not_packed) {
  const TemporaryDirectory directory;
  const std::filesystem::path mesh = directory.write("a.obj", "v 0 0 0\n");
  InputFiles files;
  EXPECT_EQ(files.read(mesh), "v 0 0 0\n");
  EXPECT_EQ(files.read(mesh), "v 0 0 0\n");
  directory.write("a.obj", "v 0 0 1\n");
  try {
    static_cast<void>(files.pack());
    FAIL() << "packed what no model was built from";
  } catch (const OutputError& error) {
    EXPECT_EQ(error.path(), mesh);
    EXPECT_EQ(error.message(), "the file has changed since it was read");
  }
  EXPECT_THROW(static_cast<void>(files.read(mesh)), OutputError) << "one model of two versions of a file";
}

TEST(input_files, a_deck_from_a_pipe_is_packed_too) {
  const TemporaryDirectory directory;
  const std::filesystem::path pipe = directory / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(pipe) << "title = \"piped\"\n"; });
  InputFiles here;
  EXPECT_EQ(here.read(pipe), "title = \"piped\"\n");
  writer.join();
  EXPECT_EQ(InputFiles::unpack(here.pack(), "packed").read(pipe), "title = \"piped\"\n");
}

TEST(input_files, kinds_on_the_disk_are_told_apart) {
  const TemporaryDirectory directory;
  const InputFiles files;
  EXPECT_EQ(files.kind(directory.write("a", "")), InputFiles::Kind::file);
  EXPECT_EQ(files.kind(directory.path()), InputFiles::Kind::directory);
  EXPECT_EQ(files.kind(directory / "none"), InputFiles::Kind::missing);
  EXPECT_EQ(files.kind("/dev/null"), InputFiles::Kind::other);
  EXPECT_EQ(files.deck(), "");
}

TEST(input_files, sections_of_another_kind_or_a_newer_format_are_refused) {
  EXPECT_THROW(static_cast<void>(InputFiles::unpack(pack_sections(test::some_sections()), "packed")), OutputError);
  ByteWriter head;
  head.value(std::uint32_t{2});
  const std::vector<Section> newer{{"inputs", head.take()}};
  EXPECT_THROW(static_cast<void>(InputFiles::unpack(pack_sections(newer), "packed")), OutputError);
}

}  // namespace
}  // namespace fexp::io
