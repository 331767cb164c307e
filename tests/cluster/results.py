# SPDX-License-Identifier: Apache-2.0
"""Whether two runs of a deck have written the same, to the last bit."""

import csv
import json

import h5py
import numpy

HISTORIES = ("energies", "momenta", "nodes", "bodies", "walls", "hashes")
# How much was searched and found on the way, which depends on when islands came from elsewhere.
OF_WORK = ("candidates", "searches")


def state_hash(run):
    return json.loads((run / "summary.json").read_text(encoding="utf-8"))["state_hash"]


def steps_without_work(run):
    rows = list(csv.reader((run / "steps.csv").read_text(encoding="utf-8").splitlines()))
    kept = [column for column, name in enumerate(rows[0]) if name not in OF_WORK]
    return [[row[column] for column in kept] for row in rows]


def datasets(run):
    found = {}
    with h5py.File(run / "results.vtkhdf", "r") as file:
        def visit(name, item):
            if isinstance(item, h5py.Dataset):
                found[name] = item[()]
        file.visititems(visit)
        found["NSteps"] = numpy.array(file["/VTKHDF/Steps"].attrs["NSteps"])
    return found


def first_difference(one, other):
    for number, (a, b) in enumerate(zip(one, other), 1):
        if a != b:
            return f"line {number}: {a} | {b}"
    return f"{len(one)} lines, and {len(other)}"


def differences(run, reference):
    """What is not the same in two finished runs, as sentences; none when they are equal."""
    found = []
    if state_hash(run) != state_hash(reference):
        found.append(f"state_hash: {state_hash(run)}, not {state_hash(reference)}")
    for name in HISTORIES:
        one, other = run / f"{name}.csv", reference / f"{name}.csv"
        if one.exists() != other.exists():
            found.append(f"{name}.csv is only there in one")
        elif one.exists() and one.read_bytes() != other.read_bytes():
            lines = (path.read_text(encoding="utf-8").split("\n") for path in (one, other))
            found.append(f"{name}.csv: {first_difference(*lines)}")
    if steps_without_work(run) != steps_without_work(reference):
        found.append(f"steps.csv: {first_difference(steps_without_work(run), steps_without_work(reference))}")
    one, other = datasets(run), datasets(reference)
    if sorted(one) != sorted(other):
        found.append(f"results.vtkhdf: datasets {sorted(set(one) ^ set(other))} are only there in one")
    for name in sorted(set(one) & set(other)):
        # Bytes, so that no number passes for another one.
        if one[name].shape != other[name].shape or one[name].tobytes() != other[name].tobytes():
            if one[name].dtype != object or one[name].tolist() != other[name].tolist():
                found.append(f"results.vtkhdf: {name} {one[name].shape} differs from {other[name].shape}")
    frames = (run / "results.xdmf2").read_bytes()
    if frames != (reference / "results.xdmf2").read_bytes():
        found.append("results.xdmf2")
    return found
