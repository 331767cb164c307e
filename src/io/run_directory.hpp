// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fexp::io {

/// What is known about the program and the machine, for versions.txt.
struct Versions {
  std::vector<std::pair<std::string, std::string>> lines;  ///< (what, version)
};

/// The program's, its compiler's, its libraries' and the processor's versions; `kernel` is the element kernel in use.
[[nodiscard]] Versions present_versions(std::string_view kernel);

/// The directory of one run: a copy of the deck, results, histories, log and summary. Nobody's results are replaced
/// silently: without a name the first free one of deck.run, deck-2.run, deck-3.run ... in the current directory is
/// taken; a directory named by the user must be new or empty unless `force` is set, and even then only files that a run
/// writes are replaced.
class RunDirectory {
 public:
  /// `out` empty: a name from the deck's. `deck_bytes`: the deck as it was read. Throws OutputError.
  [[nodiscard]] static RunDirectory create(const std::filesystem::path& deck, std::string_view deck_bytes,
                                           const std::filesystem::path& out, bool force);

  explicit RunDirectory(std::filesystem::path path) : path_(std::move(path)) {}

  void write_versions(const Versions& versions) const;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  [[nodiscard]] std::filesystem::path deck() const { return path_ / "deck.toml"; }
  [[nodiscard]] std::filesystem::path results() const { return path_ / results_name; }
  /// Version 2 of XDMF, whose extension makes ParaView take the reader that understands it.
  [[nodiscard]] std::filesystem::path xdmf() const { return path_ / "results.xdmf2"; }
  /// The neighbourhood of a fault.
  [[nodiscard]] std::filesystem::path fault() const { return path_ / "fault.vtkhdf"; }
  [[nodiscard]] std::filesystem::path log() const { return path_ / "log.txt"; }
  [[nodiscard]] std::filesystem::path summary() const { return path_ / "summary.json"; }
  [[nodiscard]] std::filesystem::path versions() const { return path_ / "versions.txt"; }
  [[nodiscard]] std::filesystem::path hashes() const { return path_ / "hashes.csv"; }
  /// The deck and its meshes, packed.
  [[nodiscard]] std::filesystem::path inputs() const { return path_ / "inputs.fexp"; }
  /// The directory of CheckpointFiles.
  [[nodiscard]] std::filesystem::path checkpoints() const { return path_ / "checkpoints"; }
  /// The steps at which the run was taken up, one line for each time.
  [[nodiscard]] std::filesystem::path taken_up() const { return path_ / "taken_up.csv"; }
  /// "energies" -> <directory>/energies.csv
  [[nodiscard]] std::filesystem::path history(std::string_view name) const {
    return path_ / (std::string(name) + ".csv");
  }

  static constexpr const char* results_name = "results.vtkhdf";

 private:
  std::filesystem::path path_;
};

}  // namespace fexp::io
