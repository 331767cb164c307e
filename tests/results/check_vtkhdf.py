#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Results follow the VTKHDF layout and hold, frame by frame, what was captured.

usage: check_vtkhdf.py PROBE      writes made-up results with PROBE and checks layout and values
       check_vtkhdf.py --layout FILE    checks the layout of any results file
"""

import pathlib
import sys
import tempfile

import numpy as np

from probe import Expected, close_to, run_probe, time_of
from vtkhdf_layout import LayoutError, Results


def check_values(results, expected, frames):
    assert results.frames == frames, f"{results.frames} frames instead of {frames}"
    assert np.array_equal(results.triangles, expected.triangles), "other triangles"
    for frame in range(frames):
        assert results.times[frame] == time_of(frame), f"time of frame {frame}"
        assert results.step(frame) == 10 * frame, f"step of frame {frame}"
        assert np.array_equal(results.points(frame), expected.points(frame)), f"points of frame {frame}"
        for kind, wanted in (("PointData", expected.point_data(frame)), ("CellData", expected.cell_data(frame))):
            read = results.data(kind, frame)
            assert set(read) == set(wanted), f"{kind}: {sorted(read)} instead of {sorted(wanted)}"
            for name, values in wanted.items():
                assert close_to(read[name], values), f"{name} of frame {frame} differs"


def check_in_vtk(path, expected, frames):
    """VTK's own reader; before VTK 9.3 it knows no steps, but must still show the first frame."""
    try:
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkCommonCore import vtkObject, vtkVersion
        from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
        from vtkmodules.vtkIOHDF import vtkHDFReader
    except ImportError:
        return "no VTK here"
    vtkObject.GlobalWarningDisplayOff()
    version = vtkVersion.GetVTKVersion()
    reader = vtkHDFReader()
    assert reader.CanReadFile(str(path)), f"VTK {version} does not take the file"
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    steps = vtkStreamingDemandDrivenPipeline.TIME_STEPS()
    information = reader.GetOutputInformation(0)
    times = [information.Get(steps, i) for i in range(information.Length(steps))]
    assert times in ([], [time_of(frame) for frame in range(frames)]), f"VTK {version} finds times {times}"
    for frame in range(max(1, len(times))):
        if times:
            reader.UpdateTimeStep(times[frame])
        else:
            reader.Update()
        grid = reader.GetOutputDataObject(0)
        while hasattr(grid, "GetPartition"):
            grid = grid.GetPartition(0)
        points = vtk_to_numpy(grid.GetPoints().GetData())
        assert np.array_equal(points, expected.points(frame)), f"VTK {version}: points of frame {frame}"
        triangles = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 3)
        assert np.array_equal(triangles, expected.triangles), f"VTK {version}: triangles of frame {frame}"
        for data, wanted in (
            (grid.GetPointData(), expected.point_data(frame)),
            (grid.GetCellData(), expected.cell_data(frame)),
        ):
            for name, values in wanted.items():
                assert close_to(vtk_to_numpy(data.GetArray(name)), values), f"VTK {version}: {name} of frame {frame}"
    return f"VTK {version} reads {'all frames' if times else 'the first frame'}"


def main():
    if sys.argv[1] == "--layout":
        results = Results(sys.argv[2])
        print(f"{sys.argv[2]}: {results.frames} frames of {results.cells_count} triangles, layout as published")
        return
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "results.vtkhdf"
        # More frames than a chunk of the step arrays has rows, and than the index was sized for.
        for frames, bodies, cells, more in ((1, 1, 1, {}), (3, 3, 10, {}), (200, 2, 3, {"expected": 1}),
                                            (3, 2, 5000, {}), (5, 3, 10, {"deflate": 4})):
            run_probe(sys.argv[1], path, frames=frames, bodies=bodies, cells=cells, **more)
            expected = Expected(bodies, cells)
            results = Results(path)
            check_values(results, expected, frames)
            results.file.close()
            note = check_in_vtk(path, expected, frames)
            print(f"{frames} frames of {expected.elements} triangles {more}: good; {note}")
        run_probe(sys.argv[1], path, frames=7, bodies=3, cells=10)
        run_probe(sys.argv[1], path, frames=9, bodies=3, cells=10, resume=4)
        check_values(Results(path), Expected(3, 10), 9)
        print("gone on after 4 of 7 frames up to 9: good")


if __name__ == "__main__":
    try:
        main()
    except (AssertionError, LayoutError) as error:
        sys.exit(f"check_vtkhdf: {error}")
