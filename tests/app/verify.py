# SPDX-License-Identifier: Apache-2.0
"""fexp verify: its own suite, decks of a user, and what is wrong with them.

usage: verify.py PROGRAM
"""
import json
import pathlib
import subprocess
import sys

import program

PROJECT = pathlib.Path(__file__).resolve().parents[2]

EXPECT = """
[[expect]]
name = "fall"
history = "{history}"
column = "{column}"
body = "ball"
over_time = "last"
reference = {reference}
tolerance = 1.0e-3
"""

STRIP = """
[run]
duration = 1.0

[contact]
enabled = false

[[material]]
name = "soft"
density = 1.0
young = 10.0
poisson = 0.0

[[section]]
name = "strip"
material = "soft"
thickness = 0.1

[[body]]
name = "strip"
section = "strip"
mesh = {{ kind = "plate", length_x = 2.0, length_y = 1.0, cells_x = 4, cells_y = 2 }}

[[prescribed]]
set = "all"
dof = "x"
velocity = 0.25

[output]
nodes = ["all"]

[verify]
{verify}

[[expect]]
name = "own"
mesh = 1.0
column = "velocity_x"
reference = 0.25
tolerance = 1.0e-9

[[expect]]
name = "speed"
column = "velocity_x"
reference = 0.25
tolerance = 1.0e-9
"""


