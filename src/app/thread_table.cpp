// SPDX-License-Identifier: Apache-2.0
#include "app/thread_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "io/history.hpp"

namespace fexp::app {

namespace {

using coordinator::MachineThreads;
using coordinator::WorldRecord;
using coordinator::WorldThreads;

bool alike(const WorldThreads& a, const WorldThreads& b) {
  return std::ranges::equal(a.machines, b.machines, [](const MachineThreads& one, const MachineThreads& other) {
    return one.machine == other.machine && one.computing == other.computing && one.running == other.running;
  });
}

std::string row_text(const WorldRecord& world) {
  const WorldThreads& threads = world.threads;
  int running = threads.coordinator + threads.mpirun + threads.launch_agents, computing = 0;
  std::string text =
      fmt::format("  {:<7}{:<33}", world.world,
                  fmt::format("{} + {} + {}", threads.coordinator, threads.mpirun, threads.launch_agents));
  std::string machines;
  for (const MachineThreads& one : threads.machines) {
    machines += fmt::format("  {} {} / {} / {}", one.machine, one.native, one.running, one.computing);
    running += one.running;
    computing += one.computing;
  }
  return text + fmt::format("{:<18}", fmt::format("{} / {}", running, computing)) + machines + "\n";
}

}  // namespace

std::string thread_table(const coordinator::ClusterRecord& record) {
  std::string text =
      "  world  coordinator + mpirun + agents    run / compute       machine native / run / compute, in threads\n";
  const WorldThreads* before = nullptr;
  for (const WorldRecord& world : record.worlds) {
    if (!world.threads.machines.empty() && (before == nullptr || !alike(*before, world.threads))) {
      text += row_text(world);
      before = &world.threads;
    }
  }
  return before == nullptr ? "" : text;
}

void write_thread_table(const io::RunDirectory& directory, const coordinator::ClusterRecord& record) {
  io::CsvWriter csv(directory.history("threads"),
                    {{"world", ""}, {"process", ""}, {"native", ""}, {"running", ""}, {"computing", ""}});
  const std::int64_t none = 0;
  for (const WorldRecord& world : record.worlds) {
    const WorldThreads& threads = world.threads;
    if (threads.machines.empty()) {
      continue;
    }
    const std::int64_t number = world.world;
    csv.row({number, std::string_view("coordinator"), none, std::int64_t{threads.coordinator}, none});
    csv.row({number, std::string_view("mpirun"), none, std::int64_t{threads.mpirun}, none});
    csv.row({number, std::string_view("launch agents"), none, std::int64_t{threads.launch_agents}, none});
    for (const MachineThreads& one : threads.machines) {
      csv.row({number, std::string_view(one.machine), std::int64_t{one.native}, std::int64_t{one.running},
               std::int64_t{one.computing}});
    }
  }
  csv.close();
}

}  // namespace fexp::app
