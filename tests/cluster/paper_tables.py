#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The tables of the paper from runs on several ranks: where the four spheres are computed when, and that nothing of
their results depends on it.

usage: paper_tables.py PROGRAM
"""
import csv
import json
import os

import real


class Tables(real.Case):
    deck_file = real.EXAMPLES / "four_spheres.toml"

    def check_tables(self, threads):
        process = self.start_real("c1", "c2", "c3", threads=threads, words=("--at", "90 add c4=localhost"))
        placement = self.finish(process)["placement"]
        self.assertEqual([frame["elements"] for frame in placement["frames"]],
                         [[384, 192, 192], [576, 0, 192], [768, 0, 0, 0], [192, 192, 192, 192]])
        self.assertEqual([frame["nodes"] for frame in placement["frames"]],
                         [[196, 98, 98], [294, 0, 98], [392, 0, 0, 0], [98, 98, 98, 98]])
        self.assertEqual((placement["moved_elements"], placement["moved_nodes"], placement["moved_ratio"]),
                         (960, 490, 1.25))
        self.assertEqual([(machine["name"], machine["threads"]) for machine in placement["machines"]],
                         [(name, threads) for name in ("c1", "c2", "c3", "c4")])
        self.check_threads(threads)

    def check_threads(self, threads):
        """Table 2: three machines compute, then four, each with a process of its own, beside the coordinator and
        mpirun; the system has counted the threads of all."""
        with open(self.folder / "run" / "threads.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        machines = {world: {row["process"]: row for row in rows if row["world"] == world and row["process"][0] == "c"
                            and row["process"] != "coordinator"} for world in ("1", "2")}
        self.assertEqual([sorted(machines[world]) for world in ("1", "2")], [["c1", "c2", "c3"],
                                                                            ["c1", "c2", "c3", "c4"]])
        for world in machines.values():
            for row in world.values():
                self.assertEqual(int(row["computing"]), threads)
                self.assertEqual(int(row["native"]), os.cpu_count())
                # The heartbeat and MPI have threads of their own; those that compute start when there is work.
                self.assertGreater(int(row["running"]), 1)
            if threads == 1:
                running = {name: int(row["running"]) for name, row in world.items()}
                # Frames are written by a thread of rank 0, which is on c1.
                self.assertEqual(running, {name: running["c2"] + (name == "c1") for name in running})
        server = [(row["world"], row["process"], int(row["running"])) for row in rows if row["process"] in
                  ("coordinator", "mpirun")]
        self.assertEqual([(world, process) for world, process, _ in server],
                         [(world, process) for world in ("1", "2") for process in ("coordinator", "mpirun")])
        self.assertTrue(all(running >= 1 for _, _, running in server), server)

    def test_a_fourth_machine_joins_when_all_spheres_touch_and_gets_one_when_they_part(self):
        self.check_tables(1)

    def test_and_so_it_is_with_two_threads_on_every_machine(self):
        self.check_tables(2)

    def test_by_measured_cost_the_machine_that_joins_gets_work_at_once(self):
        """And the rule, as all options, is kept for whoever resumes the run. The bits are those of the paper's rule."""
        process = self.start_real("c1", "c2", "c3", words=("--placement", "cost", "--at", "20 add c4=localhost"))
        frames = self.finish(process)["placement"]["frames"]
        self.assertTrue(any(len(frame["elements"]) == 4 and frame["elements"][3] > 0 and frame["time"] < 0.0014
                            for frame in frames), frames)
        self.assertEqual(self.record()["options"]["placement"], "cost")

    def test_the_tables_are_printed_at_the_end(self):
        self.local_hosts("c1", "c2", "c3")
        process = self.start_run("--threads", "1", *self.run_words, "--at", "90 add c4=localhost")
        output, error = process.communicate(timeout=90)
        self.assertEqual(process.returncode, 0, error)
        lines = [line.split() for line in output.splitlines()]
        frames = [words[1:] for words in lines if words[-1:] in (["start"], ["merge"], ["split"])]
        self.assertEqual([row[:9] for row in frames][2:], [
            ["768", "/", "392", "0", "/", "0", "0", "/", "0"], ["192", "/", "98", "192", "/", "98", "192", "/", "98"]])
        self.assertIn("1.25 of the model", output)
        threads = lines[[words[:2] for words in lines].index(["world", "coordinator"]) + 1:]
        self.assertEqual([words[words.index("c1") - 1] for words in threads], ["3", "4"])

    def test_plain_mpirun_gives_the_same_to_the_last_bit_on_any_number_of_ranks(self):
        for ranks, threads in ((3, 1), (2, 2), (5, 1)):
            with self.subTest(ranks=ranks, threads=threads):
                out = f"plain{ranks}"
                result = self.mpirun_plain(ranks, "run", "deck.toml", "--out", out, "--json", "--quiet", "--threads",
                                           threads, *self.run_words)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual(json.loads(result.stdout)["ranks"], ranks)
                self.check_equal(out)


if __name__ == "__main__":
    real.main()
