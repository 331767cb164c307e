// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/command.hpp"
#include "app/options.hpp"
#include "app/print.hpp"
#include "app/ranks.hpp"
#include "app/run_driver.hpp"
#include "app/signals.hpp"
#include "app/verify_report.hpp"
#include "app/with_ranks.hpp"
#include "io/atomic_file.hpp"
#include "io/input_files.hpp"
#include "io/output_error.hpp"
#include "io/run_directory.hpp"

namespace fexp::app {

namespace {

namespace fs = std::filesystem;

struct VerifyOptions {
  std::vector<std::string> cases;
  std::string out;
  int threads{};
  bool all{};
  bool json{};
};

/// A directory for the runs: the user's, or one that is removed at the end.
class RunsDirectory {
 public:
  explicit RunsDirectory(const std::string& asked) : path_(asked), kept_(!asked.empty()) {
    if (!kept_) {
      std::string pattern = (fs::temp_directory_path() / "fexp-verify-XXXXXX").string();
      if (mkdtemp(pattern.data()) == nullptr) {
        throw io::OutputError(fs::temp_directory_path(), "cannot make a directory in it",
                              "name one with --out, or set TMPDIR to one that can be written");
      }
      path_ = pattern;
    }
  }
  RunsDirectory(const RunsDirectory&) = delete;
  RunsDirectory& operator=(const RunsDirectory&) = delete;
  ~RunsDirectory() {
    std::error_code ignored;
    if (!kept_) {
      fs::remove_all(path_, ignored);
    }
  }

  [[nodiscard]] bool is_kept() const noexcept { return kept_; }
  [[nodiscard]] fs::path run_of(const fs::path& deck) const { return path_ / deck.stem(); }
  [[nodiscard]] fs::path table() const { return path_ / "verification.json"; }
  /// A deck like the given one, its meshes refined by the factor.
  [[nodiscard]] fs::path refined_deck(const fs::path& deck, double factor) const {
    return path_ / fmt::format("{}_refined_{}.toml", deck.stem().string(), factor);
  }

 private:
  fs::path path_;
  bool kept_;
};

/// The suite's decks, in order.
std::vector<fs::path> suite() {
  std::vector<fs::path> decks;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(FEXP_VERIFICATION_DIRECTORY, error)) {
    if (entry.path().extension() == ".toml") {
      decks.push_back(entry.path());
    }
  }
  if (decks.empty()) {
    ErrorList errors;
    errors.add({FEXP_VERIFICATION_DIRECTORY}, "there are no decks to verify", "a directory with decks",
               "name decks, or install fexp with its verification decks");
    errors.throw_if_any();
  }
  std::ranges::sort(decks);
  return decks;
}

/// Whether a case such as "07_time_reversal" has that number.
bool is_numbered(const std::string& known, const std::string& number) {
  const std::string digits = known.substr(0, known.find('_'));
  return digits == number || digits == "0" + number;
}

/// The decks that are named: files, or cases of the suite by their names or numbers.
std::vector<fs::path> named_decks(const std::vector<std::string>& names) {
  std::vector<fs::path> decks;
  ErrorList errors;
  for (const std::string& name : names) {
    const fs::path path(name);
    if (path.extension() == ".toml" || fs::exists(path)) {
      decks.push_back(path);
      continue;
    }
    std::vector<std::string> known;
    const std::size_t before = decks.size();
    for (const fs::path& deck : suite()) {
      known.push_back(deck.stem().string());
      if (known.back() == name || is_numbered(known.back(), name)) {
        decks.push_back(deck);
      }
    }
    if (decks.size() == before) {
      errors.add({}, fmt::format("there is no case \"{}\"", name), fmt::format("{}", fmt::join(known, ", ")),
                 "name a case by its name or number, or a deck by its file");
    }
  }
  errors.throw_if_any();
  return decks;
}

void check_case(const Case& loaded, const fs::path& deck) {
  ErrorList errors;
  if (loaded.deck.expectations.empty()) {
    errors.add({deck.string()}, "the deck has no [[expect]]", "one for each number to be verified",
               "add [[expect]], or use \"fexp run\"");
  }
  if (!loaded.deck.verify.meshes.empty() && loaded.deck.refinement.factor != 1.0) {
    errors.add(loaded.deck.refinement.place, "the deck refines its meshes, and verify.meshes does so, too",
               "one of the two", "remove [refinement], and give the bodies' meshes the cells");
  }
  errors.throw_if_any();
}

/// Runs cases one after the other.
class Verifier {
 public:
  Verifier(const VerifyOptions& options, Ranks& ranks) : options_(options), ranks_(ranks), runs_(options.out) {}

  ExitCode run() {
    const bool named = !options_.cases.empty();
    const std::vector<fs::path> decks = named ? named_decks(options_.cases) : suite();
    for (const fs::path& deck : decks) {
      width_ = std::max(width_, deck.stem().string().size());
    }
    for (const fs::path& deck : decks) {
      const ExitCode code = run_case(deck, named);
      if (code != ExitCode::done) {
        return code;
      }
    }
    if (!ranks_.is_first()) {
      return ExitCode::done;
    }
    print(sum_text(findings_));
    if (options_.json) {
      print_json(to_json(findings_));
    }
    if (runs_.is_kept()) {
      io::write_atomically(runs_.table(), to_json(findings_).dump(2) + "\n");
    }
    return findings_.wrong() == 0 && findings_.stopped.empty() ? ExitCode::done : ExitCode::different;
  }

