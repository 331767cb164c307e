// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/errors.hpp"
#include "coordinator/control_channel.hpp"
#include "coordinator/control_server.hpp"
#include "coordinator/host_source.hpp"
#include "coordinator/places.hpp"
#include "coordinator/record.hpp"
#include "io/output_error.hpp"
#include "support/temporary_directory.hpp"

namespace fexp::coordinator {

namespace {

namespace fs = std::filesystem;

std::vector<ControlServer::Message> wait_for(ControlServer& server, std::size_t count) {
  std::vector<ControlServer::Message> messages;
  for (int k = 0; k < 1000 && messages.size() < count; ++k) {
    for (auto& message : server.receive()) {
      messages.push_back(std::move(message));
    }
  }
  return messages;
}

}  // namespace

TEST(control_channel, carries_messages_both_ways_whole_and_in_order) {
  const test::TemporaryDirectory folder;
  ControlServer server(folder.path() / "run" / "s.sock");
  ControlClient client(folder.path() / "run" / "s.sock", 3);
  EXPECT_FALSE(client.poll());
  const std::string large(300000, 'x');  // More than a socket takes at once
  client.send({{"event", "status"}, {"text", large}});
  client.send({{"event", "ended"}});
  std::vector<ControlServer::Message> messages;
  for (int k = 0; k < 1000 && messages.size() < 3; ++k) {
    EXPECT_FALSE(client.poll()) << "it sends what waits, and nothing has come";
    for (auto& message : server.receive()) {
      messages.push_back(std::move(message));
    }
  }
  ASSERT_EQ(messages.size(), 3U);
  EXPECT_EQ(messages[0].content, (nlohmann::json{{"hello", "world"}, {"world", 3}}));
  EXPECT_EQ(messages[1].content.at("text"), large);
  EXPECT_EQ(messages[2].content.at("event"), "ended");
  server.send(messages[0].client, {{"command", "reform"}});
  server.send(messages[0].client, {{"command", "stop"}});
  EXPECT_EQ(client.wait(5.0), (nlohmann::json{{"command", "reform"}}));
  EXPECT_EQ(client.poll(), (nlohmann::json{{"command", "stop"}}));
  EXPECT_FALSE(client.lost());
}

TEST(control_channel, a_client_knows_that_the_coordinator_is_gone) {
  const test::TemporaryDirectory folder;
  const fs::path socket = folder.path() / "run" / "s.sock";
  EXPECT_TRUE(ControlClient(socket, 1).lost());
  auto server = std::make_unique<ControlServer>(socket);
  ControlClient client(socket, 1);
  ASSERT_EQ(wait_for(*server, 1).size(), 1U);
  server.reset();
  EXPECT_FALSE(client.poll());
  EXPECT_TRUE(client.lost());
  client.send({{"event", "status"}});
  EXPECT_FALSE(fs::exists(socket));
}

TEST(control_channel, what_a_client_said_before_it_left_is_heard) {
  const test::TemporaryDirectory folder;
  ControlServer server(folder.path() / "run" / "s.sock");
  {
    ControlClient client(folder.path() / "run" / "s.sock", 1);
    client.send({{"event", "ended"}});
  }
  EXPECT_EQ(wait_for(server, 2).size(), 2U);
  static_cast<void>(server.receive());
  EXPECT_EQ(server.take_left().size(), 1U);
}

TEST(control_channel, text_that_is_no_message_ends_the_connection) {
  const test::TemporaryDirectory folder;
  ControlServer server(folder.path() / "run" / "s.sock");
  auto client = connect_to(folder.path() / "run" / "s.sock");
  ASSERT_TRUE(client);
  client->send(nlohmann::json::array({1, 2}));
  EXPECT_TRUE(wait_for(server, 1).empty());
  EXPECT_EQ(server.take_left().size(), 1U);
}

TEST(control_channel, the_socket_is_closed_to_others) {
  const test::TemporaryDirectory folder;
  const ControlServer server(folder.path() / "run" / "s.sock");
  struct stat found {};
  ASSERT_EQ(stat((folder.path() / "run").c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 0777U, 0700U);
  ASSERT_EQ(stat((folder.path() / "run" / "s.sock").c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 0777U, 0600U);
  fs::create_directory(folder.path() / "open");
  ASSERT_EQ(chmod((folder.path() / "open").c_str(), 0755), 0);
  EXPECT_THROW(ControlServer(folder.path() / "open" / "s.sock"), io::OutputError);
  EXPECT_THROW(ControlServer(folder.path() / std::string(120, 'x') / "s.sock"), io::OutputError);
}

TEST(cluster_record, is_read_back_as_it_was_written) {
  const test::TemporaryDirectory folder;
  ClusterRecord record;
  record.run_id = "0123456789abcdef";
  record.options = {"/d/deck.toml", "/d/hosts", "", "agent -v", "--mca a b", 3, 7, 60.0, "cost", true};
  record.machines = {{"c1", "localhost", 2}};
  record.listed = {{"c1", "localhost", 2}, {"c2", "far", 0}};
  record.events = {{50, true, {"c3", "far3", 0}, true}};
  record.worlds = {{4, {"c1=localhost:2"}, "today", "reform", {{{"c1", 8, 5, 2}}, 3, 1, 0}}};
  record.state = "stopped";
  record.pid = 42;
  write_record(folder.path(), record);
  const ClusterRecord read = read_record(folder.path());
  EXPECT_EQ(to_json(read), to_json(record));
  EXPECT_EQ(read.next_world(), 5);
  EXPECT_EQ(ClusterRecord{}.next_world(), 1);
}

TEST(cluster_record, a_directory_without_one_is_refused) {
  const test::TemporaryDirectory folder;
  EXPECT_THROW(static_cast<void>(read_record(folder.path())), InputErrors);
  std::ofstream(record_file(folder.path())) << "{\"format\": 1}";
  EXPECT_THROW(static_cast<void>(read_record(folder.path())), InputErrors);
}

TEST(cluster_record, the_lock_of_a_run_is_held_by_one) {
  const test::TemporaryDirectory folder;
  {
    const RunLock lock(folder.path());
    EXPECT_THROW(RunLock(folder.path()), InputErrors);
  }
  EXPECT_NO_THROW(RunLock(folder.path()));
}

TEST(host_source, takes_a_file_that_has_stopped_changing) {
  const test::TemporaryDirectory folder;
  const fs::path file = folder.path() / "hosts";
  std::ofstream(file) << "a\n";
  HostSource source(file, "");
  std::string complaint;
  ASSERT_TRUE(source.look(0.0, complaint));
  EXPECT_FALSE(source.look(1.0, complaint));
  std::ofstream(file) << "a\nb\n";
  EXPECT_FALSE(source.look(2.0, complaint)) << "an editor may still be writing";
  const auto list = source.look(3.0, complaint);
  ASSERT_TRUE(list);
  EXPECT_EQ(list->size(), 2U);
  EXPECT_EQ(complaint, "");
}

TEST(host_source, a_wrong_or_missing_file_changes_nothing_and_is_told_once) {
  const test::TemporaryDirectory folder;
  const fs::path file = folder.path() / "hosts";
  std::ofstream(file) << "a\n";
  HostSource source(file, "");
  std::string complaint;
  ASSERT_TRUE(source.look(0.0, complaint));
  std::ofstream(file) << "a slots=x\n";
  EXPECT_FALSE(source.look(1.0, complaint));
  EXPECT_FALSE(source.look(2.0, complaint));
  EXPECT_NE(complaint.find("slots=x"), std::string::npos) << complaint;
  complaint.clear();
  fs::remove(file);
  EXPECT_FALSE(source.look(3.0, complaint));
  EXPECT_NE(complaint.find("stays in force"), std::string::npos) << complaint;
  complaint.clear();
  EXPECT_FALSE(source.look(4.0, complaint));
  EXPECT_EQ(complaint, "");
}

TEST(host_source, a_script_that_fails_is_told_with_its_own_words) {
  const test::TemporaryDirectory folder;
  const fs::path script = folder.path() / "discover";
  const auto write = [&](const char* text) {
    std::ofstream(script) << "#!/bin/sh\n" << text << "\n";
    ASSERT_EQ(chmod(script.c_str(), 0755), 0);
  };
  write("echo node1 slots=2; echo node2");
  EXPECT_EQ(run_host_script(script), "node1 slots=2\nnode2\n");
  write("echo the queue is down >&2; exit 3");
  try {
    static_cast<void>(run_host_script(script));
    FAIL();
  } catch (const io::OutputError& error) {
    EXPECT_NE(error.message().find("exit code 3"), std::string::npos) << error.message();
    EXPECT_NE(error.message().find("the queue is down"), std::string::npos) << error.message();
  }
  EXPECT_THROW(static_cast<void>(run_host_script(folder.path() / "nothing")), io::OutputError);
}

}  // namespace fexp::coordinator
