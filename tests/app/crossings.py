# SPDX-License-Identifier: Apache-2.0
"""fexp crossings: nothing crosses in the examples, and what crosses without contact is told.

usage: crossings.py PROGRAM
"""
import json
import math
import re
from pathlib import Path

import h5py

import program

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
# Long ones end here, after bodies have met.
SHORTENED = {"poured_spheres": 0.25}


class Crossings(program.Case):
    def run_example(self, name, contact=True):
        """The example's run, with its results as often as it asks for."""
        text = (EXAMPLES / f"{name}.toml").read_text(encoding="utf-8").replace('path = "', f'path = "{EXAMPLES}/')
        if name in SHORTENED:
            text = re.sub(r"(?m)^duration = .*$", f"duration = {SHORTENED[name]}", text)
        if not contact:
            text = re.sub(r"\[contact\]\n(\w.*\n)*", "", text) + "\n[contact]\nenabled = false\n"
        (self.folder / "deck.toml").write_text(text, encoding="utf-8")
        result = self.fexp("run", "deck.toml", "--quiet", "--force", "--out", "run")
        self.assertEqual(result.returncode, 0, result.stderr)
        return "run"

    def report(self, *words, code=0):
        result = self.fexp("crossings", *words, "--json")
        self.assertEqual((result.returncode, result.stderr), (code, ""))
        report = json.loads(result.stdout)
        self.assertEqual(report["crosses"], code == 1)
        return report

    def test_nothing_crosses_in_the_examples(self):
        decks = sorted(EXAMPLES.glob("*.toml"))
        self.assertGreaterEqual(len(decks), 7)
        for deck in decks:
            with self.subTest(deck=deck.name):
                report = self.report(self.run_example(deck.stem))
                self.assertGreater(len(report["frames"]), 5)
                self.assertEqual([frame for frame in report["frames"] if frame["pairs"]], [])
                text = self.fexp("crossings", "run").stdout
                self.assertRegex(text, r"^run/results\.vtkhdf: \d+ frames, time 0 to .*: nothing crosses\n$")

    def test_without_contact_spheres_cross_and_it_is_told_where(self):
        run = self.run_example("four_spheres", contact=False)
        frames = self.report(run, code=1)["frames"]
        # They are free at the start; then edges cut, and in the end the first pair has come out again.
        self.assertEqual(frames[0]["pairs"], [])
        crossed = [frame for frame in frames if frame["pairs"]]
        self.assertGreater(len(crossed), 50)
        pair = crossed[0]["pairs"][0]
        self.assertEqual(pair["bodies"], ["a", "b"])
        self.assertGreater(pair["edges_through_triangles"], 0)
        self.assertEqual(pair["of_these_at_start"], 0)
        self.assertEqual(crossed[0]["edges_through_triangles"],
                         sum(p["edges_through_triangles"] for p in crossed[0]["pairs"]))
        # The spheres meet in the middle between them, at x = 0.55.
        self.assertEqual(len(pair["first_edges"]), 3)
        for edge in pair["first_edges"]:
            self.assertAlmostEqual(edge["place"][0], 0.55, delta=0.01)
            self.assertEqual({edge["body"], edge["element_body"]}, {"a", "b"})
        self.assertGreater(max(frame["nodes_on_the_wrong_side"] for frame in crossed), 20)
        self.assertEqual({tuple(p["bodies"]) for frame in crossed for p in frame["pairs"]}, {("a", "b"), ("c", "d")})
        text = self.fexp("crossings", f"{run}/results.vtkhdf")
        self.assertEqual(text.returncode, 1)
        self.assertRegex(text.stdout, r'(?m)^ +edge \d+-\d+ of "a" through element \d+ of "b" at \(0\.5')
        self.assertRegex(text.stdout, r'(?m)^ +node \d+ of "\w" has passed through "\w" and is at ')
        self.assertIn("more rows, which --json lists", text.stdout)

        # What is left out is not told.
        self.assertEqual({tuple(p["bodies"]) for frame in self.report(run, "--exclude", "a", "b", code=1)["frames"]
                          for p in frame["pairs"]}, {("c", "d")})
        self.report(run, "--exclude", "b", "a", "--exclude", "c", "d")

    def test_edges_across_each_other_have_no_node_on_the_wrong_side(self):
        frames = self.report(self.run_example("edge_to_edge", contact=False), code=1)["frames"]
        plates = [p for frame in frames for p in frame["pairs"] if p["bodies"] == ["level", "upright"]]
        self.assertEqual((plates[0]["edges_through_triangles"], plates[0]["nodes_on_the_wrong_side"]), (2, 0))

    def test_what_crosses_at_the_start_is_told_and_is_no_failure(self):
        # The ball falls freely, and the plate of one body with it, so that they stay as they are.
        text = program.deck(duration=0.2).split("[[plane]]")[0].replace("-3.0, 1.0]", "-3.0, 8.0]")
        text = re.sub(r"(?s)\[body\.array\].*", "", text).replace("[-12.0,", "[6.0,")
        text = text.replace('name = "plate"', 'name = "plate"\nvelocity = [0.0, 0.0, -2.0]')
        self.folder.joinpath("deck.toml").write_text(text + "[contact]\nenabled = false\n", encoding="utf-8")
        self.assertEqual(self.fexp("run", "deck.toml", "--quiet", "--out", "run").returncode, 0)
        for frame in self.report("run")["frames"]:
            self.assertGreater(frame["of_these_at_start"], 0)
            self.assertEqual(frame["of_these_at_start"], frame["edges_through_triangles"])
        text = self.fexp("crossings", "run").stdout
        self.assertIn("as at the start", text)
        self.assertIn("nothing crosses but what does in the first frame", text)

    def test_copies_of_an_array_are_left_out_by_the_name_that_they_share(self):
        self.run_deck("--out", "run", duration=0.1)
        self.report("run", "--exclude", "plate", "ball", "--exclude", "plate", "plate")
        result = self.fexp("crossings", "run", "--exclude", "plat", "ball")
        self.assertEqual(result.returncode, 2)
        self.assertRegex(result.stderr, '--exclude: .*no body "plat".*cure: did you mean plate')

    def test_damaged_results_are_refused(self):
        self.run_deck("--out", "run", duration=0.1)
        results = self.folder / "run/results.vtkhdf"
        whole = results.read_bytes()

        def spoil(path, value):
            def change(file):
                file[path][0] = value
            return change

        def no_frames(file):
            file["VTKHDF/Steps"].attrs["NSteps"] = 0

        for change, found in ((no_frames, "there are no frames"),
                              (spoil("VTKHDF/Connectivity", 10**6), "nodes and bodies make no sense"),
                              (spoil("VTKHDF/Connectivity", -1), "nodes and bodies make no sense"),
                              (spoil("fexp/node_body", 77), "nodes and bodies make no sense"),
                              (spoil("VTKHDF/Points", math.nan), "positions in frame 0 are not finite")):
            results.write_bytes(whole)
            with h5py.File(results, "r+") as file:
                change(file)
            result = self.fexp("crossings", "run")
            self.assertEqual((result.returncode, result.stdout), (2, ""), found)
            self.assertRegex(result.stderr, f"results.vtkhdf: error: .*{found}; cure: ")

    def test_what_is_no_result_is_refused(self):
        self.write_deck()
        for words in (["deck.toml"], ["no_such.run"], [], ["deck.toml", "--exclude", "a"]):
            result = self.fexp("crossings", *words)
            self.assertEqual((result.returncode, result.stdout), (2, ""), words)
            self.assertIn("fexp: ", result.stderr)
        self.assertIn("fexp crossings four_spheres.run", self.fexp("crossings", "--help").stdout)


if __name__ == "__main__":
    program.main()
