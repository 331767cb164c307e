#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A killed run leaves a file with all its complete frames.

usage: check_killed.py PROBE [KILLS]

Two ways to die: at each single call by which HDF5 writes, before and in the middle of it (after it is before the next);
and by SIGKILL from outside at KILLS random moments. After each death the file must open, follow the layout, have at least the frames
that were reported complete, with the right values, and take further frames.
"""

import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from check_vtkhdf import check_values
from probe import DIED, Expected, run_probe
from vtkhdf_layout import LayoutError, Results

# Of a call that writes: nothing, three eighths, and what would count an entry of an index that is not there.
PARTS = ({"share": 0}, {"share": 3}, {"bytes": 24})


def complete_frames(lines):
    return max([0] + [int(line.split()[1]) for line in lines if line.startswith("frame")])


def check_remains(path, expected, complete, where):
    try:
        results = Results(path)
        if complete is not None:
            assert results.frames in (complete, complete + 1), f"{results.frames} frames, {complete} were complete"
        check_values(results, expected, results.frames)
        frames = results.frames
        results.file.close()
        return frames
    except (AssertionError, LayoutError, OSError, KeyError, ValueError) as error:
        raise AssertionError(f"killed {where}: {error}") from error


def die_at_every_write(program, folder, part, frames, resumed):
    """Kills the probe at each write, of which a part still happens."""
    path, expected = folder / "results.vtkhdf", Expected(2, 3)
    options = {"bodies": 2, "cells": 3, "tell": 1, "expected": frames}
    _, lines = run_probe(program, path, frames=frames, **options)
    first = int(lines[0].split()[1]) + 1
    last = int(lines[-1].split()[1])
    for write in range(first, last + 1):
        code, lines = run_probe(program, path, frames=frames, die_at=write, **part, **options)
        assert code == DIED, f"write {write} was not reached"
        found = check_remains(path, expected, complete_frames(lines), f"at write {write}, {part} of it done")
        if resumed:
            run_probe(program, path, frames=frames + 2, resume=found, **options)
            check_remains(path, expected, frames + 2, f"at write {write} and gone on")
    return last - first + 1


def die_while_going_on(program, folder, part):
    """Kills the probe at each write while it drops two of five frames and writes three new ones."""
    path, kept, expected = folder / "results.vtkhdf", folder / "five.vtkhdf", Expected(2, 3)
    options = {"bodies": 2, "cells": 3, "tell": 1, "expected": 8}
    run_probe(program, kept, frames=5, **options)
    write, code = 0, DIED
    while code == DIED:
        write += 1
        shutil.copy(kept, path)
        code, lines = run_probe(program, path, frames=6, resume=3, die_at=write, **part, **options)
        found = check_remains(path, expected, None, f"at write {write} of going on, {part} of it done")
        complete = complete_frames(lines)
        assert found >= max(3, complete), f"{found} frames are left of {complete} at write {write} of going on"
        run_probe(program, path, frames=7, resume=min(found, 3), **options)
        check_remains(path, expected, 7, f"at write {write} of going on and gone on again")
    return write - 1


def kill_at_random(program, folder, kills):
    path = folder / "results.vtkhdf"
    chance = random.Random(1)
    counts = []
    for number in range(kills):
        shutil.rmtree(folder)
        folder.mkdir()
        cells = chance.choice([1, 30, 3000])
        command = [program, str(path), "frames=100000", "expected=100000", "bodies=2", f"cells={cells}", "tell"]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
            process.stdout.readline()
            time.sleep(chance.uniform(0.0, 0.15))
            process.send_signal(signal.SIGKILL)
            complete = complete_frames([line for line in process.stdout if line.endswith("\n")])
        counts.append(check_remains(path, Expected(2, cells), complete, f"from outside, kill {number}"))
    return counts


def main():
    program = sys.argv[1]
    kills = int(sys.argv[2]) if len(sys.argv) > 2 else 40
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name) / "run"
        folder.mkdir()
        for part in PARTS:
            writes = die_at_every_write(program, folder, part, frames=4, resumed=part == PARTS[1])
            print(f"ended at each of {writes} writes with {part} of it done: every complete frame is there")
        for part in PARTS:
            writes = die_while_going_on(program, folder, part)
            print(f"ended at each of {writes} writes while going on, {part} of it done: the same")
        counts = kill_at_random(program, folder, kills)
        print(f"killed {len(counts)} times at random, {min(counts)} to {max(counts)} frames: all there")


if __name__ == "__main__":
    try:
        main()
    except AssertionError as error:
        sys.exit(f"check_killed: {error}")
