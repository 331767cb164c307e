# SPDX-License-Identifier: Apache-2.0
"""fexp verify: its own suite, decks of a user, and what is wrong with them.

usage: verify.py PROGRAM
"""
import json

import program

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
        self.assertGreaterEqual(len(report["rows"]), 10)
        for row in report["rows"]:
            self.assertLessEqual(row["error"], row["tolerance"])
            scale = abs(row["reference"]) if row["relative"] else 1.0
            self.assertAlmostEqual(row["error"], abs(row["result"] - row["reference"]) / scale, delta=1e-9)

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
