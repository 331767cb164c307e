#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs whose coordinator is stopped, interrupted or killed, and that go on.

usage: resuming.py PROGRAM
"""
import signal
import subprocess
import sys

import cluster


class Resuming(cluster.Case):
    def start_two(self):
        self.local_hosts("c1", "c2")
        process = self.start_run()
        self.wait_for_world(1, process)
        return process

    def resume(self, last_step):
        process = self.start("cluster", "resume", "run", env=self.environment)
        self.wait_for_world(self.record()["worlds"][-1]["world"] + 1, process)
        world = self.record()["worlds"][-1]["world"]
        self.assertGreaterEqual(self.first_step(world), last_step)
        return process

    def test_a_killed_coordinator_takes_its_world_along_and_the_run_is_resumed(self):
        process = self.start_two()
        self.cluster("add", "c3=localhost")
        self.wait_for_world(2, process)
        step = self.status()["worker"]["step"]
        run_id = self.record()["run_id"]
        refused = self.cluster("resume", "run")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("is alive", refused.stderr)
        process.kill()
        process.wait()
        self.wait_for(lambda: not self.processes("worker", run_id))
        self.assertIn("resume", self.cluster("status", "--run", "run").stderr)
        process = self.resume(step)
        self.assertEqual(self.machines_of_world(3), ["c1", "c2", "c3"])
        self.assertEqual(self.record()["run_id"], run_id)
        self.finish(process)
        over = self.cluster("resume", "run")
        self.assertEqual(over.returncode, 2)
        self.assertIn("the run is over", over.stderr)

    def start_leftover(self, run_id):
        """What a worker of the first world looks like to the system."""
        words = ["worker", "--run-id", run_id, "--world", "1"]
        process = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(100)", *words])
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def test_leftovers_of_the_old_world_are_ended_before_a_new_one_begins_and_nobody_else_is(self):
        process = self.start_two()
        process.kill()
        process.wait()
        mine, other = (self.start_leftover(run_id) for run_id in (self.record()["run_id"], "0123456789abcdef"))
        process = self.resume(0)
        self.assertEqual(mine.wait(timeout=10), -signal.SIGKILL)
        self.assertIsNone(other.poll())
        self.finish(process)

    def test_a_stopped_run_can_be_resumed(self):
        process = self.start_two()
        step = self.status()["worker"]["step"]
        self.assertEqual(self.cluster("stop").returncode, 0)
        output, error = process.communicate(timeout=20)
        self.assertEqual(process.returncode, 130, error)
        self.assertIn("fexp cluster resume", error)
        self.assertEqual(self.record()["state"], "stopped")
        self.finish(self.resume(step))

    def check_interrupted(self, number, code):
        process = self.start_two()
        process.send_signal(number)
        output, error = process.communicate(timeout=20)
        self.assertEqual(process.returncode, code, error)
        self.assertEqual(self.record()["worlds"][-1]["ended"], "interrupted")

    def test_ctrl_c_ends_a_run_in_order(self):
        self.check_interrupted(signal.SIGINT, 130)

    def test_so_does_a_termination(self):
        self.check_interrupted(signal.SIGTERM, 143)

    def test_a_run_goes_on_with_the_deck_it_began_with_whatever_becomes_of_the_file(self):
        process = self.start_two()
        step = self.status()["worker"]["step"]
        self.cluster("stop")
        process.communicate(timeout=20)
        (self.folder / "deck.toml").unlink()
        self.finish(self.resume(step))


if __name__ == "__main__":
    cluster.main()
