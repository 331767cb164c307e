#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Counts the instructions of kernels and steps under valgrind and holds them against counts.csv, which is of one
compiler. A count more than 5 % above the table's fails; any other difference is told. With --update the table is
written anew. Exit code 77, a skipped test, where nothing can be compared.

usage: count.py PROGRAM --compiler "NAME VERSION" --build FLAGS --valgrind PROGRAM [--update]
       count.py --self-test
"""
import argparse
import csv
import io
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

TABLE = Path(__file__).with_name("counts.csv")
HEADER = ["case", "kernel", "part", "per", "instructions", "compiler"]
ALLOWED = 0.05  # More than the table has
BUILD = "Release -O3 -DNDEBUG"
SKIPPED = 77
NO_SUCH_KERNEL = 3  # Exit code of the program

# Functions whose instructions, with all that they call, are counted, and what one of them is for.
PARTS = {
    "epoch": ("(anonymous namespace)::counted_epoch", "element and step"),
    "step": ("fexp::solve::IslandSolver::advance", "element and step"),
    "element kernel": ("fexp::solve::kernels::update_blocks_{kernel}", "element and step"),
    "node kernel": ("fexp::solve::kernels::update_nodes_{kernel}", "node and step"),
    "critical step": ("fexp::solve::kernels::smallest_step_{kernel}", "element"),
    "contact forces": ("fexp::contact::IslandContact::evaluate", "element and step"),
    "block pairs": ("fexp::contact::BlockPairs::search", "element and search"),
    "node search": ("fexp::contact::CandidateSearch::search", "element and search"),
    "edge search": ("fexp::contact::EdgeSearch::search", "element and search"),
}


@dataclass(frozen=True)
class Case:
    """A scene of so many elements, about, stepped or searched in so often."""
    scene: str
    elements: int
    kernel: str
    count: int
    parts: tuple


# The critical step is taken by the widest kernel that runs, whichever steps the elements.
CASES = (
    Case("plate", 3200, "avx2", 64, ("epoch", "step", "element kernel", "node kernel", "critical step")),
    Case("plate", 3200, "baseline", 64, ("epoch", "step", "element kernel", "node kernel")),
    Case("held_plate", 3200, "avx2", 64, ("epoch", "step")),
    Case("quiet_plate", 3200, "avx2", 128, ("epoch", "step")),
    Case("meeting_spheres", 1536, "avx2", 64, ("epoch", "step", "contact forces")),
    Case("search", 3200, "avx2", 4, ("block pairs", "node search", "edge search")),
)


class Skip(Exception):
    """Why nothing can be compared."""


class Failure(Exception):
    """Why nothing could be counted."""


def inclusive_counts(profile):
    """Function -> its instructions with those of all that it calls, of a profile in callgrind's format without
    abbreviations. For functions that do not call themselves."""
    counts = {}
    function = None
    for line in profile.splitlines():
        if line.startswith("fn="):
            function = line[len("fn="):]
        elif function and line and line[0] in "0123456789+-*":
            counts[function] = counts.get(function, 0) + int(line.split()[1])
    return counts


def count_of(counts, name):
    """That of the function of this name, whatever its arguments."""
    found = [count for function, count in counts.items()
             if function.startswith(f"{name}(") and "[clone" not in function]
    if len(found) != 1:
        raise Failure(f"{len(found)} functions in the profile are called {name}; was it renamed, or inlined?")
    return found[0]


def unit_of(part, numbers):
    """What the instructions of a part are divided by."""
    per = PARTS[part][1]
    amount = numbers["elements" if per.startswith("element") else "nodes"]
    for word in ("step", "search"):
        if per.endswith(f"and {word}"):
            amount *= numbers["searches" if word == "search" else "steps"]
    if amount == 0:
        raise Failure(f"nothing was done that \"{part}\" is for: {numbers}")
    return amount


def count_case(valgrind, program, case):
    """(case, kernel, part) -> instructions."""
    with tempfile.TemporaryDirectory() as folder:
        profile = Path(folder) / "profile"
        command = [valgrind, "--tool=callgrind", f"--callgrind-out-file={profile}", "--toggle-collect=*counted_*",
                   "--compress-strings=no", "--compress-pos=no", program, case.scene, str(case.elements), case.kernel,
                   str(case.count)]
        # No variable of the caller, as libraries choose their ways by some.
        result = subprocess.run(command, check=False, capture_output=True, text=True, cwd=folder,
                                env={"PATH": "/usr/bin:/bin", "LC_ALL": "C"})
        if result.returncode == NO_SUCH_KERNEL:
            raise Skip(result.stderr.strip().splitlines()[-1])
        if result.returncode != 0:
            raise Failure(f"{' '.join(map(str, command))}\nended with {result.returncode}\n{result.stdout}{result.stderr}")
        counts = inclusive_counts(profile.read_text())
    numbers = {name: int(number) for name, number in (line.split() for line in result.stdout.splitlines())}
    if (numbers["active_pairs"] > 0) != ("contact forces" in case.parts):
        raise Failure(f"{case.scene} has {numbers['active_pairs']} contacts")
    return {(case.scene, case.kernel, part):
            count_of(counts, PARTS[part][0].format(kernel=case.kernel)) / unit_of(part, numbers)
            for part in case.parts}


def text_of(counted, compiler):
    """The table."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(HEADER)
    for key, count in counted.items():
        writer.writerow([*key, PARTS[key[2]][1], f"{count:.2f}", compiler])
    return out.getvalue()


def read_table(text):
    """Its counts by (case, kernel, part), and its compilers."""
    rows = list(csv.DictReader(io.StringIO(text)))
    table = {(row["case"], row["kernel"], row["part"]): float(row["instructions"]) for row in rows}
    return table, {row["compiler"] for row in rows}


