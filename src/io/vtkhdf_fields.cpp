// SPDX-License-Identifier: Apache-2.0
#include "io/vtkhdf_fields.hpp"

#include <array>

namespace fexp::io {

namespace {

using model::Frame;

template <auto Member>
const void* data_of(const Frame& frame) {
  return (frame.*Member).data();
}

template <auto Member>
constexpr ResultField at_nodes(std::string_view name, std::string_view unit, std::string_view meaning) {
  return {name, FieldPlace::node, 3, FieldType::single_precision, Varies::always, unit, meaning, data_of<Member>};
}

template <auto Member>
constexpr ResultField at_elements(std::string_view name, int components, std::string_view unit,
                                  std::string_view meaning) {
  return {name,    FieldPlace::element, components, FieldType::single_precision, Varies::always, unit,
          meaning, data_of<Member>};
}

constexpr std::array fields{
    at_nodes<&Frame::displacement>("displacement", "length", "Position less reference position"),
    at_nodes<&Frame::velocity>("velocity", "length/time", "Velocity"),
    at_nodes<&Frame::rotation_rate>("rotation_rate", "1/time", "Angular velocity"),
    at_nodes<&Frame::contact_force>("contact_force", "force", "Force from contact with shells, without rigid walls"),
    at_elements<&Frame::membrane_force>("membrane_force", 3, "force/length", "Membrane resultants nxx nyy nxy"),
    at_elements<&Frame::bending_moment>("bending_moment", 3, "force", "Bending resultants mxx myy mxy"),
    at_elements<&Frame::shear_force>("shear_force", 2, "force/length", "Transverse shear resultants qxz qyz"),
    at_elements<&Frame::von_mises_top>("von_mises_top", 1, "force/length^2",
                                       "Von Mises stress on the side the normal points to"),
    at_elements<&Frame::von_mises_bottom>("von_mises_bottom", 1, "force/length^2",
                                          "Von Mises stress on the side away from the normal"),
    at_elements<&Frame::energy_density>("energy_density", 1, "force/length^2", "Internal energy over reference volume"),
    ResultField{"thickness", FieldPlace::element, 1, FieldType::single_precision, Varies::where_plastic, "length",
                "Shell thickness", data_of<&Frame::thickness>},
    ResultField{"plastic_strain", FieldPlace::element, 1, FieldType::single_precision, Varies::where_plastic, "-",
                "Effective plastic strain, largest through the thickness", data_of<&Frame::plastic_strain>},
    ResultField{"temperature", FieldPlace::element, 1, FieldType::single_precision, Varies::where_plastic,
                "temperature", "Temperature, highest through the thickness; 0 where plastic work does not heat",
                data_of<&Frame::temperature>},
    ResultField{"deleted", FieldPlace::element, 1, FieldType::integer, Varies::where_plastic, "-",
                "1 when the element has failed, else 0", data_of<&Frame::deleted>},
    ResultField{"body", FieldPlace::element, 1, FieldType::integer, Varies::never, "-", "Index of the body",
                data_of<&Frame::body>},
    ResultField{"island", FieldPlace::element, 1, FieldType::integer, Varies::always, "-",
                "Index of the island, -1 for a barrier", data_of<&Frame::island>},
    ResultField{"tie_force", FieldPlace::node, 3, FieldType::single_precision, Varies::where_tied, "force",
                "Force of a tied node on what carries it", data_of<&Frame::tie_force>},
    ResultField{"tied", FieldPlace::node, 1, FieldType::integer, Varies::where_tied, "-",
                "1 while a tie holds the node, else 0", data_of<&Frame::tied>},
};

}  // namespace

std::span<const ResultField> result_fields() noexcept { return fields; }

std::string path_of(const ResultField& field) {
  return (field.place == FieldPlace::node ? "/VTKHDF/PointData/" : "/VTKHDF/CellData/") + std::string(field.name);
}

}  // namespace fexp::io
