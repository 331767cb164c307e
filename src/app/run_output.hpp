// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/background_writer.hpp"
#include "app/histories.hpp"
#include "app/load.hpp"
#include "app/log.hpp"
#include "app/output_mark.hpp"
#include "cluster/simulation.hpp"
#include "io/hash_log.hpp"
#include "io/run_directory.hpp"
#include "io/vtkhdf.hpp"
#include "io/xdmf.hpp"
#include "model/capture.hpp"

namespace fexp::app {

/// All files that a run writes as it goes on. Failures throw OutputError; that of a frame, which a thread of its own
/// writes while the run goes on, is thrown by the next call.
class RunOutput {
 public:
  /// Creates the files. `hashes`: hashes.csv too.
  RunOutput(const io::RunDirectory& directory, const Case& loaded, std::int64_t expected_frames, bool hashes);
  /// Goes on in the files of a run that was at `mark`, and drops what follows in them; the same can be done again. The
  /// log keeps all its lines, and a summary of the run's earlier end is removed. A file that is not what the run had
  /// written is an OutputError. The state at the mark is not written again, where it was a frame or had rows.
  RunOutput(const io::RunDirectory& directory, const Case& loaded, const OutputMark& mark);
  RunOutput(const RunOutput&) = delete;
  RunOutput& operator=(const RunOutput&) = delete;
  /// Frames that wait are still written.
  ~RunOutput() = default;

  void log(std::string_view text) { log_.line(text); }
  /// Notes in the log where the run goes on.
  void log_resumed(const model::State& state);
  /// After every epoch: hashes, and what the histories sum up between their rows.
  void epoch(const cluster::EpochReport& report);
  /// Has the present state written as a frame; nothing when the last frame is of this step. Waits when two are to be
  /// written already. The rows so far are in their files before the frame is.
  void frame(const cluster::Simulation& simulation, const cluster::EpochReport& report);
  /// Writes rows of the present state; nothing when the last rows are of this step.
  void row(const cluster::Simulation& simulation, const cluster::EpochReport& report);

  /// Writes fault.vtkhdf and, to the log, what led to the fault. The simulation has collected both its states.
  void fault(const cluster::Simulation& simulation, const cluster::Fault& fault);

  /// Waits until all frames are in their files.
  void drain() { writer_.drain(); }
  /// Where the files stand; drains, and hands all of them to the operating system.
  [[nodiscard]] OutputMark mark();
  /// Puts all files on the disk, as far as mark() goes: before a checkpoint that is to survive a crash of the machine.
  void sync();

  /// Closes all files. After an error it leaves nothing open, keeps what can be kept and throws the first error.
  void close();

  /// Complete frames in the file, when all have been written that were to be.
  [[nodiscard]] std::int64_t frames();

 private:
  /// A frame on its way to the files.
  struct Shot {
    model::Frame frame;
    std::string note;  ///< For the log
  };

  void write(const Shot& shot);
  void flush();

  const Case& loaded_;
  io::RunDirectory directory_;
  Log log_;
  io::ResultsWriter results_;
  io::XdmfWriter xdmf_;
  Histories histories_;
  std::optional<io::HashLogWriter> hashes_;
  std::int64_t frame_step_{-1};
  std::int64_t row_step_{-1};
  std::chrono::steady_clock::time_point flushed_{std::chrono::steady_clock::now()};
  /// Uses results_, xdmf_ and log_; the first two are left alone by others until it is idle. HDF5 is not re-entrant.
  BackgroundWriter<Shot> writer_{[this](const Shot& shot) { write(shot); }};
};

/// (what it is, path) of every file in the directory that a run writes, in a fixed order; only those that are there.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> files_of(const io::RunDirectory& directory);

}  // namespace fexp::app
