#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Where the time of runs goes: samples of `perf record` by what the functions are for.

usage: profile.py FEXP DECK...

Prints a table with a column for each deck, in percent of all samples of a run on one thread. Needs perf.
"""

import collections
import pathlib
import re
import subprocess
import sys
import tempfile

# The first pattern that a symbol matches says what it is for.
PARTS = [
    ("element kernel, with the sums at nodes", r"update_\w*block"),
    ("critical step, once an epoch", r"smallest_step|smallest_layered|critical_step"),
    ("rigid walls and loads", r"[Ww]all|act_on|Loads"),
    ("contact search", r"find_near|NearEdge|BoxTree|BlockPairs|BlockWear|CandidateSearch|EdgeSearch|make_ready|prepare<|"
                       r"introsort|renew|CandidateRows"),
    ("contact pairs", r"NodeWatch|EdgeWatch|WatchedRows|IslandContact|view_of|lower_by|sharpness|closest|contact"),
    ("nodes: accelerations, half steps, motion", r"IslandSolver|update_nodes"),
]
REST = "all else: set-up, diagnostics, files, system"


def shares(program, deck):
    with tempfile.TemporaryDirectory() as name:
        samples = pathlib.Path(name) / "perf.data"
        run = [program, "run", deck, "--threads", "1", "--quiet", "--out", str(pathlib.Path(name) / "out")]
        subprocess.run(["perf", "record", "-q", "-o", str(samples), *run], check=True, stdout=subprocess.DEVNULL)
        report = ["perf", "report", "-i", str(samples), "--no-children", "-s", "symbol", "--stdio", "-q", "--percent-limit", "0"]
        text = subprocess.run(report, check=True, capture_output=True, text=True).stdout
    sums = collections.Counter()
    for line in text.splitlines():
        found = re.match(r"\s*([\d.]+)%\s+\[.\]\s+(.*)", line)
        if found:
            part = next((name for name, pattern in PARTS if re.search(pattern, found[2])), REST)
            sums[part] += float(found[1])
    return sums


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program, decks = sys.argv[1], sys.argv[2:]
    columns = [shares(program, deck) for deck in decks]
    print("| part of all samples [%] | " + " | ".join(f"`{deck}`" for deck in decks) + " |")
    print("|---" * (len(decks) + 1) + "|")
    for part in [name for name, _ in PARTS] + [REST]:
        print(f"| {part} | " + " | ".join(f"{column[part]:.0f}" for column in columns) + " |")


if __name__ == "__main__":
    main()
