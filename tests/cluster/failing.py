#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs whose ranks or disks fail.

usage: failing.py PROGRAM
"""
import os
import signal
import time

import cluster


class Ranks(cluster.Case):
    def start_three(self, *words, **changes):
        self.local_hosts("c1", "c2", "c3")
        process = self.start_run(*words, **changes)
        self.wait_for_world(1, process)
        return process

    def check_killed_rank(self, machine):
        process = self.start_three()
        os.kill(self.worker(machine), signal.SIGKILL)
        self.wait_for_world(2, process)
        self.assertEqual(self.machines_of_world(2), ["c1", "c2", "c3"])
        self.assertIn(f"the worker on {machine} was ended by signal 9", self.log())
        self.assertGreater(self.first_step(2), 0)
        self.finish(process)

    def test_a_rank_that_is_killed_is_started_again(self):
        self.check_killed_rank("c2")

    def test_so_is_rank_0(self):
        self.check_killed_rank("c1")

    def test_a_killed_mpirun_takes_its_world_along_and_another_one_begins(self):
        process = self.start_three()
        old = self.processes("worker", self.record()["run_id"])
        os.kill(self.mpirun(process), signal.SIGKILL)
        self.wait_for_world(2, process)
        self.assertFalse(set(old) & set(self.processes("worker", self.record()["run_id"])))
        self.assertIn("mpirun ended (signal 9)", self.log())
        self.finish(process)

    def test_a_frozen_rank_is_found_killed_and_its_machine_left_out(self):
        process = self.start_three()
        frozen = self.worker("c2")
        os.kill(frozen, signal.SIGSTOP)
        start = time.monotonic()
        self.wait_for_world(2, process)
        self.assertLess(time.monotonic() - start, 12.0)
        self.assertEqual(self.machines_of_world(2), ["c1", "c3"], self.log())
        self.assertFalse(cluster.is_alive(frozen))
        self.assertEqual(self.states()["c2"], "left out")
        self.assertIn("c2 is left out for 10 s: its worker does not run", self.log())
        self.finish(process)


class Output(cluster.Case):
    def test_a_full_disk_is_waited_for(self):
        self.local_hosts("c1", "c2")
        process = self.start_run()
        self.wait_for_world(1, process)
        (self.folder / "run/full").touch()
        self.wait_for(lambda: "no space left" in self.log(), process=process)
        self.wait_for(lambda: self.status()["phase"] == "waiting", process=process)
        self.assertIn("tries again in 5 s", self.status()["message"])
        (self.folder / "run/full").unlink()
        self.wait_for_world(2, process)
        self.finish(process)


class GivingUp(cluster.Case):
    def test_worlds_that_cannot_start_end_the_run_which_can_be_resumed(self):
        self.local_hosts("c1", "c2")
        process = self.start_run(FAKE_EPOCH="0.2")
        self.wait_for(lambda: (self.folder / "run").exists())
        (self.folder / "run/wrong").touch()
        output, error = process.communicate(timeout=40)
        self.assertEqual(process.returncode, 6, error)
        self.assertIn("fexp: cannot read the deck", error)
        self.assertIn("fexp cluster resume", error)
        record = self.record()
        self.assertEqual(record["state"], "gave up")
        (self.folder / "run/wrong").unlink()
        (self.folder / "run/finish").touch()
        result = self.cluster("resume", "run")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.record()["worlds"][-1]["world"], len(record["worlds"]) + 1)


if __name__ == "__main__":
    cluster.main()