 private:
  /// One case on its own mesh, or on all of its meshes.
  ExitCode run_case(const fs::path& deck, bool named) {
    io::InputFiles files;
    const Case loaded = ranks_.load(deck, files);
    ranks_.on_first([&] { check_case(loaded, deck); });
    const io::VerifySettings& settings = loaded.deck.verify;
    if (settings.is_long && !named && !options_.all) {
      return ExitCode::done;
    }
    std::vector<double> factors{1.0};
    if (options_.all && !settings.meshes.empty()) {
      factors = settings.meshes;
    }
    rows_.clear();
    for (const double factor : factors) {
      const ExitCode code = factor == 1.0 ? run_deck(loaded, deck, deck, factor) : run_refined(loaded, deck, factor);
      if (code != ExitCode::done) {
        return code;
      }
    }
    for (VerifySeries& series : series_of(rows_)) {
      print(series_text(series, width_));
      findings_.series.push_back(std::move(series));
    }
    std::ranges::move(rows_, std::back_inserter(findings_.rows));
    return ExitCode::done;
  }

  ExitCode run_refined(const Case& loaded, const fs::path& deck, double factor) {
    const fs::path refined = runs_.refined_deck(deck, factor);
    ranks_.on_first([&] {
      fs::create_directories(refined.parent_path());
      io::write_atomically(refined, loaded.deck_bytes + fmt::format("\n[refinement]\nfactor = {}\n", factor));
    });
    io::InputFiles files;
    return run_deck(ranks_.load(refined, files), refined, deck, factor);
  }

  /// Runs `path`, which is `deck` refined by the factor. Rows that a fault leaves out are told.
  ExitCode run_deck(const Case& loaded, const fs::path& path, const fs::path& deck, double factor) {
    if (!std::exchange(headed_, true)) {
      print(head_text(width_));
    }
    io::RunDirectory directory("");
    ranks_.on_first([&] { directory = io::RunDirectory::create(path, loaded.deck_bytes, runs_.run_of(path), true); });
    DriveSettings settings;
    settings.quiet = true;
    RunEnd end;
    const ExitCode code = drive({ranks_, loaded, directory, settings}, end);
    if (end.reason == EndReason::fault) {
      findings_.stopped.push_back(path.stem().string());
      print(fmt::format("{:<{}} {:>8}  stopped before its end\n", deck.stem().string(), width_,
                        loaded.model.element_count()));
      return ExitCode::done;
    }
    if (end.reason != EndReason::completed) {
      return code;
    }
    ranks_.on_first([&] { evaluate(loaded, directory, deck, factor); });
    return ExitCode::done;
  }

  /// Rows of one run's expectations from the histories that it has written.
  void evaluate(const Case& loaded, const io::RunDirectory& directory, const fs::path& deck, double factor) {
    ErrorList errors;
    for (const io::Expectation& expected : loaded.deck.expectations) {
      if (!io::in_series(expected) && expected.mesh != factor) {
        continue;
      }
      const fs::path file = directory.history(expected.history);
      if (!fs::exists(file)) {
        errors.add(expected.place, fmt::format("expect \"{}\": the run has no {}.csv", expected.name, expected.history),
                   "a history that the run writes", "name node sets or bodies under [output]");
        continue;
      }
      VerifyRow row{deck.stem().string(),
                    deck.string(),
                    loaded.deck.title,
                    loaded.model.element_count(),
                    factor,
                    expected,
                    0.0,
                    0.0};
      row.result = io::expected_number(expected, io::read_csv(file), errors);
      row.error = io::error_of(expected, row.result);
      print(row_text(row, width_));
      rows_.push_back(std::move(row));
    }
    errors.throw_if_any();
  }

  void print(const std::string& text) const {
    if (!options_.json && ranks_.is_first()) {
      print_out(text);
    }
  }

  const VerifyOptions& options_;
  Ranks& ranks_;
  RunsDirectory runs_;
  SignalWatch watch_;
  std::size_t width_{};
  bool headed_{};
  std::vector<VerifyRow> rows_;  // Of the present case
  VerifyFindings findings_;
};

std::function<ExitCode()> declare_verify(CLI::App& app) {
  auto options = std::make_shared<VerifyOptions>();
  app.add_option(
      "CASE", options->cases,
      "Cases of fexp's own suite by name or number, or decks with [[expect]]; the whole suite when left out");
  app.add_flag("--all", options->all, "Run long cases too, and the refined meshes of all: minutes instead of seconds");
  app.add_option("--out", options->out, "Directory for the runs and the table; removed afterwards when left out")
      ->option_text("DIR");
  add_threads_option(app, options->threads);
  add_json_option(app, options->json, "Print the table as JSON, and nothing else, on the standard output");
  return
      [options] { return with_ranks(options->threads, [&](Ranks& ranks) { return Verifier(*options, ranks).run(); }); };
}

}  // namespace

const Command verify_command{"verify", "Run decks and hold their results against references",
                             "  fexp verify                             fexp's own verification suite\n"
                             "  fexp verify --all 17 22                 two of its cases, with refined meshes\n"
                             "  fexp verify my_bracket.toml --out runs  decks of your own, with [[expect]]",
                             declare_verify};

}  // namespace fexp::app
