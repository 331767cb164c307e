// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/deck.hpp"

namespace fexp::io {

/// Calls, for every section of a deck in the order of the reference, `visitor.table(name, meaning, presence, struct)`
/// for a single table and `visitor.list(name, meaning, presence, vector)` for a list of tables. The parser and the
/// reference both go through it.
template <class SomeDeck, class Visitor>
void for_each_section(SomeDeck& deck, Visitor& visitor) {
  constexpr Presence optional = Presence::optional, required = Presence::required;
  auto& d = deck.description;
  visitor.table("units", "Names of the units, for headings and reports. The solver computes in the numbers as given.",
                optional, deck.units);
  visitor.table("run", "What to integrate and when to stop.", required, d.run);
  visitor.list("curve", "A piecewise linear function of time, by which loads and conditions are multiplied.", optional,
               d.curves);
  visitor.list("material", "A material law.", optional, d.materials);
  visitor.list("section", "Thickness and material of shells.", optional, d.sections);
  visitor.list("body", "A set of shells that moves as a connected piece. Placement: scale, rotate, translate, array.",
               required, d.bodies);
  visitor.table("refinement", "Finer or coarser meshes than the bodies say.", optional, deck.refinement);
  visitor.list("node_set",
               "Named nodes: those of the bodies that satisfy every selection given. The set \"all\" is there already.",
               optional, d.node_sets);
  visitor.list("initial_velocity", "Velocities at the start, added to those of the bodies and of other such tables.",
               optional, d.initial_velocities);
  visitor.list("fixed", "Degrees of freedom that are held at rest.", optional, d.fixed);
  visitor.list("prescribed",
               "A motion prescribed on one degree of freedom: its velocity, displacement or acceleration.", optional,
               d.prescribed);
  visitor.list("symmetry",
               "A plane of mirror symmetry: no velocity along its normal, no rotation about axes in the plane.",
               optional, d.symmetry);
  visitor.list("gravity", "An acceleration of all nodes.", optional, d.gravity);
  visitor.list("pressure", "A pressure on faces.", optional, d.pressure);
  visitor.list("force", "Forces and moments on nodes.", optional, d.forces);
  visitor.list("point_mass", "Masses on nodes, besides those of the shells.", optional, d.point_masses);
  visitor.list("tie",
               "Nodes that are joined with the surface of other bodies, with those and nothing else in between: meshes "
               "that do not match, glued layers, webs on plates. Masses and forces of the nodes go to the corners of "
               "the triangles.",
               optional, d.ties);
  visitor.list(
      "plane",
      "A rigid wall that nodes cannot pass: a plane. Walls stand, or move as told whatever touches them, or have a "
      "mass and move by what pushes them.",
      optional, d.planes);
  visitor.list("cylinder", "A rigid wall that nodes cannot pass: an endless cylinder, from outside or inside.",
               optional, d.cylinders);
  visitor.list("sphere", "A rigid wall that nodes cannot pass: a sphere, from outside or inside.", optional, d.spheres);
  visitor.table("contact", "Contact between bodies, and of each with itself; on unless switched off.", optional,
                d.contact);
  visitor.table("output", "What to write and how often. Frames and rows stand at the start and the end, too.", optional,
                deck.output);
  visitor.table("verify", "How \"fexp verify\" runs the deck.", optional, deck.verify);
  visitor.list("expect", "A number that \"fexp verify\" takes from the histories and holds against a reference.",
               optional, deck.expectations);
}

}  // namespace fexp::io
