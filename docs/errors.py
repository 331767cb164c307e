#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs fexp on wrong decks, meshes and command lines and writes what it says to docs/errors.md.

usage: docs/errors.py PROGRAM            renews the page
       docs/errors.py PROGRAM --check    fails where the page is not what the program says

Either way every case must end with the exit code that the page gives and leave no file behind.
"""

import difflib
import pathlib
import re
import subprocess
import sys
import tempfile

PAGE = pathlib.Path(__file__).with_suffix(".md")

DECK = """title = "A ball falls on a plate"

[run]
duration = 0.001

[[material]]
name = "rubber"
density = 1100.0
young = 5.0e6
poisson = 0.45

[[section]]
name = "skin"
material = "rubber"
thickness = 0.005

[[body]]
name = "ball"
section = "skin"
mesh = { kind = "cubed_sphere", radius = 0.1, cells = 4 }
translate = [0.0, 0.0, 0.15]
velocity = [0.0, 0.0, -2.0]

[[body]]
name = "plate"
section = "skin"
mesh = { kind = "plate", length_x = 0.4, length_y = 0.4 }
translate = [-0.2, -0.2, 0.0]

[[node_set]]
name = "rim"
bodies = ["plate"]
boundary = true

[[fixed]]
set = "rim"

[[plane]]
name = "floor"
point = [0.0, 0.0, -0.3]
normal = [0.0, 0.0, 1.0]
"""

BALL_MESH = 'mesh = { kind = "cubed_sphere", radius = 0.1, cells = 4 }'
PLATE_MESH = 'mesh = { kind = "plate", length_x = 0.4, length_y = 0.4 }'

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"

MSH = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
2 1 "crown"
2 2 "flanges"
$EndPhysicalNames
$Nodes
4
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
$EndNodes
$Elements
2
1 2 2 1 1 1 2 3
2 2 2 2 1 1 3 4
$EndElements
"""


class Case:
    """The sound deck with texts replaced, or `deck` in its place, beside `files`, run with `options`."""

    def __init__(self, *changes, deck=None, files=None, options=(), command="run", code=2):
        self.deck = DECK if deck is None else deck
        for old, new in changes:
            assert self.deck.count(old) == 1, f"{old!r} stands {self.deck.count(old)} times in the deck"
            self.deck = self.deck.replace(old, new)
        self.files, self.command, self.options, self.code = files or {}, command, options, code

    def run(self, program):
        """What the program says on the standard error."""
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in {"deck.toml": self.deck, **self.files}.items():
                (root / name).parent.mkdir(exist_ok=True)
                (root / name).write_bytes(text if isinstance(text, bytes) else text.encode())
            before = contents(root)
            call = [program, self.command, *(self.options or ("deck.toml",))]
            done = subprocess.run(call, cwd=root, capture_output=True, text=True, check=False, timeout=60)
            assert done.returncode == self.code, f"{call} ended with {done.returncode}: {done.stderr}"
            assert contents(root) == before, f"{call} wrote {sorted(contents(root).keys() - before.keys())}"
            assert done.stdout == "", f"{call} printed {done.stdout}"
            return done.stderr


def contents(root):
    return {str(path): path.read_bytes() if path.is_file() else None for path in root.rglob("*")}


def with_mesh(name, text, *changes, parts=""):
    """The ball from a mesh file."""
    mesh = f'mesh = {{ kind = "file", path = "{name}" }}' + parts
    return Case((BALL_MESH, mesh), *changes, files={name: text})


