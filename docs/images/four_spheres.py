# SPDX-License-Identifier: Apache-2.0
"""Draws docs/images/four_spheres.png from the results of examples/four_spheres.toml.

usage: /usr/bin/python3 docs/images/four_spheres.py RUN_DIRECTORY

Needs the packages python3-h5py and python3-matplotlib.
"""

import pathlib
import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import numpy as np
from matplotlib import pyplot
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize

STRESS_UNIT = 1.0e6  # Pa in the MPa of the colour bar
DIRECTION = np.array([-0.45, -1.0, 0.85])  # from the scene to the eye
LIGHT = np.array([-0.7, -0.8, 1.3])


def unit(vector):
    return vector / np.linalg.norm(vector)


class Results:
    def __init__(self, directory):
        root = h5py.File(pathlib.Path(directory) / "results.vtkhdf", "r")["VTKHDF"]
        self.root = root
        self.times = root["Steps/Values"][:]
        self.nodes = int(root["NumberOfPoints"][0])
        self.cells = int(root["NumberOfCells"][0])
        self.triangles = root["Connectivity"][:].reshape(-1, 3)

    def corners(self, frame):
        """Positions [m], shape [triangles, 3, 3]."""
        return self.root["Points"][frame * self.nodes : (frame + 1) * self.nodes][self.triangles]

    def stress(self, frame):
        """The larger von Mises stress of both faces [MPa], shape [triangles]."""
        rows = slice(frame * self.cells, (frame + 1) * self.cells)
        fields = [self.root["CellData"][name][rows] for name in ("von_mises_top", "von_mises_bottom")]
        return np.maximum(*fields) / STRESS_UNIT


def visible(corners):
    """Order in which to paint the triangles that face the eye, the farthest first, and their shades."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    eye = unit(DIRECTION)
    order = np.argsort(corners.mean(axis=1) @ eye)
    order = order[normals[order] @ eye > 0.0]
    return order, 0.72 + 0.28 * np.clip(normals[order] @ unit(LIGHT), 0.0, 1.0)


def draw(axes, corners, stress, colours):
    right = unit(np.cross([0.0, 0.0, 1.0], DIRECTION))
    up = unit(np.cross(DIRECTION, right))
    order, shade = visible(corners)
    paint = colours.to_rgba(stress[order])
    paint[:, :3] *= shade[:, None]
    flat = np.stack([corners[order] @ right, corners[order] @ up], axis=-1)
    axes.add_collection(PolyCollection(flat, facecolors=paint, edgecolors=(0.1, 0.1, 0.12), linewidths=0.6))
    axes.set_aspect("equal")
    axes.axis("off")
    return flat.reshape(-1, 2)


def main():
    results = Results(sys.argv[1])
    peaks = [results.stress(frame).max() for frame in range(len(results.times))]
    impact = int(np.argmax(peaks))
    frames = [("before", 0), ("at impact", impact), ("after", len(results.times) - 1)]
    colours = pyplot.cm.ScalarMappable(Normalize(0.0, 1000.0), "YlOrRd")
    figure, all_axes = pyplot.subplots(1, 3, figsize=(12, 4.5), dpi=90)
    figure.subplots_adjust(left=0.01, right=0.99, top=0.93, bottom=0.19, wspace=0.02)
    drawn = [draw(axes, results.corners(frame), results.stress(frame), colours)
             for axes, (_, frame) in zip(all_axes, frames)]
    low, high = np.min(np.concatenate(drawn), axis=0), np.max(np.concatenate(drawn), axis=0)
    for axes, (title, frame) in zip(all_axes, frames):
        axes.set_xlim(low[0] - 0.05, high[0] + 0.05)
        axes.set_ylim(low[1] - 0.05, high[1] + 0.05)
        axes.set_title(f"{title}, {1e3 * results.times[frame]:.1f} ms", fontsize=14)
    bar = figure.colorbar(colours, cax=figure.add_axes((0.3, 0.13, 0.4, 0.035)), orientation="horizontal", extend="max")
    bar.set_label("von Mises stress [MPa]", fontsize=12)
    figure.savefig(pathlib.Path(__file__).with_suffix(".png"), facecolor="white")


main()
