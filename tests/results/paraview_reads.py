# SPDX-License-Identifier: Apache-2.0
"""Reads results with ParaView and checks every value of every frame.

usage: pvpython paraview_reads.py FILE BODIES CELLS FRAMES

FILE is the XDMF file or, from ParaView 5.12 on, the VTKHDF file, of frames that the probe wrote.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))

import numpy as np
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

from probe import Expected, close_to, time_of


def check_grid(grid, expected, frame):
    while grid.IsA("vtkMultiBlockDataSet"):
        grid = grid.GetBlock(0)
    assert np.array_equal(vtk_to_numpy(grid.GetPoints().GetData()), expected.points(frame)), f"points of {frame}"
    triangles = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 3)
    assert np.array_equal(triangles, expected.triangles), "other triangles"
    for data, wanted in ((grid.GetPointData(), expected.point_data(frame)), (grid.GetCellData(), expected.cell_data(frame))):
        for name, values in wanted.items():
            assert data.GetArray(name) is not None, f"{name} of frame {frame} is missing"
            assert close_to(vtk_to_numpy(data.GetArray(name)), values), f"{name} of frame {frame} differs"


def main():
    path, (bodies, cells, frames) = sys.argv[1], map(int, sys.argv[2:5])
    expected = Expected(bodies, cells)
    reader = simple.OpenDataFile(path)
    reader.UpdatePipelineInformation()
    times = list(np.atleast_1d(reader.TimestepValues))
    assert times == [time_of(frame) for frame in range(frames)], f"times {times}"
    for frame in list(range(frames)) + [0]:
        reader.UpdatePipeline(times[frame])
        check_grid(servermanager.Fetch(reader), expected, frame)
    print(f"ParaView {simple.GetParaViewVersion()} reads {frames} frames")


main()
