#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs with machines that are reached through a launch agent, and fail.

usage: machines.py PROGRAM
"""
import os
import signal

import cluster


class Machines(cluster.Case):
    def start_far(self, *names):
        self.far_hosts("c1=localhost", *names)
        return self.start_run("--agent", cluster.HERE / "agent.sh")

    def test_a_machine_that_is_down_is_left_out_and_joins_when_it_is_back(self):
        (self.folder / "down-far2").touch()
        process = self.start_far("far1", "far2")
        self.wait_for_world(1, process)
        self.assertEqual(self.machines_of_world(1), ["c1", "far1"])
        self.assertIn("far2 is left out for 10 s: ssh: connect to host far2 port 22: No route to host", self.log())
        (self.folder / "down-far2").unlink()
        self.wait_for_world(2, process)
        self.assertEqual(self.machines_of_world(2), ["c1", "far1", "far2"])
        self.finish(process)

    def test_a_machine_that_is_cut_off_is_left_out(self):
        process = self.start_far("far1", "far2")
        self.wait_for_world(1, process)
        (self.folder / "cut-far2").touch()
        os.kill(self.worker("far2"), signal.SIGSTOP)  # Nothing comes through to the others
        self.wait_for_world(2, process)
        self.assertEqual(self.machines_of_world(2), ["c1", "far1"])
        self.assertIn("far2 is left out for 10 s: it does not answer within 2 s", self.log())
        self.finish_with_leftovers(process)

    def finish_with_leftovers(self, process):
        """The worker of a machine that cannot be reached stays."""
        (self.folder / "run/finish").touch()
        output, error = process.communicate(timeout=20)
        self.assertEqual(process.returncode, 0, error)

    def test_a_machine_with_another_version_is_refused(self):
        (self.folder / "old-far1").touch()
        process = self.start_far("far1")
        self.wait_for_world(1, process)
        self.assertEqual(self.machines_of_world(1), ["c1"])
        self.assertRegex(self.log(), r"far1 is left out for 10 s: it has fexp 0\.0\.1, and this machine has \d")
        self.finish(process)


if __name__ == "__main__":
    cluster.main()
