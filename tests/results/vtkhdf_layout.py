# SPDX-License-Identifier: Apache-2.0
"""Holds a results file against the published VTKHDF 2.0 layout of a transient unstructured grid."""

import h5py
import numpy as np

VTK_TRIANGLE = 5


class LayoutError(Exception):
    pass


def require(condition, text):
    if not condition:
        raise LayoutError(text)


def integers(group, name, shape=None):
    require(name in group, f"{group.name}/{name} is missing")
    values = group[name]
    require(values.dtype.kind == "i", f"{values.name} is not of integers")
    if shape is not None:
        require(len(values.shape) == len(shape), f"{values.name} has {len(values.shape)} dimensions")
        for have, want in zip(values.shape, shape):
            require(have >= want, f"{values.name} has shape {values.shape}, less than {shape}")
    return values


def check_root(root):
    """Attributes and datasets that a static file has too; returns the triangles."""
    kind = root.attrs.get_id("Type")
    require(kind.get_type().get_class() == h5py.h5t.STRING, "Type is not a string")
    require(not kind.get_type().is_variable_str(), "Type is not of fixed length")
    require(kind.get_type().get_cset() == h5py.h5t.CSET_ASCII, "Type is not ASCII")
    require(root.attrs["Type"] == b"UnstructuredGrid", f"Type is {root.attrs['Type']}")
    require(list(root.attrs["Version"]) == [2, 0], f"Version is {root.attrs['Version']}")
    points = int(integers(root, "NumberOfPoints", (1,))[0])
    cells = int(integers(root, "NumberOfCells", (1,))[0])
    corners = int(integers(root, "NumberOfConnectivityIds", (1,))[0])
    require(corners == 3 * cells, "NumberOfConnectivityIds is not three per triangle")
    connectivity = integers(root, "Connectivity", (corners,))[:]
    offsets = integers(root, "Offsets", (cells + 1,))[:]
    require(len(offsets) == cells + 1 and np.array_equal(offsets, 3 * np.arange(cells + 1)), "Offsets are wrong")
    require(connectivity.min() >= 0 and connectivity.max() < points, "Connectivity leaves the points")
    types = root["Types"]
    require(types.dtype == np.uint8 and types.shape == (cells,), "Types are not one byte per cell")
    require(np.all(types[:] == VTK_TRIANGLE), "Types are not all triangles")
    require(root["Points"].dtype == np.float64 and root["Points"].shape[1:] == (3,), "Points have a wrong shape")
    return points, cells, connectivity.reshape(-1, 3)


class Results:
    """A results file, checked when it is opened and read as the layout says a reader has to."""

    def __init__(self, path):
        self.file = h5py.File(path, "r")
        root = self.root = self.file["VTKHDF"]
        self.points_count, self.cells_count, self.triangles = check_root(root)
        steps = self.steps = root["Steps"]
        self.frames = int(steps.attrs["NSteps"])
        require(np.shape(steps.attrs["NSteps"]) == (), "NSteps is not a scalar")
        n = self.frames
        require(steps["Values"].dtype == np.float64 and steps["Values"].shape[0] >= n, "Values are too few")
        self.times = steps["Values"][:n]
        require(np.all(np.diff(self.times) > 0), "times do not ascend")
        self.parts = integers(steps, "PartOffsets", (n,))[:n]
        require(np.all(integers(steps, "NumberOfParts", (n,))[:n] == 1), "NumberOfParts is not 1")
        self.point_offsets = integers(steps, "PointOffsets", (n,))[:n]
        self.cell_offsets = integers(steps, "CellOffsets", (n, 1))[:n, 0]
        self.corner_offsets = integers(steps, "ConnectivityIdOffsets", (n, 1))[:n, 0]
        require(np.all(self.parts == 0), "PartOffsets leave the parts")
        require(np.all(self.cell_offsets == 0) and np.all(self.corner_offsets == 0), "the topology is not constant")
        self._check_arrays("PointData", self.points_count)
        self._check_arrays("CellData", self.cells_count)
        require(len(self.file["fexp/step"]) >= n, "/fexp/step is too short")

    def _check_arrays(self, kind, rows):
        offsets = self.steps[f"{kind}Offsets"]
        require(set(offsets) == set(self.root[kind]), f"{kind} and its offsets do not name the same arrays")
        for name, array in self.root[kind].items():
            first = integers(offsets, name, (self.frames,))[: self.frames]
            require(array.dtype in (np.float32, np.int32), f"{array.name} has type {array.dtype}")
            for offset in first:
                require(0 <= offset and offset + rows <= array.shape[0], f"{array.name} ends before its last frame")
        for offset in self.point_offsets:
            require(0 <= offset <= self.root["Points"].shape[0] - self.points_count, "Points end too early")

    def points(self, frame):
        begin = self.point_offsets[frame]
        return self.root["Points"][begin : begin + self.points_count]

    def data(self, kind, frame):
        rows = self.points_count if kind == "PointData" else self.cells_count
        arrays = {}
        for name, array in self.root[kind].items():
            begin = self.steps[f"{kind}Offsets"][name][frame]
            arrays[name] = array[begin : begin + rows]
        return arrays

    def step(self, frame):
        return int(self.file["fexp/step"][frame])