CASES = {
    "The deck's text": {
        "No TOML": Case(("duration = 0.001", "duration = = 0.001")),
        "A text that does not end": Case(('name = "floor"', 'name = "floor')),
        "A key given twice": Case(("young = 5.0e6", "young = 5.0e6\nyoung = 6.0e6")),
        "Not a text file": Case(deck=b"\x7fELF\x02\x01\x00\xff\xfe" * 8),
        "An empty deck": Case(deck=""),
    },
    "Keys and values": {
        "An unknown key": Case(("thickness =", "thicknes =")),
        "An unknown section": Case(("[[fixed]]", "[[fixd]]")),
        "A wrong type": Case(("young = 5.0e6", 'young = "5.0e6"')),
        "A number with a decimal point where something is counted": Case(("cells = 4", "cells = 4.5")),
        "Two numbers for a vector": Case(("velocity = [0.0, 0.0, -2.0]", "velocity = [0.0, -2.0]")),
        "Out of range": Case(("poisson = 0.45", "poisson = 0.5"), ("density = 1100.0", "density = -1100.0")),
        "Not a number": Case(("duration = 0.001", "duration = nan")),
        "A required key left out": Case(("duration = 0.001", "safety = 0.9")),
        "An unknown mesh": Case(('kind = "plate"', 'kind = "plat"')),
        "A huge count": Case(("cells = 4", "cells = 100000000000")),
        "Too many elements": Case(
            ("cells = 4", "cells = 10000"),
            ("translate = [0.0, 0.0, 0.15]",
             "translate = [0.0, 0.0, 0.15]\narray = { count = [1000, 1000, 1], pitch = [1.0, 1.0, 0.0] }")),
        "Single brackets where there can be several": Case(("[[plane]]", "[plane]")),
    },
    "Names": {
        "A name given twice": Case(('name = "plate"', 'name = "ball"'), ('bodies = ["plate"]', 'bodies = ["ball"]')),
        "An unknown section of shells": Case(('section = "skin"\n' + PLATE_MESH, 'section = "skn"\n' + PLATE_MESH)),
        "An unknown material": Case(('material = "rubber"', 'material = "ruber"')),
        "An unknown node set": Case(('set = "rim"', 'set = "rims"')),
        "An unknown body": Case(('bodies = ["plate"]', 'bodies = ["plates"]')),
        "A node set without nodes": Case(("boundary = true",
                                          "box = { low = [5.0, 5.0, 5.0], high = [6.0, 6.0, 6.0] }")),
        "An unknown curve": Case(('set = "rim"', 'set = "rim"\n\n[[gravity]]\nacceleration = [0, 0, -9.81]\n'
                                  'curve = "ramp"')),
    },
    "Sense": {
        "A normal without direction": Case(("normal = [0.0, 0.0, 1.0]", "normal = [0.0, 0.0, 0.0]")),
        "A box the wrong way round": Case(("boundary = true", "box = { low = [1, 1, 1], high = [-1, -1, -1] }")),
        "Fixed and moved at once": Case(('set = "rim"', 'set = "rim"\n\n[[prescribed]]\nset = "rim"\ndof = "x"\n'
                                         "velocity = 1.0")),
        "Two prescribed motions": Case(('[[fixed]]\nset = "rim"', "".join(
            f'[[prescribed]]\nset = "rim"\ndof = "z"\nvelocity = {v}\n\n' for v in (1.0, 2.0)))),
        "A displacement and a velocity": Case(('[[fixed]]\nset = "rim"', '[[prescribed]]\nset = "rim"\ndof = "z"\n'
                                               "velocity = 1.0\ndisplacement = 1.0")),
        "A displacement at once": Case(('[[fixed]]\nset = "rim"', '[[prescribed]]\nset = "rim"\ndof = "z"\n'
                                        "displacement = 1.0")),
        "Axes that span no plane": Case(('set = "rim"', 'set = "rim"\ndofs = ["x"]\n'
                                         "axes = { x = [1.0, 0.0, 0.0], xy = [2.0, 0.0, 0.0] }")),
        "A tie whose nodes are too far away": Case(
            ('[[plane]]', '[[node_set]]\nname = "skin of the ball"\nbodies = ["ball"]\n\n'
                          '[[tie]]\nname = "weld"\nset = "skin of the ball"\nsurface = ["plate"]\n\n[[plane]]')),
        "A tied node that has a condition": Case(
            ('[[plane]]', '[[tie]]\nname = "weld"\nset = "rim"\nsurface = ["ball"]\n\n[[plane]]')),
        "A body that is tied to itself": Case(
            ('[[plane]]', '[[tie]]\nname = "weld"\nset = "rim"\nsurface = ["plate"]\n\n[[plane]]')),
        "A tie with a strength on a rigid body that moves": Case(
            ('name = "ball"', 'name = "ball"\nrigid = true'),
            ('[[plane]]', '[[tie]]\nname = "weld"\nset = "rim"\nsurface = ["ball"]\nstrength_normal = 1.0e6\n\n'
                          '[[plane]]')),
        "A part of a rigid body is held": Case(('name = "plate"', 'name = "plate"\nrigid = true')),
        "A mass of a body that deforms": Case(('name = "plate"', 'name = "plate"\nmass = 2.0')),
        "A wall with a velocity and a displacement": Case(
            ("normal = [0.0, 0.0, 1.0]", "normal = [0.0, 0.0, 1.0]\nvelocity = [0, 0, 1]\ndisplacement = [0, 0, 1]")),
        "A force on a wall without mass": Case(
            ("normal = [0.0, 0.0, 1.0]", "normal = [0.0, 0.0, 1.0]\nforce = [0.0, 0.0, 5.0]")),
        "A wall with mass that is told how to move": Case(
            ("normal = [0.0, 0.0, 1.0]", "normal = [0.0, 0.0, 1.0]\nmass = 5.0\nvelocity = [0.0, 0.0, 1.0]")),
        "A wall with mass that begins where it cannot go": Case(
            ("normal = [0.0, 0.0, 1.0]", "normal = [0.0, 0.0, 1.0]\nmass = 5.0\ninitial_velocity = [1.0, 0.0, 1.0]")),
        "A curve of a wall that stands": Case(
            ('set = "rim"', 'set = "rim"\n\n[[curve]]\nname = "ramp"\npoints = [[0, 0], [1, 1]]'),
            ("normal = [0.0, 0.0, 1.0]", 'normal = [0.0, 0.0, 1.0]\ncurve = "ramp"')),
        "Copies in one place": Case(("translate = [0.0, 0.0, 0.15]", "translate = [0.0, 0.0, 0.15]\n"
                                     "array = { count = [2, 1, 1], pitch = [0.0, 0.0, 0.0] }")),
        "A curve that goes back in time": Case(('set = "rim"', 'set = "rim"\n\n[[curve]]\nname = "ramp"\n'
                                                "points = [[0, 0], [2, 1], [1, 1]]")),
        "Hardening as stiff as the elastic material": Case(
            ("poisson = 0.45", 'poisson = 0.45\nlaw = "j2_linear"\nyield = 1.0e5\ntangent_modulus = 5.0e6')),
        "A table of hardening that falls": Case(
            ("poisson = 0.45", 'poisson = 0.45\nlaw = "j2_table"\ntable = [[0.0, 1.0e5], [0.1, 2.0e5], [0.2, 1.9e5]]')),
        "Two laws of the rate of strain": Case(
            ("poisson = 0.45", 'poisson = 0.45\nlaw = "j2_linear"\nyield = 1.0e5\nrate_sensitivity = 0.1\n'
                               'cowper_symonds = { rate = 40.0, exponent = 5.0 }')),
        "A filter of a rate that nothing depends on": Case(
            ("poisson = 0.45", 'poisson = 0.45\nlaw = "j2_linear"\nyield = 1.0e5\nrate_cutoff = 1.0e4')),
        "A material that has melted": Case(
            ("poisson = 0.45", 'poisson = 0.45\nlaw = "j2_linear"\nyield = 1.0e5\n'
                               'heating = { specific_heat = 2000.0, melting_temperature = 450.0, '
                               'reference_temperature = 293.0, initial_temperature = 500.0 }')),
        "Too few points of Lobatto's rule": Case(
            ("thickness = 0.005", 'thickness = 0.005\npoints = 2\nquadrature = "lobatto"')),
        "A velocity away from an axis, on it": Case(
            ('set = "rim"', 'set = "rim"\n\n[[initial_velocity]]\nset = "rim"\nradial = 1.0\npoint = [-0.2, -0.2, 0]')),
        "Parts of cells": Case(('set = "rim"', 'set = "rim"\n\n[refinement]\nfactor = 0.3')),
        "Expectations of meshes that are not run": Case(
            ('set = "rim"', 'set = "rim"\n\n[verify]\nmeshes = [1.0, 2.0]\n\n[[expect]]\nname = "peak"\n'
             'column = "displacement_z"\nreference = 1.0\ntolerance = 0.1\nmesh = 4.0')),
        "A penalty stiffness that is given and is not there": Case(
            ("normal = [0.0, 0.0, 1.0]", 'normal = [0.0, 0.0, 1.0]\n\n[contact]\npenalty = "given"')),
        "A pair of bodies with settings twice": Case(
            ("normal = [0.0, 0.0, 1.0]", "normal = [0.0, 0.0, 1.0]\n" + "".join(
                f'\n[[contact.pairs]]\nbodies = ["{a}", "{b}"]\nfriction = 0.1\n'
                for a, b in (("ball", "plate"), ("plate", "ball"))))),
        "A pair of bodies without settings": Case(
            ("normal = [0.0, 0.0, 1.0]", 'normal = [0.0, 0.0, 1.0]\n\n[[contact.pairs]]\nbodies = ["ball", "plate"]')),
        "Bodies that pass through each other and cannot be moved apart": Case(
            ("translate = [0.0, 0.0, 0.15]", "translate = [0.013, 0.007, 0.05]"),
            ("normal = [0.0, 0.0, 1.0]", 'normal = [0.0, 0.0, 1.0]\n\n[contact]\ninitial_penetrations = "remove"')),
        "A body without a section": Case(('section = "skin"\n' + BALL_MESH, BALL_MESH)),
    },
    "Meshes": {
        "A file that is not there": Case((BALL_MESH, 'mesh = { kind = "file", path = "bal.stl" }')),
        "A folder": Case((BALL_MESH, 'mesh = { kind = "file", path = "." }')),
        "An empty file": with_mesh("ball.stl", ""),
        "A file of another kind": with_mesh("ball.step", "ISO-10303-21;\nHEADER;\n"),
        "A file that breaks off": with_mesh("ball.msh", MSH[:MSH.index("3 1 1 0")]),
        "A node that is not there": with_mesh("ball.obj", TRIANGLE + "f 1 2 4\n"),
        "A letter in a number": with_mesh("ball.obj", TRIANGLE.replace("v 1", "v l") + "f 1 2 3\n"),
        "A triangle without area": with_mesh("ball.obj", TRIANGLE + "v 2 0 0\nf 1 2 3\nf 1 2 4\n"),
        "An edge of nine triangles": with_mesh(
            "ball.obj", TRIANGLE + "".join(f"v 0 {i} 1\nf 1 2 {i + 3}\n" for i in range(1, 10))),
        "A triangle that is there twice": with_mesh("ball.obj", TRIANGLE + "f 1 2 3\nf 3 1 2\n"),
        "A Moebius strip": with_mesh(
            "ball.obj", TRIANGLE + "v 1 1 1\nv 2 0 1\nv 2 1 0\n"
            + "".join(f"f {a} {b} {c}\n" for a, b, c in ((1, 2, 3), (2, 3, 4), (3, 4, 5), (4, 5, 1), (5, 1, 2)))),
        "A part without a section": with_mesh(
            "ball.msh", MSH, ('section = "skin"\n' + 'mesh = { kind = "file"', 'mesh = { kind = "file"'),
            parts='\nparts = [{ part = "crown", section = "skin" }]'),
        "An unknown part": with_mesh("ball.msh", MSH, parts='\nparts = [{ part = "crwn", section = "skin" }]'),
    },
    "The command line": {
        "A deck that is not there": Case(options=("dekc.toml",)),
        "A folder for a deck": Case(options=(".",)),
        "No deck": Case(options=("--quiet",)),
        "An unknown option": Case(options=("deck.toml", "--thread", "2")),
        "No thread": Case(options=("deck.toml", "--threads", "0")),
        "An unknown command": Case(command="rum"),
        "Threads that are no number": Case(command="bench", options=("--threads", "1,many")),
        "No such case": Case(command="verify", options=("99",)),
        "No such benchmark": Case(command="bench", options=("--filter", "sphere_")),
        "Something that is no result": Case(command="info", options=("deck.toml",)),
        "A comparison with nothing": Case(command="compare", options=("a.run", "b.run")),
        "Results that would be replaced": Case(files={"results/notes.txt": "mine\n"},
                                               options=("deck.toml", "--out", "results"), code=4),
        "A directory that cannot be": Case(options=("deck.toml", "--out", "deck.toml/results"), code=4),
    },
}

HEAD = """# What wrong input gets

What `fexp` says to wrong decks, meshes and command lines. Each message names the place, what is wrong, what is accepted
and the cure; all that can be found at once is told at once. The exit code is 2 unless noted, and nothing is written.

This page is made by `python3 docs/errors.py build/release/fexp`, which changes one thing in a sound deck of a ball and
a plate at a time and runs it.
"""


def page(program):
    text = HEAD
    for heading, cases in CASES.items():
        text += f"\n## {heading}\n"
        for title, case in cases.items():
            code = "" if case.code == 2 else f" Exit code {case.code}."
            call = " ".join(["fexp", case.command, *(case.options or ("deck.toml",))])
            said = re.sub(r"at most \S+ triangles", "at most ... triangles", case.run(program).rstrip("\n"))
            text += f"\n**{title}** (`{call}`).{code}\n\n```text\n{said}\n```\n"
    return text


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    made = page(program)
    if sys.argv[2:] == ["--check"]:
        present = PAGE.read_text(encoding="utf-8")
        sys.stdout.writelines(difflib.unified_diff(present.splitlines(True), made.splitlines(True), "page", "program"))
        return 0 if present == made else 1
    PAGE.write_text(made, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
