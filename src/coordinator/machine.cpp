// SPDX-License-Identifier: Apache-2.0
#include "coordinator/machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

namespace fexp::coordinator {

namespace {

constexpr int most_slots = 4096;
constexpr const char* machine_forms = "NAME, NAME:SLOTS, NAME=ADDRESS or NAME=ADDRESS:SLOTS";

std::optional<int> slots_of(std::string_view text) {
  int slots = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), slots);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  return whole && slots >= 1 && slots <= most_slots ? std::optional(slots) : std::nullopt;
}

/// Names become names of files and parts of command lines. Those that begin with "_" are ours.
bool is_name(std::string_view text) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-' ||
           c == '_';
  };
  constexpr std::size_t longest = 200;
  return !text.empty() && text.size() <= longest && std::ranges::all_of(text, allowed) && text.front() != '.' &&
         text.front() != '_' && text.front() != '-';
}

/// A name, or a number of version 6 with its colons.
bool is_address(std::string_view text) {
  return is_name(text) ||
         (text.find_first_not_of("0123456789abcdefABCDEF:") == text.npos && text.find(':') != text.npos);
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  constexpr std::string_view blank = " \t\r";
  for (std::size_t begin = line.find_first_not_of(blank); begin != line.npos;) {
    const std::size_t end = std::min(line.find_first_of(blank, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(blank, end);
  }
  return words;
}

/// Takes "slots=4" and its kind. False when the word is none of them.
bool take_count(std::string_view word, Machine& machine, const Place& place, ErrorList& errors) {
  const std::size_t equals = word.find('=');
  const std::string_view key = word.substr(0, equals);
  const bool is_slots = key == "slots" || key == "cpus" || key == "count";
  const bool is_most = key == "max_slots" || key == "max-slots" || key == "max";
  if (equals == word.npos || (!is_slots && !is_most)) {
    return false;
  }
  const std::optional<int> count = slots_of(word.substr(equals + 1));
  if (!count) {
    errors.add(place, fmt::format("\"{}\" is no number of slots", word), fmt::format("1 to {}", most_slots),
               "correct the number");
  } else if (is_slots) {
    machine.slots = *count;
  }
  return true;
}

void add_line(const Machine& machine, const Place& place, std::vector<Machine>& machines, ErrorList& errors) {
  const auto same = std::ranges::find(machines, machine.name, &Machine::name);
  if (same == machines.end()) {
    machines.push_back(machine);
  } else if (same->address != machine.address) {
    errors.add(place,
               fmt::format("machine \"{}\" stands at {} and at {}", machine.name, same->address, machine.address), "",
               "give each machine a name of its own");
  } else {
    // A line without slots counts one, as with mpirun.
    same->slots = std::max(same->slots, 1) + std::max(machine.slots, 1);
  }
}

}  // namespace

Machine parse_machine(std::string_view text, const Place& place, ErrorList& errors) {
  Machine machine;
  const std::size_t equals = text.find('=');
  std::string_view address = equals == text.npos ? text : text.substr(equals + 1);
  const std::size_t colon = address.find(':');
  if (colon != address.npos && address.find(':', colon + 1) == address.npos) {
    const std::optional<int> slots = slots_of(address.substr(colon + 1));
    if (!slots) {
      errors.add(place, fmt::format("\"{}\" has no number of slots after the colon", text),
                 fmt::format("1 to {}", most_slots), "correct the number");
    }
    machine.slots = slots.value_or(0);
    address = address.substr(0, colon);
  }
  machine.address = address;
  machine.name = equals == text.npos ? address : text.substr(0, equals);
  if (!is_address(address) || (equals != text.npos && !is_name(machine.name))) {
    errors.add(place, fmt::format("\"{}\" names no machine", text),
               fmt::format("{}, of letters, digits, \".\", \"-\" and \"_\"", machine_forms),
               "correct the name; what else it takes to reach a machine (user, port) belongs into ~/.ssh/config");
  }
  return machine;
}

std::vector<Machine> parse_machines(std::string_view text, const std::string& file, ErrorList& errors) {
  std::vector<Machine> machines;
  int number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const Place place{file, ++number, 0};
    const std::vector<std::string_view> words = words_of(line.substr(0, line.find('#')));
    if (words.empty()) {
      continue;
    }
    Machine machine = parse_machine(words.front(), place, errors);
    for (std::size_t w = 1; w < words.size(); ++w) {
      if (!take_count(words[w], machine, place, errors)) {
        errors.add(place, fmt::format("unexpected \"{}\" after a machine", words[w]), "slots=N, max_slots=N",
                   "one machine on each line");
      }
    }
    add_line(machine, place, machines, errors);
  }
  return machines;
}

std::string to_text(const Machine& machine) {
  const std::string where =
      machine.name == machine.address ? machine.name : fmt::format("{}={}", machine.name, machine.address);
  return machine.slots > 0 ? fmt::format("{}:{}", where, machine.slots) : where;
}

std::string names_text(const std::vector<Machine>& machines) {
  std::string text;
  for (std::size_t m = 0; m < machines.size(); ++m) {
    text += m == 0 ? "" : m + 1 < machines.size() ? ", " : " and ";
    text += machines[m].name;
  }
  return text;
}

}  // namespace fexp::coordinator
