// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/child_process.hpp"
#include "coordinator/machine.hpp"

namespace fexp::coordinator {

/// What the script prints, waited for at most 30 s. Throws OutputError when it fails.
[[nodiscard]] std::string run_host_script(const std::string& script);

/// Where the list of machines comes from while the run goes on: a file that is watched, a script that is run again and
/// again, or nowhere.
class HostSource {
 public:
  /// At most one of both is set.
  HostSource(std::filesystem::path file, std::string script);

  /// A new list, if there is one now; to be called several times a second. A list that cannot be read or is wrong
  /// changes nothing, but is told of in `complaint`, once.
  [[nodiscard]] std::optional<std::vector<Machine>> look(double now, std::string& complaint);

  [[nodiscard]] std::vector<int> descriptors() const;

 private:
  void look_at_file(double now, std::string& complaint);
  void look_at_script(double now, std::string& complaint);
  void complain_once(const std::string& text, std::string& complaint);

  std::filesystem::path file_;
  std::string script_;
  double next_look_{};
  double started_{};
  std::unique_ptr<ChildProcess> running_;
  std::optional<std::string> seen_;   ///< At the last look
  std::optional<std::string> taken_;  ///< Last taken for a list
  std::optional<std::string> new_;
  std::string complained_;
};

}  // namespace fexp::coordinator
