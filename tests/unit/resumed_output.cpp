// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "app/load.hpp"
#include "app/output_mark.hpp"
#include "app/run_output.hpp"
#include "app/schedule.hpp"
#include "cluster/simulation.hpp"
#include "io/atomic_file.hpp"
#include "io/history.hpp"
#include "io/output_error.hpp"
#include "io/vtkhdf_reader.hpp"
#include "support/file_size_limit.hpp"
#include "support/temporary_directory.hpp"

namespace fexp::app {
namespace {

namespace fs = std::filesystem;
using test::TemporaryDirectory;

/// Two balls that meet above a plane, one with a tile that is glued on and comes off, with every kind of history;
/// intervals that are no multiples of each other.
const std::string deck_text = R"(
[run]
duration = 0.06
epoch_steps = 2
[[material]]
name = "rubber"
density = 1000.0
young = 1.0e8
poisson = 0.4
[[section]]
name = "skin"
material = "rubber"
thickness = 0.02
[[body]]
name = "left"
section = "skin"
mesh = {kind = "cubed_sphere", radius = 0.5, cells = 2}
translate = [-0.53, 0, 0.52]
velocity = [6, 0, -3]
[[body]]
name = "right"
section = "skin"
mesh = {kind = "cubed_sphere", radius = 0.5, cells = 2}
translate = [0.53, 0.1, 0.6]
velocity = [-6, 0, 0]
[[body]]
name = "tile"
section = "skin"
mesh = {kind = "plate", length_x = 0.1, length_y = 0.1, cells_x = 1, cells_y = 1}
translate = [-0.58, -0.05, 1.04]
velocity = [6, 0, -3]
[[node_set]]
name = "tile"
bodies = ["tile"]
[[tie]]
name = "glue"
set = "tile"
surface = ["left"]
distance = 0.1
strength_normal = 1000.0
strength_shear = 1000.0
[[node_set]]
name = "some"
box = {low = [-2, -2, 0.9], high = [2, 2, 2]}
[[plane]]
name = "floor"
point = [0, 0, 0]
normal = [0, 0, 1]
[output]
results_interval = 0.007
history_interval = 0.0019
nodes = ["some"]
elements = ["some"]
bodies = ["left"]
)";

constexpr std::int64_t hash_every = 5;

/// A run, epoch by epoch, that writes as the program does; with no output it leaves no trace.
class WrittenRun {
 public:
  explicit WrittenRun(const Case& loaded)
      : loaded_(loaded), simulation_(loaded.model, solve::KernelChoice::automatic), schedule_(whole_schedule()) {}

  [[nodiscard]] const cluster::Simulation& simulation() const { return simulation_; }
  [[nodiscard]] int epochs() const { return epochs_; }
  [[nodiscard]] bool over() const { return schedule_.over(); }
  [[nodiscard]] std::int64_t frames() const { return schedule_.frames(); }

  void write(RunOutput& output) {
    last_ = epochs_ == 0 ? simulation_.present() : last_;
    output.row(simulation_, last_);
    output.frame(simulation_, last_);
  }

  void epoch(RunOutput* output) {
    last_ = simulation_.run_epoch(schedule_.next(), hash_every);
    ++epochs_;
    if (output != nullptr) {
      output->epoch(last_);
    }
    if (simulation_.state().time == schedule_.next()) {
      if (output != nullptr && schedule_.row_due()) {
        output->row(simulation_, last_);
      }
      if (output != nullptr && schedule_.frame_due()) {
        output->frame(simulation_, last_);
      }
      schedule_.advance();
    }
  }

  void go_to(int epochs, RunOutput* output) {
    while (epochs_ < epochs) {
      epoch(output);
    }
  }

  /// Takes up a schedule that knows nothing of what went before.
  void renew_schedule() {
    schedule_ = whole_schedule();
    schedule_.skip_to(simulation_.state().time);
  }

  void finish(RunOutput& output) {
    while (!over()) {
      epoch(&output);
    }
    write(output);
    output.close();
  }

 private:
  [[nodiscard]] Schedule whole_schedule() const {
    const io::OutputSettings& output = loaded_.deck.output;
    return {loaded_.model.run.duration, output.results_interval, output.history_interval};
  }

