// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "coordinator/machine.hpp"
#include "coordinator/mpirun_command.hpp"
#include "coordinator/places.hpp"
#include "coordinator/probe.hpp"

namespace fexp::coordinator {

namespace {

Machine parsed(const std::string& text) {
  ErrorList errors;
  Machine machine = parse_machine(text, {}, errors);
  EXPECT_TRUE(errors.empty()) << text;
  return machine;
}

std::size_t errors_of(const std::string& text) {
  ErrorList errors;
  static_cast<void>(parse_machines(text, "hosts", errors));
  return errors.size();
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    text += word + " ";
  }
  return text;
}

WorldLaunch two_ranks() {
  return {"0123456789abcdef", 7, {{"c1", "localhost", 0}, {"c2", "node2", 4}}, false, "/run/s.sock", 0, "", "",
          {"/usr/bin/fexp"}};
}

}  // namespace

TEST(machine, is_written_in_four_ways) {
  EXPECT_EQ(parsed("node1"), (Machine{"node1", "node1", 0}));
  EXPECT_EQ(parsed("node1:8"), (Machine{"node1", "node1", 8}));
  EXPECT_EQ(parsed("c2=localhost"), (Machine{"c2", "localhost", 0}));
  EXPECT_EQ(parsed("c2=10.0.0.2:4"), (Machine{"c2", "10.0.0.2", 4}));
  EXPECT_EQ(parsed("c3=fe80::1"), (Machine{"c3", "fe80::1", 0})) << "the colons of an address are no slots";
}

TEST(machine, is_read_back_from_its_text) {
  for (const char* text : {"node1", "node1:8", "c2=localhost", "c2=10.0.0.2:4"}) {
    EXPECT_EQ(to_text(parsed(text)), text);
  }
}

TEST(machine, hosts_files_are_those_of_mpirun) {
  ErrorList errors;
  const auto machines = parse_machines(
      "# all of them\nnode1 slots=4 max_slots=8\n\n  node2\t# plain\nnode3 cpus=2\r\nnode1 slots=2\nnode2\nc=node4:3",
      "hosts", errors);
  EXPECT_TRUE(errors.empty());
  EXPECT_EQ(machines, (std::vector<Machine>{
                          {"node1", "node1", 6}, {"node2", "node2", 2}, {"node3", "node3", 2}, {"c", "node4", 3}}));
}

TEST(machine, what_cannot_be_a_machine_is_refused) {
  for (const char* text : {"../x", "no/de", ".hidden", "-oProxyCommand=x", "a=", "=b", "a:0", "a:x", "user@node", "a b",
                           "node slots=0", "node slots=many", "node slots", "a=x\na=y", "_writer"}) {
    EXPECT_EQ(errors_of(text), 1U) << text;
  }
}

TEST(mpirun_command, has_an_application_context_for_each_rank_with_its_machines_name) {
  const std::string command = joined(mpirun_command(two_ranks()));
  EXPECT_NE(command.find("-np 1 --host localhost -x FEXP_HOST=c1 -x FEXP_WORLD=7 /usr/bin/fexp worker --run-id "
                         "0123456789abcdef --world 7 --socket /run/s.sock : -np 1 --host node2 -x FEXP_HOST=c2 -x "
                         "FEXP_WORLD=7 /usr/bin/fexp worker --run-id 0123456789abcdef --world 7 --socket /run/s.sock "
                         "--threads 4 "),
            std::string::npos)
      << command;
  EXPECT_EQ(command.find("--writer-only"), std::string::npos);
}

TEST(mpirun_command, takes_threads_of_the_user_before_slots) {
  WorldLaunch launch = two_ranks();
  launch.threads = 2;
  const auto command = mpirun_command(launch);
  EXPECT_EQ(std::ranges::count(command, "--threads"), 2);
  EXPECT_EQ(std::ranges::count(command, "2"), 2);
}

TEST(mpirun_command, tells_every_rank_that_rank_0_only_writes) {
  WorldLaunch launch = two_ranks();
  launch.writer_only = true;
  EXPECT_EQ(std::ranges::count(mpirun_command(launch), "--writer-only"), 2);
}

TEST(mpirun_command, leaves_a_parameter_to_the_user_who_sets_it) {
  WorldLaunch launch = two_ranks();
  launch.agent = "/opt/agent -v";
  launch.options = "--mca mpi_yield_when_idle 0  --mca btl tcp,self";
  const auto command = mpirun_command(launch);
  EXPECT_EQ(std::ranges::count(command, "mpi_yield_when_idle"), 1);
  EXPECT_NE(joined(command).find("--mca mpi_yield_when_idle 0 --mca btl tcp,self"), std::string::npos);
  EXPECT_EQ(std::ranges::count(command, "/opt/agent -v"), 1) << "one word of mpirun's, taken apart by mpirun";
}

TEST(remote_command, is_one_line_for_the_shell_at_the_other_end) {
  EXPECT_EQ(remote_command("/opt/agent -v", {"c2", "node2", 0}, false, {"fexp", "it's", "$HOME"}),
            (std::vector<std::string>{"/opt/agent", "-v", "node2", "'fexp' 'it'\\''s' '$HOME'"}));
  EXPECT_EQ(remote_command("/opt/agent", {"c1", "localhost", 0}, true, {"fexp", "$HOME"}),
            (std::vector<std::string>{"fexp", "$HOME"}));
  EXPECT_EQ(remote_command("", {"c2", "node2", 0}, false, {"fexp"}).front(), "ssh");
}

