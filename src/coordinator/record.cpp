// SPDX-License-Identifier: Apache-2.0
#include "coordinator/record.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "base/errors.hpp"
#include "io/atomic_file.hpp"
#include "io/output_error.hpp"

namespace fexp::coordinator {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int format_version = 1;

Json machine_json(const Machine& machine) {
  return {{"name", machine.name}, {"address", machine.address}, {"slots", machine.slots}};
}

Machine machine_of(const Json& json) { return {json.at("name"), json.at("address"), json.at("slots")}; }

Json machines_json(const std::vector<Machine>& machines) {
  Json json = Json::array();
  for (const Machine& machine : machines) {
    json.push_back(machine_json(machine));
  }
  return json;
}

std::vector<Machine> machines_of(const Json& json) {
  std::vector<Machine> machines;
  for (const Json& machine : json) {
    machines.push_back(machine_of(machine));
  }
  return machines;
}

Json options_json(const ClusterOptions& options) {
  return {{"deck", options.deck},
          {"hosts", options.hosts},
          {"discover", options.script},
          {"agent", options.agent},
          {"mpirun", options.mpirun},
          {"threads", options.threads},
          {"quiet", options.quiet},
          {"hash_every", options.hash_every},
          {"checkpoint_seconds", options.checkpoint_seconds},
          {"placement", options.placement}};
}

ClusterOptions options_of(const Json& json) {
  ClusterOptions options;
  options.deck = json.at("deck");
  options.hosts = json.at("hosts");
  options.script = json.at("discover");
  options.agent = json.at("agent");
  options.mpirun = json.at("mpirun");
  options.threads = json.at("threads");
  options.quiet = json.at("quiet");
  options.hash_every = json.at("hash_every");
  options.checkpoint_seconds = json.at("checkpoint_seconds");
  options.placement = json.at("placement");
  return options;
}

Json threads_json(const WorldThreads& threads) {
  Json machines = Json::array();
  for (const MachineThreads& one : threads.machines) {
    machines.push_back(
        {{"name", one.machine}, {"native", one.native}, {"running", one.running}, {"computing", one.computing}});
  }
  return {{"machines", std::move(machines)},
          {"coordinator", threads.coordinator},
          {"mpirun", threads.mpirun},
          {"launch_agents", threads.launch_agents}};
}

WorldThreads threads_of(const Json& json) {
  WorldThreads threads;
  for (const Json& one : json.at("machines")) {
    threads.machines.push_back({one.at("name"), one.at("native"), one.at("running"), one.at("computing")});
  }
  threads.coordinator = json.at("coordinator");
  threads.mpirun = json.at("mpirun");
  threads.launch_agents = json.at("launch_agents");
  return threads;
}

ClusterRecord record_of(const Json& json) {
  ClusterRecord record;
  record.run_id = json.at("run_id");
  record.options = options_of(json.at("options"));
  record.machines = machines_of(json.at("machines"));
  record.listed = machines_of(json.at("listed"));
  for (const Json& event : json.at("events")) {
    record.events.push_back({event.at("step"), event.at("add"), machine_of(event.at("machine")), event.at("applied")});
  }
  for (const Json& world : json.at("worlds")) {
    record.worlds.push_back({world.at("world"), world.at("machines"), world.at("started"), world.at("ended"),
                             threads_of(world.at("threads"))});
  }
  record.state = json.at("state");
  record.message = json.at("message");
  record.host = json.at("coordinator").at("host");
  record.pid = json.at("coordinator").at("pid");
  record.socket = json.at("coordinator").at("socket");
  return record;
}

}  // namespace

fs::path record_file(const fs::path& run) { return run / "cluster.json"; }

nlohmann::ordered_json to_json(const ClusterRecord& record) {
  Json events = Json::array(), worlds = Json::array();
  for (const StepEvent& event : record.events) {
    events.push_back({{"step", event.step},
                      {"add", event.add},
                      {"machine", machine_json(event.machine)},
                      {"applied", event.applied}});
  }
  for (const WorldRecord& world : record.worlds) {
    worlds.push_back({{"world", world.world},
                      {"machines", world.machines},
                      {"started", world.started},
                      {"ended", world.ended},
                      {"threads", threads_json(world.threads)}});
  }
  return {{"format", format_version},
          {"run_id", record.run_id},
          {"state", record.state},
          {"message", record.message},
          {"coordinator", {{"host", record.host}, {"pid", record.pid}, {"socket", record.socket}}},
          {"options", options_json(record.options)},
          {"machines", machines_json(record.machines)},
          {"listed", machines_json(record.listed)},
          {"events", std::move(events)},
          {"worlds", std::move(worlds)}};
}

void write_record(const fs::path& run, const ClusterRecord& record) {
  io::write_atomically(record_file(run), to_json(record).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

ClusterRecord read_record(const fs::path& run) {
  const std::string path = record_file(run).string();
  ErrorList errors;
  ClusterRecord record;
  try {
    const Json json = Json::parse(io::read_whole(path));
    record = record_of(json);
  } catch (const io::OutputError& error) {
    errors.add({path}, error.message(), "the directory of a run that \"fexp cluster run\" began",
               "name that directory");
  } catch (const nlohmann::json::exception& error) {
    errors.add({path}, std::string("cannot be understood: ") + error.what(),
               "a file that this version of fexp has written", "begin the run anew with \"fexp cluster run\"");
  }
  errors.throw_if_any();
  return record;
}

RunLock::RunLock(const fs::path& run) {
  const fs::path path = run / "cluster.lock";
  constexpr mode_t mode = 0600;
  descriptor_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, mode);  // NOLINT(cppcoreguidelines-pro-type-vararg)
  if (descriptor_ < 0) {
    throw io::OutputError(path, "cannot be opened: " + std::generic_category().message(errno),
                          "choose a directory that you may write to");
  }
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    const int error = errno;
    close(descriptor_);
    if (error != EWOULDBLOCK) {
      throw io::OutputError(path, "cannot be locked: " + std::generic_category().message(error),
                            "choose a directory on a file system with locks");
    }
    ErrorList errors;
    errors.add({run.string()}, "the coordinator of this run is alive", "",
               "see \"fexp cluster status\"; end the run with \"fexp cluster stop\"");
    errors.throw_if_any();
  }
}

RunLock::RunLock(RunLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

RunLock::~RunLock() {
  if (descriptor_ >= 0) {
    close(descriptor_);
  }
}

}  // namespace fexp::coordinator
