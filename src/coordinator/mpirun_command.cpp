// SPDX-License-Identifier: Apache-2.0
#include "coordinator/mpirun_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <csignal>
#include <sstream>

namespace fexp::coordinator {

namespace {

/// Quoted for a shell.
std::string quoted_word(std::string_view word) {
  std::string text = "'";
  for (const char c : word) {
    text += c == '\'' ? "'\\''" : std::string(1, c);
  }
  return text + "'";
}

/// The number that stands at the beginning of the text after blanks.
std::optional<int> leading_number(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t\n"), text.size()));
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} ? std::optional(number) : std::nullopt;
}

std::optional<int> number_after(std::string_view text, std::string_view words) {
  const std::size_t found = text.find(words);
  return found == text.npos ? std::nullopt : leading_number(text.substr(found + words.size()));
}

std::string_view between(std::string_view text, std::string_view before, std::string_view after) {
  const std::size_t begin = text.find(before);
  if (begin == text.npos) {
    return {};
  }
  text.remove_prefix(begin + before.size());
  return text.substr(0, text.find(after));
}

/// Lines that tell something, without mpirun's frames and general advice.
std::vector<std::string> telling_lines(std::string_view output) {
  constexpr std::array general{"ORTE was unable",        "This usually is caused",
                               "This is usually caused", "* ",
                               "settings, or configur",  "Please ",
                               "mpirun detected that",   "Primary job  terminat",
                               "per user-direction",     "a non-zero exit code",
                               "not finding the requi",  "lack of authority",
                               "the inability to wr",    "compilation of the",
                               "lack of common netw",    "acting as an interm",
                               "the rsh agent",          "ORTE does not know",
                               "Unfortunately",          "mpirun was unable to cle"};
  std::vector<std::string> lines;
  std::istringstream stream{std::string(output)};
  for (std::string line; std::getline(stream, line);) {
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if (begin == line.npos || line.find_first_not_of("-=* \t\r") == line.npos) {
      continue;
    }
    line = line.substr(begin, line.find_last_not_of(" \t\r") + 1 - begin);
    const bool is_general = std::ranges::any_of(general, [&](const char* text) { return line.starts_with(text); });
    // Every rank may have said the same.
    if (!is_general && std::ranges::find(lines, line) == lines.end()) {
      lines.push_back(line);
    }
  }
  return lines;
}

/// The last few lines that tell something; those of the launch agent if there are any.
std::string last_words(std::string_view output) {
  constexpr std::array of_agents{"ssh:",     "Permission denied", "Host key",          "Connection ",
                                 "No route", "not found",         "Could not resolve", "cannot connect",
                                 "fexp:",    "timed out",         "cannot open"};
  constexpr std::size_t most = 3;
  std::vector<std::string> lines = telling_lines(output), better;
  std::ranges::copy_if(lines, std::back_inserter(better), [&](const std::string& line) {
    return std::ranges::any_of(of_agents, [&](const char* text) { return line.find(text) != line.npos; });
  });
  if (!better.empty()) {
    lines = std::move(better);
  }
  lines.erase(lines.begin(), lines.end() - static_cast<std::ptrdiff_t>(std::min(most, lines.size())));
  return fmt::format("{}", fmt::join(lines, " | "));
}

/// Whether the signal comes from a user or from the system, rather than from an error of the program.
bool is_from_outside(std::optional<int> signal) {
  const int number = signal.value_or(0);
  return number == SIGKILL || number == SIGTERM;
}

}  // namespace

std::vector<std::string> split_words(std::string_view text) {
  std::istringstream stream{std::string(text)};
  std::vector<std::string> words;
  for (std::string word; stream >> word;) {
    words.push_back(word);
  }
  return words;
}

std::string agent_or_ssh(std::string_view agent) {
  return agent.empty() || agent == "ssh" ? "ssh -o BatchMode=yes -o ConnectTimeout=5" : std::string(agent);
}

std::vector<std::string> mpirun_command(const WorldLaunch& launch) {
  std::vector<std::string> words{"mpirun", "--oversubscribe", "--bind-to", "none"};
  const std::vector<std::string> more = split_words(launch.options);
  const auto set = [&](const std::string& parameter, const std::string& value) {
    // mpirun refuses a parameter that is set twice, so the user's setting replaces ours.
    if (std::ranges::find(more, parameter) == more.end()) {
      words.insert(words.end(), {"--mca", parameter, value});
    }
  };
  set("plm", "rsh");
  set("plm_rsh_agent", agent_or_ssh(launch.agent));
  set("plm_rsh_no_tree_spawn", "1");
  set("mpi_yield_when_idle", "1");
  // When a rank has died the others cannot end in order, so mpirun need not wait a second on every machine in turn.
  set("odls_base_sigkill_timeout", "0");
  words.insert(words.end(), more.begin(), more.end());
  for (std::size_t rank = 0; rank < launch.ranks.size(); ++rank) {
    const Machine& machine = launch.ranks[rank];
    if (rank > 0) {
      words.emplace_back(":");
    }
    words.insert(words.end(), {"-np", "1", "--host", machine.address, "-x", "FEXP_HOST=" + machine.name, "-x",
                               fmt::format("FEXP_WORLD={}", launch.world)});
    words.insert(words.end(), launch.worker.begin(), launch.worker.end());
    words.insert(words.end(), {"worker", "--run-id", launch.run_id, "--world", std::to_string(launch.world), "--socket",
                               launch.socket});
    const int threads = launch.threads > 0 ? launch.threads : machine.slots;
    if (threads > 0) {
      words.insert(words.end(), {"--threads", std::to_string(threads)});
    }
    if (launch.writer_only) {
      words.emplace_back("--writer-only");
    }
  }
  return words;
}

std::vector<std::string> remote_command(std::string_view agent, const Machine& machine, bool is_own,
                                        const std::vector<std::string>& words) {
  if (is_own) {
    return words;
  }
  std::vector<std::string> command = split_words(agent_or_ssh(agent));
  std::string line;
  for (const std::string& word : words) {
    line += (line.empty() ? "" : " ") + quoted_word(word);
  }
  command.insert(command.end(), {machine.address, line});
  return command;
}

LaunchFailure explain_launch_failure(std::string_view output, std::string_view status,
                                     const std::vector<Machine>& ranks) {
  LaunchFailure failure;
  const auto name_of = [&](int rank) {
    return rank >= 0 && static_cast<std::size_t>(rank) < ranks.size() ? ranks[static_cast<std::size_t>(rank)].name
                                                                      : std::string("an unknown machine");
  };
  const std::string last = last_words(output);
  if (const auto rank = number_after(output, "noticed that process rank ")) {
    failure.killed = is_from_outside(number_after(output, "exited on signal "));
    failure.rank = rank;
    failure.words = fmt::format("the worker on {} was ended by signal {}", name_of(*rank),
                                between(output, "exited on signal ", "."));
  } else if (const auto code = number_after(output, "Exit code:")) {
    failure.rank = number_after(between(output, "Process name: [[", "\n"), "],");
    failure.words = fmt::format("the worker on {} ended with exit code {}", name_of(failure.rank.value_or(-1)), *code);
    const std::size_t own = last.find("fexp:");
    failure.words += own == last.npos ? "" : ": " + last.substr(own);
  } else {
    failure.killed = is_from_outside(number_after(status, "signal "));
    failure.words = fmt::format("mpirun ended ({}){}{}", status, last.empty() ? "" : ": ", last);
  }
  return failure;
}

}  // namespace fexp::coordinator
