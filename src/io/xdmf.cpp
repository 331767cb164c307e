// SPDX-License-Identifier: Apache-2.0
#include "io/xdmf.hpp"

#include <fmt/format.h>

#include <utility>

#include "io/atomic_file.hpp"
#include "io/vtkhdf_fields.hpp"

namespace fexp::io {

namespace {

std::string number_text(FieldType type) {
  const char* kind = type == FieldType::integer ? "Int" : "Float";
  return fmt::format(R"(NumberType="{}" Precision="{}")", kind, bytes_of(type));
}

const char* attribute_type(int components) {
  return components == 1 ? "Scalar" : components == 3 ? "Vector" : "Matrix";
}

constexpr const char* head =
    "<?xml version=\"1.0\"?>\n"
    "<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>\n"
    "<Xdmf Version=\"2.0\">\n"
    "<Domain>\n"
    "<Grid Name=\"frames\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
constexpr const char* tail = "</Grid>\n</Domain>\n</Xdmf>\n";

}  // namespace

XdmfWriter::XdmfWriter(std::filesystem::path path, std::string results, const model::Model& model,
                       std::span<const double> times)
    : path_(std::move(path)),
      results_(std::move(results)),
      nodes_(model.node_count()),
      elements_(model.element_count()),
      variety_(Variety::of(model)) {
  for (const double time : times) {
    list(time);
  }
  write();
}

/// Rows [first, first + rows) of a dataset.
std::string XdmfWriter::rows_text(const std::string& dataset, std::int64_t first, std::int64_t rows, int components,
                                  const std::string& number) const {
  // One frame's slab, cut out of the rows up to its end: the dataset may have grown since.
  if (components == 1) {
    return fmt::format(
        "<DataItem ItemType=\"HyperSlab\" Dimensions=\"{1}\">"
        "<DataItem Dimensions=\"3 1\" Format=\"XML\">{0} 1 {1}</DataItem>"
        "<DataItem Dimensions=\"{2}\" {3} Format=\"HDF\">{4}:{5}</DataItem></DataItem>\n",
        first, rows, first + rows, number, results_, dataset);
  }
  return fmt::format(
      "<DataItem ItemType=\"HyperSlab\" Dimensions=\"{1} {2}\">"
      "<DataItem Dimensions=\"3 2\" Format=\"XML\">{0} 0 1 1 {1} {2}</DataItem>"
      "<DataItem Dimensions=\"{3} {2}\" {4} Format=\"HDF\">{5}:{6}</DataItem></DataItem>\n",
      first, rows, components, first + rows, number, results_, dataset);
}

std::string XdmfWriter::frame_text(std::int64_t frame, double time) const {
  std::string text = fmt::format(
      "<Grid Name=\"frame {0}\">\n<Time Value=\"{1}\"/>\n"
      "<Topology TopologyType=\"Triangle\" NumberOfElements=\"{2}\">",
      frame, time, elements_);
  // ParaView's reader would take a plain item here as a sign that the points do not move.
  text += rows_text("/VTKHDF/Connectivity", 0, 3 * elements_, 1, "NumberType=\"Int\" Precision=\"8\"");
  text += "</Topology>\n<Geometry GeometryType=\"XYZ\">";
  text += rows_text("/VTKHDF/Points", frame * nodes_, nodes_, 3, number_text(FieldType::double_precision));
  text += "</Geometry>\n";
  for (const ResultField& field : result_fields()) {
    const bool node = field.place == FieldPlace::node;
    const std::int64_t rows = node ? nodes_ : elements_;
    text += fmt::format("<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">", field.name,
                        attribute_type(field.components), node ? "Node" : "Cell");
    text += rows_text(path_of(field), field.constant(variety_) ? 0 : frame * rows, rows, field.components,
                      number_text(field.type));
    text += "</Attribute>\n";
  }
  return text + "</Grid>\n";
}

void XdmfWriter::list(double time) {
  frames_text_ += frame_text(frames_, time);
  ++frames_;
}

void XdmfWriter::append(double time) {
  list(time);
  if (frames_ - written_ > frames_ / 100) {
    write();
  }
}

void XdmfWriter::close() {
  if (written_ != frames_) {
    write();
  }
}

void XdmfWriter::write() {
  write_atomically(path_, head + frames_text_ + tail);
  written_ = frames_;
}

}  // namespace fexp::io
