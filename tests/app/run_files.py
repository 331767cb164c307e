#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a run writes: frames and rows at their times, columns with units, a summary that fits them.

usage: run_files.py PROGRAM
"""
import json
import math

import h5py
import program

KEYS = ["completed", "steps", "time", "elements", "nodes", "bodies", "threads", "ranks", "energy_error",
        "linear_momentum_error", "angular_momentum_error", "state_hash", "wall_seconds", "element_steps_per_second",
        "files"]


def multiples(interval, end):
    """0, the multiples below the end as the program computes them, and the end."""
    count = math.ceil(end / interval - 1e-6)
    return [k * interval for k in range(count)] + [end]


class Times(program.Case):
    def frame_times(self, run):
        with h5py.File(self.folder / run / "results.vtkhdf") as file:
            return list(file["VTKHDF/Steps/Values"])

    def test_frames_and_rows_stand_at_their_multiples_exactly(self):
        # 0.1 and 0.3 have multiples that differ by rounding only; 0.7 fits neither the other nor the end.
        for results, history, end in ((0.3, 0.1, 2.1), (0.1, 0.3, 2.1), (0.7, 0.1, 2.0), (5.0, 7.0, 1.0)):
            out = f"run-{results}-{history}"
            summary = self.run_deck("--out", out, duration=end, results_interval=results, history_interval=history)
            self.assertEqual(self.frame_times(out), multiples(results, end))
            self.assertEqual(summary["frames"], len(multiples(results, end)))
            for name in ("energies", "momenta", "steps", "walls"):
                times = [float(row["time"]) for row in self.table(f"{out}/{name}.csv")[0]]
                self.assertEqual(len(times), len(multiples(history, end)))
                for time, expected in zip(times, multiples(history, end)):
                    self.assertAlmostEqual(time, expected, delta=1e-12)
            self.assertEqual(summary["time"], end)
            steps = self.table(f"{out}/steps.csv")[0]
            smallest = min(float(row["dt"]) for row in steps[1:])
            self.assertGreater(smallest, 1e-3 * summary["step_largest"], "a step as short as a rounding error")

    def test_the_index_beside_lists_every_frame(self):
        self.run_deck("--out", "here")
        text = (self.folder / "here/results.xdmf2").read_text(encoding="utf-8")
        self.assertEqual(text.count("<Time "), len(multiples(0.5, 2.0)))


class Histories(program.Case):
    def setUp(self):
        super().setUp()
        self.summary = self.run_deck("--out", "here")

    def test_columns_have_names_and_units(self):
        headers = {name: self.table(f"here/{name}.csv")[1] for name in
                   ("energies", "momenta", "steps", "walls", "nodes", "bodies")}
        for name, header in headers.items():
            self.assertEqual(header[:2], ["step", "time [ms]"], name)
        self.assertEqual(headers["energies"][2:],
                         [f"{name} [kN*mm]" for name in
                          ("kinetic", "internal", "contact", "barrier", "external", "damping", "friction", "dissipated",
                           "balance")] +
                         ["relative_error"])
        self.assertEqual(headers["steps"][2:],
                         ["dt [ms]", "critical_step [ms]", "islands", "largest_island_elements", "candidates",
                          "contacts", "searches", "rollbacks", "deepest_penetration", "deleted"])
        self.assertEqual(headers["walls"][2:], ["floor_x [kN]", "floor_y [kN]", "floor_z [kN]"])
        self.assertEqual(headers["nodes"][2:5], ["set", "body", "node"])
        self.assertIn("acceleration_z [mm/ms^2]", headers["nodes"])
        self.assertIn("centre_x [mm]", headers["bodies"])
        self.assertIn("linear_z [kN*ms]", headers["momenta"])

    def test_chosen_nodes_and_bodies_and_no_others_are_written(self):
        nodes = self.table("here/nodes.csv")[0]
        first = [row for row in nodes if row["step"] == "0"]
        self.assertEqual(len(first), 2 * 12, "rim nodes of two plates of 3 x 3 cells")
        self.assertEqual({row["body"] for row in nodes}, {"plate[0,0,0]", "plate[1,0,0]"})
        bodies = self.table("here/bodies.csv")[0]
        self.assertEqual({row["body"] for row in bodies}, {"plate[0,0,0]", "plate[1,0,0]"})
        self.assertAlmostEqual(float(bodies[0]["centre_x"]), -9.0, delta=1e-12)
        self.assertAlmostEqual(float(bodies[0]["centre_z"]), 1.0, delta=1e-12)

    def test_elements_within_a_node_set_are_written(self):
        text = program.deck(duration=0.2).replace('nodes = ["rim"]', 'elements = ["rim"]')
        (self.folder / "deck.toml").write_text(text, encoding="utf-8")
        self.assertEqual(self.fexp("run", "deck.toml", "--quiet", "--out", "other").returncode, 0)
        self.assertFalse((self.folder / "other/nodes.csv").exists())
        rows, header = self.table("other/elements.csv")
        self.assertEqual(header[:5], ["step", "time [ms]", "set", "body", "element"])
        self.assertIn("stress_top_xy [kN/mm^2]", header)
        self.assertIn("shear_force_yz [kN/mm]", header)
        first = [row for row in rows if row["step"] == "0"]
        # The triangles that cut off two corners of a plate have all their nodes on its rim.
        self.assertEqual(len(first), 2 * 2)
        self.assertEqual({row["body"] for row in rows}, {"plate[0,0,0]", "plate[1,0,0]"})
        self.assertEqual({(row["thickness"], row["deleted"]) for row in first}, {("1", "0")})

    def test_the_largest_errors_of_the_rows_are_not_above_the_summary_s(self):
        rows = self.table("here/energies.csv")[0]
        self.assertGreater(float(rows[-1]["barrier"]) + float(rows[-1]["internal"]), 0.0, "nothing has touched")
        self.assertLessEqual(max(float(row["relative_error"]) for row in rows), self.summary["energy_error"])
        for row in rows:
            parts = sum(float(row[name]) for name in ("kinetic", "internal", "contact", "barrier", "damping", "friction"))
            self.assertAlmostEqual(parts - float(row["external"]), float(row["balance"]), delta=1e-12)
        self.assertEqual(self.summary["energies"]["kinetic"], float(rows[-1]["kinetic"]))
        searches = sum(int(row["searches"]) for row in self.table("here/steps.csv")[0])
        self.assertEqual(searches, self.summary["searches"])


class Planes(program.Case):
    def test_the_plane_s_force_is_what_changes_the_momentum(self):
        self.run_deck("--out", "here", history_interval=0.002, results_interval=2.0)
        walls = self.table("here/walls.csv")[0]
        momenta = self.table("here/momenta.csv")[0]
        self.assertTrue(all(int(row["step"]) <= n for n, row in enumerate(walls)), "a row for every step")
        impulse = 0.0
        for before, row in zip(walls, walls[1:]):
            dt = float(row["time"]) - float(before["time"])
            impulse += 0.5 * dt * (float(before["floor_z"]) + float(row["floor_z"]))
        change = float(momenta[-1]["linear_z"]) - float(momenta[0]["linear_z"])
        self.assertGreater(impulse, 0.1 * abs(float(momenta[0]["linear_z"])), "the plane was hardly touched")
        self.assertAlmostEqual(change / impulse, 1.0, delta=1e-9)


class Summary(program.Case):
    def test_json_on_stdout_is_the_summary_of_the_directory(self):
        summary = self.run_deck("--out", "here", "--threads", "1")
        for key in KEYS:
            self.assertIn(key, summary)
        self.assertEqual(json.loads((self.folder / "here/summary.json").read_text(encoding="utf-8")), summary)
        self.assertIs(summary["completed"], True)
        self.assertEqual((summary["elements"], summary["nodes"], summary["bodies"]), (192 + 36, 98 + 32, 3))
        self.assertEqual((summary["threads"], summary["ranks"]), (1, 1))
        self.assertRegex(summary["state_hash"], "^[0-9a-f]{16}$")
        for path in summary["files"].values():
            self.assertTrue((self.folder / path).is_file(), path)
        written = {name for name in self.names() if name.startswith("here/")}
        self.assertEqual(written, set(summary["files"].values()))
        self.assertEqual((self.folder / "here/deck.toml").read_bytes(), (self.folder / "deck.toml").read_bytes())

    def test_the_state_does_not_depend_on_threads_kernel_or_what_is_watched(self):
        hashes = {}
        for number, words in enumerate((["--threads", "1"], ["--threads", "2"], ["--threads", "5"],
                                        ["--kernel", "scalar"], ["--kernel", "baseline"], ["--hash-every", "3"])):
            summary = self.run_deck("--out", f"run{number}", *words)
            hashes.setdefault((summary["state_hash"], summary["steps"]), []).append(words)
        self.assertEqual(len(hashes), 1, hashes)

    def test_the_printed_summary_has_energies_momenta_and_files(self):
        result = self.fexp("run", self.write_deck())
        self.assertEqual(result.returncode, 0)
        for piece in ("a ball on a floor: completed", "energy [kN*mm]", "balance", "linear momentum", "wall time",
                      "deck.run: results.vtkhdf"):
            self.assertIn(piece, result.stdout)


if __name__ == "__main__":
    program.main()
