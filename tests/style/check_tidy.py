#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs clang-tidy over every file of src/ in the compile commands. A file found clean is not checked again until it,
a header it includes, .clang-tidy or its compile command changes.

usage: check_tidy.py CLANG_TIDY PROJECT COMPILE_COMMANDS CACHE_FOLDER [OPTION OF CLANG-TIDY...]
"""
import hashlib
import json
import os
import re
import shlex
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)


def compile_flags(command):
    """The flags alone: without compiler, launcher, source, object and dependency files."""
    words = shlex.split(command)
    words = words[next(i for i, word in enumerate(words) if word.startswith("-")):]
    flags, skip = [], False
    for word in words:
        if skip:
            skip = False
        elif word in ("-o", "-c", "-MT", "-MF"):
            skip = True
        elif word != "-MD":
            flags.append(word)
    return flags


def with_includes(source, src):
    """The file and all headers of src/ that it includes, directly or not."""
    found, waiting = set(), [source]
    while waiting:
        path = waiting.pop()
        if path in found or not path.is_file():
            continue
        found.add(path)
        waiting += [src / name for name in INCLUDE.findall(path.read_text(encoding="utf-8"))]
    return sorted(found)


def main():
    clang_tidy, project, database, cache = sys.argv[1], *map(Path, sys.argv[2:5])
    options = sys.argv[5:]
    src = project / "src"
    version = subprocess.run([clang_tidy, "--version"], check=True, capture_output=True, text=True).stdout
    configuration = version + (project / ".clang-tidy").read_text(encoding="utf-8")
    cache.mkdir(parents=True, exist_ok=True)

    def check(entry):
        source, flags = Path(entry["file"]), compile_flags(entry["command"])
        key = hashlib.sha256(f"{configuration}{options}{flags}".encode())
        for path in with_includes(source, src):
            key.update(path.read_bytes())
        stamp = cache / f"{source.stem}-{key.hexdigest()[:32]}"
        if stamp.exists():
            return source, 0.0, ""
        started = time.monotonic()
        command = [clang_tidy, "--quiet", *options, str(source), "--", *flags]
        result = subprocess.run(command, check=False, capture_output=True, text=True, cwd=entry["directory"])
        if result.returncode == 0:
            stamp.touch()
            return source, time.monotonic() - started, ""
        return source, time.monotonic() - started, result.stdout or result.stderr

    entries = [e for e in json.loads(database.read_text()) if Path(e["file"]).is_relative_to(src)]
    started = time.monotonic()
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(check, entries))
    # A fault in a header is met once per file that includes it.
    faults = {}
    for source, _, output in results:
        for block in re.split(r"\n(?=/)", output):
            if ": error: " in block.split("\n", 1)[0] or ": warning: " in block.split("\n", 1)[0]:
                faults.setdefault(block.split("\n", 1)[0], block)
        if output and not faults:
            faults[str(source)] = output
    for block in faults.values():
        print(block)
    checked = [seconds for _, seconds, _ in results if seconds > 0]
    print(f"{len(results)} files, {len(checked)} of them checked anew in {time.monotonic() - started:.0f} s, "
          f"{len(faults)} faults")
    return 1 if any(output for _, _, output in results) else 0


if __name__ == "__main__":
    sys.exit(main())
