#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Exit codes, what is printed where, and that wrong input leaves nothing behind.

usage: command_line.py PROGRAM
"""
import json
import resource
import subprocess

import program


class WrongInput(program.Case):
    """Exit code 2, every error on stderr, nothing on stdout and nothing written."""

    def expect_refused(self, words, *pieces):
        before = self.names()
        result = self.fexp(*words)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertEqual(self.names(), before)
        for piece in pieces:
            self.assertIn(piece, result.stderr)
        return result.stderr

    def test_all_errors_of_a_deck_are_told_at_once_with_their_places(self):
        text = program.deck(duration=-1).replace("density =", "densty =").replace("[output]", "[output]\ndeflate = 11")
        (self.folder / "wrong.toml").write_text(text, encoding="utf-8")
        for command in ("run", "check"):
            error = self.expect_refused([command, "wrong.toml"], "wrong.toml:8:12: error: ", "densty", "deflate")
            self.assertGreaterEqual(error.count(": error: "), 3)
            self.assertGreaterEqual(error.count("; cure: "), 3)

    def test_errors_that_only_the_model_shows(self):
        self.write_deck("mesh.toml")
        path = self.folder / "mesh.toml"
        good = path.read_text(encoding="utf-8")
        path.write_text(good.replace('mesh = { kind = "plate"', 'mesh = { kind = "file", path = "no.msh" }\n#'),
                        encoding="utf-8")
        self.expect_refused(["run", "mesh.toml"], "no.msh")
        path.write_text(good.replace('nodes = ["rim"]', 'nodes = ["rum"]'), encoding="utf-8")
        self.expect_refused(["run", "mesh.toml"], "rum", "rim")

    def test_output_more_often_than_makes_sense(self):
        self.expect_refused(["run", self.write_deck(history_interval=1e-9)], "history_interval", "2e+09 times")

    def test_a_deck_that_is_not_there_or_no_file(self):
        self.expect_refused(["run", "nothing.toml"], "nothing.toml", "No such file")
        self.expect_refused(["run", "."], "directory")

    def test_unknown_words_with_the_nearest_known(self):
        name = self.write_deck()
        self.expect_refused(["rum", name], 'unknown command "rum"', "did you mean run?")
        self.expect_refused(["run", name, "--thread", "2"], "unknown option --thread;", "did you mean --threads?")
        self.expect_refused(["run", name, "--jsn"], "did you mean --json?")
        self.expect_refused(["run", name, "another.toml"], "another.toml")

    def test_options_out_of_range(self):
        name = self.write_deck()
        self.expect_refused(["run", name, "--threads", "0"], "--threads", "1 to")
        self.expect_refused(["run", name, "--threads", "two"], "--threads", "two")
        self.expect_refused(["run", name, "--hash-every", "0"], "--hash-every")
        self.expect_refused(["run", name, "--kernel", "mmx"], "--kernel", "mmx",
                            "accepted: auto, avx2, avx512, baseline, scalar")
        self.expect_refused(["run", name, "--placement", "best"], "--placement", "best", "accepted: cost, elements")
        self.expect_refused(["run"], "DECK")
        self.expect_refused([], "--help")

    def test_results_that_are_not_there(self):
        self.expect_refused(["info", "nothing.run"], "nothing.run")
        self.expect_refused(["compare", "a.run", "b.run"], "a.run")


class Output(program.Case):
    """Exit code 4: what could not be written is named, and what was written before can be read."""

    def test_a_directory_in_use_is_left_alone_unless_forced(self):
        self.run_deck("--out", "here")
        before = (self.folder / "here/summary.json").read_bytes()
        result = self.fexp("run", "deck.toml", "--out", "here")
        self.assertEqual(result.returncode, 4)
        self.assertIn("--force", result.stderr)
        self.assertEqual((self.folder / "here/summary.json").read_bytes(), before)
        self.run_deck("--out", "here", "--force", velocity=-1.0)
        self.assertNotEqual((self.folder / "here/summary.json").read_bytes(), before)

    def test_without_a_name_each_run_takes_a_new_one(self):
        files = [self.run_deck()["files"]["results"] for _ in range(3)]
        self.assertEqual(files, ["deck.run/results.vtkhdf", "deck-2.run/results.vtkhdf", "deck-3.run/results.vtkhdf"])

    def test_a_directory_that_cannot_be_made(self):
        (self.folder / "file").write_text("", encoding="utf-8")
        result = self.fexp("run", self.write_deck(), "--out", "file/inside")
        self.assertEqual(result.returncode, 4)
        self.assertIn("file/inside", result.stderr)

    def test_a_file_that_cannot_grow_leaves_the_frames_before(self):
        self.run_deck("--out", "whole")
        size = (self.folder / "whole/results.vtkhdf").stat().st_size
        counts = []
        for missing in range(1, 60000, 2500):
            limit = size - missing
            result = self.fexp("run", "deck.toml", "--out", "cut", "--force", "--json",
                               preexec_fn=lambda most=limit: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most)))
            self.assertEqual(result.returncode, 4, result.stderr)
            self.assertIn("cut/results.vtkhdf: error: cannot write results: File too large", result.stderr)
            summary = json.loads(result.stdout)
            self.assertEqual((summary["completed"], summary["exit_reason"]), (False, "output error"))
            read = self.fexp("info", "cut", "--json")
            self.assertEqual(read.returncode, 0, f"{missing} bytes are missing: {read.stderr}")
            self.assertEqual(json.loads(read.stdout)["frames"], summary["frames"])
            counts.append(summary["frames"])
        self.assertEqual(counts, sorted(counts, reverse=True))
        self.assertEqual((counts[0], counts[-1]), (4, 2))

    def test_standard_output_that_takes_nothing(self):
        name = self.write_deck()
        for words in (["run", name, "--json", "--quiet", "--out", "here"], ["info", "here"], ["reference"]):
            with open("/dev/full", "w", encoding="utf-8") as full:
                process = subprocess.run([program.PROGRAM, *words], check=False, stdout=full, stderr=subprocess.PIPE,
                                         text=True, cwd=self.folder)
            self.assertEqual(process.returncode, 4)
            self.assertIn("standard output", process.stderr)


class Compare(program.Case):
    def test_same_and_different_runs(self):
        self.run_deck("--out", "a", "--hash-every", "1")
        self.run_deck("--out", "b", "--hash-every", "1", "--threads", "1")
        self.run_deck("--out", "c", "--hash-every", "1", velocity=-2.0000000001)
        same = self.fexp("compare", "a", "b")
        self.assertEqual((same.returncode, same.stderr), (0, ""))
        different = self.fexp("compare", "a", "c")
        self.assertEqual(different.returncode, 1)
        self.assertIn("step 1, body 0 (ball)", different.stdout)


class Check(program.Case):
    def test_tells_masses_steps_and_time_and_writes_nothing(self):
        name = self.write_deck(cells=16)
        before = self.names()
        result = self.fexp("check", name, "--json")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual(self.names(), before)
        report = json.loads(result.stdout)
        ball = report["bodies"][0]
        mass = 1.0e-6 * 4.0 * 3.14159265 * 100.0
        self.assertAlmostEqual(ball["mass"] / mass, 1.0, delta=0.01)
        self.assertAlmostEqual(ball["inertia"][2] / (2.0 / 3.0 * mass * 100.0), 1.0, delta=0.02)
        self.assertEqual(ball["high"], [10.0, 10.0, 21.0])
        self.assertEqual([body["name"] for body in report["bodies"]], ["ball", "plate[0,0,0]", "plate[1,0,0]"])
        self.assertEqual(report["smallest_step_body"], "ball")
        summary = self.run_deck(cells=16)
        self.assertAlmostEqual(report["expected_steps"] / summary["steps"], 1.0, delta=0.1)

    def test_warns_of_bodies_that_are_inside_a_wall_at_the_start(self):
        path = self.folder / self.write_deck()
        self.assertNotIn("inside", self.fexp("check", "deck.toml").stdout)
        path.write_text(path.read_text(encoding="utf-8").replace("translate = [0.0, 0.0, 11.0]",
                                                                  "translate = [0.0, 0.0, 10.2]"), encoding="utf-8")
        result = self.fexp("check", "deck.toml")
        self.assertIn('body "ball": inside rigid wall "floor"', result.stdout)

    def test_a_trial_that_stops_says_why(self):
        result = self.fexp("check", self.write_deck(energy_drift_limit=1e-14))
        self.assertEqual(result.returncode, 3)
        self.assertIn("energy balance", result.stderr)


class Help(program.Case):
    def test_every_command_has_examples_and_the_exit_codes(self):
        overview = self.fexp("--help")
        self.assertEqual((overview.returncode, overview.stderr), (0, ""))
        for command in ("run", "check", "info", "compare", "bench", "reference", "cluster"):
            text = self.fexp(command, "--help").stdout
            self.assertIn(f"  fexp {command} ", text)
            self.assertIn(f"  fexp {command} ", overview.stdout)
            for code in ("0 ", "1 ", "2 ", "3 ", "4 ", "5 ", "6 ", "129", "130", "143"):
                self.assertIn(f"\n  {code}", text)

    def test_version(self):
        self.assertRegex(self.fexp("--version").stdout, r"^fexp \d+\.\d+\.\d+\n$")

    def test_the_reference_s_own_example_runs(self):
        text = self.fexp("reference").stdout
        example = text.split("```toml\n")[1].split("```")[0]
        (self.folder / "example.toml").write_text(example, encoding="utf-8")
        self.assertEqual(self.fexp("check", "example.toml").returncode, 0)


if __name__ == "__main__":
    program.main()
