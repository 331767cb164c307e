// SPDX-License-Identifier: Apache-2.0
#include "io/checkpoint_files.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "io/atomic_file.hpp"
#include "io/output_error.hpp"
#include "io/run_directory.hpp"
#include "support/sections.hpp"
#include "support/temporary_directory.hpp"

namespace fexp::io {
namespace {

using test::TemporaryDirectory;
using Steps = std::vector<std::int64_t>;

std::vector<Section> sections_of(std::int64_t step) {
  std::vector<Section> sections = test::some_sections();
  sections.push_back({"step", test::bytes_of(std::to_string(step))});
  return sections;
}

void write(const CheckpointFiles& files, std::int64_t step) { files.write(step, sections_of(step)); }

void cut(const std::filesystem::path& path, std::uintmax_t bytes) {
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - bytes);
}

TEST(checkpoint_files, keep_the_newest_two_and_spare_foreign_files) {
  const TemporaryDirectory directory;
  const CheckpointFiles files(directory / "run" / "checkpoints");
  EXPECT_EQ(files.steps(), Steps{});
  for (const std::int64_t step : {0, 7, 1234}) {
    write(files, step);
  }
  EXPECT_EQ(files.path(1234), directory / "run" / "checkpoints" / "step-000000001234.fexp");
  EXPECT_EQ(files.steps(), (Steps{7, 1234}));
  for (const char* name : {"step-12.fexp", "step-.fexp", "step--00000000012.fexp", "step-0000000x1234.fexp", "notes"}) {
    std::ofstream(directory / "run" / "checkpoints" / name) << "mine";
  }
  write(files, 1000000000000000);
  EXPECT_EQ(files.steps(), (Steps{1234, 1000000000000000}));
  EXPECT_TRUE(std::filesystem::exists(directory / "run" / "checkpoints" / "step-12.fexp"));
  EXPECT_EQ(files.newest().step, 1000000000000000);
  EXPECT_EQ(files.newest().sections, sections_of(1000000000000000));
  EXPECT_TRUE(files.newest().passed_over.empty());
}

TEST(checkpoint_files, a_step_written_again_is_replaced_and_keeps_the_one_before) {
  const TemporaryDirectory directory;
  const CheckpointFiles files(directory.path());
  write(files, 5);
  write(files, 10);
  files.write(10, sections_of(11));
  EXPECT_EQ(files.steps(), (Steps{5, 10}));
  EXPECT_EQ(files.newest().sections, sections_of(11));
}

TEST(checkpoint_files, the_one_before_is_taken_when_the_newest_is_damaged_and_a_sentence_says_so) {
  const TemporaryDirectory directory;
  const CheckpointFiles files(directory.path());
  write(files, 5);
  write(files, 10);
  cut(files.path(10), 3);
  const auto size = std::filesystem::file_size(files.path(10));
  const FoundCheckpoint found = files.newest();
  EXPECT_EQ(found.step, 5);
  EXPECT_EQ(found.path, files.path(5));
  EXPECT_EQ(found.sections, sections_of(5));
  EXPECT_EQ(found.passed_over,
            std::vector<std::string>{files.path(10).string() + ": truncated at byte " + std::to_string(size) + " of " +
                                     std::to_string(size + 3) + ", taking the one before"});
  // The run goes on from there: its next checkpoint comes before the damaged one, which must not outlive it.
  write(files, 8);
  EXPECT_EQ(files.steps(), (Steps{5, 8}));
  EXPECT_EQ(files.newest().step, 8);
}

TEST(checkpoint_files, without_a_sound_one_all_reasons_and_a_cure_are_told) {
  const TemporaryDirectory directory;
  const CheckpointFiles files(directory / "c");
  const auto error_of = [&]() -> std::string {
    try {
      static_cast<void>(files.newest());
    } catch (const OutputError& error) {
      EXPECT_NE(error.cure().find("run the deck again from the start"), std::string::npos);
      return error.message();
    }
    return "";
  };
  EXPECT_EQ(error_of(), "there is no checkpoint");
  write(files, 5);
  write(files, 10);
  std::ofstream(files.path(5)) << "nothing of the kind";
  cut(files.path(10), 1);
  const std::string text = error_of();
  EXPECT_EQ(text.find("there is no sound checkpoint: step-000000000010.fexp: truncated at byte "), 0U) << text;
  EXPECT_NE(text.find("; step-000000000005.fexp: not a file of this kind"), std::string::npos) << text;
}

TEST(checkpoint_files, one_that_could_not_be_written_leaves_those_before) {
  const TemporaryDirectory directory;
  const CheckpointFiles files(directory.path());
  write(files, 5);
  write(files, 10);
  // A directory in the place of the unfinished file stands for a place that cannot be written to.
  std::filesystem::create_directories(files.path(15).string() + ".new/full");
  EXPECT_THROW(write(files, 15), OutputError);
  EXPECT_EQ(files.steps(), (Steps{5, 10}));
  EXPECT_THROW(write(CheckpointFiles(directory.write("a file", "")), 1), OutputError);
}

TEST(checkpoint_files, what_a_killed_write_left_is_not_taken_for_a_checkpoint) {
  const TemporaryDirectory directory;
  const CheckpointFiles files(directory.path());
  write(files, 5);
  std::ofstream(files.path(10).string() + ".new") << "half";
  EXPECT_EQ(files.newest().step, 5);
  EXPECT_TRUE(files.newest().passed_over.empty());
  write(files, 15);
  EXPECT_FALSE(std::filesystem::exists(files.path(10).string() + ".new")) << "half a checkpoint takes space for ever";
}

TEST(checkpoint_files, of_an_earlier_run_go_when_a_new_one_takes_its_directory) {
  const TemporaryDirectory directory;
  const RunDirectory first = RunDirectory::create("d.toml", "x", directory / "d.run", false);
  first.write_versions(present_versions("scalar"));
  write(CheckpointFiles(first.checkpoints()), 5);
  write_durably(first.inputs(), test::bytes_of("packed"));
  std::ofstream(first.checkpoints() / "notes.md") << "mine";
  const RunDirectory second = RunDirectory::create("d.toml", "x", directory / "d.run", true);
  EXPECT_EQ(CheckpointFiles(second.checkpoints()).steps(), Steps{});
  EXPECT_FALSE(std::filesystem::exists(second.inputs()));
  EXPECT_EQ(read_whole(second.checkpoints() / "notes.md"), "mine");
}

}  // namespace
}  // namespace fexp::io
