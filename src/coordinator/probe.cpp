// SPDX-License-Identifier: Apache-2.0
#include "coordinator/probe.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>
#include <thread>

#include "coordinator/places.hpp"

namespace fexp::coordinator {

namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

/// As far as it can be read: a process may end in between.
std::string text_of(const fs::path& path) {
  const std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Words that end with a zero each.
std::vector<std::string> words_of(const fs::path& path) {
  std::istringstream text(text_of(path));
  std::vector<std::string> words;
  for (std::string word; std::getline(text, word, '\0');) {
    words.push_back(word);
  }
  return words;
}

std::optional<int> number_of(std::string_view text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size() && !text.empty() ? std::optional(number)
                                                                                   : std::nullopt;
}

std::vector<std::string> command_line_of(const fs::path& process) { return words_of(process / "cmdline"); }

struct ProcessState {
  char letter{' '};  ///< As ps prints it
  pid_t parent{};
};

ProcessState state_of(const fs::path& process) {
  const std::string stat = text_of(process / "stat");
  // "id (name) state parent ..."; the name may hold anything.
  std::istringstream rest(stat.substr(std::min(stat.rfind(')') + 1, stat.size())));
  ProcessState state;
  rest >> state.letter >> state.parent;
  return state;
}

/// The process above, if it is a launch daemon of this user.
std::optional<pid_t> daemon_above(const fs::path& process) {
  const pid_t parent = state_of(process).parent;
  struct stat owner {};
  const fs::path above = "/proc/" + std::to_string(parent);
  const bool is_ours = ::stat(above.c_str(), &owner) == 0 && owner.st_uid == getuid();
  return is_ours && text_of(above / "comm") == "orted\n" ? std::optional(parent) : std::nullopt;
}

struct Found {
  std::vector<pid_t> workers;
  std::vector<pid_t> daemons;
};

Found find_workers(const ProbeRequest& request) {
  Found found;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator("/proc", error)) {
    const std::optional<int> id = number_of(entry.path().filename().string());
    struct stat owner {};
    if (!id || *id == getpid() || ::stat(entry.path().c_str(), &owner) != 0 || owner.st_uid != getuid()) {
      continue;
    }
    const auto world = world_of_worker(command_line_of(entry.path()), request.run_id);
    if (world && *world < request.kill_below.value_or(0)) {
      found.workers.push_back(*id);
      if (const auto above = daemon_above(entry.path())) {
        found.daemons.push_back(*above);
      }
    }
  }
  return found;
}

/// Whether a worker of the run that goes by this machine's name lives here and has not been stopped.
bool find_own_worker(const ProbeRequest& request) {
  const std::string host = "FEXP_HOST=" + request.machine;
  std::error_code error;
  return std::ranges::any_of(fs::directory_iterator("/proc", error), [&](const fs::directory_entry& entry) {
    if (!number_of(entry.path().filename().string()) ||
        !world_of_worker(command_line_of(entry.path()), request.run_id) || state_of(entry.path()).letter == 'T') {
      return false;
    }
    const std::vector<std::string> variables = words_of(entry.path() / "environ");
    return std::ranges::find(variables, host) != variables.end();
  });
}

int kill_workers(const ProbeRequest& request) {
  constexpr int most_rounds = 100;
  int killed = 0;
  for (int round = 0; round < most_rounds; ++round) {
    const Found found = find_workers(request);
    for (const std::vector<pid_t>& processes : {found.workers, found.daemons}) {
      for (const pid_t process : processes) {
        static_cast<void>(kill(process, SIGKILL));
      }
    }
    if (found.workers.empty()) {
      break;
    }
    killed = std::max(killed, static_cast<int>(found.workers.size()));
    std::this_thread::sleep_for(10ms);
  }
  return killed;
}

std::int64_t free_memory() {
  std::ifstream file("/proc/meminfo");
  constexpr std::int64_t unit = 1024;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string key;
    std::int64_t count = 0;
    if (words >> key >> count && key == "MemAvailable:") {
      return count * unit;
    }
  }
  return 0;
}

