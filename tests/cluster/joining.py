#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs on machines that come and go as they are told to.

usage: joining.py PROGRAM
"""
import json

import cluster


class Running(cluster.Case):
    def test_a_run_on_three_machines_completes_and_leaves_nothing_behind(self):
        self.local_hosts("c1", "c2", "c3")
        process = self.start_run("--json")
        self.wait_for_world(1, process)
        output, error = self.finish(process)
        self.assertEqual(json.loads(output)["machines"], ["c1", "c2", "c3"])
        self.assertIn("world 1 begins on c1, c2 and c3", error)

    def test_quiet_prints_nothing(self):
        self.local_hosts("c1", "c2")
        process = self.start_run("--quiet")
        self.wait_for_world(1, process)
        self.assertEqual(self.finish(process), ("", ""))

    def test_wrong_input_ends_before_anything_is_written_or_launched(self):
        self.write_hosts("c1=localhost", "c2 slots=none", "c3 and more")
        before = self.names()
        for words, pieces in {
            ("nothing.toml", "--hosts", "hosts"): ["nothing.toml"],
            ("deck.toml", "--hosts", "hosts"): ["hosts:2: error:", "hosts:3: error:", "cure:"],
            ("deck.toml", "--hosts", "missing"): ["missing", "No such file"],
            ("deck.toml", "--discover", "/bin/false"): ["/bin/false", "exit code 1"],
            ("deck.toml", "--discover", "/bin/true"): ["names no machine"],
            ("deck.toml", "--discover", "a", "--hosts", "b"): ["--hosts", "--discover"],
            ("deck.toml", "--at", "ten add c1"): ["STEP add HOST"],
            ("deck.toml", "--at", "10 add a/b"): ["a/b"],
            ("deck.toml", "--host", "hosts"): ["did you mean --hosts", "fexp cluster run --help"],
        }.items():
            result = self.cluster("run", *words)
            self.assertEqual((result.returncode, result.stdout), (2, ""), result.stderr)
            for piece in pieces:
                self.assertIn(piece, result.stderr)
        self.assertEqual(self.names(), before)

    def test_rank_0_only_writes_when_the_coordinators_machine_is_not_listed(self):
        self.far_hosts("far1", "far2")
        process = self.start_run("--agent", cluster.HERE / "agent.sh")
        self.wait_for_world(1, process)
        self.assertEqual(self.machines_of_world(1), ["_writer", "far1", "far2"])
        self.assertEqual(self.states(), {"far1": "computing", "far2": "computing"})
        self.finish(process)


class Joining(cluster.Case):
    def test_machines_join_and_leave_by_commands(self):
        self.local_hosts("c1", "c2")
        process = self.start_run()
        self.wait_for_world(1, process)
        added = self.cluster("add", "c3=localhost:2")
        self.assertEqual(added.returncode, 0, added.stderr)
        self.wait_for_world(2, process)
        self.assertEqual(self.machines_of_world(2), ["c1", "c2", "c3"])
        self.assertGreater(self.first_step(2), 0)
        self.assertEqual(self.states(), {"c1": "computing", "c2": "computing", "c3": "computing"})
        self.assertEqual(self.cluster("remove", "c2").returncode, 0)
        self.wait_for_world(3, process)
        self.assertEqual(self.machines_of_world(3), ["c1", "c3"])
        self.assertGreater(self.first_step(3), self.first_step(2))
        for words, piece in {("remove", "c2"): "no machine", ("add", "../c"): "names no machine",
                             ("add", "c1=elsewhere"): "already"}.items():
            result = self.cluster(*words)
            self.assertEqual(result.returncode, 2)
            self.assertIn(piece, result.stderr)
        self.cluster("remove", "c3")
        self.wait_for_world(4, process)
        self.assertIn("last machine", self.cluster("remove", "c1").stderr)
        self.finish(process)

    def test_machines_join_and_leave_with_the_hosts_file(self):
        self.local_hosts("c1", "c2")
        process = self.start_run()
        self.wait_for_world(1, process)
        self.local_hosts("c1", "c2", "c3")
        self.wait_for_world(2, process)
        self.assertEqual(self.machines_of_world(2), ["c1", "c2", "c3"])
        self.local_hosts("c3", "c1")
        self.wait_for_world(3, process)
        self.assertEqual(sorted(self.machines_of_world(3)), ["c1", "c3"])
        self.write_hosts("c1=localhost slots=oops")
        self.wait_for(lambda: "slots=oops" in self.log())
        self.assertEqual(len(self.states()), 2)
        self.finish(process)

    def test_machines_join_as_a_script_lists_them(self):
        script = self.folder / "discover"
        script.write_text(f"#!/bin/sh\ncat {self.folder}/hosts || exit 1\n", encoding="utf-8")
        script.chmod(0o755)
        self.local_hosts("c1")
        process = self.start_run("--discover", "./discover")
        self.wait_for_world(1, process)
        self.local_hosts("c1", "c2")
        self.wait_for_world(2, process)
        self.assertEqual(self.machines_of_world(2), ["c1", "c2"])
        self.finish(process)

    def test_machines_join_and_leave_at_steps_of_the_run(self):
        self.local_hosts("c1", "c2")
        process = self.start_run("--at", "95 add c3=localhost", "--at", "200 remove c1", FAKE_STEPS="300",
                                 FAKE_EPOCH="0.01")
        output, error = process.communicate(timeout=25)
        self.assertEqual(process.returncode, 0, error)
        self.assertEqual([self.machines_of_world(world) for world in (1, 2, 3)],
                         [["c1", "c2"], ["c1", "c2", "c3"], ["c2", "c3"]])
        self.assertEqual([self.first_step(world) for world in (1, 2, 3)], [0, 100, 200])


class Talking(cluster.Case):
    def test_status_tells_how_the_run_and_its_machines_are(self):
        self.local_hosts("c1", "c2")
        process = self.start_run()
        self.wait_for_world(1, process)
        status = self.status()
        self.assertEqual((status["world"], status["phase"], status["pid"]), (1, "running", process.pid))
        self.assertEqual(status["worker"]["islands"], 3)
        result = self.cluster("status")
        text = result.stdout + result.stderr
        for piece in ("running, world 1", "c1", "c2", "computing", "islands: 3"):
            self.assertIn(piece, text)
        self.finish(process)

    def test_a_command_asks_which_run_is_meant_when_there_are_several(self):
        self.assertIn("no cluster run", self.cluster("status").stderr)
        self.local_hosts("c1")
        first, second = self.start_run(out="one"), self.start_run(out="two")
        self.wait_for_world(1, first, "one")
        self.wait_for_world(1, second, "two")
        result = self.cluster("status")
        self.assertEqual(result.returncode, 2)
        for piece in ("2 cluster runs", "/one", "/two", "--run"):
            self.assertIn(piece, result.stderr)
        self.assertEqual(self.status("two")["pid"], second.pid)
        forced = self.cluster("run", "deck.toml", "--out", "one", "--force")
        self.assertEqual(forced.returncode, 2)
        self.assertIn("is alive", forced.stderr)
        for process, out in ((first, "one"), (second, "two")):
            (self.folder / out / "finish").touch()
            self.assertEqual(process.wait(timeout=20), 0)
        self.assertIn("does not live", self.cluster("status", "--run", "one").stderr)


if __name__ == "__main__":
    cluster.main()
