// SPDX-License-Identifier: Apache-2.0
#include "model/build_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "model/build_contact.hpp"
#include "model/check_tools.hpp"
#include "model/material_checks.hpp"
#include "model/wall_checks.hpp"

namespace fexp::model {

namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void check_curve(const Curve& curve, ErrorList& errors) {
  double last = -HUGE_VAL;
  bool good = !curve.points.empty();
  for (const auto& [time, value] : curve.points) {
    good = good && std::isfinite(time) && std::isfinite(value) && time >= last;
    last = time;
  }
  if (!good) {
    errors.add(curve.place, fmt::format("curve \"{}\" is no function of time", curve.name),
               "at least one point, finite numbers, ascending times", "correct its points");
  }
}

void check_quadrature(const Section& section, ErrorList& errors) {
  if (!Section::points_range.contains(section.points)) {
    errors.add(section.place, fmt::format("section \"{}\" has {} points", section.name, section.points),
               std::string(Section::points_range.text), "correct the number");
  } else if (section.quadrature == quadrature_names[1] && section.points < physics::fewest_lobatto_points) {
    errors.add(section.place,
               fmt::format("section \"{}\" has {} points of Lobatto's rule", section.name, section.points),
               fmt::format("{} to {}", physics::fewest_lobatto_points, physics::most_points),
               "take more points, or quadrature = \"gauss\"");
  }
}

void check_dof(const std::string& dof, const Place& place, ErrorList& errors) {
  if (dof_index(dof) == no_index) {
    errors.add(place, fmt::format("\"{}\" is no degree of freedom", dof), "x, y, z, rx, ry, rz", "use one of these");
  }
}

void check_section_name(const std::vector<std::string>& sections, const std::string& name, const std::string& body,
                        const Place& place, ErrorList& errors) {
  if (!contains(sections, name)) {
    errors.add(place, fmt::format("body \"{}\" names section \"{}\", which is not there", body, name),
               name_list(sections), "define it or correct the name");
  }
}

/// Sets and curves that conditions and loads name are there.
class ReferenceChecks {
 public:
  ReferenceChecks(const Description& description, ErrorList& errors)
      : sets_(names_of(description.node_sets)), curves_(names_of(description.curves)), errors_(errors) {
    sets_.insert(sets_.begin(), "all");
  }

  template <class Condition>
  void operator()(const std::vector<Condition>& conditions) {
    for (const Condition& condition : conditions) {
      if constexpr (requires { condition.set; }) {
        check("node set", condition.set, sets_, condition.place);
      }
      if constexpr (requires { condition.curve; }) {
        if (!condition.curve.empty()) {
          check("curve", condition.curve, curves_, condition.place);
        }
      }
    }
  }

 private:
  void check(std::string_view kind, const std::string& name, const std::vector<std::string>& known,
             const Place& place) {
    if (!contains(known, name)) {
      errors_.add(place, fmt::format("there is no {} \"{}\"", kind, name), name_list(known),
                  "define it or correct the name");
    }
  }

