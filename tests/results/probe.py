# SPDX-License-Identifier: Apache-2.0
"""What the probe writes, computed again, and how the checks call it."""

import subprocess
import sys

import numpy as np

DIED = 9


def made_up(items, components, frame):
    """tests/support/hand_model.hpp: made_up, for arrays of items and components."""
    value = items[:, None] * 37 + components[None, :] * 53 + frame * 11
    return (np.fmod(value, 128) - 64) / 64.0


class Expected:
    """Points, fields and topology of one frame of `bodies` strips of `cells` squares."""

    thickness = 0.125
    area = 0.5

    def __init__(self, bodies, cells):
        self.bodies, self.cells = bodies, cells
        b, i, j = np.meshgrid(np.arange(bodies), np.arange(cells + 1), np.arange(2), indexing="ij")
        self.reference = np.stack([i.ravel(), j.ravel(), 2.0 * b.ravel()], axis=1)
        self.nodes = len(self.reference)
        self.elements = bodies * 2 * cells
        element = np.arange(self.elements)
        self.body = element // (2 * cells)
        corner = self.body * 2 * (cells + 1) + 2 * (element % (2 * cells) // 2)
        even = np.stack([corner, corner + 2, corner + 3], axis=1)
        odd = np.stack([corner, corner + 3, corner + 1], axis=1)
        self.triangles = np.where((element % 2 == 0)[:, None], even, odd)

    def points(self, frame):
        return self.reference + made_up(np.arange(self.nodes), np.arange(0, 3), frame)

    def point_data(self, frame):
        n = np.arange(self.nodes)
        names = {"displacement": 0, "velocity": 3, "rotation_rate": 6, "contact_force": 9}
        data = {name: made_up(n, np.arange(c, c + 3), frame) for name, c in names.items()}
        return data | {"tie_force": np.zeros((self.nodes, 3)), "tied": np.zeros(self.nodes)}

    def cell_data(self, frame):
        row = made_up(np.arange(self.elements), np.arange(12), frame)
        t = self.thickness
        surface = {}
        for name, sign in (("top", 1.0), ("bottom", -1.0)):
            sxx, syy, sxy = (row[:, 0:3] / t + sign * 6.0 * row[:, 3:6] / t**2).T
            surface[name] = np.sqrt(0.5 * ((sxx - syy) ** 2 + syy**2 + sxx**2) + 3.0 * sxy**2)
        return {
            "membrane_force": row[:, 0:3],
            "bending_moment": row[:, 3:6],
            "shear_force": row[:, 6:8],
            "von_mises_top": surface["top"],
            "von_mises_bottom": surface["bottom"],
            "energy_density": row[:, 11] / (self.area * t),
            "thickness": np.full(self.elements, t),
            "plastic_strain": np.zeros(self.elements),
            "temperature": np.zeros(self.elements),
            "deleted": np.zeros(self.elements),
            "body": self.body,
            "island": self.body // 2,
        }


def time_of(frame):
    return frame / 8.0


def run_probe(program, path, **arguments):
    """Runs the probe; returns its exit code and its lines."""
    command = [program, str(path)] + [f"{name}={value}" for name, value in arguments.items()]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    if done.returncode not in (0, DIED):
        sys.exit(f"{' '.join(command)} failed: {done.stderr}")
    return done.returncode, done.stdout.splitlines()


def close_to(read, expected):
    """Equal to single precision."""
    return np.shape(read) == np.shape(expected) and np.allclose(read, expected, rtol=1e-6, atol=1e-6)
