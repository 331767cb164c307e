// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

/// Decks for tests of the parser.
namespace fexp::test {

/// A deck that uses every section and every kind of value, and of which a model can be built.
inline const std::string full_deck = R"(title = "everything"

[units]
length = "mm"
time = "ms"
mass = "kg"
force = "kN"

[run]
duration = 2
safety = 0.8
damping = 0.5
energy_drift_limit = 0.01
step_collapse = 0.0
drilling = 0.2
epoch_steps = 32

[[curve]]
name = "ramp"
points = [[0, 0.0], [1.5, 2]]

[[material]]
name = "steel"
law = "linear_elastic"
density = 7.85e-6
young = 210
poisson = 0.3

[[section]]
name = "thin"
material = "steel"
thickness = 0.5

[[body]]
name = "ball"
mesh = { kind = "cubed_sphere", radius = 0.5, cells = 3 }
section = "thin"
scale = 2.0
rotate = [{ axis = [0, 0, 1], angle_degrees = 45 }, { axis = [1, 0, 0], angle_degrees = 30, point = [0, 1, 0] }]
translate = [1.0, 2, 3.5]
velocity = [0, 0, -1]
angular_velocity = [0.1, 0, 0]
flip_normals = true

[[body]]
name = "plate"
parts = [{ part = "shell", section = "thin" }]
translate = [0, 0, -20]
[body.mesh]
kind = "plate"
length_x = 4
length_y = 3
cells_x = 5
diagonals = "crossed"
[body.array]
count = [2, 1, 3]
pitch = [10, 0, 10]

[[node_set]]
name = "edge"
bodies = ["plate"]
boundary = true
box = { low = [0, 0, -21], high = [0, 3, -19] }

[[node_set]]
name = "shells"
bodies = ["ball"]

[[fixed]]
set = "edge"

[[fixed]]
set = "edge"
dofs = ["x", "rz"]

[[prescribed]]
set = "shells"
dof = "y"
velocity = 3
curve = "ramp"

[[symmetry]]
set = "edge"
normal = [1, 0, 0]

[[gravity]]
acceleration = [0, 0, -9.81e-3]
curve = "ramp"

[[pressure]]
bodies = ["ball"]
part = "shell"
value = 0.1
curve = "ramp"

[[force]]
set = "edge"
force = [1, 0, 0]
moment = [0, 1, 0]
total = true
curve = "ramp"

[[plane]]
name = "floor"
point = [0, 0, -50]
normal = [0, 0, 2]
stiffness = 100

[[cylinder]]
name = "roll"
point = [0, 0, -60]
axis = [0, 3, 0]
radius = 5
velocity = [1, 0, 0]
curve = "ramp"

[[sphere]]
name = "bowl"
centre = [0, 0, 1]
radius = 500
inside = true
stiffness = 50
displacement = [0, 0, 2]
curve = "ramp"

[contact]
enabled = true
self = false
penalty_scale = 0.5
stiffness = 10
exclude = [["ball", "plate"], ["ball", "ball"]]

[output]
results_interval = 0.1
history_interval = 0.01
nodes = ["edge"]
bodies = ["ball"]
deflate = 3

[[point_mass]]
set = "edge"
mass = 0.01
inertia = 0.02
total = true
)";

}  // namespace fexp::test
