#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A function that several translation units compile (weak symbol) is kept once by the linker, from whichever unit comes
first. If that unit was compiled for a wider instruction set, the whole program needs a machine that has it. So the
kernels for wider instruction sets may emit no weak function that any other object emits too.

usage: check_kernel_symbols.py --nm NM ARCHIVE...
"""
import re
import subprocess
import sys

WIDE = re.compile(r"_(avx2|avx512)\.cpp\.o$")


def weak_functions(nm, archive):
    """Maps each object in the archive to the weak functions it defines."""
    text = subprocess.run([nm, "--defined-only", archive], check=True, capture_output=True, text=True).stdout
    functions, member = {}, None
    for line in text.splitlines():
        if line.endswith(".o:"):
            member = line[:-1]
            functions[member] = set()
        else:
            parts = line.split()
            if len(parts) == 3 and parts[1] == "W":
                functions[member].add(parts[2])
    return functions


def leaks(nm, archive):
    """How many wide kernels the archive has, and the functions that could leak from them."""
    functions = weak_functions(nm, archive)
    wide = [member for member in functions if WIDE.search(member)]
    # Types named after an instruction set are compiled for that one only; everything else may meet its namesake in
    # another object of the program.
    return len(wide), {
        f"{member}: {name}" for member in wide for name in functions[member] if "InstructionSet" not in name
    }


def main():
    nm, archives = sys.argv[2], sys.argv[3:]
    found = 0
    for archive in archives:
        wide, shared = leaks(nm, archive)
        if not wide:
            print(f"{archive} has no kernel for a wider instruction set")
            found += 1
            continue
        for line in sorted(shared):
            print(line)
        print(f"{archive}: {wide} wide kernels, {len(shared)} functions that could leak from them")
        found += len(shared)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
