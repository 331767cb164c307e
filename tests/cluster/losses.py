#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs that lose ranks, machines, memory, disks and their coordinator, and end with the results of an undisturbed run.

usage: losses.py PROGRAM
"""
import os
import shutil
import signal
import subprocess
import time
import unittest

import cluster
import program
import real


class Ranks(real.Case):
    def check_killed(self, machine):
        process = self.start_real("c1", "c2", "c3")
        self.wait_for_step(200, process)
        self.wait_for_snapshot(process, 3)
        os.kill(self.worker(machine), signal.SIGKILL)
        self.finish(process)
        self.assertIn(f"the worker on {machine} was ended by signal 9", self.log())
        self.assertGreater(self.first_step(2), 0)

    def test_a_rank_is_killed(self):
        self.check_killed("c2")

    def test_rank_0_is_killed(self):
        self.check_killed("c1")

    def test_mpirun_is_killed(self):
        process = self.start_real("c1", "c2", "c3")
        self.wait_for_step(200, process)
        os.kill(self.mpirun(process), signal.SIGKILL)
        self.finish(process)
        self.assertIn("mpirun ended (signal 9)", self.log())

    def test_a_rank_is_frozen(self):
        process = self.start_real("c1", "c2", "c3")
        self.wait_for_step(200, process)
        os.kill(self.worker("c3"), signal.SIGSTOP)
        self.finish(process)
        self.assertIn("c3 is left out for 10 s: its worker does not run", self.log())


class Machines(real.Case):
    def test_machines_join_and_leave_by_commands_and_by_the_hosts_file(self):
        process = self.start_real("c1", "c2", words=("--at", "1500 remove c1"))
        self.wait_for_step(100, process)
        self.cluster("add", "c3=localhost:1")
        self.wait_for_world(2, process)
        self.cluster("remove", "c2")
        self.wait_for_world(3, process)
        self.local_hosts("c1", "c2", "c4")
        self.wait_for_world(4, process)
        self.assertEqual(sorted(self.machines_of_world(4)), ["c1", "c3", "c4"])
        self.finish(process)
        self.assertEqual(sorted(self.machines_of_world(5)), ["c3", "c4"])

    def test_a_machine_is_lost_with_what_it_had_in_memory(self):
        process = self.start_real("c1", "c2", "c3")
        self.wait_for_step(300, process)
        self.wait_for_snapshot(process, 3)
        worker, memory = self.worker("c2"), self.memory("c2")
        os.kill(worker, signal.SIGKILL)
        shutil.rmtree(memory)
        self.finish(process)
        self.assertGreater(self.first_step(2), 0)

    def test_all_memory_is_lost_and_the_disk_has_a_checkpoint(self):
        process = self.start_real("c1", "c2")
        self.wait_for_step(200, process)
        self.cluster("stop")
        self.assertEqual(process.wait(timeout=20), 130)
        shutil.rmtree(self.memory("c1").parent)
        self.finish(self.resume())
        self.assertGreater(self.first_step(2), 0)

    def test_a_machine_that_comes_back_with_the_memory_of_another_history_does_no_harm(self):
        process = self.start_real("c1", "c2")
        self.wait_for_step(500, process)
        self.wait_for_snapshot(process, 2)
        process.send_signal(signal.SIGSTOP)
        memory, kept = self.memory("c2"), self.folder / "kept"
        os.kill(self.worker("c2"), signal.SIGKILL)
        self.wait_for(lambda: not self.processes("worker", self.record()["run_id"]))
        shutil.copytree(memory, kept)
        shutil.rmtree(memory.parent)
        process.send_signal(signal.SIGCONT)
        self.wait_for_world(2, process)
        self.assertEqual(self.first_step(2), 0)
        os.kill(self.worker("c1"), signal.SIGKILL)
        for path in (kept / "snapshots").iterdir():
            shutil.copy(path, memory / "snapshots")
        self.finish(process)
        self.assertLess(self.first_step(3), 500)


class Coordinators(real.Case):
    def test_the_coordinator_is_killed(self):
        process = self.start_real("c1", "c2", "c3")
        self.wait_for_step(300, process)
        self.wait_for_snapshot(process, 3)
        process.kill()
        process.wait()
        run_id = self.record()["run_id"]
        self.wait_for(lambda: not self.processes("worker", run_id))
        self.finish(self.resume())
        self.assertGreater(self.first_step(2), 0)

    def test_a_truncated_checkpoint_is_named_and_the_one_before_it_taken(self):
        process = self.start_real("c1", "c2")
        steps = []
        for step in (150, 400):
            self.wait_for_step(step, process)
            self.cluster("stop")
            self.assertEqual(process.wait(timeout=20), 130)
            steps = sorted((self.folder / "run/checkpoints").glob("step-*.fexp"))
            process = self.resume() if step == 150 else None
        self.assertEqual(len(steps), 2)
        steps[1].write_bytes(steps[1].read_bytes()[:-100])
        shutil.rmtree(self.memory("c1").parent)
        self.finish(self.resume())
        self.assertIn(f"{steps[1]}: ", self.log())
        self.assertEqual(self.first_step(3), int(steps[0].name[5:17]))

    def test_a_run_that_ended_unheard_is_known_to_be_complete(self):
        process = self.start_real("c1", "c2")
        self.wait_for_step(500, process)
        process.send_signal(signal.SIGSTOP)
        self.wait_for(lambda: (self.folder / "run/summary.json").exists())
        process.kill()
        process.wait()
        result = self.cluster("resume", "run")
        self.assertEqual(result.returncode, 2)
        self.assertIn("the run is over (completed)", result.stderr)
        self.check_equal()


class Disks(real.Case):
    def setUp(self):
        super().setUp()
        if os.getuid() != 0:
            self.skipTest("only root can mount a small disk")
        self.disk = self.folder / "run"
        self.disk.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64m", "tmpfs", self.disk], check=False,
                                 capture_output=True, text=True)
        if mounted.returncode != 0:
            self.skipTest(f"no small disk can be mounted: {mounted.stderr}")
        self.addCleanup(subprocess.run, ["umount", "-l", self.disk], check=False)

    def fill(self):
        with (self.disk / "filling").open("wb", buffering=0) as file:
            try:
                while file.write(b"\0" * 65536) == 65536:
                    pass
                while file.write(b"\0"):
                    pass
            except OSError:
                pass

    def test_the_disk_is_full_for_a_while(self):
        process = self.start_real("c1", "c2", "c3")
        self.wait_for_step(200, process)
        self.fill()
        self.wait_for(lambda: self.status()["phase"] == "waiting", process=process)
        self.assertIn("results cannot be written", self.log())
        (self.disk / "filling").unlink()
        self.finish(process)


class PlainRuns(real.Case):
    """Runs without a coordinator, ended from outside and resumed."""

    def kill_plain(self, *words):
        process = self.start("run", "deck.toml", "--out", "run", "--quiet", "--checkpoint-every", "0.2", *self.run_words,
                             *words, env=self.environment)
        self.wait_for(lambda: list(self.folder.glob("run/checkpoints/step-*.fexp")), process=process)
        process.kill()
        process.wait()

    def test_a_killed_run_is_resumed_with_other_threads(self):
        self.kill_plain("--threads", "1")
        self.assertEqual(self.fexp("resume", "run", "--quiet", "--threads", "2").returncode, 0)
        self.check_equal()

    def test_a_killed_run_is_resumed_on_several_ranks_and_again_alone(self):
        self.kill_plain("--threads", "2")
        process = subprocess.Popen(["mpirun", "--oversubscribe", "-n", "3", program.PROGRAM, "resume", "run", "--quiet",
                                    "--threads", "1", "--checkpoint-every", "0.2"], cwd=self.folder,
                                   env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        checkpoints = self.folder / "run/checkpoints"
        before = max(checkpoints.iterdir())
        self.wait_for(lambda: max(checkpoints.glob("step-*.fexp")) > before)
        process.kill()
        process.wait()
        # Its ranks notice that it is gone a little later
        self.wait_for(lambda: not cluster.processes_in(self.folder))
        self.assertEqual(self.fexp("resume", "run", "--quiet").returncode, 0)
        self.check_equal()

    def test_a_cluster_run_is_resumed_on_one_machine(self):
        process = self.start_real("c1", "c2")
        self.wait_for_step(200, process)
        refused = self.fexp("resume", "run")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("is alive", refused.stderr)
        self.cluster("stop")
        self.assertEqual(process.wait(timeout=20), 130)
        self.assertEqual(self.fexp("resume", "run", "--quiet").returncode, 0)
        self.check_equal()


class More(real.Case):
    """Rarer than the ones above."""

    def test_rank_0_is_killed_again_and_again_while_it_writes(self):
        process = self.start_real("c1", "c2")
        for world in range(1, 6):
            self.wait_for_world(world, process)
            time.sleep(0.05 * world)
            os.kill(self.worker(self.machines_of_world(world)[0]), signal.SIGKILL)
        self.finish(process)

    def test_the_launch_daemon_of_a_machine_is_killed(self):
        self.far_hosts("c1=localhost", "far1")
        process = self.start_run("--agent", cluster.HERE / "agent.sh", "--threads", "1", "--json", *self.run_words)
        self.wait_for_step(200, process)
        os.kill(cluster.parent_of(self.worker("far1")), signal.SIGKILL)
        self.finish(process)

    def test_all_memory_is_lost_before_there_is_a_checkpoint(self):
        process = self.start_real("c1", "c2")
        self.wait_for_step(200, process)
        process.send_signal(signal.SIGSTOP)  # So that no world begins before all is gone
        os.kill(self.worker("c2"), signal.SIGKILL)
        shutil.rmtree(self.memory("c1").parent, ignore_errors=True)
        process.send_signal(signal.SIGCONT)
        self.finish(process)
        self.assertEqual(self.first_step(2), 0)

    def test_coordinator_and_mpirun_are_killed_and_the_run_is_resumed_at_once(self):
        process = self.start_real("c1", "c2", "c3")
        self.wait_for_step(300, process)
        mpirun = self.mpirun(process)
        process.kill()
        os.kill(mpirun, signal.SIGKILL)
        process.wait()
        self.finish(self.resume())


if __name__ == "__main__":
    real.main()
