// SPDX-License-Identifier: Apache-2.0
#include "io/checkpoint_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

#include "io/atomic_file.hpp"
#include "io/output_error.hpp"

namespace fexp::io {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view prefix = "step-";
constexpr std::string_view extension = ".fexp";
/// What a file is called while it is written, after its name.
constexpr std::string_view unfinished = ".new";

std::string name_of(std::int64_t step) { return fmt::format("{}{:012}{}", prefix, step, extension); }

/// The step in a file's name; nothing when no checkpoint has that name.
std::optional<std::int64_t> step_of(const std::string& name) {
  if (name.size() <= prefix.size() + extension.size()) {
    return {};
  }
  std::int64_t step = 0;
  std::from_chars(name.data() + prefix.size(), name.data() + name.size() - extension.size(), step);
  return step >= 0 && name == name_of(step) ? std::optional(step) : std::nullopt;
}

std::vector<std::string> names_in(const fs::path& directory) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(directory, error), end; !error && entry != end; entry.increment(error)) {
    names.push_back(entry->path().filename().string());
  }
  return names;
}

}  // namespace

fs::path CheckpointFiles::path(std::int64_t step) const { return directory_ / name_of(step); }

std::vector<std::int64_t> CheckpointFiles::steps() const {
  std::vector<std::int64_t> steps;
  for (const std::string& name : names_in(directory_)) {
    if (const std::optional<std::int64_t> step = step_of(name)) {
      steps.push_back(*step);
    }
  }
  std::ranges::sort(steps);
  return steps;
}

void CheckpointFiles::remove_unfinished() const {
  std::error_code error;
  for (const std::string& name : names_in(directory_)) {
    if (name.ends_with(unfinished) && step_of(name.substr(0, name.size() - unfinished.size()))) {
      fs::remove(directory_ / name, error);
    }
  }
}

void CheckpointFiles::clear() const {
  std::error_code error;
  for (const std::int64_t step : steps()) {
    fs::remove(path(step), error);
  }
  remove_unfinished();
}

void CheckpointFiles::write(std::int64_t step, std::span<const Section> sections) const {
  std::error_code error;
  if (fs::create_directories(directory_, error)) {
    sync_directory(directory_.parent_path());
  }
  if (error) {
    throw OutputError(directory_, "cannot create the directory: " + error.message(),
                      "see that you may write there and that no file of that name is in the way");
  }
  remove_unfinished();
  write_sections(path(step), sections);
  const std::vector<std::int64_t> present = steps();
  const auto written = std::ranges::lower_bound(present, step);
  for (const std::int64_t other : present) {
    const bool before = written != present.begin() && other == *std::prev(written);
    if (other != step && !before) {
      fs::remove(path(other), error);
    }
  }
}

FoundCheckpoint CheckpointFiles::newest() const {
  std::vector<std::int64_t> latest_first = steps();
  std::ranges::reverse(latest_first);
  FoundCheckpoint found;
  std::string wrong;
  for (const std::int64_t step : latest_first) {
    found.step = step;
    found.path = path(step);
    try {
      found.sections = read_sections(found.path);
      return found;
    } catch (const OutputError& failure) {
      wrong += fmt::format("{}{}: {}", wrong.empty() ? "" : "; ", found.path.filename().string(), failure.message());
      found.passed_over.push_back(fmt::format("{}: {}, taking the one before", found.path.string(), failure.message()));
    }
  }
  throw OutputError(directory_, wrong.empty() ? "there is no checkpoint" : "there is no sound checkpoint: " + wrong,
                    "run the deck again from the start, or put a copy of a checkpoint there");
}

}  // namespace fexp::io
