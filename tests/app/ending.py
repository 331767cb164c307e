#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs that do not reach their end: interrupted, killed, or stopped by a fault. What came before is readable.

usage: ending.py PROGRAM
"""
import json
import signal
import sys
import time
from pathlib import Path

import h5py
import numpy as np
import program

sys.path.append(str(Path(__file__).parents[1] / "results"))
from vtkhdf_layout import Results  # noqa: E402


class Ending(program.Case):
    def start_long_run(self, **changes):
        """A run of an hour or so, under way: its second frame is written."""
        settings = {"duration": 2.0e4, "results_interval": 1.0, "history_interval": 0.25, **changes}
        process = self.start("run", self.write_deck(**settings), "--out", "here", "--json")
        self.wait_for(lambda: "frame 1:" in self.log(), process)
        return process

    def log(self):
        path = self.folder / "here/log.txt"
        return path.read_text(encoding="utf-8") if path.exists() else ""

    def wait_for(self, condition, process):
        for _ in range(2000):
            if condition():
                return
            self.assertIsNone(process.poll(), "it has ended before")
            time.sleep(0.01)
        self.fail("waited for too long")

    def check_readable(self, frames=None):
        """Frames and rows stand at their times, the last frame excepted; returns their number."""
        with h5py.File(self.folder / "here/results.vtkhdf") as file:
            count = int(file["VTKHDF/Steps"].attrs["NSteps"])
            times = list(file["VTKHDF/Steps/Values"][:count])
            nodes = int(file["VTKHDF/NumberOfPoints"][0])
            self.assertGreaterEqual(len(file["VTKHDF/Points"]), count * nodes)
            self.assertTrue((abs(file["VTKHDF/Points"][: count * nodes]) < 1e3).all())
        if frames is not None:
            self.assertEqual(count, frames)
        self.assertEqual(times[:-1], [1.0 * k for k in range(count - 1)])
        rows = self.table("here/energies.csv")[0]
        self.assertEqual([float(row["time"]) for row in rows[:-1]], [0.25 * k for k in range(len(rows) - 1)])
        return count


class Interrupted(Ending):
    def expect_orderly_end(self, number, code):
        process = self.start_long_run()
        process.send_signal(number)
        output, error = process.communicate(timeout=60)
        self.assertEqual(process.returncode, code, error)
        self.assertIn("interrupted at time", error)
        self.assertIn("To go on: fexp resume", error)
        summary = json.loads(output)
        self.assertEqual((summary["completed"], summary["exit_reason"]), (False, "interrupted"))
        self.check_readable(summary["frames"])
        with h5py.File(self.folder / "here/results.vtkhdf") as file:
            self.assertEqual(file["VTKHDF/Steps/Values"][summary["frames"] - 1], summary["time"])
        self.assertEqual(float(self.table("here/energies.csv")[0][-1]["time"]), summary["time"])
        info = self.fexp("info", "here").stdout
        self.assertIn("ended early: interrupted", info)

    def test_ctrl_c_finishes_the_epoch_and_closes_the_files(self):
        self.expect_orderly_end(signal.SIGINT, 130)

    def test_so_does_sigterm(self):
        self.expect_orderly_end(signal.SIGTERM, 143)

    def test_a_second_signal_ends_at_once(self):
        # One epoch takes minutes.
        process = self.start("run", self.write_deck(duration=1e4, epoch_steps=100000, cells=60, results_interval=1e4,
                                                    history_interval=1e4), "--out", "here")
        self.wait_for(lambda: "frame 0:" in self.log(), process)
        process.send_signal(signal.SIGINT)
        time.sleep(0.5)
        self.assertIsNone(process.poll(), "the first signal must let the epoch finish")
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=5)
        self.assertEqual(process.returncode, -signal.SIGINT)
        with h5py.File(self.folder / "here/results.vtkhdf") as file:
            self.assertEqual(int(file["VTKHDF/Steps"].attrs["NSteps"]), 1)

    def test_nothing_is_lost_when_the_reader_of_progress_goes_away(self):
        process = self.start("run", self.write_deck(), "--out", "here")
        process.stdout.close()
        process.stderr.close()
        self.assertEqual(process.wait(timeout=60), 4)
        summary = json.loads((self.folder / "here/summary.json").read_text(encoding="utf-8"))
        self.assertIs(summary["completed"], True)


class Killed(Ending):
    def test_complete_frames_and_rows_stay(self):
        process = self.start_long_run()
        self.wait_for(lambda: "frame 7:" in self.log(), process)
        process.kill()
        process.communicate(timeout=60)
        self.assertGreaterEqual(self.check_readable(), 8)
        info = json.loads(self.fexp("info", "here", "--json").stdout)
        self.assertIn("unfinished", info["completeness"])
        # Rows up to the last frame are in the file.
        rows = self.table("here/energies.csv")[0]
        self.assertGreaterEqual(float(rows[-1]["time"]), 7.0 - 1e-9)


class Fault(Ending):
    def test_a_fault_names_the_place_and_the_cure_and_keeps_the_last_state(self):
        name = self.write_deck(duration=100.0, results_interval=1.0, history_interval=0.25, energy_drift_limit=1e-12)
        result = self.fexp("run", name, "--out", "here", "--json")
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertRegex(result.stderr, r'the energy balance is off by .* element \d+ of body "ball"; cure: ')
        summary = json.loads(result.stdout)
        self.assertEqual((summary["completed"], summary["exit_reason"]), (False, "fault"))
        self.assertEqual(summary["fault"]["body"], "ball")
        self.assertEqual(summary["retries"], 1)
        self.assertRegex(self.log(), "the epoch was put back and done again with half the step")
        self.assertGreater(summary["energy_error"], 1e-12)
        self.check_readable(summary["frames"])
        with h5py.File(self.folder / "here/results.vtkhdf") as file:
            self.assertEqual(file["VTKHDF/Steps/Values"][summary["frames"] - 1], summary["time"])
            self.assertEqual(file["fexp/step"][summary["frames"] - 1], summary["steps"])
        self.check_neighbourhood(summary)

    def check_neighbourhood(self, summary):
        """fault.vtkhdf has the start of the last epoch and the end, and the element of the fault first."""
        path = self.folder / "here/fault.vtkhdf"
        self.assertEqual(summary["files"]["fault"], "here/fault.vtkhdf")
        around = Results(path)
        self.assertEqual(around.frames, 2)
        self.assertEqual(around.times[1], summary["time"])
        self.assertLess(around.times[0], around.times[1])
        self.assertEqual(around.step(1), summary["steps"])
        everything = Results(self.folder / "here/results.vtkhdf")
        self.assertEqual(around.cells_count, everything.cells_count)
        labels, every_label = around.file["fexp/element_label"][:], everything.file["fexp/element_label"][:]
        self.assertEqual(labels[0], summary["fault"]["element"])
        bodies, names = around.data("CellData", 1)["body"], around.file["fexp/body_names"].asstr()[:]
        self.assertEqual(names[bodies[0]], summary["fault"]["body"])
        # The same elements at the same places with the same values as in the results.
        key = [(body, label) for body, label in zip(everything.data("CellData", 0)["body"], every_label)]
        place = {pair: index for index, pair in enumerate(key)}
        order = [place[pair] for pair in zip(bodies, labels)]
        last = everything.frames - 1
        for name, values in around.data("CellData", 1).items():
            self.assertTrue(np.array_equal(values, everything.data("CellData", last)[name][order]), name)
        centres = around.points(1)[around.triangles].mean(axis=1)
        whole = everything.points(last)[everything.triangles].mean(axis=1)
        self.assertTrue(np.array_equal(centres, whole[order]))
        self.assertTrue(np.isnan(around.data("PointData", 0)["contact_force"]).all())
        self.assertTrue(np.isfinite(around.data("PointData", 1)["contact_force"]).all())
        starts = around.points(0)[around.triangles].mean(axis=1)
        distance = np.linalg.norm(starts - starts[0], axis=1)
        self.assertTrue((np.diff(distance) >= -1e-12).all(), "not in order of distance")

    def test_a_fault_of_a_pair_names_both_bodies_and_shows_their_last_epochs(self):
        name = self.write_deck(duration=100.0, velocity=-6.0, energy_drift_limit=1e-3)
        text = (self.folder / name).read_text(encoding="utf-8").replace("translate = [-12.0, -3.0, 1.0]",
                                                                       "translate = [-3.0, -3.0, 0.9]")
        text = text.replace("count = [2, 1, 1]", "count = [1, 1, 1]")
        (self.folder / name).write_text(text + "[contact]\npenalty_scale = 0.01\nhardening = 0.0\n", encoding="utf-8")
        result = self.fexp("run", name, "--out", "here")
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertRegex(result.stderr, r'% of it by contact of body "ball" with body "plate\[0,0,0\]", hardest: node \d+ of body')
        for words in ("the last epochs:", 'body "ball"', 'body "plate[0,0,0]"', "contact work", "fault.vtkhdf"):
            self.assertIn(words, result.stderr)
        summary = json.loads((self.folder / "here/summary.json").read_text(encoding="utf-8"))
        fault = summary["fault"]
        self.assertEqual((fault["body"], fault["other_body"]), ("ball", "plate[0,0,0]"))
        self.assertGreater(fault["share"], 0.5)
        self.assertEqual(fault["history"][-1]["step"], summary["steps"])
        self.assertLessEqual(len(fault["history"]), 6)
        self.assertIn("the last epochs", self.log())

    def test_a_sound_run_leaves_no_file_of_a_fault_and_a_new_run_takes_an_old_one_away(self):
        self.fexp("run", self.write_deck(energy_drift_limit=1e-12), "--out", "here")
        self.assertTrue((self.folder / "here/fault.vtkhdf").exists())
        result = self.fexp("run", self.write_deck(), "--out", "here", "--force")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertFalse((self.folder / "here/fault.vtkhdf").exists())
        summary = json.loads((self.folder / "here/summary.json").read_text(encoding="utf-8"))
        self.assertEqual(summary["retries"], 0)
        self.assertNotIn("fault", summary["files"])


if __name__ == "__main__":
    program.main()
