// SPDX-License-Identifier: Apache-2.0
#include "model/material_checks.hpp"

#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>
#include <variant>

namespace fexp::model {

namespace {

/// A law of linear hardening: it must not be stiffer beyond the yield stress than before.
void check_hardening(const Material& material, const physics::J2Linear& law, ErrorList& errors) {
  if (law.tangent_modulus >= law.young) {
    errors.add(material.place,
               fmt::format("material \"{}\": tangent_modulus is {}, young is {}", material.name, law.tangent_modulus,
                           law.young),
               "a tangent_modulus less than young", "correct one of them");
  }
}

void check_hardening(const Material& material, const physics::J2Table& law, ErrorList& errors) {
  std::string wrong = law.table.count == 0 ? "has no points" : "";
  const std::array<double, 2>* last = nullptr;
  for (const std::array<double, 2>& point : law.table) {
    const auto& [strain, stress] = point;
    if (!wrong.empty()) {
      break;
    }
    if (!(stress > 0.0)) {
      wrong = fmt::format("has a yield stress of {} at a strain of {}", stress, strain);
    } else if (last == nullptr && strain != 0.0) {
      wrong = fmt::format("begins at a strain of {}", strain);
    } else if (last != nullptr && !(strain > (*last)[0])) {
      wrong = fmt::format("has a strain of {} after one of {}", strain, (*last)[0]);
    } else if (last != nullptr && !(stress >= (*last)[1])) {
      wrong = fmt::format("has a yield stress of {} after one of {}", stress, (*last)[1]);
    }
    last = &point;
  }
  if (!wrong.empty()) {
    errors.add(material.place, fmt::format("the table of material \"{}\" {}", material.name, wrong),
               "strains ascending from 0, stresses > 0 that do not fall",
               "correct the table; plastic strain is total strain less stress/young");
  }
}

void check_rate(const Material& material, const physics::J2Law& law, ErrorList& errors) {
  if (law.cowper_symonds && law.rate_sensitivity > 0.0) {
    errors.add(material.place,
               fmt::format("material \"{}\" has both cowper_symonds and a rate_sensitivity of {}", material.name,
                           law.rate_sensitivity),
               "one law of the rate", "remove one of them");
  }
  if (law.rate_cutoff > 0.0 && !law.depends_on_rate()) {
    errors.add(material.place,
               fmt::format("material \"{}\": rate_cutoff is {}, but the yield stress does not depend on the rate",
                           material.name, law.rate_cutoff),
               "rate_cutoff where there is a rate_sensitivity, c or cowper_symonds",
               "remove rate_cutoff, or say how the yield stress depends on the rate");
  }
}

void check_heating(const Material& material, const physics::AdiabaticHeating& heating, ErrorList& errors) {
  const auto below = [&](std::string_view name, double temperature) {
    if (!(temperature < heating.melting_temperature)) {
      errors.add(material.place,
                 fmt::format("material \"{}\": {} is {}, melting_temperature is {}", material.name, name, temperature,
                             heating.melting_temperature),
                 fmt::format("{} below melting_temperature", name), "correct one of them");
    }
  };
  below("reference_temperature", heating.reference_temperature);
  below("initial_temperature", heating.initial_temperature);
}

}  // namespace

void check_materials(const Description& description, ErrorList& errors) {
  for (const Material& material : description.materials) {
    std::visit(
        [&](const auto& law) {
          if constexpr (requires { check_hardening(material, law, errors); }) {
            check_hardening(material, law, errors);
          }
          if constexpr (requires { law.plasticity(); }) {
            check_rate(material, law, errors);
            if (law.heating) {
              check_heating(material, *law.heating, errors);
            }
          }
        },
        material.law);
  }
}

}  // namespace fexp::model
