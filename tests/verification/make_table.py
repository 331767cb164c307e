#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes docs/verification.md, and the plots in it, from what the verification decks and tests give.

usage: make_table.py DECKS ROWS DOCUMENT       renews the document and images/verification/ beside it
       make_table.py --agree DECKS DOCUMENT    exit code 1 when results of decks are not as the document has them

DECKS is what "fexp verify --all --json" prints; for --agree, what "fexp verify --json" prints will do. ROWS is the file
that FEXP_VERIFICATION_ROWS names: one row a line, fields separated by tabs (case, title, quantity, reference, result,
error, tolerance, source of the reference).
"""
import json
import math
import sys
from collections import namedtuple
from pathlib import Path

Row = namedtuple("Row", "number title elements quantity reference source result error tolerance")

HEAD = """# Verification

Every row is held to its tolerance. The error is relative to the reference, or absolute where the reference is zero. Rows
with a number of elements are decks in `verification/`, which `fexp verify` runs: their own meshes in less than a minute,
long ones and refined meshes with `--all` in some minutes. The others are tests in `tests/verification/`, of what a deck
cannot say: single elements and steps, laws without a mesh, stresses, higher modes. Some cases have both.

An order is that of the error towards the reference on the two finest meshes where the reference is what meshes
converge to; otherwise it follows, with the limit, from the three finest meshes. Where these are not refined by one ratio,
or results do not approach a limit on them, there is none.

Made by `tests/verification/make_table.py`; to renew it:

    rm -f build/rows.tsv
    build/release/fexp verify --all --json > build/decks.json
    FEXP_VERIFICATION_ROWS=build/rows.tsv build/release/tests/verification_tests
    tests/verification/make_table.py build/decks.json build/rows.tsv docs/verification.md