  const Case& loaded_;
  cluster::Simulation simulation_;
  Schedule schedule_;
  cluster::EpochReport last_;
  int epochs_{};
};

/// A run that was killed in an epoch, and its marks at the ends of earlier ones.
struct Killed {
  fs::path path;
  std::vector<OutputMark> marks;  ///< After each epoch, the start first
};

class ResumedOutput : public testing::Test {
 protected:
  ResumedOutput() : loaded_(load_case(directory_.write("deck.toml", deck_text))) {}

  /// Writes a whole run; returns the number of its epochs.
  int write_whole(const fs::path& path) {
    fs::create_directory(path);
    WrittenRun run(loaded_);
    RunOutput output(io::RunDirectory(path), loaded_, run.frames(), true);
    run.write(output);
    run.finish(output);
    return run.epochs();
  }

  /// What is on the disk when a run is killed after `epochs` epochs: rows that still wait in memory are lost.
  Killed killed_after(int epochs) {
    Killed killed{directory_ / "killed", {}};
    fs::create_directory(directory_ / "live");
    WrittenRun run(loaded_);
    RunOutput output(io::RunDirectory(directory_ / "live"), loaded_, run.frames(), true);
    run.write(output);
    killed.marks.push_back(output.mark());
    while (run.epochs() < epochs) {
      run.epoch(&output);
      // A mark hands over what waits, so that later epochs alone have rows to lose.
      if (run.epochs() <= epochs / 2) {
        killed.marks.push_back(output.mark());
      }
    }
    // The copy is to be of one moment.
    output.drain();
    fs::copy(directory_ / "live", killed.path, fs::copy_options::recursive);
    output.close();
    fs::remove_all(directory_ / "live");
    return killed;
  }

  /// Goes on from the mark that was made after `epochs` epochs, until `end` or, with none, to the end of the run.
  void resume(const fs::path& path, const OutputMark& mark, int epochs, std::optional<int> end) {
    WrittenRun run(loaded_);
    run.go_to(epochs, nullptr);
    run.renew_schedule();
    RunOutput output(io::RunDirectory(path), loaded_, mark);
    output.log_resumed(run.simulation().state());
    if (epochs == 0) {
      run.write(output);
    }
    if (end) {
      run.go_to(*end, &output);
    } else {
      run.finish(output);
    }
  }

  void expect_refused(const fs::path& path, const OutputMark& mark, const std::string& message) {
    try {
      const RunOutput output(io::RunDirectory(path), loaded_, mark);
      ADD_FAILURE() << "went on, but: " << message;
    } catch (const io::OutputError& error) {
      EXPECT_NE(error.message().find(message), std::string::npos) << error.what();
      EXPECT_NE(error.cure().find("run the deck again"), std::string::npos) << error.what();
    }
  }

