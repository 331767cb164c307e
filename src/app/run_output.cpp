// SPDX-License-Identifier: Apache-2.0
#include "app/run_output.hpp"

#include <fmt/format.h>

#include <exception>
#include <functional>
#include <string>
#include <string_view>
#include <system_error>

#include "app/fault_report.hpp"
#include "app/schedule.hpp"
#include "io/atomic_file.hpp"
#include "io/expectation.hpp"
#include "io/vtkhdf_reader.hpp"

namespace fexp::app {

namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

/// What a kill can take from the histories at most.
constexpr auto flush_after = 1s;

io::ResultsOptions options_of(const Case& loaded, std::int64_t expected_frames) {
  return {.title = loaded.deck.title, .expected_frames = expected_frames, .deflate = loaded.deck.output.deflate};
}

std::int64_t frames_of(const Case& loaded) {
  const io::OutputSettings& output = loaded.deck.output;
  return Schedule(loaded.model.run.duration, output.results_interval, output.history_interval).frames();
}

std::vector<double> times_of(const fs::path& results, std::int64_t frames) {
  return frames > 0 ? io::ResultsReader(results).times() : std::vector<double>{};
}

}  // namespace

RunOutput::RunOutput(const io::RunDirectory& directory, const Case& loaded, std::int64_t expected_frames, bool hashes)
    : loaded_(loaded),
      directory_(directory),
      log_(directory.log()),
      results_(directory.results(), loaded.model, options_of(loaded, expected_frames)),
      xdmf_(directory.xdmf(), io::RunDirectory::results_name, loaded.model),
      histories_(directory, loaded) {
  if (hashes) {
    hashes_.emplace(directory.hashes());
  }
}

RunOutput::RunOutput(const io::RunDirectory& directory, const Case& loaded, const OutputMark& mark)
    : loaded_(loaded),
      directory_(directory),
      log_(directory.log(), Log::Begin::go_on),
      results_(io::ResultsWriter::resume(directory.results(), loaded.model, mark.frames,
                                         options_of(loaded, frames_of(loaded)))),
      xdmf_(directory.xdmf(), io::RunDirectory::results_name, loaded.model, times_of(directory.results(), mark.frames)),
      histories_(directory, loaded, &mark),
      frame_step_(mark.frame_step),
      row_step_(mark.row_step) {
  if (mark.csv_bytes.contains(directory.hashes().stem().string())) {
    hashes_ = io::HashLogWriter::resume(directory.hashes(), mark.bytes_of(directory.hashes()));
  }
  std::error_code error;
  fs::remove(directory.summary(), error);
  fs::remove(directory.fault(), error);
}

void RunOutput::log_resumed(const model::State& state) {
  log_.line(fmt::format("resumed at step {}, time {:.6g}", state.step, state.time));
}

void RunOutput::epoch(const cluster::EpochReport& report) {
  // A full disk ends the run soon, not at the next frame.
  writer_.check();
  histories_.add(report);
  if (hashes_) {
    for (const solve::HashRecord& record : report.hashes) {
      hashes_->append({record.step, record.body, record.hash});
    }
  }
  if (report.rollbacks > 0) {
    log_.line(fmt::format("an epoch was put back and redone {} times, the last time with {} steps of {:.4g}",
                          report.rollbacks, report.steps, report.dt));
  }
  if (report.retried.kind != cluster::FaultKind::none) {
    log_.line(fmt::format("{}: the epoch was put back and done again with half the step, {:.4g}",
                          report.retried.message, report.dt));
  }
  if (std::chrono::steady_clock::now() - flushed_ >= flush_after) {
    flush();
  }
}

void RunOutput::frame(const cluster::Simulation& simulation, const cluster::EpochReport& report) {
  const model::State& state = simulation.state();
  if (state.step == frame_step_) {
    return;
  }
  frame_step_ = state.step;
  flush();
  Shot& shot = writer_.next();
  model::capture_into(loaded_.model, state, simulation.workspace().contact.force, simulation.island_of_body(),
                      shot.frame);
  shot.note = fmt::format("time {:.6g}, step {}, dt {:.4g}, energy error {:.2e}, {} islands, {} contacts", state.time,
                          state.step, report.dt, report.energy_error, report.islands, report.active_pairs);
  writer_.hand_over();
}

/// On the writer's thread.
void RunOutput::write(const Shot& shot) {
  results_.append(shot.frame);
  xdmf_.append(shot.frame.time);
  log_.line(fmt::format("frame {}: {}", results_.frames() - 1, shot.note));
}

std::int64_t RunOutput::frames() {
  writer_.wait();
  return results_.frames();
}

void RunOutput::row(const cluster::Simulation& simulation, const cluster::EpochReport& report) {
  if (simulation.state().step != row_step_) {
    row_step_ = simulation.state().step;
    histories_.write(simulation, report);
  }
}

void RunOutput::fault(const cluster::Simulation& simulation, const cluster::Fault& fault) {
  drain();
  if (const std::string text = history_text(loaded_.model, fault, loaded_.deck.units); !text.empty()) {
    log_.line(text.substr(0, text.size() - 1));
  }
  if (write_neighbourhood(directory_.fault(), simulation, fault)) {
    log_.line(fmt::format("what is around the fault is in {}", directory_.fault().filename().string()));
  }
}

void RunOutput::flush() {
  histories_.flush();
  if (hashes_) {
    hashes_->flush();
  }
  flushed_ = std::chrono::steady_clock::now();
}

OutputMark RunOutput::mark() {
  drain();
  flush();
  OutputMark mark;
  mark.frames = results_.frames();
  mark.frame_step = frame_step_;
  mark.row_step = row_step_;
  histories_.mark(mark);
  if (hashes_) {
    mark.note(directory_.hashes(), hashes_->bytes());
  }
  return mark;
}

void RunOutput::sync() {
  drain();
  histories_.sync();
  if (hashes_) {
    hashes_->sync();
  }
  results_.sync();
  io::sync_directory(directory_.path());
  flushed_ = std::chrono::steady_clock::now();
}

void RunOutput::close() {
  std::exception_ptr first;
  const auto attempt = [&first](const std::function<void()>& work) {
    try {
      work();
    } catch (...) {
      first = first ? first : std::current_exception();
    }
  };
  attempt([this] { drain(); });
  attempt([this] { histories_.close(); });
  attempt([this] {
    if (hashes_) {
      hashes_->close();
    }
  });
  attempt([this] { xdmf_.close(); });
  attempt([this] { results_.close(); });
  if (first) {
    std::rethrow_exception(first);
  }
}

std::vector<std::pair<std::string, std::string>> files_of(const io::RunDirectory& directory) {
  std::vector<std::pair<std::string, std::string>> files{
      {"results", directory.results().string()},   {"xdmf", directory.xdmf().string()},
      {"deck", directory.deck().string()},         {"inputs", directory.inputs().string()},
      {"versions", directory.versions().string()}, {"log", directory.log().string()},
      {"summary", directory.summary().string()},   {"hashes", directory.hashes().string()},
      {"fault", directory.fault().string()}};
  for (const std::string_view name : io::Expectation::histories) {
    files.emplace_back(name, directory.history(std::string(name)).string());
  }
  // The summary is about to be written.
  std::erase_if(files, [](const auto& file) { return file.first != "summary" && !fs::exists(file.second); });
  return files;
}

}  // namespace fexp::app
