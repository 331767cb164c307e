#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What fexp check warns of, with the ids of the mesh file, and that the examples are free of it.

usage: quality.py PROGRAM
"""
import json
from pathlib import Path

import program

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"

DECK = """
[run]
duration = 1.0
[[material]]
name = "soft"
density = 1000.0
young = 1.0e6
poisson = 0.3
[[section]]
name = "skin"
material = "soft"
thickness = 0.1
[[body]]
name = "panel"
mesh = { kind = "file", path = "panel.msh" }
section = "skin"
velocity = [1.0, 0.0, 0.0]
"""


class Mesh:
    """A Gmsh file of plates; tags of nodes begin at 101, those of triangles at 701."""

    def __init__(self):
        self.nodes, self.triangles = [], []

    def plate(self, cells, x0=0.0, z=0.0):
        first = 101 + len(self.nodes)
        self.nodes += [(x0 + i, float(j), z) for j in range(cells + 1) for i in range(cells + 1)]
        for j in range(cells):
            for i in range(cells):
                a = first + j * (cells + 1) + i
                b, c, d = a + 1, a + cells + 2, a + cells + 1
                self.triangles += [(a, b, c), (a, c, d)]
        return self

    def write(self, path):
        text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n" % len(self.nodes)
        text += "".join(f"{101 + n} {x} {y} {z}\n" for n, (x, y, z) in enumerate(self.nodes))
        text += "$EndNodes\n$Elements\n%d\n" % len(self.triangles)
        text += "".join(f"{701 + t} 2 2 1 1 {a} {b} {c}\n" for t, (a, b, c) in enumerate(self.triangles))
        path.write_text(text + "$EndElements\n", encoding="utf-8")


class Quality(program.Case):
    def check(self, mesh, *words, deck=DECK):
        mesh.write(self.folder / "panel.msh")
        (self.folder / "deck.toml").write_text(deck, encoding="utf-8")
        return self.fexp("check", "deck.toml", *words)

    def findings(self, mesh, deck=DECK):
        """By kind."""
        result = self.check(mesh, "--json", deck=deck)
        self.assertEqual(result.returncode, 0, result.stderr)
        return {finding["kind"]: finding for finding in json.loads(result.stdout)["findings"]}

    def warnings(self, mesh, deck=DECK):
        return {kind for kind, finding in self.findings(mesh, deck).items() if finding["severity"] == "warning"}

    def test_a_sound_mesh_has_no_warning(self):
        result = self.check(Mesh().plate(3), "--strict")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertNotIn("warning", result.stdout)
        self.assertIn('  note: body "panel": 12 free edges\n', result.stdout)

    def test_a_seam_is_told_with_the_mesh_s_own_tags(self):
        mesh = Mesh().plate(3).plate(3, x0=3.0)
        result = self.check(mesh)
        self.assertEqual(result.returncode, 0)
        self.assertIn('warning: body "panel": 4 pairs of nodes lie on each other', result.stdout)
        self.assertIn("nodes 104 and 117, 108 and 121, 112 and 125, 116 and 129; ", result.stdout)
        self.assertEqual(self.check(mesh, "--strict").returncode, 2)
        found = self.findings(mesh)
        self.assertEqual(found["duplicate_nodes"]["ids"], [104, 108, 112, 116])
        self.assertEqual(found["duplicate_nodes"]["other_ids"], [117, 121, 125, 129])
        self.assertEqual(found["open_seam"]["count"], 3)
        self.assertEqual(found["pieces"]["count"], 2)

    def test_a_part_that_is_there_twice(self):
        found = self.findings(Mesh().plate(3).plate(3, z=0.001))
        self.assertEqual(found["overlapping_shells"]["severity"], "warning")
        self.assertEqual(found["overlapping_shells"]["count"], 18)
        self.assertAlmostEqual(found["overlapping_shells"]["numbers"]["smallest_distance"], 0.001)

    def test_a_normal_that_points_the_other_way(self):
        mesh = Mesh().plate(3)
        mesh.triangles[5] = mesh.triangles[5][::-1]
        self.assertEqual(self.findings(mesh)["turned_normals"]["ids"], [706])

    def test_a_sliver_and_the_step_without_it(self):
        mesh = Mesh().plate(10)
        mesh.nodes[60] = (4.02, 5.0, 0.0)
        sliver = self.findings(mesh)["slivers"]
        self.assertEqual(sliver["severity"], "warning")
        self.assertGreater(sliver["numbers"]["step_without"], 1.5 * sliver["numbers"]["step"])
        for tag in sliver["ids"]:
            self.assertIn(161, mesh.triangles[tag - 701])

    def test_what_nothing_acts_on(self):
        resting = DECK.replace("velocity = [1.0, 0.0, 0.0]", "")
        self.assertEqual(self.warnings(Mesh().plate(2), resting), {"idle"})
        self.assertEqual(self.warnings(Mesh().plate(2), resting + "[[gravity]]\nacceleration = [0, 0, -9.81]\n"), set())

    def test_the_examples_are_free_of_warnings(self):
        for deck in sorted(EXAMPLES.glob("*.toml")):
            with self.subTest(deck=deck.name):
                result = self.fexp("check", deck, "--strict")
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertNotIn("warning", result.stdout)


if __name__ == "__main__":
    program.main()
