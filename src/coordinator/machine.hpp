// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/errors.hpp"

namespace fexp::coordinator {

/// A machine of the cluster as the user named it.
struct Machine {
  std::string name;     ///< Tells it from the others
  std::string address;  ///< What the launch agent and mpirun call it; the name, unless written NAME=ADDRESS
  int slots{};          ///< Threads to compute with; 0: as many as it has

  friend bool operator==(const Machine&, const Machine&) = default;
};

/// Reads one machine as on the command line: NAME, NAME:SLOTS, NAME=ADDRESS or NAME=ADDRESS:SLOTS. `place` is where it
/// stands, for errors; with an error the result means nothing.
[[nodiscard]] Machine parse_machine(std::string_view text, const Place& place, ErrorList& errors);

/// Reads a hosts file of mpirun: a machine as above on each line, then "slots=N" and "max_slots=N" (which is read
/// over);
/// "#" begins a comment. A machine on several lines has the slots of all of them. `file` is its name, for errors.
[[nodiscard]] std::vector<Machine> parse_machines(std::string_view text, const std::string& file, ErrorList& errors);

/// The same machine as text that parse_machine reads.
[[nodiscard]] std::string to_text(const Machine& machine);

/// "a, b and c"
[[nodiscard]] std::string names_text(const std::vector<Machine>& machines);

}  // namespace fexp::coordinator