  TemporaryDirectory directory_;
  Case loaded_;
};

void expect_same_results(const fs::path& one, const fs::path& other) {
  const io::ResultsReader a(one);
  const io::ResultsReader b(other);
  EXPECT_EQ(a.steps(), b.steps());
  EXPECT_EQ(a.times(), b.times());
  ASSERT_EQ(a.frames(), b.frames());
  for (std::int64_t f = 0; f < a.frames(); ++f) {
    EXPECT_EQ(a.points(f), b.points(f)) << "frame " << f;
    for (const io::ResultField& field : io::result_fields()) {
      EXPECT_EQ(a.raw(field, f), b.raw(field, f)) << field.name << " of frame " << f;
    }
  }
}

/// All files but the log, which has times of day.
void expect_same_files(const fs::path& one, const fs::path& other) {
  for (const char* name : {"energies.csv", "momenta.csv", "steps.csv", "walls.csv", "ties.csv", "nodes.csv",
                           "elements.csv", "bodies.csv", "hashes.csv", "results.xdmf2"}) {
    EXPECT_EQ(io::read_whole(one / name), io::read_whole(other / name)) << name;
  }
  expect_same_results(one / "results.vtkhdf", other / "results.vtkhdf");
}

/// The last mark of which something holds.
template <class Property>
int last_mark(const std::vector<OutputMark>& marks, Property property) {
  const auto found = std::find_if(marks.rbegin(), marks.rend(), property);
  EXPECT_NE(found, marks.rend());
  return static_cast<int>(marks.rend() - found) - 1;
}

int count(const std::string& text, const std::string& word) {
  int found = 0;
  for (std::size_t i = text.find(word); i != std::string::npos; i = text.find(word, i + 1)) {
    ++found;
  }
  return found;
}

TEST_F(ResumedOutput, is_that_of_a_run_in_one_go_wherever_it_was_killed) {
  const fs::path whole = directory_ / "whole";
  const int epochs = write_whole(whole);
  ASSERT_GT(io::read_csv(whole / "steps.csv").rows.size(), 25U);
  ASSERT_GT(epochs, 60) << "too short to be killed in the middle";
  std::mt19937 random(4);
  for (int trial = 0; trial < 7; ++trial) {
    const int killed_at = trial < 3 ? epochs - 1 : 3 + static_cast<int>(random() % static_cast<unsigned>(epochs - 3));
    const Killed killed = killed_after(killed_at);
    int from = static_cast<int>(random() % killed.marks.size());
    if (trial == 0) {
      from = 0;
    } else if (trial == 1) {  // Between rows, the next of which tells of the searches before.
      from = last_mark(killed.marks, [](const OutputMark& mark) { return mark.searches > 0; });
    } else if (trial == 2) {  // Likewise, while the balls part: no later penetration is as deep.
      from = last_mark(killed.marks, [](const OutputMark& mark) { return mark.deepest > 0.0; });
    }
    SCOPED_TRACE("killed after epoch " + std::to_string(killed_at) + ", resumed after epoch " + std::to_string(from));
    std::ofstream(killed.path / "energies.csv", std::ios::app) << "12,0.0";
    std::ofstream(killed.path / "summary.json") << "{}";
    const OutputMark mark = OutputMark::unpack(killed.marks[static_cast<std::size_t>(from)].pack(), "mark");
    // Killed once more on the way, and taken up from the same mark.
    resume(killed.path, mark, from, (from + killed_at) / 2);
    resume(killed.path, mark, from, std::nullopt);
    expect_same_files(whole, killed.path);
    EXPECT_FALSE(fs::exists(killed.path / "summary.json")) << "of the end that the run came to before";
    const std::string log = io::read_whole(killed.path / "log.txt");
    EXPECT_EQ(count(log, "  resumed at step "), 2);
    EXPECT_EQ(log.find("  frame 0: "), 19U) << "the log of the first part is lost";
    fs::remove_all(killed.path);
  }
}

TEST_F(ResumedOutput, does_not_repeat_the_frame_and_rows_at_the_mark) {
  const fs::path path = directory_ / "run";
  fs::create_directory(path);
  WrittenRun run(loaded_);
  OutputMark mark;
  {
    RunOutput output(io::RunDirectory(path), loaded_, run.frames(), true);
    run.write(output);
    while (mark.frames < 3) {
      run.epoch(&output);
      mark = output.mark();
    }
    output.sync();
    EXPECT_EQ(output.mark(), mark) << "writing to the disk is no event";
  }
  ASSERT_EQ(mark.frame_step, run.simulation().state().step);
  RunOutput output(io::RunDirectory(path), loaded_, mark);
  // What the loop asks for when it sets in.
  run.write(output);
  EXPECT_EQ(output.frames(), 3);
  EXPECT_EQ(output.mark().csv_bytes.at("nodes") > mark.csv_bytes.at("nodes"), mark.row_step != mark.frame_step);
  output.close();
}

TEST_F(ResumedOutput, without_hashes_goes_on_without_them) {
  const fs::path path = directory_ / "run";
  fs::create_directory(path);
  WrittenRun run(loaded_);
  OutputMark mark;
  {
    RunOutput output(io::RunDirectory(path), loaded_, run.frames(), false);
    run.write(output);
    mark = output.mark();
  }
  EXPECT_FALSE(mark.csv_bytes.contains("hashes"));
  RunOutput output(io::RunDirectory(path), loaded_, mark);
  run.finish(output);
  EXPECT_FALSE(fs::exists(path / "hashes.csv"));
}

TEST_F(ResumedOutput, of_a_disk_that_was_full_has_all_frames_before_and_goes_on) {
  const fs::path path = directory_ / "run";
  write_whole(directory_ / "whole");
  // Within a frame's numbers, and where the space is taken for what is written after them.
  for (rlim_t room = 50000; room <= 75000; room += 5000) {
    SCOPED_TRACE(room);
    fs::create_directory(path);
    OutputMark mark;
    int marked = 0;
    std::int64_t kept = 0;
    testing::internal::CaptureStderr();
    {
      WrittenRun run(loaded_);
      RunOutput output(io::RunDirectory(path), loaded_, run.frames(), true);
      run.write(output);
      mark = output.mark();
      const test::FileSizeLimit limit(fs::file_size(path / "results.vtkhdf") + room);
      try {
        while (!run.over()) {
          run.epoch(&output);
          if (run.epochs() % 4 == 0) {
            mark = output.mark();
            marked = run.epochs();
          }
        }
        output.drain();
        ADD_FAILURE() << "the limit was not reached";
      } catch (const io::OutputError& error) {
        EXPECT_EQ(error.path(), path / "results.vtkhdf");
        EXPECT_NE(std::string(error.what()).find("File too large"), std::string::npos) << error.what();
      }
      EXPECT_NO_THROW(output.close()) << "it has been told";
      kept = output.frames();
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "HDF5 prints nothing on any thread";
    EXPECT_GT(marked, 0);
    EXPECT_LE(mark.frames, kept);
    EXPECT_EQ(io::ResultsReader(path / "results.vtkhdf").frames(), kept);
    resume(path, mark, marked, std::nullopt);
    expect_same_files(directory_ / "whole", path);
    fs::remove_all(path);
  }
}

TEST_F(ResumedOutput, files_that_are_not_what_the_run_had_written_are_refused_with_a_cure) {
  const Killed killed = killed_after(20);
  const OutputMark& mark = killed.marks[8];
  const auto keep = [&](const char* name) { fs::rename(killed.path / name, directory_ / "kept"); };
  const auto put_back = [&](const char* name) { fs::rename(directory_ / "kept", killed.path / name); };

  for (const char* name : {"energies.csv", "bodies.csv", "hashes.csv", "results.vtkhdf"}) {
    keep(name);
    expect_refused(killed.path, mark, "the file is missing");
    put_back(name);
  }
  fs::copy(killed.path / "momenta.csv", directory_ / "copy");
  fs::resize_file(killed.path / "momenta.csv", mark.csv_bytes.at("momenta") - 1);
  expect_refused(killed.path, mark, "and the run had written");
  std::ofstream(killed.path / "momenta.csv") << "step,other\n" << std::string(100000, '\n');
  expect_refused(killed.path, mark, "the file has other columns");
  fs::rename(directory_ / "copy", killed.path / "momenta.csv");

  OutputMark other = mark;
  other.csv_bytes.erase("walls");
  expect_refused(killed.path, other, "did not write this file");
  // Nothing of all that has spoilt the run.
  resume(killed.path, mark, 8, std::nullopt);
  write_whole(directory_ / "whole");
  expect_same_files(directory_ / "whole", killed.path);
}

TEST_F(ResumedOutput, results_with_fewer_frames_than_the_mark_are_refused) {
  const Killed killed = killed_after(20);
  OutputMark mark = killed.marks.back();
  mark.frames = 1000;
  EXPECT_THROW(RunOutput(io::RunDirectory(killed.path), loaded_, mark), io::OutputError);
}

TEST(output_mark, comes_back_from_its_bytes_and_from_no_others) {
  const OutputMark mark{7, 120, 130, {{"energies", 812}, {"nodes", 1U << 20U}}, 3, 2, 0.125};
  const Bytes bytes = mark.pack();
  EXPECT_EQ(OutputMark::unpack(bytes, "a.fexp"), mark);
  EXPECT_EQ(OutputMark::unpack(OutputMark{}.pack(), "a.fexp"), OutputMark{});
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_THROW((void)OutputMark::unpack(std::span(bytes).first(length), "a.fexp"), io::OutputError) << length;
  }
  Bytes other = bytes;
  other.push_back({});
  EXPECT_THROW((void)OutputMark::unpack(other, "a.fexp"), io::OutputError);
  other = bytes;
  other[0] = std::byte{2};
  EXPECT_THROW((void)OutputMark::unpack(other, "a.fexp"), io::OutputError);
}

}  // namespace
}  // namespace fexp::app