def compare(table, counted):
    """Faults, and remarks on what changed without being one."""
    faults, remarks = [], []
    for key in table.keys() | counted.keys():
        name = ", ".join(key)
        if key not in counted:
            faults.append(f"{name}: in the table, but not counted")
        elif key not in table:
            faults.append(f"{name}: counted, but not in the table")
        else:
            change = counted[key] / table[key] - 1.0
            line = f"{name}: {counted[key]:.2f} instructions instead of {table[key]:.2f}, {100 * change:+.1f} %"
            if not change <= ALLOWED:
                faults.append(line)
            elif f"{counted[key]:.2f}" != f"{table[key]:.2f}":
                remarks.append(line)
    return sorted(faults), sorted(remarks)


def check_comparable(text, compiler, build, valgrind):
    """Raises Skip where there is nothing to compare with."""
    if not shutil.which(valgrind):
        raise Skip("there is no valgrind")
    if build != BUILD:
        raise Skip(f"the table is of the build \"{BUILD}\"; this one is \"{build}\"")
    _, compilers = read_table(text)
    if compilers != {compiler}:
        raise Skip(f"the table is of {' and '.join(sorted(compilers))}; the compiler is {compiler}")


def judge(text, counted, compiler):
    """Prints what differs; true unless something is a fault."""
    faults, remarks = compare(read_table(text)[0], counted)
    lines = dict(zip(counted, text_of(counted, compiler).splitlines()[1:]))
    for title, differences in (("Faults:", faults), ("Changed:", remarks)):
        if differences:
            print(title, *differences, sep="\n  ")
    if faults or remarks:
        new = [line for line in lines.values() if line not in text.splitlines()]
        print(f"Lines for {TABLE.name} (cmake --build BUILD --target renew_instruction_counts writes them):", *new,
              sep="\n  ")
    if not faults:
        print(f"{len(counted)} counts are within {100 * ALLOWED:.0f} % of the table")
    return not faults


PROFILE = """events: Ir

ob=program
fl=???
fn=space::inner(int)
10 100
cfn=other()
calls=2 5
11 40

fn=space::inner(int) [clone .cold]
12 7

fn=outer()
0 1
cob=library
cfi=file
cfn=space::inner(int)
calls=1 10
0 140

totals: 288
"""


def expect_skip(word, *arguments):
    try:
        check_comparable(*arguments)
    except Skip as reason:
        assert word in str(reason), reason
        return
    raise AssertionError(f"not skipped for {word}")


def self_test():
    keys = [("plate", "avx2", part) for part in ("epoch", "step", "element kernel")]
    text = text_of({key: 200.0 for key in keys}, "GNU 1")
    table, compilers = read_table(text)
    assert table == {key: 200.0 for key in keys} and compilers == {"GNU 1"}

    def outcome(**changes):
        counted = {key: 200.0 * changes.get(key[2], 1.0) for key in keys}
        faults, remarks = compare(table, counted)
        assert judge(text, counted, "GNU 1") == (not faults)
        return len(faults), len(remarks)

    for changes, expected in (({}, (0, 0)), ({"step": 1.06}, (1, 0)), ({"step": 1.04}, (0, 1)),
                              ({"step": 0.94}, (0, 1)), ({"step": 0.96, "epoch": 1.06}, (1, 1)),
                              ({"step": float("nan")}, (1, 0))):
        assert outcome(**changes) == expected, (changes, outcome(**changes))
    for lacking in (keys[:2], keys[1:]):
        faults, _ = compare(table, {key: 200.0 for key in lacking})
        assert len(faults) == 1 and "not counted" in faults[0], faults
        faults, _ = compare({key: 200.0 for key in lacking}, table)
        assert len(faults) == 1 and "not in the table" in faults[0], faults

    counts = inclusive_counts(PROFILE)
    assert count_of(counts, "space::inner") == 140 and count_of(counts, "outer") == 141, counts
    for name in ("space", "none"):
        try:
            count_of(counts, name)
            raise AssertionError(f"{name} was found")
        except Failure:
            pass

    check_comparable(text, "GNU 1", BUILD, sys.executable)
    expect_skip("no valgrind", text, "GNU 1", BUILD, "FEXP_VALGRIND-NOTFOUND")
    expect_skip("the compiler is GNU 2", text, "GNU 2", BUILD, sys.executable)
    for build in ("", "Debug -O3 -DNDEBUG", f"{BUILD} thread", "Release -O2 -DNDEBUG"):
        expect_skip("this one is", text, "GNU 1", build, sys.executable)
    print("regressions, gaps and what cannot be compared are found")
    return 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1])
    parser.add_argument("program", type=Path)
    for option in ("--compiler", "--build", "--valgrind"):
        parser.add_argument(option, required=True)
    parser.add_argument("--update", action="store_true")
    options = parser.parse_args()
    try:
        text = TABLE.read_text(encoding="utf-8") if TABLE.exists() else ""
        # A new table may be of another compiler, but of no other build.
        present = text_of({("", "", "step"): 0}, options.compiler) if options.update else text
        check_comparable(present, options.compiler, options.build, options.valgrind)
        counted = {}
        for case in CASES:
            counted.update(count_case(options.valgrind, options.program.resolve(), case))
    except Skip as reason:
        print(f"skipped: {reason}")
        return SKIPPED
    except Failure as failure:
        print(failure)
        return 1
    if options.update:
        TABLE.write_text(text_of(counted, options.compiler), encoding="utf-8")
        print(f"{TABLE} is written")
        return 0
    return 0 if judge(text, counted, options.compiler) else 1


if __name__ == "__main__":
    sys.exit(main())
