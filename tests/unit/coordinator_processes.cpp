// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include "coordinator/child_process.hpp"
#include "coordinator/probe_crew.hpp"

namespace fexp::coordinator {

namespace {

using namespace std::chrono_literals;

#if defined(__SANITIZE_ADDRESS__)
constexpr bool is_sanitized = true;
#elif defined(__has_feature)
constexpr bool is_sanitized = __has_feature(address_sanitizer);
#else
constexpr bool is_sanitized = false;
#endif

/// Looks until the program has ended, 10 s at most.
void wait_for(ChildProcess& process) {
  for (int k = 0; k < 1000 && !process.exited(); ++k) {
    std::this_thread::sleep_for(10ms);
    process.look();
  }
  EXPECT_TRUE(process.exited());
}

std::vector<std::string> shell(const std::string& line) { return {"sh", "-c", line}; }

}  // namespace

TEST(child_process, tells_what_a_program_wrote_and_how_it_ended) {
  ChildProcess good(shell("echo out; echo err >&2; echo $FEXP_TEST_WORD"), {{"FEXP_TEST_WORD", "a b"}});
  wait_for(good);
  EXPECT_TRUE(good.succeeded());
  EXPECT_EQ(good.output(), "out\na b\n");
  EXPECT_EQ(good.errors(), "err\n");
  ChildProcess bad(shell("exit 3"));
  wait_for(bad);
  EXPECT_FALSE(bad.succeeded());
  EXPECT_EQ(bad.status_text(), "exit code 3");
  ChildProcess killed(shell("kill -9 $$"));
  wait_for(killed);
  EXPECT_EQ(killed.status_text(), "signal 9");
}

TEST(child_process, keeps_the_end_of_much_output) {
  ChildProcess process(shell("i=0; while [ $i -lt 20000 ]; do echo line $i; i=$((i+1)); done"));
  wait_for(process);
  EXPECT_LE(process.output().size(), 65536U);
  EXPECT_TRUE(process.output().ends_with("line 19999\n"));
}

TEST(child_process, a_program_that_is_not_there_ends_with_a_reason) {
  ChildProcess process({"/no/such/program"});
  wait_for(process);
  EXPECT_EQ(process.status_text(), "exit code 127");
  EXPECT_EQ(process.errors(), "cannot start /no/such/program: ENOENT\n");
}

TEST(child_process, so_does_one_for_which_the_system_has_no_room) {
  if (is_sanitized) {
    GTEST_SKIP() << "the sanitizer of virtual calls needs descriptors of its own";
  }
  rlimit usual{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &usual), 0);
  const rlimit none{3, usual.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
  const ChildProcess process(shell("true"));
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &usual), 0);
  EXPECT_TRUE(process.exited());
  EXPECT_FALSE(process.succeeded());
  EXPECT_NE(process.errors().find("cannot start sh: "), std::string::npos) << process.errors();
}

TEST(child_process, a_program_does_not_outlive_whoever_watches_it) {
  pid_t id = 0;
  {
    const ChildProcess process(shell("sleep 100"));
    id = process.id();
  }
  EXPECT_EQ(kill(id, 0), -1);
  EXPECT_EQ(errno, ESRCH);
}

TEST(probe_crew, a_machine_that_does_not_answer_in_time_is_told_so) {
  ProbeCrew crew;
  crew.start(ProbeCrew::Purpose::look, {"a", "a", 0}, shell("sleep 100"), 50.0, 2.0);
  EXPECT_TRUE(crew.take_answers(51.9).empty());
  EXPECT_TRUE(crew.is_busy_with(ProbeCrew::Purpose::look));
  EXPECT_FALSE(crew.is_busy_with(ProbeCrew::Purpose::clean));
  const auto answers = crew.take_answers(52.1);
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_FALSE(answers[0].probe);
  EXPECT_EQ(answers[0].words, "it does not answer within 2 s");
  EXPECT_FALSE(crew.is_busy_with(ProbeCrew::Purpose::look));
}

TEST(probe_crew, a_failing_launch_agent_is_told_in_its_own_words) {
  ProbeCrew crew;
  crew.start(ProbeCrew::Purpose::check, {"a", "a", 0}, shell("echo hello; echo No route >&2; exit 255"), 0.0, 10.0);
  crew.start(ProbeCrew::Purpose::check, {"b", "b", 0}, shell("exit 1"), 0.0, 10.0);
  std::vector<ProbeCrew::Answer> answers;
  for (int k = 0; k < 1000 && answers.size() < 2; ++k) {
    std::this_thread::sleep_for(5ms);
    for (auto& answer : crew.take_answers(1.0)) {
      answers.push_back(answer);
    }
  }
  ASSERT_EQ(answers.size(), 2U);
  const bool in_order = answers[0].machine.name == "a";
  EXPECT_EQ(answers[in_order ? 0 : 1].words, "No route");
  EXPECT_EQ(answers[in_order ? 1 : 0].words, "it gives no sensible answer (exit code 1)");
}

}  // namespace fexp::coordinator