TEST(launch_failure, names_the_machine_whose_rank_was_killed) {
  const LaunchFailure failure = explain_launch_failure(
      "------\nmpirun noticed that process rank 1 with PID 0 on node c2 exited on signal 9 (Killed).\n------\n",
      "exit code 137", two_ranks().ranks);
  EXPECT_EQ(failure.rank, 1);
  EXPECT_EQ(failure.words, "the worker on c2 was ended by signal 9 (Killed)");
  EXPECT_TRUE(failure.killed);
}

TEST(launch_failure, tells_a_worker_that_failed_from_one_that_was_killed) {
  const LaunchFailure failure = explain_launch_failure(
      "mpirun noticed that process rank 0 with PID 0 on node c1 exited on signal 11 (Segmentation fault).\n",
      "exit code 139", two_ranks().ranks);
  EXPECT_FALSE(failure.killed);
  EXPECT_TRUE(explain_launch_failure("", "signal 9", {}).killed);
  EXPECT_FALSE(explain_launch_failure("", "exit code 1", {}).killed);
}

TEST(launch_failure, tells_the_workers_own_words) {
  const LaunchFailure failure = explain_launch_failure(
      "fexp: cannot read the deck\nfexp: cannot read the deck\n------\nPrimary job  terminated normally, but 1 process "
      "returned\na non-zero exit "
      "code. Per user-direction, the job has been aborted.\n------\n-----\nmpirun detected that one or more processes "
      "exited with non-zero status, thus causing\nthe job to be terminated. The first process to do so was:\n\n  "
      "Process name: [[18083,1],0]\n  Exit code:    7\n-----\n",
      "exit code 7", two_ranks().ranks);
  EXPECT_EQ(failure.rank, 0);
  EXPECT_EQ(failure.words, "the worker on c1 ended with exit code 7: fexp: cannot read the deck");
}

TEST(launch_failure, tells_the_launch_agents_own_words) {
  const LaunchFailure failure = explain_launch_failure(
      "ssh: connect to host node2 port 22: No route to host\n-----\nORTE was unable to reliably start one or more "
      "daemons.\nThis usually is caused by:\n\n* not finding the required libraries\n-----\n",
      "exit code 1", two_ranks().ranks);
  EXPECT_FALSE(failure.rank);
  EXPECT_EQ(failure.words, "mpirun ended (exit code 1): ssh: connect to host node2 port 22: No route to host");
}

TEST(launch_failure, says_how_mpirun_ended_when_it_said_nothing) {
  EXPECT_EQ(explain_launch_failure("", "signal 9", {}).words, "mpirun ended (signal 9)");
}

TEST(probe, knows_a_worker_of_the_run_by_its_command_line_and_nobody_else) {
  const std::string id = "0123456789abcdef";
  const auto world = [&](const std::vector<std::string>& words) { return world_of_worker(words, id); };
  EXPECT_EQ(world({"/usr/bin/fexp", "worker", "--run-id", id, "--world", "12", "--socket", "s"}), 12);
  EXPECT_FALSE(world({"/usr/bin/fexp", "probe", "--run-id", id, "--world", "12"}));
  EXPECT_FALSE(world({"/usr/bin/fexp", "worker", "--run-id", "0123456789abcdee", "--world", "12"}));
  EXPECT_FALSE(world({"/usr/bin/fexp", "worker", "--run-id", id, "--world", "x"}));
  EXPECT_FALSE(world({"grep", "worker --run-id " + id + " --world 12"}));
  EXPECT_FALSE(world({"worker", "--run-id", id, "--world"}));
  EXPECT_FALSE(world({}));
}

TEST(probe, an_answer_is_found_behind_what_a_shell_prints) {
  Probe probe;
  probe.version = "1.0";
  probe.machine = "c1";
  probe.has_mpi = true;
  probe.heartbeat_age = 0.25;
  probe.snapshots = {"a", "b"};
  const auto read = read_probe("Welcome {to} node\n" + to_json(probe).dump() + "\n");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->version, "1.0");
  EXPECT_EQ(read->heartbeat_age, 0.25);
  EXPECT_EQ(read->snapshots, probe.snapshots);
  EXPECT_TRUE(read->has_mpi);
  EXPECT_FALSE(read_probe("command not found"));
  EXPECT_FALSE(read_probe("{\"version\": 3}"));
  EXPECT_FALSE(read_probe(""));
}

TEST(places, ids_of_runs_differ_and_are_known) {
  const std::string id = new_run_id();
  EXPECT_TRUE(is_run_id(id));
  EXPECT_NE(id, new_run_id());
  EXPECT_FALSE(is_run_id("../../etc/passwd"));
  EXPECT_FALSE(is_run_id(""));
}

TEST(places, this_machine_is_known_by_its_names_and_numbers) {
  EXPECT_TRUE(is_own_address("localhost"));
  EXPECT_TRUE(is_own_address("127.0.0.1"));
  EXPECT_TRUE(is_own_address("::1"));
  EXPECT_TRUE(is_own_address(own_name()));
  EXPECT_FALSE(is_own_address("no-such-machine"));
  EXPECT_FALSE(is_own_address("192.0.2.77"));
}

}  // namespace fexp::coordinator