bool is_in_path(const char* program) {
  const char* path = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe)
  std::istringstream folders(path != nullptr ? path : "/usr/local/bin:/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (access((fs::path(folder) / program).c_str(), X_OK) == 0) {
      return true;
    }
  }
  return false;
}

std::optional<double> age_of(const fs::path& path) {
  struct stat found {};
  timespec now{};
  if (::stat(path.c_str(), &found) != 0 || clock_gettime(CLOCK_REALTIME, &now) != 0) {
    return std::nullopt;
  }
  constexpr double nano = 1.0e-9;
  return std::max(0.0, static_cast<double>(now.tv_sec - found.st_mtim.tv_sec) +
                           nano * static_cast<double>(now.tv_nsec - found.st_mtim.tv_nsec));
}

}  // namespace

std::optional<int> world_of_worker(const std::vector<std::string>& words, std::string_view run_id) {
  constexpr std::ptrdiff_t length = 5;
  for (auto word = words.begin(); words.end() - word >= length; ++word) {
    if (word[0] == "worker" && word[1] == "--run-id" && word[2] == run_id && word[3] == "--world") {
      return number_of(word[4]);
    }
  }
  return std::nullopt;
}

Probe probe_here(const ProbeRequest& request, std::string_view kernel) {
  Probe probe;
  if (request.kill_below) {
    probe.killed = kill_workers(request);
  }
  std::error_code error;
  if (request.forget) {
    fs::remove_all(machine_memory(request.run_id, request.machine), error);
    fs::remove(run_memory(request.run_id), error);  // Only when no other machine's folder is in it
  }
  probe.has_worker = find_own_worker(request);
  probe.version = FEXP_VERSION;
  probe.kernel = kernel;
  probe.machine = request.machine;
  probe.system_name = own_name();
  probe.has_mpi = is_in_path("orted");
  probe.threads = static_cast<int>(std::thread::hardware_concurrency());
  probe.memory_free = free_memory();
  probe.heartbeat_age = age_of(heartbeat_file(request.run_id, request.machine));
  for (const fs::directory_entry& entry :
       fs::directory_iterator(snapshot_folder(request.run_id, request.machine), error)) {
    probe.snapshots.push_back(entry.path().filename().string());
  }
  std::ranges::sort(probe.snapshots);
  return probe;
}

nlohmann::json to_json(const Probe& probe) {
  nlohmann::json json{{"version", probe.version},         {"kernel", probe.kernel},    {"machine", probe.machine},
                      {"system_name", probe.system_name}, {"mpi", probe.has_mpi},      {"threads", probe.threads},
                      {"memory_free", probe.memory_free}, {"alive_age_s", nullptr},    {"snapshots", probe.snapshots},
                      {"killed", probe.killed},           {"worker", probe.has_worker}};
  if (probe.heartbeat_age) {
    json["alive_age_s"] = *probe.heartbeat_age;
  }
  return json;
}

std::optional<Probe> read_probe(std::string_view text) {
  const std::size_t begin = text.rfind("\n{") == text.npos ? text.find('{') : text.rfind("\n{");
  if (begin == text.npos) {
    return std::nullopt;
  }
  try {
    const nlohmann::json json = nlohmann::json::parse(text.substr(begin));
    Probe probe;
    probe.version = json.at("version");
    probe.machine = json.at("machine");
    probe.kernel = json.value("kernel", "");
    probe.system_name = json.value("system_name", "");
    probe.has_mpi = json.value("mpi", false);
    probe.threads = json.value("threads", 0);
    probe.memory_free = json.value("memory_free", std::int64_t{0});
    if (json.at("alive_age_s").is_number()) {
      probe.heartbeat_age = json.at("alive_age_s").get<double>();
    }
    probe.snapshots = json.value("snapshots", std::vector<std::string>{});
    probe.killed = json.value("killed", 0);
    probe.has_worker = json.value("worker", true);
    return probe;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

}  // namespace fexp::coordinator
