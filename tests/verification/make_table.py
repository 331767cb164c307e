#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes docs/verification.md from the rows that the verification tests append to a file.

usage: make_table.py ROWS DOCUMENT
       make_table.py --check ROWS DOCUMENT    exit code 1 when the document is not what the rows give

ROWS is the file that FEXP_VERIFICATION_ROWS names: one row a line, fields separated by tabs (case, title, quantity,
reference, result, error, tolerance, source of the reference).
"""
import sys
from collections import namedtuple
from pathlib import Path

Row = namedtuple("Row", "number title quantity reference result error tolerance source")

HEAD = """# Verification

Every row is a check in `tests/verification/`, which fails when the error exceeds the tolerance. The error is relative
to the reference, or absolute where the reference is zero. Made by `tests/verification/make_table.py`; to renew it:

    rm -f build/rows.tsv
    FEXP_VERIFICATION_ROWS=build/rows.tsv build/release/tests/verification_tests
    tests/verification/make_table.py build/rows.tsv docs/verification.md

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
    15: "Cantilever, step load",
    17: "Scordelis-Lo roof",
    21: "Large rotation under end shear",
    23: "Panel of 120 degrees under an explosive",
    24: "Clamped beam under an explosive",
    26: "Two equal strips end to end",
    27: "Penalty bounce",
    28: "Gravity: rest and drop on a plane",
    31: "Four spheres",
    32: "Renumbering, rotation and translation of the model",
    33: "Strip with a tip mass",
    34: "Damped strip",
    35: "Prescribed displacement",
    50: "Rigid body without moments",
    51: "Spinning rigid plate",
    52: "Thrown rigid plate",
    53: "Rigid ball on a plane",
    54: "Rigid ball on an elastic plate",
    55: "Plate pushed by a plane",
    56: "Ball and round walls",
    57: "Ball struck by a wall",
}


def read_rows(path):
    rows = []
    for line_number, line in enumerate(Path(path).read_text(encoding="utf-8").splitlines(), 1):
        fields = line.split("\t")
        if len(fields) != len(Row._fields):
            sys.exit(f"{path}:{line_number}: {len(fields)} fields instead of {len(Row._fields)}; remove the file and "
                     "run the tests again")
        rows.append(Row(*fields))
    seen = set()
    for row in rows:
        if (row.number, row.title, row.quantity) in seen:
            sys.exit(f"{path}: case {row.number}, {row.title}, {row.quantity} is there twice: the file holds more than "
                     "one run; remove it and run the tests again")
        seen.add((row.number, row.title, row.quantity))
    return rows


def document(rows):
    text = HEAD
    for number in sorted({int(row.number) for row in rows}):
        text += f"## {number}. {CASES.get(number, 'Other')}\n\n"
        text += "| case | quantity | reference | source | result | error | tolerance |\n|---|---|---|---|---|---|---|\n"
        for row in (row for row in rows if int(row.number) == number):
            cells = (row.title, row.quantity, row.reference, row.source, row.result, row.error, row.tolerance)
            text += "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |\n"
        text += "\n"
    return text.rstrip("\n") + "\n"


def main():
    arguments = sys.argv[1:]
    check = arguments[:1] == ["--check"]
    if len(arguments) != 2 + check:
        sys.exit(__doc__)
    rows, target = arguments[-2:]
    text = document(read_rows(rows))
    if check:
        if not Path(target).exists() or Path(target).read_text(encoding="utf-8") != text:
            print(f"{target} is not what {rows} gives; make it again with {sys.argv[0]} {rows} {target}")
            return 1
        return 0
    Path(target).write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
