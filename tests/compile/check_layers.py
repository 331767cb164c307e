#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds every include in src/ against the table of layers: an include points to the own layer or to one below it.

usage: check_layers.py SRC | --self-test
"""
import re
import sys
import tempfile
from pathlib import Path

# Layer: the layers it may include besides itself, the same table as in src/CMakeLists.txt.
ALLOWED = {
    "base": [],
    "parallel": ["base"],
    "physics": ["base"],
    "model": ["base", "parallel", "physics"],
    "contact": ["base", "parallel", "physics", "model"],
    "quality": ["base", "parallel", "physics", "model", "contact"],
    "solve": ["base", "parallel", "physics", "model", "contact"],
    "cluster": ["base", "parallel", "physics", "model", "contact", "solve"],
    "io": ["base", "parallel", "physics", "model"],
    "coordinator": ["base", "io"],
    "bench": ["base", "parallel", "physics", "model", "contact", "solve", "cluster"],
    "app": ["base", "parallel", "physics", "model", "contact", "quality", "solve", "cluster", "io", "coordinator",
            "bench"],
}

# Libraries that one layer hides from the others.
PRIVATE_LIBRARIES = {
    "tbb/": {"parallel"},
    "oneapi/": {"parallel"},
    "toml++/": {"io"},
    "hdf5": {"io"},
    "H5": {"io"},
    "nlohmann/": {"io", "coordinator", "app"},
    "CLI/": {"app"},
    "xxhash": {"base"},
    "iostream": {"io", "app"},
    "print": {"io", "app"},
}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def faults_of_file(src, path, layer):
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        bracket, target = match.groups()
        place = f"src/{path.relative_to(src)}:{number}"
        if bracket == "<":
            for prefix, layers in PRIVATE_LIBRARIES.items():
                if target.startswith(prefix) and layer not in layers:
                    yield f"{place}: <{target}> belongs to {', '.join(sorted(layers))}; {layer} must not include it"
            continue
        first, _, rest = target.partition("/")
        if not rest or first not in ALLOWED:
            yield f'{place}: "{target}" is not written as "layer/file.hpp"'
        elif first != layer and first not in ALLOWED[layer]:
            allowed = ", ".join(ALLOWED[layer]) or "no other layer"
            yield f'{place}: {layer} must not include "{target}"; it may include {allowed}'
        elif not (src / target).is_file():
            yield f'{place}: "{target}" does not exist'


def faults_of_tree(src):
    for layer in ALLOWED:
        if not (src / layer).is_dir():
            yield f"src/{layer}: the layer has no folder"
    for folder in sorted(p for p in src.iterdir() if p.is_dir()):
        if folder.name not in ALLOWED:
            yield f"src/{folder.name}: not a layer"
            continue
        for path in sorted(folder.rglob("*.[ch]pp")):
            yield from faults_of_file(src, path, folder.name)
    for path in sorted(src.glob("*.[ch]pp")):
        yield f"src/{path.name}: belongs to no layer"


def self_test():
    """Plants one fault of each kind in a clean tree and expects exactly that one to be named."""
    planted = {
        'base/a.cpp:#include "solve/b.hpp"': "base must not include",
        'io/a.cpp:#include "cluster/b.hpp"': "io must not include",
        'solve/a.cpp:#include <tbb/parallel_for.h>': "belongs to parallel",
        'model/a.cpp:#include <iostream>': "belongs to app, io",
        'model/a.cpp:#include "b.hpp"': "is not written as",
        'app/a.cpp:#include "model/missing.hpp"': "does not exist",
        'extra/a.cpp:': "not a layer",
    }
    for plan, expected in planted.items():
        with tempfile.TemporaryDirectory() as folder:
            src = Path(folder)
            for layer in ALLOWED:
                (src / layer).mkdir()
                (src / layer / "b.hpp").write_text('#include "base/b.hpp"\n#include <vector>\n')
            assert not list(faults_of_tree(src)), "a clean tree has faults"
            name, _, text = plan.partition(":")
            (src / name).parent.mkdir(exist_ok=True)
            (src / name).write_text(text + "\n")
            found = list(faults_of_tree(src))
            assert len(found) == 1 and expected in found[0], f"{plan}: {found}"
    print(f"{len(planted)} planted faults found")
    return 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    src = Path(sys.argv[1])
    faults = list(faults_of_tree(src))
    for fault in faults:
        print(fault)
    if not faults:
        print(f"{sum(1 for _ in src.rglob('*.[ch]pp'))} files keep to the layers")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
