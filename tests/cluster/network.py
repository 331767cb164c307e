#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs on several hosts with a network between them and no common files, whose cables are pulled.

usage: network.py PROGRAM
"""
import subprocess
import time

import cluster
import lab
import program
import real

NAMES = ("c1", "c2", "c3")


class Hosts(real.Case):
    """Three of them, in a network of their own."""

    seconds = 6.0

    def setUp(self):
        super().setUp()
        place = program.tempfile.TemporaryDirectory(prefix="fexp-lab-")
        self.addCleanup(place.cleanup)
        self.lab = lab.Lab(len(NAMES), program.Path(place.name) / "lab", self.folder)
        self.addCleanup(self.lab.close)

    def begin(self):
        """The coordinator on the first host."""
        self.write_hosts(*(f"c{number}={lab.NETWORK}.{number}" for number in range(1, len(NAMES) + 1)))
        words = ["cluster", "run", self.folder / "deck.toml", "--out", self.folder / "run", "--hosts",
                 self.folder / "hosts", "--agent", f"{cluster.HERE / 'lab_agent.py'} {self.lab.folder}", "--mpirun",
                 lab.MPIRUN, "--threads", "1", "--json", *self.run_words]
        process = subprocess.Popen(self.lab.command_on("c1", [program.PROGRAM, *words]), env=self.environment,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        self.wait_for(lambda: "world 1 is stepping" in self.log(), 30.0, process)
        self.assertEqual(self.machines_of_world(1), list(NAMES), self.log())
        return process

    def wait_for_machines(self, world, names, process):
        self.wait_for(lambda: f"world {world} is stepping" in self.log(), 40.0, process)
        self.assertEqual(self.machines_of_world(world), names, self.log())

    def wait_for_frame(self, number, process):
        """By then there is a snapshot too, which is taken after half a second."""
        time.sleep(0.6)
        log = self.folder / "run/log.txt"
        self.wait_for(lambda: f"frame {number}:" in log.read_text(encoding="utf-8"), 40.0, process)

    def end(self, process):
        output, error = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 0, error + self.log())
        self.check_equal()


class Network(Hosts):
    def test_hosts_without_common_files_give_the_results_of_one_machine(self):
        process = self.begin()
        self.end(process)
        self.assertEqual(len(self.record()["worlds"]), 1)
        for name in NAMES:
            self.assertEqual(self.lab.processes_of(name, "worker"), [])

    def test_a_cable_is_cut_and_mended(self):
        process = self.begin()
        self.wait_for_frame(20, process)
        old = self.lab.processes_of("c2", "worker")
        self.lab.cut("c2")
        self.wait_for_machines(2, ["c1", "c3"], process)
        self.lab.mend("c2")
        added = subprocess.run(self.lab.command_on("c1", [program.PROGRAM, "cluster", "add", f"c2={lab.NETWORK}.2",
                                                          "--run", self.folder / "run"]), env=self.environment,
                               check=False, capture_output=True, text=True)
        self.assertEqual(added.returncode, 0, added.stderr)
        self.wait_for_machines(3, ["c1", "c2", "c3"], process)
        self.assertFalse(set(old) & set(self.lab.processes_of("c2", "worker")))
        self.end(process)


class Long(Hosts):
    def test_a_cable_is_cut(self):
        process = self.begin()
        self.wait_for_frame(20, process)
        self.lab.cut("c3")
        self.wait_for_machines(2, ["c1", "c2"], process)
        self.assertGreater(self.first_step(2), 0)
        self.end(process)
        self.assertRegex(self.log(), "c3 is left out for 10 s: (ssh: connect to host|it does not answer)")

    def test_a_cable_that_is_out_for_a_moment_does_no_harm(self):
        process = self.begin()
        self.wait_for_frame(20, process)
        self.lab.cut("c2")
        time.sleep(0.3)
        self.lab.mend("c2")
        self.end(process)

    def test_a_host_freezes(self):
        process = self.begin()
        self.wait_for_frame(20, process)
        self.lab.freeze("c3")
        self.wait_for_machines(2, ["c1", "c2"], process)
        self.lab.thaw("c3")
        self.end(process)

    def test_a_host_is_switched_off(self):
        process = self.begin()
        self.wait_for_frame(20, process)
        self.lab.switch_off("c2")
        self.wait_for_machines(2, ["c1", "c3"], process)
        self.assertGreater(self.first_step(2), 0)
        self.end(process)


if __name__ == "__main__":
    lab.enter_own_network()
    real.main()
