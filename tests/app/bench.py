# SPDX-License-Identifier: Apache-2.0
"""fexp bench: what it promises of machine and rows. No time is judged, as the machine may be doing anything else.

usage: bench.py PROGRAM
"""
import json
import math
import os

import program

# Every case has these, each a positive number.
ROW = ("elements", "nodes", "threads", "repetitions", "element_steps_per_second", "nanoseconds_per_element_step",
       "microseconds_per_step", "steps", "islands", "flops_per_element_step", "bytes_per_element_step",
       "triad_bandwidth", "peak_flops", "separate_peak_flops", "share_of_triad_bandwidth", "share_of_peak_flops",
       "share_of_separate_peak_flops", "heap_bytes_per_element", "least_bytes_per_element")
SEARCH = ("elements", "nodes", "threads", "repetitions", "tree_elements_per_second",
          "search_elements_per_second", "triad_bandwidth", "peak_flops")
CASES = {"plate", "johnson_cook", "four_spheres", "quiet_contact", "separate_spheres", "meeting_spheres"}


class Bench(program.Case):
    def bench(self, *words):
        """What is printed as JSON."""
        result = self.fexp("bench", "--quick", "--seconds", "0.001", "--json", "--quiet", *words)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return json.loads(result.stdout)

    def expect_positive(self, row, keys):
        for key in keys:
            self.assertIsInstance(row[key], (int, float), key)
            self.assertTrue(math.isfinite(row[key]) and row[key] > 0, f"{key} is {row[key]}")

    def test_every_case_has_what_is_promised(self):
        report = self.bench("--threads", "1,2")
        machine = report["machine"]
        self.assertEqual(machine["hardware_threads"], os.cpu_count())
        self.assertIn(machine["instruction_set"], ("baseline", "avx2", "avx512"))
        self.assertTrue(machine["processor"])
        self.expect_positive(machine, ("triad_bandwidth", "peak_flops", "separate_peak_flops", "triad_array_bytes"))
        roofs = {one["threads"]: one for one in machine["by_threads"]}
        self.assertEqual(set(roofs), {1, 2})
        for key in ("triad_bandwidth", "peak_flops"):
            self.assertEqual(machine[key], roofs[2][key])
        self.assertEqual({row["case"] for row in report["rows"]}, CASES)
        self.assertEqual({row["case"] for row in report["searches"]}, {"search"})
        self.assertEqual({row["threads"] for row in report["rows"]}, {1, 2})
        for row in report["rows"]:
            self.expect_positive(row, ROW)
            self.assertGreaterEqual(row["spread"], 0)
            for key in ("triad_bandwidth", "peak_flops"):
                self.assertEqual(row[key], roofs[row["threads"]][key])
        for row in report["searches"]:
            self.expect_positive(row, SEARCH)

    def test_numbers_of_a_row_belong_together(self):
        report = self.bench("--threads", "1")
        for row in report["rows"]:
            rate = row["element_steps_per_second"]
            self.assertAlmostEqual(row["nanoseconds_per_element_step"] * rate, 1e9, delta=1)
            self.assertAlmostEqual(row["microseconds_per_step"] * rate / row["elements"], 1e6, delta=1e-3)
            for share, need, roof in (("share_of_triad_bandwidth", "bytes_per_element_step", "triad_bandwidth"),
                                      ("share_of_peak_flops", "flops_per_element_step", "peak_flops"),
                                      ("share_of_separate_peak_flops", "flops_per_element_step",
                                       "separate_peak_flops")):
                self.assertAlmostEqual(row[share] * row[roof] / (row[need] * rate), 1, delta=1e-9)
            # Whoever steps a model has at least its history, motion and connectivity in memory.
            self.assertGreater(row["heap_bytes_per_element"], row["least_bytes_per_element"])

    def test_operations_and_bytes_are_those_of_the_element(self):
        report = self.bench("--threads", "1", "--filter", "plate")
        element, node = report["element_step"]["element"], report["element_step"]["node"]
        for count in (element, node):
            self.assertEqual(count["flops"], count["additions"] + count["multiplications"] + count["divisions"]
                             + count["square_roots"])
        # Two frames have a division and two roots each, the turn of the material has one division.
        self.assertEqual((element["divisions"], element["square_roots"]), (3, 4))
        # Six components: force to acceleration, two half steps of a product and a sum each; three of them move.
        self.assertEqual((node["additions"], node["multiplications"]), (6 * 2 + 3, 6 * 3 + 3))
        # Both frames have 46 each (tests/unit/bench_element_step.cpp counts by hand), strains, resultants and forces
        # about five times that; a count outside of this range is a fault of the counting.
        self.assertTrue(400 < element["flops"] < 900, element)
        for row in report["rows"]:
            nodes = row["nodes"] / row["elements"]
            self.assertAlmostEqual(row["flops_per_element_step"], element["flops"] + nodes * node["flops"], delta=1e-9)
            # 12 doubles of history and 9 of a node's motion twice, two inverse masses, three corners.
            self.assertAlmostEqual(row["bytes_per_element_step"], 2 * 96 + 12 + nodes * (2 * 72 + 16), delta=1e-9)
            self.assertAlmostEqual(row["least_bytes_per_element"], 96 + 12 + nodes * (72 + 16), delta=1e-9)

    def test_cases_do_what_their_names_say(self):
        rows = {}
        for row in self.bench("--threads", "1")["rows"]:
            rows.setdefault(row["case"], []).append(row)
        self.assertEqual([row["elements"] for row in rows["four_spheres"]], [768, 4 * 12 * 8 * 8])
        for row in rows["plate"] + rows["quiet_contact"]:
            self.assertEqual((row["islands"], row["active_pairs"]), (1, 0))
        self.assertEqual(rows["plate"][0]["searches_per_step"], 0)
        separate, = rows["separate_spheres"]
        self.assertEqual((separate["islands"], separate["active_pairs"]), (separate["elements"] / 192, 0))
        meeting, = rows["meeting_spheres"]
        self.assertEqual(meeting["islands"], meeting["elements"] / 384)
        self.assertGreater(meeting["active_pairs"], 0)
        for name, given in rows.items():
            for row in given:
                self.assertEqual(row["contact_share"] is not None, name == "quiet_contact")
                # More than nothing is not promised: the times of the two may differ by more than contact takes.
                self.assertLess(row["contact_share"] or 0, 1)
        self.assertTrue(any(row["active_pairs"] > 0 for row in rows["four_spheres"]))

    def test_the_table_has_the_rows_of_the_report(self):
        report = self.bench("--filter", "s", "--csv", "rows.csv")
        rows, header = self.table("rows.csv")
        expected = report["rows"] + report["searches"]
        self.assertEqual([row["case"] for row in rows], [row["case"] for row in expected])
        self.assertIn("element_steps_per_second [1/s]", header)
        for row, other in zip(rows, expected):
            self.assertEqual(set(other) - set(row), set())
            for key, cell in row.items():
                value = other.get(key)
                if isinstance(value, (int, float)):
                    self.assertEqual(float(cell), value, key)
                else:
                    self.assertEqual(cell, value or "", key)
        self.assertEqual(self.names(), ["rows.csv"])

    def test_the_filter_takes_cases_by_a_part_of_their_names(self):
        report = self.bench("--filter", "_spheres", "--threads", "2")
        self.assertEqual({row["case"] for row in report["rows"]},
                         {"four_spheres", "separate_spheres", "meeting_spheres"})
        self.assertEqual((report["searches"], {row["threads"] for row in report["rows"]}), ([], {2}))

    def test_people_get_a_table_and_are_told_how_far_it_is(self):
        result = self.fexp("bench", "--quick", "--seconds", "0.001", "--filter", "plate", "--threads", "1")
        self.assertEqual(result.returncode, 0)
        for word in ("triad [GB/s]", "fused peak", "separate peak", "10^6 el-steps/s", "plate"):
            self.assertIn(word, result.stdout)
        self.assertIn("plate, 3200 triangles, 1 thread: ", result.stderr)
        self.assertEqual(self.names(), [])


class WrongInput(program.Case):
    def expect_refused(self, words, *pieces, code=2):
        result = self.fexp("bench", "--quick", "--seconds", "0.001", *words)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertEqual((result.stdout, self.names()), ("", []))
        for piece in pieces:
            self.assertIn(piece, result.stderr)

    def test_wrong_options(self):
        self.expect_refused(["--threads", "0"], "--threads", "Value 0", "1 to 4096")
        self.expect_refused(["--threads", "1,two"], "--threads", "two", "1 to 4096")
        self.expect_refused(["--seconds", "-1"], "--seconds", "Value -1")
        self.expect_refused(["--filter", "plat_"], "--filter", "plat_", "accepted: ", "four_spheres", "; cure: ")
        self.expect_refused(["--quik"], "unknown option --quik", "did you mean --quick")
        self.expect_refused(["plate"], "plate")

    def test_a_table_that_cannot_be_written(self):
        self.expect_refused(["--csv", "nowhere/rows.csv"], "nowhere/rows.csv", "No such file", "--csv", code=4)


if __name__ == "__main__":
    program.main()
