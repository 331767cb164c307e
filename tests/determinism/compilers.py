#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs decks with several builds of fexp and several numbers of threads. Every run of a deck must end in the same
state: the same bits, so the same state_hash after the same number of steps.

usage: compilers.py [--threads N,N...] --program NAME=PATH... --deck DECK...
"""
import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path


def run(program, deck, threads, out):
    """The state hash and number of steps of one run, or why there is none."""
    command = [program, "run", str(deck), "--out", str(out), "--threads", str(threads), "--quiet", "--json"]
    result = subprocess.run(command, check=False, capture_output=True, text=True)
    if result.returncode != 0:
        return f"exit code {result.returncode}: {(result.stderr or result.stdout).strip()[-500:]}"
    try:
        summary = json.loads(result.stdout)
        return f"{summary['state_hash']} after {summary['steps']} steps"
    except (ValueError, KeyError) as error:
        return f"no summary ({error!r}): {result.stdout[:200]}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", action="append", required=True, metavar="NAME=PATH")
    parser.add_argument("--deck", action="append", required=True, type=Path)
    parser.add_argument("--threads", default="1,2,3")
    arguments = parser.parse_args()
    threads = [int(word) for word in arguments.threads.split(",")]
    programs = [word.split("=", 1) for word in arguments.program]

    failed = False
    for deck in arguments.deck:
        found = {}
        for name, program in programs:
            for count in threads:
                started = time.monotonic()
                with tempfile.TemporaryDirectory() as folder:
                    outcome = run(program, deck, count, Path(folder) / "run")
                found.setdefault(outcome, []).append(f"{name} with {count} threads")
                print(f"{deck.name:30} {name:15} {count:2} threads  {outcome}  {time.monotonic() - started:6.1f} s",
                      flush=True)
        if len(found) != 1 or not next(iter(found)).count(" after "):
            failed = True
            print(f"{deck.name}: {len(found)} different outcomes")
            for outcome, runs in found.items():
                print(f"  {outcome}: {', '.join(runs)}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
