// SPDX-License-Identifier: Apache-2.0
#include "coordinator/membership.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "support/membership_scene.hpp"

namespace fexp::coordinator {

TEST(membership, rank_0_is_on_the_coordinators_machine_and_computes_when_that_is_listed) {
  const Scene scene = three();
  EXPECT_EQ(scene.ranks(), (Names{"here", "a", "b"}));
  EXPECT_FALSE(scene.launches.back().writer_only);
}

TEST(membership, rank_0_only_writes_when_the_coordinators_machine_is_not_listed) {
  Scene scene;
  scene.want("a", "far1");
  ASSERT_EQ(scene.launches.size(), 1U);
  EXPECT_EQ(scene.ranks(), (Names{writer_name, "a"}));
  EXPECT_TRUE(scene.launches.back().writer_only);
}

TEST(membership, no_world_begins_before_every_new_machine_has_answered) {
  Scene scene;
  scene.answer_checks = false;
  scene.want("a", "far1");
  scene.want("here", "localhost");
  ASSERT_EQ(scene.checks.size(), 2U);
  scene.membership.checked(scene.now, scene.checks[1].machine, scene.good);
  scene.pass(1.0);
  EXPECT_TRUE(scene.launches.empty());
  scene.membership.checked(scene.now, scene.checks[0].machine, {false, "no route", "", false});
  scene.settle();
  ASSERT_EQ(scene.launches.size(), 1U);
  EXPECT_EQ(scene.ranks(), (Names{"here"}));
  EXPECT_EQ(scene.state("a"), "left out");
}

TEST(membership, a_machine_with_another_version_is_refused_with_both_named) {
  Scene scene;
  scene.good.version = "0.9";
  scene.want("a", "far1");
  EXPECT_TRUE(scene.launches.empty());
  EXPECT_NE(scene.told.find("fexp 0.9, and this machine has 1.0"), std::string::npos) << scene.told;
  scene.good = {true, "", "1.0", false};
  scene.pass(10.2);
  EXPECT_NE(scene.told.find("orted"), std::string::npos) << scene.told;
  scene.good.has_mpi = true;
  scene.pass(20.2);
  EXPECT_EQ(scene.launches.size(), 1U);
}

TEST(membership, a_machine_that_is_added_joins_once_it_has_answered) {
  Scene scene = three();
  scene.answer_checks = false;
  scene.want("c", "far3");
  scene.pass(1.0);
  EXPECT_EQ(scene.reforms, 0);
  scene.membership.checked(scene.now, scene.checks.back().machine, scene.good);
  scene.settle();
  EXPECT_EQ(scene.reforms, 1);
  scene.pass(0.5);
  EXPECT_EQ(scene.reforms, 1) << "asked once";
  scene.end("reform", 20);
  EXPECT_EQ(scene.ranks(), (Names{"here", "a", "b", "c"}));
  EXPECT_EQ(scene.launches.back().world, 2);
  EXPECT_TRUE(scene.kills.empty());
}

TEST(membership, a_machine_that_is_added_but_does_not_answer_disturbs_nobody) {
  Scene scene = three();
  scene.dead = {"c"};
  scene.want("c", "far3");
  scene.pass(2.0);
  EXPECT_EQ(scene.reforms, 0);
}

TEST(membership, no_reform_is_asked_before_the_world_has_started) {
  Scene scene;
  scene.want("here", "localhost");
  scene.membership.connected(scene.now);
  scene.want("a", "far1");
  EXPECT_EQ(scene.reforms, 0);
  scene.membership.started(scene.now, 0);
  scene.settle();
  EXPECT_EQ(scene.reforms, 1);
}

TEST(membership, a_machine_that_is_removed_leaves_at_the_next_boundary) {
  Scene scene = three();
  EXPECT_TRUE(scene.membership.unwant(scene.now, "a"));
  scene.settle();
  EXPECT_EQ(scene.reforms, 1);
  EXPECT_EQ(scene.state("a"), "leaving");
  scene.end("reform", 20);
  EXPECT_EQ(scene.ranks(), (Names{"here", "b"}));
  EXPECT_EQ(scene.state("a"), "unknown");
  EXPECT_FALSE(scene.membership.unwant(scene.now, "a"));
}

TEST(membership, the_coordinators_machine_may_be_removed_and_then_only_writes) {
  Scene scene = three();
  EXPECT_TRUE(scene.membership.unwant(scene.now, "here"));
  scene.settle();
  scene.end("reform");
  EXPECT_EQ(scene.ranks(), (Names{writer_name, "a", "b"}));
}

TEST(membership, when_every_machine_is_removed_the_world_goes_on_with_the_last) {
  Scene scene;
  scene.want("here", "localhost");
  scene.start();
  EXPECT_TRUE(scene.membership.unwant(scene.now, "here"));
  scene.settle();
  EXPECT_EQ(scene.reforms, 0);
}

TEST(membership, a_machine_at_another_address_is_another_machine) {
  Scene scene = three();
  const std::size_t before = scene.checks.size();
  scene.want("a", "far9");
  EXPECT_EQ(scene.checks.size(), before + 1);
  EXPECT_EQ(scene.reforms, 1);
}

TEST(membership, other_slots_alone_do_not_end_a_world) {
  Scene scene = three();
  scene.membership.want(scene.now, {"a", "far1", 8});
  scene.settle();
  EXPECT_EQ(scene.reforms, 0);
}

TEST(membership, a_rank_that_dies_once_is_started_again_at_once_on_the_same_machines) {
  Scene scene = three();
  scene.die(1);
  ASSERT_EQ(scene.kills.size(), 1U);
  EXPECT_EQ(scene.kills[0].machines.size(), 3U);
  ASSERT_EQ(scene.launches.size(), 2U);
  EXPECT_EQ(scene.ranks(), (Names{"here", "a", "b"}));
}

TEST(membership, a_machine_whose_rank_dies_twice_within_a_minute_is_left_out_for_a_while) {
  Scene scene = three();
  scene.die(1);
  scene.start();
  scene.advance(20);
  scene.pass(2.0);
  scene.die(1);
  EXPECT_EQ(scene.ranks(), (Names{"here", "b"}));
  EXPECT_EQ(scene.state("a"), "left out");
  scene.start();
  for (int step = 30; scene.reforms == 0 && step < 400; ++step) {
    scene.pass(0.5);
    scene.advance(step);
  }
  EXPECT_EQ(scene.reforms, 1) << "after ten seconds it is tried again and joins";
  EXPECT_EQ(scene.state("a"), "ready");
}

TEST(membership, deaths_of_a_rank_more_than_a_minute_apart_are_two_first_ones) {
  Scene scene = three();
  scene.die(1);
  scene.start();
  for (int step = 20; step < 90; ++step) {
    scene.pass(1.0);
    scene.advance(step);
  }
  scene.die(1);
  EXPECT_EQ(scene.ranks(), (Names{"here", "a", "b"}));
}

TEST(membership, a_machine_that_cannot_be_reached_after_a_loss_is_left_out) {
  Scene scene = three();
  scene.die({}, {{"b", "no route to host"}});
  EXPECT_EQ(scene.ranks(), (Names{"here", "a"}));
  EXPECT_NE(scene.told.find("b is left out for 10 s: no route to host"), std::string::npos) << scene.told;
}

TEST(membership, the_wait_for_a_machine_that_stays_away_doubles_up_to_ten_minutes) {
  Scene scene = three();
  scene.dead = {"b"};
  scene.die({}, {{"b", "gone"}});
  scene.start();
  std::vector<double> times;
  std::size_t seen = scene.checks.size();
  const double begin = scene.now;
  for (int step = 20; scene.now < begin + 4000.0; ++step) {
    scene.pass(1.0);
    scene.advance(step);
    if (scene.checks.size() > seen) {
      seen = scene.checks.size();
      times.push_back(scene.now);
    }
  }
  std::vector<double> waits;
  for (std::size_t t = 1; t < times.size(); ++t) {
    waits.push_back(times[t] - times[t - 1]);
  }
  ASSERT_GE(waits.size(), 7U);
  for (std::size_t w = 0; w < waits.size(); ++w) {
    EXPECT_NEAR(waits[w], std::min(20.0 * std::exp2(static_cast<double>(w)), 600.0), 1.5) << w;
  }
}

TEST(membership, a_machine_that_is_asked_for_again_is_tried_now) {
  Scene scene = three();
  scene.die({}, {{"b", "gone"}});
  scene.start();
  scene.want("b", "far2");
  EXPECT_EQ(scene.reforms, 1);
}

TEST(membership, the_run_goes_on_on_one_machine) {
  Scene scene = three();
  scene.die({}, {{"a", "gone"}, {"b", "gone"}});
  EXPECT_EQ(scene.ranks(), (Names{"here"}));
}

TEST(membership, when_no_machine_can_be_used_the_run_waits) {
  Scene scene;
  scene.dead = {"a"};
  scene.want("a", "far1");
  EXPECT_TRUE(scene.launches.empty());
  EXPECT_NE(scene.told.find("no machine can be used"), std::string::npos);
  scene.dead.clear();
  scene.pass(9.5);
  EXPECT_TRUE(scene.launches.empty());
  scene.pass(1.0);
  EXPECT_EQ(scene.launches.size(), 1U);
}

TEST(membership, a_world_without_news_is_looked_at_after_three_seconds) {
  Scene scene = three();
  scene.pass(2.8);
  EXPECT_TRUE(scene.looks.empty());
  scene.pass(0.4);
  ASSERT_EQ(scene.looks.size(), 1U);
  EXPECT_EQ(scene.looks[0].machines.size(), 3U);
  scene.pass(5.0);
  EXPECT_EQ(scene.looks.size(), 1U) << "not again before the answers are there";
}

TEST(membership, a_world_with_long_epochs_is_looked_at_after_ten_of_them) {
  Scene scene = three();
  scene.pass(2.0);
  scene.advance(20);
  scene.pass(19.0);
  EXPECT_TRUE(scene.looks.empty());
  scene.pass(1.5);
  EXPECT_EQ(scene.looks.size(), 1U);
}

TEST(membership, a_machine_whose_heart_stands_still_while_others_beat_is_left_out) {
  Scene scene = three();
  scene.pass(3.2);
  scene.look({{"here", true, "", 0.1}, {"a", true, "", 3.0}, {"b", true, "", 0.2}});
  ASSERT_EQ(scene.kills.size(), 1U);
  EXPECT_EQ(scene.kills[0].machines.size(), 3U) << "a frozen worker can be killed";
  scene.clean();
  EXPECT_EQ(scene.ranks(), (Names{"here", "b"}));
}

TEST(membership, a_machine_that_is_cut_off_is_left_out_and_not_waited_for) {
  Scene scene = three();
  scene.pass(3.2);
  scene.look({{"here", true, "", 0.1}, {"a", true, "", 0.3}, {"b", false, "no answer", {}}});
  ASSERT_EQ(scene.kills.size(), 1U);
  EXPECT_EQ(scene.kills[0].machines.size(), 2U);
  scene.clean();
  EXPECT_EQ(scene.ranks(), (Names{"here", "a"}));
}

TEST(membership, a_world_that_misses_a_worker_twice_is_lost_without_waiting_for_mpirun) {
  Scene scene;
  scene.want("a", "node-a");
  scene.launches.clear();
  const std::vector<LookAnswer> answers{{"_writer", true, "", {}, true}, {"a", true, "", {}, false}};
  scene.pass(3.2);
  scene.look(answers);
  EXPECT_TRUE(scene.kills.empty()) << "it may be about to start";
  scene.pass(3.2);
  scene.look(answers);
  ASSERT_EQ(scene.kills.size(), 1U);
  EXPECT_NE(scene.told.find("the worker on a is gone"), std::string::npos);
  scene.clean();
  ASSERT_EQ(scene.launches.size(), 1U);
  EXPECT_EQ(scene.ranks(), (Names{"_writer", "a"}));
}

TEST(membership, daemons_on_other_machines_have_time_to_start_the_first_worker) {
  Scene scene;
  scene.want("a", "node-a");
  for (int look = 0; look < 5; ++look) {
    scene.pass(3.2);
    scene.look({{"_writer", true, "", {}, false}, {"a", true, "", {}, false}});
    EXPECT_TRUE(scene.kills.empty());
  }
}

TEST(membership, a_world_whose_machines_are_all_well_is_left_alone) {
  Scene scene = three();
  scene.pass(3.2);
  scene.look({{"here", true, "", 0.1}, {"a", true, "", 1.9}, {"b", true, "", {}}});
  EXPECT_TRUE(scene.kills.empty());
  scene.pass(3.2);
  EXPECT_EQ(scene.looks.size(), 2U);
}

TEST(membership, answers_that_the_world_has_overtaken_count_for_nothing) {
  Scene scene = three();
  scene.pass(3.2);
  scene.advance(20);
  scene.look({{"here", true, "", 0.1}, {"a", true, "", 5.0}, {"b", false, "no answer", {}}});
  EXPECT_TRUE(scene.kills.empty());
}

TEST(membership, when_no_heart_beats_anywhere_the_world_is_started_again_on_all) {
  Scene scene = three();
  scene.pass(3.2);
  scene.look({{"here", true, "", 9.0}, {"a", true, "", 9.0}, {"b", true, "", 9.0}});
  EXPECT_TRUE(scene.kills.empty()) << "this machine may be slow";
  scene.pass(3.2);
  scene.look({{"here", true, "", 12.0}, {"a", true, "", 12.0}, {"b", true, "", 12.0}});
  ASSERT_EQ(scene.kills.size(), 1U);
  scene.clean();
  EXPECT_EQ(scene.ranks(), (Names{"here", "a", "b"}));
}

TEST(membership, a_world_that_stands_still_with_all_hearts_beating_is_ended_after_two_minutes) {
  Scene scene = three();
  for (int k = 0; k < 118; ++k) {
    scene.pass(1.0);
    scene.look({{"here", true, "", 0.1}, {"a", true, "", 0.1}, {"b", true, "", 0.1}});
  }
  EXPECT_TRUE(scene.kills.empty());
  scene.pass(3.0);
  EXPECT_EQ(scene.kills.size(), 1U);
}

TEST(membership, a_world_of_which_nothing_is_heard_is_ended_after_a_minute) {
  Scene scene;
  scene.want("here", "localhost");
  scene.pass(59.0);
  EXPECT_TRUE(scene.kills.empty());
  scene.pass(2.0);
  EXPECT_EQ(scene.kills.size(), 1U);
}

TEST(membership, a_world_that_loads_a_large_model_is_given_time) {
  Scene scene;
  scene.want("here", "localhost");
  scene.membership.connected(scene.now);
  scene.pass(600.0);
  EXPECT_TRUE(scene.kills.empty());
}

TEST(membership, silence_while_this_process_slept_means_nothing) {
  Scene scene = three();
  scene.now += 1000.0;
  scene.membership.woke_up(scene.now);
  scene.membership.tick(scene.now);
  scene.settle();
  EXPECT_TRUE(scene.looks.empty());
  EXPECT_TRUE(scene.kills.empty());
}

}  // namespace fexp::coordinator
