#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs clang-tidy over every file of src/ in the compile commands, in bundles. A bundle found clean is not checked again
until a file of it, a header it includes, .clang-tidy or its compile command changes.

usage: check_tidy.py CLANG_TIDY CLANG PROJECT COMPILE_COMMANDS CACHE_FOLDER [OPTION OF CLANG-TIDY...]
"""
import hashlib
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

MOST = 20  # files in a bundle
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


def sources_of(entry):
    """A bundle of the build lists its sources as includes."""
    file = Path(entry["file"])
    if file.parent.name == "Unity":
        return [Path(name) for name in INCLUDE.findall(file.read_text(encoding="utf-8"))]
    return [file]


def bundles(entries, clang, src, folder):
    """Lists of source files that can be checked as one: of one layer, with the same flags and without clashing names.
    Most of what clang-tidy looks at is in the headers of libraries, which all files of a layer share."""
    alike = {}
    for entry in entries:
        for source in sources_of(entry):
            if source.is_relative_to(src):
                key = (source.relative_to(src).parts[0], entry["directory"], tuple(compile_flags(entry["command"])))
                alike.setdefault(key, set()).add(source)
    waiting = []
    for (layer, directory, flags), sources in alike.items():
        sources = sorted(sources)
        count = -(-len(sources) // MOST)
        waiting += [(layer, directory, flags, sources[i::count]) for i in range(count)]
    found = []
    while waiting:
        layer, directory, flags, sources = waiting.pop()
        bundle = folder / f"{layer}-{hashlib.sha256(repr((flags, sources)).encode()).hexdigest()[:16]}.cpp"
        bundle.write_text("".join(f'#include "{source}"  // NOLINT\n' for source in sources), encoding="utf-8")
        if len(sources) > 1 and subprocess.run(
                [clang, "-fsyntax-only", "-w", *flags, str(bundle)], check=False, capture_output=True,
                cwd=directory).returncode != 0:
            bundle.unlink()
            half = len(sources) // 2
            waiting += [(layer, directory, flags, part) for part in (sources[:half], sources[half:])]
        else:
            found.append((bundle, directory, flags, sources))
    return found


def main():
    clang_tidy, clang, project, database, cache = *sys.argv[1:3], *map(Path, sys.argv[3:6])
    options = sys.argv[6:]
    src = project / "src"
    version = subprocess.run([clang_tidy, "--version"], check=True, capture_output=True, text=True).stdout
    configuration = version + (project / ".clang-tidy").read_text(encoding="utf-8")
    cache.mkdir(parents=True, exist_ok=True)

    def check(bundle, directory, flags, sources):
        key = hashlib.sha256(f"{configuration}{options}{flags}".encode())
        for path in sorted(set().union(*(with_includes(source, src) for source in sources))):
            key.update(path.read_bytes())
        stamp = cache / f"{bundle.stem}-{key.hexdigest()[:32]}"
        if stamp.exists():
            return 0.0, ""
        started = time.monotonic()
        command = [clang_tidy, "--quiet", f"--config-file={project / '.clang-tidy'}",
                   r"--header-filter=.*/src/.*\.(hpp|cpp)$", *options, str(bundle), "--", *flags,
                   "-Wno-shadow"]  # By the names of the file before in the bundle; the builds have this warning
        result = subprocess.run(command, check=False, capture_output=True, text=True, cwd=directory)
        if result.returncode == 0:
            stamp.touch()
            return time.monotonic() - started, ""
        return time.monotonic() - started, result.stdout or result.stderr

    entries = json.loads(database.read_text(encoding="utf-8"))
    started = time.monotonic()
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(os.cpu_count()) as pool:
        found = bundles(entries, clang, src, Path(folder))
        results = list(pool.map(lambda bundle: check(*bundle), found))
    # A fault in a header is met once per bundle that includes it.
    faults = {}
    for bundle, (_, output) in zip(found, results):
        for block in re.split(r"\n(?=/)", output):
            if ": error: " in block.split("\n", 1)[0] or ": warning: " in block.split("\n", 1)[0]:
                faults.setdefault(block.split("\n", 1)[0], block)
        if output and not faults:
            faults[str(bundle[0])] = output
    for block in faults.values():
        print(block)
    anew = sum(seconds > 0 for seconds, _ in results)
    print(f"{sum(len(bundle[3]) for bundle in found)} files in {len(found)} bundles, {anew} of them checked anew in "
          f"{time.monotonic() - started:.0f} s, {len(faults)} faults")
    return 1 if any(output for _, output in results) else 0


if __name__ == "__main__":
    sys.exit(main())
