// SPDX-License-Identifier: Apache-2.0
#include "io/run_directory.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>
#include <thread>

#include "io/atomic_file.hpp"
#include "io/checkpoint_files.hpp"
#include "io/output_error.hpp"
#include "io/vtkhdf_hdf5.hpp"
#include "parallel/library_version.hpp"

namespace fexp::io {

namespace fs = std::filesystem;

namespace {

constexpr const char* cure_path = "choose a directory that you may write to, with --out";

/// True when the directory is there now and was made by this call.
bool make_directory(const fs::path& path) {
  std::error_code error;
  const bool made = fs::create_directories(path, error);
  if (error) {
    throw OutputError(path, "cannot create the directory: " + error.message(), cure_path);
  }
  return made;
}

fs::path first_free(const fs::path& deck) {
  const std::string stem = deck.stem().empty() ? "fexp" : deck.stem().string();
  constexpr int most = 100000;
  for (int number = 1; number < most; ++number) {
    fs::path path = number == 1 ? stem + ".run" : fmt::format("{}-{}.run", stem, number);
    if (make_directory(path)) {
      return path;
    }
  }
  throw OutputError(stem + ".run", "all names up to " + fmt::format("{}-{}.run", stem, most - 1) + " are taken",
                    "name a directory with --out");
}

/// Removes what an earlier run wrote, so that nothing of it is taken for this run's.
void clear_earlier_run(const RunDirectory& run) {
  std::error_code error;
  const bool is_run = fs::exists(run.versions(), error);
  for (const fs::path& path : {run.deck(), run.results(), run.xdmf(), run.log(), run.summary(), run.versions(),
                               run.inputs(), run.taken_up(), run.fault()}) {
    fs::remove(path, error);
  }
  CheckpointFiles(run.checkpoints()).clear();
  if (!is_run) {
    return;
  }
  std::vector<fs::path> histories;
  for (const fs::directory_entry& entry : fs::directory_iterator(run.path(), error)) {
    if (entry.path().extension() == ".csv") {
      histories.push_back(entry.path());
    }
  }
  for (const fs::path& path : histories) {
    fs::remove(path, error);
  }
}

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) {
      const std::size_t begin = line.find_first_not_of(": \t", line.find(':'));
      return begin == std::string::npos ? "unknown" : line.substr(begin);
    }
  }
  return "unknown";
}

std::string system_name() {
  std::ifstream file("/etc/os-release");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("PRETTY_NAME=\"") && line.ends_with('"')) {
      return line.substr(13, line.size() - 14);
    }
  }
  return "unknown";
}

std::string compiler_name() {
#if defined(__clang__)
  const std::string name = "clang " __clang_version__;
#elif defined(__GNUC__)
  const std::string name = "gcc " __VERSION__;
#else
  const std::string name = "unknown";
#endif
#if defined(__OPTIMIZE__)
  return name + ", optimised";
#else
  return name + ", not optimised";
#endif
}

}  // namespace

Versions present_versions(std::string_view kernel) {
  char host[256] = "unknown";
  gethostname(host, sizeof(host) - 1);
  Versions versions;
  versions.lines = {{"fexp", FEXP_VERSION},
                    {"compiler", compiler_name()},
                    {"kernel", std::string(kernel)},
                    {"HDF5", hdf5::library_version()},
                    {"oneTBB", parallel::library_version()},
                    {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
                    {"nlohmann-json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                                  NLOHMANN_JSON_VERSION_PATCH)},
                    {"system", system_name()},
                    {"host", host},
                    {"processor", processor_name()},
                    {"hardware threads", std::to_string(std::thread::hardware_concurrency())}};
  return versions;
}

RunDirectory RunDirectory::create(const fs::path& deck, std::string_view deck_bytes, const fs::path& out, bool force) {
  const fs::path usual = deck.stem().string() + ".run";
  RunDirectory run(!out.empty() ? out : force ? usual : first_free(deck));
  make_directory(run.path());
  std::error_code error;
  const bool empty = fs::is_empty(run.path(), error);
  if (error || !fs::is_directory(run.path())) {
    throw OutputError(run.path(), "is not a directory", cure_path);
  }
  if (!empty && !force) {
    throw OutputError(run.path(), "the directory is not empty",
                      "name another with --out, or replace the results in it with --force");
  }
  clear_earlier_run(run);
  write_atomically(run.deck(), deck_bytes);
  return run;
}

void RunDirectory::write_versions(const Versions& versions) const {
  std::string text;
  for (const auto& [what, version] : versions.lines) {
    text += fmt::format("{}: {}\n", what, version);
  }
  write_atomically(this->versions(), text);
}

}  // namespace fexp::io
