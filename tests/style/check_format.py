#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds every source file against .clang-format.

usage: check_format.py CLANG_FORMAT PROJECT
"""
import subprocess
import sys
from pathlib import Path


def main():
    clang_format, project = sys.argv[1], Path(sys.argv[2])
    files = sorted(p for top in ("src", "tests", "bench") for p in (project / top).rglob("*.[ch]pp"))
    result = subprocess.run([clang_format, "--dry-run", "-Werror", *files], check=False, capture_output=True, text=True)
    faulty = sorted({line.split(":", 1)[0] for line in result.stderr.splitlines() if ": error: " in line})
    if result.returncode != 0:
        print(result.stderr[:4000])
        names = " ".join(str(Path(name).relative_to(project)) for name in faulty)
        print(f"\nTo put these files in order: clang-format -i {names}")
        return 1
    print(f"{len(files)} files are formatted")
    return 0


if __name__ == "__main__":
    sys.exit(main())