  std::vector<std::string> sets_, curves_;
  ErrorList& errors_;
};

void check_body_sections(const BodyDescription& body, const std::vector<std::string>& sections, ErrorList& errors) {
  if (!body.section.empty()) {
    check_section_name(sections, body.section, body.name, body.place, errors);
  }
  std::set<std::string> parts;
  for (const PartSection& part : body.parts) {
    if (!parts.insert(part.part).second) {
      errors.add(part.place, fmt::format("body \"{}\" gives part \"{}\" a section twice", body.name, part.part),
                 "one section for each part", "remove one of them");
    }
    check_section_name(sections, part.section, body.name, part.place, errors);
  }
}

void check_placement(const BodyDescription& body, ErrorList& errors) {
  for (const Rotation& rotation : body.rotate) {
    if (!has_direction(rotation.axis)) {
      errors.add(body.place, fmt::format("a rotation of body \"{}\" has an axis without direction", body.name),
                 "an axis that is not zero", "correct the axis");
    }
  }
  if (!body.array) {
    return;
  }
  const Vec3d& p = body.array->pitch;
  const std::array<double, 3> pitch{p.x, p.y, p.z};
  for (std::size_t d = 0; d < 3; ++d) {
    const int count = body.array->count[d];
    if (!Array::count_range.contains(count)) {
      errors.add(body.place, fmt::format("body \"{}\": an array's count in {} is {}", body.name, dof_names[d], count),
                 std::string(Array::count_range.text), "correct the count");
    } else if (count > 1 && pitch[d] == 0.0) {
      errors.add(body.place,
                 fmt::format("body \"{}\": {} copies in {} stand in one place", body.name, count, dof_names[d]),
                 "a pitch that is not zero where there is more than one copy", "set the pitch or the count");
    }
  }
}

void check_axes(const std::optional<LocalAxes>& axes, const std::string& set, const Place& place, ErrorList& errors) {
  if (axes && !(has_direction(axes->x) && has_direction(axes->xy) && has_direction(cross(axes->x, axes->xy)))) {
    errors.add(place, fmt::format("the axes of the condition on set \"{}\" span no plane", set),
               "x and xy that are neither zero nor parallel", "correct the axes");
  }
}

/// One motion.
void check_prescribed(const Prescribed& p, const std::vector<Curve>& curves, ErrorList& errors) {
  check_dof(p.dof, p.place, errors);
  check_axes(p.axes, p.set, p.place, errors);
  const int given = (p.velocity ? 1 : 0) + (p.displacement ? 1 : 0) + (p.acceleration ? 1 : 0);
  if (given != 1) {
    errors.add(p.place,
               fmt::format("set \"{}\" is given {} prescribed motions for one degree of freedom", p.set, given),
               "one of velocity, displacement and acceleration", given == 0 ? "add one of them" : "keep one of them");
  }
  if (p.displacement) {
    check_displacement(fmt::format("set \"{}\"", p.set), p.curve, curves, p.place, errors);
  }
}

/// Smallest component of a unit normal that is taken for more than rounding.
constexpr double least_component = 1.0e-9;

/// Part of axis `dof` (translations and rotations alike) along the normal.
double along(const Vec3d& normal, Index dof) {
  const Index axis = dof % 3;
  return std::abs(axis == 0 ? normal.x : axis == 1 ? normal.y : normal.z);
}

/// A plane of symmetry lets translations in the plane and rotation about its normal free; a prescribed motion must be
/// one of these.
bool prescribed_clashes(const Vec3d& normal, const PrescribedNode& p) {
  const double part = std::abs(dot(normal, p.direction));
  return p.dof < 3 ? part > least_component : part < 1.0 - least_component;
}

/// Holding one axis that is oblique to the plane couples the others, which the masks of fixed nodes cannot express.
bool fixed_clashes(const Vec3d& normal, unsigned mask) {
  constexpr unsigned every_axis = 7;
  bool clash = false;
  for (Index dof = 0; dof < 6; ++dof) {
    const unsigned group = mask >> (dof < 3 ? 0U : 3U) & every_axis;
    const bool oblique = along(normal, dof) > least_component && along(normal, dof) < 1.0 - least_component;
    clash = clash || ((mask >> static_cast<unsigned>(dof) & 1U) != 0 && group != every_axis && oblique);
  }
  return clash;
}

template <class Item>
auto first_at(const std::vector<Item>& items, Index node) {
  return std::lower_bound(items.begin(), items.end(), node, [](const Item& item, Index n) { return item.node < n; });
}

}  // namespace

Index dof_index(std::string_view name) {
  const auto found = std::find(dof_names.begin(), dof_names.end(), name);
  return found == dof_names.end() ? no_index : static_cast<Index>(found - dof_names.begin());
}

std::string name_list(std::span<const std::string> names) {
  constexpr std::size_t most = 12;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  if (names.size() > most) {
    text += fmt::format(" and {} more", names.size() - most);
  }
  return text.empty() ? "(there are none)" : text;
}