"""

CASES = {
    1: "Membrane patch",
    2: "Bending patch",
    3: "Constant transverse shear",
    4: "Eigenvalues of one element",
    5: "Finite rigid rotation in one step",
    6: "Free spinning plate",
    7: "Time reversal",
    8: "Central differences",
    9: "Stable step",
    10: "J2 law in plane stress",
    11: "Bending beyond the yield stress",
    12: "Strip wave",
    13: "Simply supported plate, free vibration",
    14: "Clamped and cantilever plates, free vibration",
    15: "Cantilever, step load",
    16: "NAFEMS 13T, step load",
    17: "Scordelis-Lo roof",
    18: "Pinched cylinder",
    19: "Twisted beam",
    20: "Square plates under a uniform load",
    21: "Large rotation under end shear",
    22: "Roll-up by an end moment",
    23: "Panel of 120 degrees under an explosive",
    24: "Clamped beam under an explosive",
    25: "Spherical cap under a step of pressure",
    26: "Two equal strips end to end",
    27: "Penalty bounce",
    28: "Gravity: rest and drop on a plane",
    29: "Friction",
    30: "Square tube crush",
    31: "Four spheres",
    32: "Renumbering, rotation and translation of the model",
    33: "Crossed edges, tip mass, tied patch",
    34: "Damped strip, glued layers",
    35: "Prescribed displacement, spinning tied plates",
    36: "Wave through a tied line",
    37: "Glue pulled off",
    38: "Glue in mixed mode",
    39: "Glue between plates that fly",
    50: "Rigid body without moments",
    51: "Spinning rigid plate",
    52: "Thrown rigid plate",
    53: "Rigid ball on a plane",
    54: "Rigid ball on an elastic plate",
    55: "Plate pushed by a plane",
    56: "Ball and round walls",
    57: "Ball struck by a wall",
    58: "Damping by the stiffness",
    59: "Block on a slope",
    60: "Plate on a moving plane",
    70: "Mass on a strip",
    71: "Walls that bounce",
    72: "Loaded platen",
    73: "Sphere on a plate",
    74: "Stable step of plates that become thicker",
    75: "Adiabatic pure shear",
    76: "Adiabatic tensile test",
    77: "Filtered rate of strain",
    78: "Cowper and Symonds's law",
}
COLOURS = ("#1f5fa8", "#c4501b", "#2f7d3b", "#7a3f9a", "#806000", "#444444")


def read_rows(path):
    rows = []
    for line_number, line in enumerate(Path(path).read_text(encoding="utf-8").splitlines(), 1):
        fields = line.split("\t")
        if len(fields) != 8:
            sys.exit(f"{path}:{line_number}: {len(fields)} fields instead of 8; remove the file and run the tests again")
        number, title, quantity, reference, result, error, tolerance, source = fields
        rows.append(Row(int(number), title, "", quantity, reference, source, result, error, tolerance))
    names = [(row.number, row.title, row.quantity) for row in rows]
    for name in names:
        if names.count(name) > 1:
            sys.exit(f"{path}: case {name[0]}, {name[1]}, {name[2]} is there twice: the file holds more than one run; "
                     "remove it and run the tests again")
    return rows


def number_of(case):
    return int(case.split("_")[0])


def deck_rows(report):
    """Rows of all results that are held to a tolerance."""
    return [Row(number_of(row["case"]), row["title"], str(row["elements"]), row["quantity"], f"{row['reference']:.9g}",
                row["source"], f"{row['result']:.9g}", f"{row['error']:.2e}", f"{row['tolerance']:.1e}")
            for row in report["rows"] if row["tolerance"] is not None]


def line_of(cells):
    return "| " + " | ".join(str(cell).replace("|", "\\|") for cell in cells) + " |\n"


def table(rows):
    names = ("case", "elements", "quantity", "reference", "source", "result", "error", "tolerance")
    return line_of(names) + "|---" * len(names) + "|\n" + "".join(line_of(row[1:]) for row in rows)


def series_table(series):
    names = ("quantity", "elements", "result", "error", "order")
    text = line_of(names) + "|---" * len(names) + "|\n"
    for one in series:
        for mesh in one["meshes"]:
            last = mesh is one["meshes"][-1]
            order = ""
            if last:
                order = "none" if one["order"] is None else f"{one['order']:.2f}"
                order += "" if one["limit"] is None else f", limit {one['limit']:.6g}"
                order += "" if one["least_order"] is None else f", at least {one['least_order']:g} asked"
            text += line_of((one["quantity"], mesh["elements"], f"{mesh['result']:.6g}", f"{mesh['error']:.2e}", order))
    return text


class Plot:
    """Errors over refinement, both axes by decades."""
    width, height, left, right, top, bottom = 520, 340, 64, 14, 34, 46

    def __init__(self, title, curves):
        points = [point for _, curve in curves for point in curve]
        self.low_x, self.high_x = (f(math.log2(x) for x, _ in points) for f in (min, max))
        self.low_y = math.floor(min(math.log10(y) for _, y in points))
        self.high_y = max(math.ceil(max(math.log10(y) for _, y in points)), self.low_y + 1)
        self.parts = []
        self.text(self.left, 20, title, "start", 'font-weight="bold"')
        self.axes(sorted({x for x, _ in points}))
        for i, (name, curve) in enumerate(curves):
            self.curve(name, curve, COLOURS[i % len(COLOURS)], self.top + 14 + 16 * i)

    def x(self, factor):
        share = (math.log2(factor) - self.low_x) / (self.high_x - self.low_x)
        return self.left + share * (self.width - self.left - self.right)

    def y(self, error):
        share = (math.log10(error) - self.low_y) / (self.high_y - self.low_y)
        return self.height - self.bottom - share * (self.height - self.top - self.bottom)

    def text(self, x, y, text, anchor="middle", more=""):
        escaped = text.replace("&", "&amp;").replace("<", "&lt;")
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" {more}>{escaped}</text>')

    def line(self, points, colour, width):
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        self.parts.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="{width}"/>')

    def axes(self, factors):
        for decade in range(self.low_y, self.high_y + 1):
            y = self.y(10.0 ** decade)
            self.line([(self.left, y), (self.width - self.right, y)], "#dddddd", 1)
            self.text(self.left - 6, y + 4, f"1e{decade}", "end")
        for factor in factors:
            x = self.x(factor)
            self.line([(x, self.top), (x, self.height - self.bottom)], "#dddddd", 1)
            self.text(x, self.height - self.bottom + 16, f"{factor:g}")
        self.text((self.left + self.width - self.right) / 2, self.height - 8, "cells per length over those of the deck")

    def curve(self, name, points, colour, legend):
        place = [(self.x(x), self.y(y)) for x, y in points]
        self.line(place, colour, 2)
        for x, y in place:
            self.parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.5" fill="{colour}"/>')
        self.text(self.width - self.right - 6, legend, name, "end", f'style="fill:{colour}"')

    def svg(self):
        return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{self.width}" height="{self.height}" '
                f'viewBox="0 0 {self.width} {self.height}" font-family="Helvetica, Arial, sans-serif" font-size="12">\n'
                '<rect width="100%" height="100%" fill="white"/>\n' + "\n".join(self.parts) + "\n</svg>\n")


def curve_of(one):
    """Distance from the reference where it is exact, from the limit where there is one, and its name."""
    goal = one["limit"] if not one["exact"] and one["limit"] is not None else one["reference"]
    name = one["quantity"] + (", from the limit" if goal == one["limit"] else "")
    points = [(mesh["factor"], abs(mesh["result"] - goal) / (abs(goal) or 1.0)) for mesh in one["meshes"]]
    return name, [(factor, error) for factor, error in points if error > 0.0]


def write_document(report, rows, target):
    images = target.parent / "images/verification"
    images.mkdir(parents=True, exist_ok=True)
    for old in images.glob("*.svg"):
        old.unlink()
    text = HEAD
    titles = {row["case"]: row["title"] for row in report["rows"]}
    for number in sorted({row.number for row in rows}):
        text += f"## {number}. {CASES.get(number, 'Other')}\n\n" + table(r for r in rows if r.number == number) + "\n"
        for case, title in titles.items():
            series = [one for one in report["series"] if one["case"] == case]
            if number_of(case) != number or not series:
                continue
            text += f"{title}, refined meshes:\n\n{series_table(series)}\n"
            curves = [curve for curve in map(curve_of, series) if len(curve[1]) > 1]
            if curves:
                (images / f"{case}.svg").write_text(Plot(title + ": relative error", curves).svg(), encoding="utf-8")
                text += f"![Errors over refinement](images/verification/{case}.svg)\n\n"
    target.write_text(text.rstrip("\n") + "\n", encoding="utf-8")


def disagreements(report, document):
    """Results that the document has otherwise or not at all, and those it has of these cases that nobody gives."""
    lines = set(document.splitlines())
    given = {line_of(row[1:]).rstrip("\n") for row in deck_rows(report)}
    titles = {(row["title"], str(row["elements"])) for row in report["rows"]}
    known = {line for line in lines if tuple(cell.strip() for cell in line.split("|")[1:3]) in titles}
    return sorted(given - lines) + sorted(known - given)


def main():
    arguments = sys.argv[1:]
    agree = arguments[:1] == ["--agree"]
    if len(arguments) != 3:
        sys.exit(__doc__)
    target = Path(arguments[2])
    if agree:
        report = json.loads(Path(arguments[1]).read_text(encoding="utf-8"))
        wrong = disagreements(report, target.read_text(encoding="utf-8"))
        if wrong:
            print(f"{target} and fexp verify disagree; the head of the page says how to renew it:", *wrong, sep="\n")
        return 1 if wrong else 0
    report = json.loads(Path(arguments[0]).read_text(encoding="utf-8"))
    if report["stopped"]:
        sys.exit(f"{arguments[0]}: runs were stopped: {', '.join(report['stopped'])}")
    write_document(report, read_rows(arguments[1]) + deck_rows(report), target)
    return 0


if __name__ == "__main__":
    sys.exit(main())