class Verify(program.Case):
    def deck_with(self, reference=-0.1, column="velocity_z", history="bodies"):
        """A ball in free flight keeps its velocity."""
        text = program.deck(duration=0.5, velocity=-0.1)
        head, output = text.split("[output]")
        output = output.replace('bodies = ["plate"]', 'bodies = ["ball"]')
        return self.write("ball.toml", head + "[output]" + output +
                          EXPECT.format(reference=reference, column=column, history=history))

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path

    def test_the_suite_is_as_expected(self):
        result = self.fexp("verify", "--json")
        report = json.loads(result.stdout)
        self.assertEqual((result.returncode, result.stderr, report["wrong"], report["stopped"]), (0, "", 0, []))
        self.assertGreaterEqual(len({row["case"] for row in report["rows"]}), 20)
        self.assertEqual(report["series"], [])
        for row in report["rows"]:
            self.assertEqual(row["factor"], 1.0)
            self.assertLessEqual(row["error"], row["tolerance"])
            scale = abs(row["reference"]) if row["relative"] else 1.0
            self.assertAlmostEqual(row["error"], abs(row["result"] - row["reference"]) / scale, delta=1e-9)
        # Results are the same bits everywhere, so the page has these very numbers.
        self.write("report.json", result.stdout)
        agree = subprocess.run([sys.executable, PROJECT / "tests/verification/make_table.py", "--agree",
                                self.folder / "report.json", PROJECT / "docs/verification.md"],
                               check=False, capture_output=True, text=True)
        self.assertEqual(agree.returncode, 0, agree.stdout + agree.stderr)

    def test_a_result_that_is_not_as_expected_is_told_and_is_the_exit_code(self):
        result = self.fexp("verify", self.deck_with())
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("1 of 1 results are as expected", result.stdout)
        result = self.fexp("verify", self.deck_with(reference=-0.2))
        self.assertEqual(result.returncode, 1)
        self.assertIn("WRONG", result.stdout)
        self.assertIn("0 of 1", result.stdout)

    def test_runs_are_kept_where_the_user_says_and_nowhere_else(self):
        deck = self.deck_with()
        before = self.names()
        self.fexp("verify", deck)
        self.assertEqual(self.names(), before)
        self.assertEqual(self.fexp("verify", deck, "--out", "runs").returncode, 0)
        self.assertTrue((self.folder / "runs/ball/bodies.csv").exists())

    def strip(self, extra="", verify="meshes = [0.5, 1.0, 2.0]"):
        """A strip whose root is pulled; its nodes follow the curve, whatever the mesh."""
        return self.write("strip.toml", STRIP.format(verify=verify) + extra)

    def test_refined_meshes_are_run_with_all_alone_and_held_from_the_decks_own_on(self):
        deck = self.strip()
        report = json.loads(self.fexp("verify", deck, "--json").stdout)
        self.assertEqual([(row["factor"], row["elements"]) for row in report["rows"]], [(1, 16)] * 2)
        self.assertEqual(report["series"], [])
        result = self.fexp("verify", deck, "--all", "--json", "--out", "runs")
        report = json.loads(result.stdout)
        self.assertEqual([row["elements"] for row in report["rows"] if row["quantity"] == "speed"], [4, 16, 64])
        coarse = [row for row in report["rows"] if row["factor"] == 0.5]
        self.assertTrue(all(row["tolerance"] is None and row["good"] for row in coarse))
        # One is for the deck's own mesh alone, and no series.
        self.assertEqual([row["factor"] for row in report["rows"] if row["quantity"] == "own"], [1])
        series, = report["series"]
        self.assertEqual((series["quantity"], [mesh["elements"] for mesh in series["meshes"]]), ("speed", [4, 16, 64]))
        self.assertEqual(json.loads((self.folder / "runs/verification.json").read_text()), report)
        # The deck of a refined run can be run by itself.
        refined = self.folder / "runs/strip_refined_2/deck.toml"
        self.assertIn("64 elements", self.fexp("check", refined).stdout)

    def test_an_order_below_the_least_is_wrong(self):
        # Nothing converges here: all meshes give the same.
        deck = self.strip("least_order = 1.0\n")
        self.assertEqual(self.fexp("verify", deck).returncode, 0)
        result = self.fexp("verify", deck, "--all")
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stdout, "(?m)^strip .*speed .*at least 1 expected: WRONG$")

    def test_a_long_case_is_run_with_all_or_by_name(self):
        self.strip(verify="long = true")
        self.assertIn("2 of 2 results", self.fexp("verify", "strip.toml").stdout)
        result = self.fexp("verify", "3", "12_strip_wave")
        self.assertRegex(result.stdout, "(?m)^03_transverse_shear .* ok ")
        self.assertRegex(result.stdout, "(?m)^12_strip_wave .* ok ")

    def test_wrong_cases_and_meshes_have_their_place_and_cure(self):
        result = self.fexp("verify", "no_such_case")
        self.assertEqual(result.returncode, 2)
        self.assertRegex(result.stderr, 'no case "no_such_case".*17_scordelis_lo_roof.*cure: ')
        for words, found in ((dict(verify="meshes = [2.0, 1.0]"), r"meshes is \[2, 1\]"),
                             (dict(verify="meshes = [0.5, 2.0]"), "1 among them"),
                             (dict(verify="meshes = [1.0, 2.0]", extra="mesh = 3.0\n"), "refined by 3 is not run"),
                             (dict(verify="", extra="least_order = 1.0\n"), "without refined meshes"),
                             (dict(verify="meshes = [1.0, 2.0]", extra="least_order = 1.0\n"), "no order follows"),
                             (dict(extra="[refinement]\nfactor = 2.0\n"), "refines its meshes")):
            result = self.fexp("verify", self.strip(**words), "--all")
            self.assertEqual(result.returncode, 2, words)
            self.assertRegex(result.stderr, r"strip\.toml:\d+:\d+: .*" + found + ".*cure: ")

    def test_what_is_wrong_with_an_expectation_has_its_line(self):
        for words in ({"column": "velocity"}, {"history": "momenta"}, {"history": "node"}):
            deck = self.deck_with(**words)
            result = self.fexp("verify", deck)
            self.assertEqual(result.returncode, 2, words)
            self.assertRegex(result.stderr, r"ball\.toml:\d+:\d+: .*cure: ")

    def test_a_deck_without_expectations_is_refused_and_a_fault_does_not_end_the_others(self):
        self.write("plain.toml", program.deck(duration=0.1))
        result = self.fexp("verify", "plain.toml")
        self.assertEqual(result.returncode, 2)
        self.assertIn("[[expect]]", result.stderr)
        good = self.deck_with()
        text = good.read_text().replace("energy_drift_limit = ", "energy_drift_limit = 1.0e-18 #")
        self.write("bad.toml", text.replace("-0.1", "-30.0"))
        result = self.fexp("verify", "bad.toml", good)
        self.assertEqual(result.returncode, 1)
        self.assertIn("1 of 1 results are as expected; 1 runs stopped", result.stdout)


if __name__ == "__main__":
    program.main()
