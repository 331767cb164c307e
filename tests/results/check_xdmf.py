#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The XDMF file beside the results leads every reader to the right values.

usage: check_xdmf.py PROBE

The file is resolved item by item with h5py. Where ParaView is installed, its XDMF reader reads it too.
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

import h5py
import numpy as np

from probe import Expected, close_to, run_probe, time_of

TYPES = {("Float", "8"): np.float64, ("Float", "4"): np.float32, ("Int", "8"): np.int64, ("Int", "4"): np.int32}


def resolve(item, folder):
    """The values of a DataItem, as the XDMF model defines them."""
    shape = tuple(int(n) for n in item.get("Dimensions").split())
    if item.get("ItemType") == "HyperSlab":
        slab, source = list(item)
        start, stride, count = resolve(slab, folder)
        assert np.all(stride == 1) and tuple(count) == shape, "a slab other than it says"
        begin, end = start, start + count
        values = resolve(source, folder)[tuple(slice(int(b), int(e)) for b, e in zip(begin, end))]
        assert values.shape == shape, f"a slab of shape {values.shape} instead of {shape}"
        return values
    if item.get("Format") == "XML":
        return np.array([int(n) for n in item.text.split()]).reshape(shape)
    assert item.get("Format") == "HDF", f"format {item.get('Format')}"
    name, path = item.text.strip().split(":")
    with h5py.File(folder / name, "r") as file:
        values = file[path]
        assert len(values.shape) == len(shape) and values.shape[0] >= shape[0], f"{path} has shape {values.shape}"
        assert values.dtype == TYPES[item.get("NumberType"), item.get("Precision")], f"{path} is {values.dtype}"
        return values[: shape[0]]


def check_file(path, expected, frames):
    collection = xml.etree.ElementTree.parse(path).getroot().find("Domain/Grid")
    assert collection.get("CollectionType") == "Temporal"
    grids = collection.findall("Grid")
    assert len(grids) == frames, f"{len(grids)} frames instead of {frames}"
    for frame, grid in enumerate(grids):
        assert float(grid.find("Time").get("Value")) == time_of(frame), f"time of frame {frame}"
        topology = grid.find("Topology")
        assert topology.get("TopologyType") == "Triangle"
        assert int(topology.get("NumberOfElements")) == expected.elements
        triangles = resolve(topology[0], path.parent)
        assert np.array_equal(triangles.reshape(-1, 3), expected.triangles), "other triangles"
        assert np.array_equal(resolve(grid.find("Geometry")[0], path.parent), expected.points(frame)), "other points"
        wanted = {("Node", name): values for name, values in expected.point_data(frame).items()}
        wanted.update({("Cell", name): values for name, values in expected.cell_data(frame).items()})
        attributes = {(a.get("Center"), a.get("Name")): a for a in grid.findall("Attribute")}
        assert set(attributes) == set(wanted), f"frame {frame} has {sorted(attributes)}"
        for key, values in wanted.items():
            assert close_to(resolve(attributes[key][0], path.parent), values), f"{key[1]} of frame {frame} differs"


def check_in_paraview(path, bodies, cells, frames):
    program = shutil.which("pvpython")
    if program is None:
        return "no ParaView here"
    script = pathlib.Path(__file__).parent / "paraview_reads.py"
    command = [program, str(script), str(path), str(bodies), str(cells), str(frames)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, f"ParaView: {done.stdout[-2000:]} {done.stderr[-2000:]}"
    return done.stdout.strip().splitlines()[-1]


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for frames, bodies, cells in ((1, 1, 1), (5, 3, 10), (250, 2, 3)):
            path = folder / "results.xdmf2"
            run_probe(sys.argv[1], folder / "results.vtkhdf", frames=frames, bodies=bodies, cells=cells, xdmf=path)
            check_file(path, Expected(bodies, cells), frames)
            note = check_in_paraview(path, bodies, cells, frames)
            print(f"{frames} frames of {bodies * cells * 2} triangles: good; {note}")


if __name__ == "__main__":
    try:
        main()
    except AssertionError as error:
        sys.exit(f"check_xdmf: {error}")
