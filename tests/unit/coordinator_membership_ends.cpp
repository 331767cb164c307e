// SPDX-License-Identifier: Apache-2.0
#include "coordinator/membership.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "support/membership_scene.hpp"

/// How worlds and runs end.
namespace fexp::coordinator {

TEST(membership, a_lost_rank_0_ends_the_world_unless_mpirun_ends_by_itself) {
  Scene scene = three();
  scene.membership.connection_lost(scene.now);
  scene.pass(4.0);
  EXPECT_TRUE(scene.kills.empty());
  scene.pass(1.5);
  EXPECT_EQ(scene.kills.size(), 1U);
}

TEST(membership, a_world_that_has_said_its_end_but_does_not_leave_is_killed_and_its_word_counts) {
  Scene scene = three();
  scene.membership.ended(scene.now, {"completed", 0, "", 100});
  scene.pass(4.5);
  EXPECT_TRUE(scene.kills.empty());
  scene.pass(1.0);
  ASSERT_EQ(scene.kills.size(), 1U);
  scene.clean();
  ASSERT_TRUE(scene.finished);
  EXPECT_EQ(scene.finished->outcome, Outcome::completed);
}

TEST(membership, a_completed_run_and_a_fault_end_it) {
  Scene completed = three();
  completed.end("completed");
  ASSERT_TRUE(completed.finished);
  EXPECT_EQ(completed.finished->outcome, Outcome::completed);
  Scene fault = three();
  fault.membership.ended(fault.now, {"fault", 3, "too thin", 20});
  fault.membership.launcher_exited(fault.now, "exit code 3", 0);
  fault.settle();
  ASSERT_TRUE(fault.finished);
  EXPECT_EQ(fault.finished->outcome, Outcome::fault);
  EXPECT_EQ(fault.finished->exit_code, 3);
  EXPECT_EQ(fault.finished->message, "too thin");
}

TEST(membership, an_interruption_that_nobody_asked_for_is_a_loss) {
  Scene scene = three();
  scene.end("interrupted");
  EXPECT_FALSE(scene.finished);
  EXPECT_EQ(scene.kills.size(), 1U);
  scene.clean();
  EXPECT_EQ(scene.launches.size(), 2U);
}

TEST(membership, a_stop_ends_the_run_in_order) {
  Scene scene = three();
  scene.membership.stop(scene.now);
  scene.settle();
  EXPECT_EQ(scene.stops, 1);
  scene.end("interrupted");
  ASSERT_TRUE(scene.finished);
  EXPECT_EQ(scene.finished->outcome, Outcome::stopped);
  EXPECT_EQ(scene.launches.size(), 1U);
}

TEST(membership, a_second_stop_kills_the_world) {
  Scene scene = three();
  scene.membership.stop(scene.now);
  scene.membership.stop(scene.now);
  scene.settle();
  ASSERT_EQ(scene.kills.size(), 1U);
  scene.clean();
  ASSERT_TRUE(scene.finished);
  EXPECT_EQ(scene.finished->outcome, Outcome::stopped);
}

TEST(membership, a_world_that_does_not_heed_a_stop_is_killed_after_half_a_minute) {
  Scene scene = three();
  scene.membership.stop(scene.now);
  scene.pass(29.0);
  EXPECT_TRUE(scene.kills.empty());
  scene.pass(2.0);
  EXPECT_EQ(scene.kills.size(), 1U);
}

TEST(membership, a_stop_without_a_world_and_a_stop_while_one_is_cleaned_up_end_the_run) {
  Scene waiting;
  waiting.dead = {"a"};
  waiting.want("a", "far1");
  waiting.membership.stop(waiting.now);
  waiting.settle();
  EXPECT_TRUE(waiting.finished);
  Scene cleaning = three();
  cleaning.membership.launcher_exited(cleaning.now, "it died", 1);
  cleaning.membership.stop(cleaning.now);
  cleaning.settle();
  EXPECT_FALSE(cleaning.finished);
  cleaning.clean();
  ASSERT_TRUE(cleaning.finished);
  EXPECT_EQ(cleaning.launches.size(), 1U);
}

TEST(membership, a_full_disk_is_waited_for_longer_each_time) {
  Scene scene = three();
  scene.end("output_error");
  EXPECT_FALSE(scene.finished);
  scene.pass(4.5);
  EXPECT_EQ(scene.launches.size(), 1U);
  scene.pass(1.0);
  EXPECT_EQ(scene.launches.size(), 2U);
  scene.start();
  scene.end("output_error");
  scene.pass(9.5);
  EXPECT_EQ(scene.launches.size(), 2U);
  scene.pass(1.0);
  EXPECT_EQ(scene.launches.size(), 3U);
  scene.start();
  scene.advance(30);
  scene.end("output_error");
  scene.pass(5.5);
  EXPECT_EQ(scene.launches.size(), 4U) << "a step was gained, so the waits begin anew";
}

TEST(membership, three_worlds_that_die_before_they_start_on_machines_that_answer_end_the_run) {
  Scene scene;
  scene.want("here", "localhost");
  scene.die({});
  scene.die({});
  EXPECT_FALSE(scene.finished);
  scene.die({});
  ASSERT_TRUE(scene.finished);
  EXPECT_EQ(scene.finished->outcome, Outcome::gave_up);
  EXPECT_NE(scene.finished->message.find("it died"), std::string::npos);
}

TEST(membership, worlds_that_die_because_a_machine_is_away_do_not_count_against_the_run) {
  Scene scene = three();
  for (int k = 0; k < 4; ++k) {
    scene.die({}, {{"b", "gone"}});
    scene.pass(700.0);  // b answers again
    scene.die({}, {{"b", "gone"}});
  }
  EXPECT_FALSE(scene.finished);
}

TEST(membership, worlds_that_are_killed_from_outside_are_tried_again_for_longer) {
  Scene scene;
  scene.want("here", "localhost");
  for (int k = 0; k < 11; ++k) {
    const std::size_t before = scene.launches.size();
    scene.membership.launcher_exited(scene.now, "mpirun ended (signal 9)", {}, true);
    scene.settle();
    scene.clean();
    EXPECT_EQ(scene.launches.size(), k == 0 ? before + 1 : before) << "the first one at once, later ones after a wait";
    EXPECT_FALSE(scene.finished) << k;
    scene.pass(31.0);
    EXPECT_EQ(scene.launches.size(), before + 1);
  }
  scene.membership.launcher_exited(scene.now, "mpirun ended (signal 9)", {}, true);
  scene.settle();
  scene.clean();
  ASSERT_TRUE(scene.finished);
  EXPECT_EQ(scene.finished->outcome, Outcome::gave_up);
  EXPECT_NE(scene.finished->message.find("12 worlds in a row were killed"), std::string::npos);
}

TEST(membership, a_start_between_deaths_breaks_the_row) {
  Scene scene;
  scene.want("here", "localhost");
  scene.die({});
  scene.die({});
  scene.start();
  scene.advance(10);
  scene.die({});
  scene.die({});
  EXPECT_FALSE(scene.finished);
}

TEST(membership, worlds_that_start_but_gain_no_step_end_the_run_in_the_end) {
  Scene scene;
  scene.want("here", "localhost");
  scene.start();
  scene.advance(10);
  scene.die({});  // It has gained steps
  for (int k = 0; k < 6; ++k) {
    EXPECT_FALSE(scene.finished) << k;
    scene.start(5);
    scene.advance(10);
    scene.die({});
  }
  ASSERT_TRUE(scene.finished);
  EXPECT_EQ(scene.finished->outcome, Outcome::gave_up);
}

TEST(membership, an_event_is_applied_when_a_world_ends_for_it) {
  Scene scene({{100, true, {"b", "far2", 0}, false}, {50, false, {"a", "a", 0}, false}});
  scene.answer_checks = false;
  scene.want("here", "localhost");
  scene.want("a", "far1");
  for (const CheckMachine& check : std::vector(scene.checks)) {
    scene.membership.checked(scene.now, check.machine, scene.good);
  }
  scene.answer_checks = true;
  scene.settle();
  EXPECT_EQ(scene.membership.event_steps(), (std::vector<std::int64_t>{50, 100}));
  scene.start();
  scene.advance(56);
  EXPECT_EQ(scene.reforms, 0) << "rank 0 does it by itself";
  scene.end("reform", 56);
  EXPECT_EQ(scene.ranks(), (Names{"here"}));
  EXPECT_EQ(scene.membership.event_steps(), (std::vector<std::int64_t>{100}));
  scene.start(56);
  scene.end("reform", 110);
  EXPECT_EQ(scene.ranks(), (Names{"here", "b"}));
  EXPECT_TRUE(scene.membership.event_steps().empty());
}

TEST(membership, events_at_step_0_are_applied_before_the_first_world) {
  Scene scene({{0, true, {"a", "far1", 0}, false}});
  scene.want("here", "localhost");
  ASSERT_EQ(scene.launches.size(), 1U);
  EXPECT_EQ(scene.ranks(), (Names{"here", "a"}));
}

TEST(membership, an_event_that_a_resumed_world_is_already_beyond_is_applied_by_a_reform) {
  Scene scene({{100, true, {"a", "far1", 0}, false}});
  scene.want("here", "localhost");
  scene.start(128);
  EXPECT_EQ(scene.reforms, 1);
}

TEST(membership, a_machine_under_way_is_checked_with_workers_of_earlier_worlds_ended) {
  Scene scene = three();
  EXPECT_EQ(scene.checks.front().below, 1);
  scene.die(1);
  scene.start();
  scene.want("c", "far3");
  EXPECT_EQ(scene.checks.back().below, 2) << "the present world's own workers may run there under another name";
}

TEST(membership, failures_are_forgotten_after_five_good_minutes) {
  Scene scene = three();
  scene.die({}, {{"b", "gone"}});
  scene.start();
  int step = 20;
  const auto run_for = [&](double seconds) {
    for (const double end = scene.now + seconds; scene.now < end;) {
      scene.pass(1.0);
      scene.advance(++step);
    }
  };
  run_for(11.0);
  scene.end("reform");
  scene.start(step);
  run_for(301.0);
  scene.told.clear();
  scene.die({}, {{"b", "gone"}});
  EXPECT_NE(scene.told.find("b is left out for 10 s"), std::string::npos) << scene.told;
}

}  // namespace fexp::coordinator
