#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs that do not reach their end: interrupted, killed, or stopped by a fault. What came before is readable.

usage: ending.py PROGRAM
"""
import json
import signal
import time

import h5py
import program


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
        self.assertGreater(summary["energy_error"], 1e-12)
        self.check_readable(summary["frames"])
        with h5py.File(self.folder / "here/results.vtkhdf") as file:
            self.assertEqual(file["VTKHDF/Steps/Values"][summary["frames"] - 1], summary["time"])
            self.assertEqual(file["fexp/step"][summary["frames"] - 1], summary["steps"])


if __name__ == "__main__":
    program.main()
