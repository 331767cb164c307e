// SPDX-License-Identifier: Apache-2.0
#include "model/build_contact.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "model/build.hpp"
#include "model/node_sets.hpp"
#include "parallel/parallel.hpp"

namespace fexp::model {

namespace {

/// Stiffness of a node by a shell of which it is a corner: half of modulus times thickness [R21].
double shell_stiffness(const SectionData& section) noexcept {
  const physics::PlaneStressModuli& c = section.moduli;
  const double young = c.direct - c.cross * c.cross / c.direct;
  return 0.5 * young * section.thickness;
}

std::string name_of(const ContactPair& pair) {
  return fmt::format("\"{}\" and \"{}\"", pair.bodies[0], pair.bodies[1]);
}

void check_pair(const ContactSettings& contact, const ContactPair& pair, ErrorList& errors) {
  if (!pair.friction && !pair.damping && !pair.penalty_scale && !pair.stiffness) {
    errors.add(pair.place, fmt::format("contact.pairs: nothing is set for {}", name_of(pair)),
               "friction, damping, penalty_scale or stiffness", "add one of them, or remove the pair");
  }
  if (pair.penalty_scale && (pair.stiffness || contact.stiffness >= 0.0)) {
    errors.add(pair.place,
               fmt::format("contact.pairs: {} have a penalty_scale besides {} stiffness", name_of(pair),
                           pair.stiffness ? "a" : "contact's"),
               "penalty_scale where no stiffness is given", "keep one of them, or give the pair a stiffness");
  }
}

void build_exclusions(const Description& description, Model& model, ErrorList& errors) {
  const BodyNames names(model);
  const auto find = [&](const std::string& name) {
    return names.find(std::span(&name, 1), description.contact.place, "contact.exclude", errors);
  };
  for (const auto& [first, second] : description.contact.exclude) {
    const std::vector<Index> bodies = find(first);
    if (first == second) {  // Takes self-contact from each copy; copies still touch each other.
      for (const Index i : bodies) {
        model.excluded_pairs.emplace_back(i, i);
      }
      continue;
    }
    for (const Index j : find(second)) {
      for (const Index i : bodies) {
        model.excluded_pairs.emplace_back(std::min(i, j), std::max(i, j));
      }
    }
  }
  for (const RigidBody& rigid : model.rigid_bodies) {  // Its parts keep their distances.
    model.excluded_pairs.emplace_back(rigid.body, rigid.body);
  }
  std::sort(model.excluded_pairs.begin(), model.excluded_pairs.end());
  model.excluded_pairs.erase(std::unique(model.excluded_pairs.begin(), model.excluded_pairs.end()),
                             model.excluded_pairs.end());
}

ContactLaw law_of(const ContactSettings& contact, const ContactPair& pair) {
  ContactLaw law;
  law.drag = {pair.friction.value_or(contact.friction), pair.damping.value_or(contact.damping)};
  law.stiffness = pair.stiffness.value_or(contact.stiffness);
  law.hardening = contact.hardening.value_or(law.stiffness >= 0.0 ? 0.0 : ContactSettings::usual_hardening);
  law.scale = pair.penalty_scale ? *pair.penalty_scale / contact.penalty_scale : 1.0;
  return law;
}

void build_laws(const ContactSettings& contact, Model& model, ErrorList& errors) {
  ContactLaws& laws = model.contact_laws;
  laws.laws = {law_of(contact, {})};
  const BodyNames names(model);
  std::vector<std::vector<std::size_t>> named(model.bodies.size());  // By which names of pairs
  for (std::size_t i = 0; i < 2 * contact.pairs.size(); ++i) {
    const ContactPair& pair = contact.pairs[i / 2];
    for (const Index body : names.find(std::span(&pair.bodies[i % 2], 1), pair.place, "contact.pairs", errors)) {
      named[at(body)].push_back(i);
    }
  }
  std::map<std::vector<std::size_t>, Index> groups;
  if (!contact.pairs.empty()) {
    for (const std::vector<std::size_t>& by : named) {
      laws.group.push_back(groups.try_emplace(by, static_cast<Index>(groups.size())).first->second);
    }
  }
  laws.groups = static_cast<Index>(groups.size());
  laws.law_of.assign(groups.size() * groups.size(), 0);
  const auto has = [](const std::vector<std::size_t>& by, std::size_t name) {
    return std::binary_search(by.begin(), by.end(), name);
  };
  for (std::size_t i = 0; i < contact.pairs.size(); ++i) {
    const auto number = static_cast<Index>(laws.laws.size());
    laws.laws.push_back(law_of(contact, contact.pairs[i]));
    Index other = 0;
    for (const auto& [by_first, first] : groups) {
      for (const auto& [by_second, second] : groups) {
        if ((has(by_first, 2 * i) && has(by_second, 2 * i + 1)) ||
            (has(by_first, 2 * i + 1) && has(by_second, 2 * i))) {
          Index& law = laws.law_of[at(first * laws.groups + second)];
          other = law != 0 ? law : other;
          law = number;
        }
      }
    }
    if (other != 0) {
      errors.add(contact.pairs[i].place,
                 fmt::format("contact.pairs: {} are set already, by the pair of {}", name_of(contact.pairs[i]),
                             name_of(contact.pairs[at(other - 1)])),
                 "one entry for each pair of bodies", "remove one of them");
    }
  }
  laws.drags = std::any_of(laws.laws.begin(), laws.laws.end(), [](const ContactLaw& law) { return law.drag.acts(); });
}

}  // namespace

void check_contact(const ContactSettings& contact, ErrorList& errors) {
  const bool given = contact.stiffness >= 0.0;
  if (contact.penalty == "given" && !given) {
    errors.add(contact.place, "contact.penalty is \"given\", and no stiffness is", "a stiffness",
               "add contact.stiffness, or leave contact.penalty out");
  } else if (!contact.penalty.empty() && contact.penalty != "given" && given) {
    errors.add(contact.place, fmt::format("contact.penalty is \"{}\", and a stiffness is given", contact.penalty),
               "no stiffness, or \"given\"", "remove one of them");
  }
  for (const ContactPair& pair : contact.pairs) {
    check_pair(contact, pair, errors);
  }
}

void build_contact_stiffness(Model& model) {
  model.contact_stiffness.resize(model.mass.size());
  const bool by_element = model.contact.penalty == "element";
  const double scale = model.contact.penalty_scale, frequency = penalty_courant / model.first_critical_step;
  parallel::for_each(model.node_count(), 1024, [&](Index n) {
    if (!by_element) {
      model.contact_stiffness[at(n)] = scale * model.mass[at(n)] * frequency * frequency;
      return;
    }
    double softest = HUGE_VAL;
    for (Index c = model.corner_start[at(n)]; c < model.corner_start[at(n) + 1]; ++c) {
      softest = std::min(softest, shell_stiffness(model.section_of(model.corner[at(c)] / 3)));
    }
    model.contact_stiffness[at(n)] = scale * softest;
  });
}

void build_contact_pairs(const Description& description, Model& model, ErrorList& errors) {
  build_exclusions(description, model, errors);
  build_laws(description.contact, model, errors);
}

}  // namespace fexp::model
