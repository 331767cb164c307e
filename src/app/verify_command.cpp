// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
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
#include "app/with_ranks.hpp"
#include "io/input_files.hpp"
#include "io/output_error.hpp"
#include "io/run_directory.hpp"

namespace fexp::app {

namespace {

namespace fs = std::filesystem;

struct VerifyOptions {
  std::vector<std::string> decks;
  std::string out;
  int threads{};
  bool json{};
};

/// One expectation, held against a run.
struct Row {
  std::string deck;
  std::string title;
  std::int64_t elements{};
  io::Expectation expected;
  double result{};
  double error{};

  [[nodiscard]] bool good() const { return error <= expected.tolerance; }
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

  [[nodiscard]] fs::path of(const fs::path& deck) const { return path_ / deck.stem(); }

 private:
  fs::path path_;
  bool kept_;
};

/// The decks to run: those that are named, or all of the suite.
std::vector<fs::path> decks_of(const VerifyOptions& options) {
  if (!options.decks.empty()) {
    return {options.decks.begin(), options.decks.end()};
  }
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

Case load(Ranks& ranks, const fs::path& deck, io::InputFiles& files) {
  Case loaded = ranks.load(deck, files);
  ranks.on_first([&] {
    ErrorList errors;
    if (loaded.deck.expectations.empty()) {
      errors.add({deck.string()}, "the deck has no [[expect]]", "one for each number to be verified",
                 "add [[expect]], or use \"fexp run\"");
    }
    errors.throw_if_any();
  });
  return loaded;
}

/// Rows of one deck's expectations from the histories that its run has written.
void evaluate(const Case& loaded, const fs::path& deck, const io::RunDirectory& directory, std::vector<Row>& rows) {
  ErrorList errors;
  for (const io::Expectation& expected : loaded.deck.expectations) {
    const fs::path file = directory.history(expected.history);
    if (!fs::exists(file)) {
      errors.add(expected.place, fmt::format("expect \"{}\": the run has no {}.csv", expected.name, expected.history),
                 "a history that the run writes", "name node sets or bodies under [output]");
      continue;
    }
    Row row{deck.string(), loaded.deck.title, loaded.model.element_count(), expected, 0.0, 0.0};
    row.result = io::expected_number(expected, io::read_csv(file), errors);
    row.error = io::error_of(expected, row.result);
    rows.push_back(std::move(row));
  }
  errors.throw_if_any();
}

std::string row_text(const Row& row) {
  const io::Expectation& e = row.expected;
  return fmt::format("  {}  {}: {:.6g}, expected {:.6g}{}, error {:.2g} {} {:.2g}\n", row.good() ? "ok   " : "WRONG",
                     e.name, row.result, e.reference, e.source.empty() ? "" : fmt::format(" ({})", e.source), row.error,
                     row.good() ? "<=" : ">", e.tolerance);
}

nlohmann::ordered_json row_json(const Row& row) {
  const io::Expectation& e = row.expected;
  return {{"deck", row.deck},         {"title", row.title},       {"elements", row.elements},
          {"quantity", e.name},       {"reference", e.reference}, {"source", e.source},
          {"result", row.result},     {"error", row.error},       {"relative", e.reference != 0.0},
          {"tolerance", e.tolerance}, {"good", row.good()}};
}

ExitCode verify_all(const VerifyOptions& options, Ranks& ranks) {
  const RunsDirectory runs(options.out);
  const SignalWatch watch;
  std::vector<Row> rows;
  std::vector<std::string> stopped;  // Decks whose runs did not come to their end
  for (const fs::path& deck : decks_of(options)) {
    io::InputFiles files;
    const Case loaded = load(ranks, deck, files);
    io::RunDirectory directory("");
    ranks.on_first([&] { directory = io::RunDirectory::create(deck, loaded.deck_bytes, runs.of(deck), true); });
    if (!options.json && ranks.is_first()) {
      print_out(fmt::format("{}: {}, {} elements\n", deck.string(),
                            loaded.deck.title.empty() ? "no title" : loaded.deck.title, loaded.model.element_count()));
    }
    DriveSettings settings;
    settings.quiet = true;
    RunEnd end;
    const ExitCode code = drive({ranks, loaded, directory, settings}, end);
    if (end.reason == EndReason::fault) {
      stopped.push_back(deck.string());
      continue;
    }
    if (end.reason != EndReason::completed) {
      return code;
    }
    ranks.on_first([&] {
      const std::size_t before = rows.size();
      evaluate(loaded, deck, directory, rows);
      for (std::size_t i = before; i < rows.size() && !options.json; ++i) {
        print_out(row_text(rows[i]));
      }
    });
  }
  const auto wrong = std::ranges::count_if(rows, [](const Row& row) { return !row.good(); });
  if (!ranks.is_first()) {
    return ExitCode::done;
  }
  if (options.json) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    std::ranges::transform(rows, std::back_inserter(all), row_json);
    print_json({{"rows", std::move(all)}, {"wrong", wrong}, {"stopped", stopped}});
  } else {
    print_out(fmt::format("{} of {} results are as expected{}\n", static_cast<std::ptrdiff_t>(rows.size()) - wrong,
                          rows.size(), stopped.empty() ? "" : fmt::format("; {} runs stopped", stopped.size())));
  }
  return wrong == 0 && stopped.empty() ? ExitCode::done : ExitCode::different;
}

std::function<ExitCode()> declare(CLI::App& app) {
  auto options = std::make_shared<VerifyOptions>();
  app.add_option("DECK", options->decks, "Decks with [[expect]]; those of fexp's own suite when left out");
  app.add_option("--out", options->out, "Directory for the runs; removed afterwards when left out")->option_text("DIR");
  add_threads_option(app, options->threads);
  add_json_option(app, options->json, "Print the table as JSON, and nothing else, on the standard output");
  return [options] { return with_ranks(options->threads, [&](Ranks& ranks) { return verify_all(*options, ranks); }); };
}

}  // namespace

const Command verify_command{"verify", "Run decks and hold their results against references",
                             "  fexp verify                             fexp's own verification suite\n"
                             "  fexp verify my_bracket.toml --out runs  decks of your own, with [[expect]]",
                             declare};

}  // namespace fexp::app