void check_description(const Description& description, ErrorList& errors) {
  if (description.bodies.empty()) {
    errors.add({}, "there is no body", "at least one body", "describe a body with a mesh and a section");
  }
  check_names("curve", description.curves, {}, errors);
  check_names("material", description.materials, {}, errors);
  check_names("section", description.sections, {}, errors);
  check_names("body", description.bodies, {}, errors);
  check_names("node set", description.node_sets, {"all"}, errors);
  check_names("tie", description.ties, {}, errors);
  check_walls(description, errors);
  check_contact(description.contact, errors);

  const std::vector<std::string> materials = names_of(description.materials);
  const std::vector<std::string> sections = names_of(description.sections);
  for (const Curve& curve : description.curves) {
    check_curve(curve, errors);
  }
  check_materials(description, errors);
  for (const Section& section : description.sections) {
    check_quadrature(section, errors);
    if (!contains(materials, section.material)) {
      errors.add(
          section.place,
          fmt::format("section \"{}\" names material \"{}\", which is not there", section.name, section.material),
          name_list(materials), "define it or correct the name");
    }
  }
  for (const BodyDescription& body : description.bodies) {
    check_body_sections(body, sections, errors);
    check_placement(body, errors);
    if (body.mass > 0.0 && !body.rigid) {
      errors.add(body.place, fmt::format("body \"{}\" is given a mass and is not rigid", body.name),
                 "mass with rigid = true only", "set rigid, or give the density of its material");
    }
  }
  for (const Fixed& fixed : description.fixed) {
    check_axes(fixed.axes, fixed.set, fixed.place, errors);
    if (fixed.dofs.empty()) {
      errors.add(fixed.place, fmt::format("nothing is fixed on set \"{}\"", fixed.set),
                 name_list(std::vector<std::string>(dof_names.begin(), dof_names.end())),
                 "name degrees of freedom in dofs, or leave it out to hold them all");
    }
    for (const std::string& dof : fixed.dofs) {
      check_dof(dof, fixed.place, errors);
    }
  }
  for (const Prescribed& prescribed : description.prescribed) {
    check_prescribed(prescribed, description.curves, errors);
  }
  for (const Symmetry& symmetry : description.symmetry) {
    if (!has_direction(symmetry.normal)) {
      errors.add(symmetry.place, "the normal of a symmetry plane has no direction", "a vector that is not zero",
                 "correct the normal");
    }
  }
  for (const InitialVelocity& given : description.initial_velocities) {
    if (!has_direction(given.axis)) {
      errors.add(given.place, fmt::format("the axis of the velocity of set \"{}\" has no direction", given.set),
                 "a vector that is not zero", "correct the axis");
    }
  }
  ReferenceChecks references(description, errors);
  references(description.initial_velocities);
  references(description.fixed);
  references(description.prescribed);
  references(description.symmetry);
  references(description.gravity);
  references(description.pressure);
  references(description.forces);
  references(description.point_masses);
  references(description.ties);
  references(description.planes);
  references(description.cylinders);
  references(description.spheres);
}

void check_symmetry(const Description& description, const Model& model, ErrorList& errors) {
  for (const Symmetry& symmetry : description.symmetry) {
    const auto set = std::find_if(model.node_sets.begin(), model.node_sets.end(),
                                  [&](const NamedNodes& named) { return named.name == symmetry.set; });
    if (set == model.node_sets.end() || !has_direction(symmetry.normal)) {
      continue;
    }
    const Vec3d normal = (1.0 / norm(symmetry.normal)) * symmetry.normal;
    for (const Index n : set->nodes) {
      const auto fixed = first_at(model.fixed, n);
      std::string_view clash;
      if (fixed != model.fixed.end() && fixed->node == n && fixed_clashes(normal, fixed->mask)) {
        clash = "fixed";
      }
      for (auto p = first_at(model.prescribed, n); p != model.prescribed.end() && p->node == n; ++p) {
        if (prescribed_clashes(normal, *p)) {
          clash = "prescribed";
        }
      }
      if (!clash.empty()) {
        errors.add(
            symmetry.place,
            fmt::format("symmetry of set \"{}\": node {} of body \"{}\" is {} against the plane of symmetry",
                        symmetry.set, model.node_label[at(n)], model.bodies[at(model.node_body[at(n)])].name, clash),
            "conditions along and across the plane", "take the node out of one of the sets");
        break;
      }
    }
  }
}

}  // namespace fexp::model
