# SPDX-License-Identifier: Apache-2.0
"""Starts the program on small decks in a directory that goes away, and reads back what it wrote."""

import csv
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM = ""

# A sphere falls on a rigid plane and on a small plate beside it.
DECK = """title = "a ball on a floor"
[units]
length = "mm"
time = "ms"
mass = "kg"
force = "kN"
[run]
duration = {duration}
epoch_steps = {epoch_steps}
energy_drift_limit = {energy_drift_limit}
[[material]]
name = "soft"
density = 1.0e-6
young = 0.01
poisson = 0.3
[[section]]
name = "skin"
material = "soft"
thickness = 1.0
[[body]]
name = "ball"
mesh = {{ kind = "cubed_sphere", radius = 10.0, cells = {cells} }}
section = "skin"
translate = [0.0, 0.0, 11.0]
velocity = [0.0, 0.0, {velocity}]
[[body]]
name = "plate"
mesh = {{ kind = "plate", length_x = 6.0, length_y = 6.0, cells_x = 3, cells_y = 3 }}
section = "skin"
translate = [-12.0, -3.0, 1.0]
[body.array]
count = [2, 1, 1]
pitch = [18.0, 0.0, 0.0]
[[node_set]]
name = "rim"
bodies = ["plate"]
boundary = true
[[fixed]]
set = "rim"
dofs = ["x", "y"]
[[plane]]
name = "floor"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
[output]
results_interval = {results_interval}
history_interval = {history_interval}
nodes = ["rim"]
bodies = ["plate"]
"""

USUAL = {
    "duration": 2.0,
    "epoch_steps": 64,
    "energy_drift_limit": 0.05,
    "cells": 4,
    "velocity": -2.0,
    "results_interval": 0.5,
    "history_interval": 0.1,
}


def deck(**changes):
    return DECK.format(**{**USUAL, **changes})


class Case(unittest.TestCase):
    """A test in its own directory."""

    maxDiff = None

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="fexp-app-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def write_deck(self, name="deck.toml", **changes):
        path = self.folder / name
        path.write_text(deck(**changes), encoding="utf-8")
        return name

    def fexp(self, *words, **options):
        """Runs the program to its end in the test's directory."""
        return subprocess.run([PROGRAM, *map(str, words)], check=False, capture_output=True, text=True,
                              cwd=self.folder, timeout=200, **options)

    def run_deck(self, *words, **changes):
        """A run that is completed: its summary."""
        result = self.fexp("run", self.write_deck(**changes), "--json", "--quiet", *words)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def start(self, *words, **options):
        """Starts the program in the test's directory, to be watched."""
        process = subprocess.Popen([PROGRAM, *map(str, words)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   text=True, cwd=self.folder, **options)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def names(self):
        """All files and directories there are."""
        return sorted(str(path.relative_to(self.folder)) for path in self.folder.rglob("*"))

    def table(self, path):
        """A history: its rows as dictionaries, by column names without units, and its header."""
        text = (self.folder / path).read_text(encoding="utf-8")
        self.assertTrue(text.endswith("\n"), f"{path} ends within a line")
        rows = list(csv.reader(text.splitlines()))
        names = [cell.split(" [")[0] for cell in rows[0]]
        for row in rows[1:]:
            self.assertEqual(len(row), len(names))
        return [dict(zip(names, row)) for row in rows[1:]], rows[0]


def main():
    global PROGRAM
    PROGRAM = str(Path(sys.argv.pop(1)).resolve())
    unittest.main(module="__main__", verbosity=2)
