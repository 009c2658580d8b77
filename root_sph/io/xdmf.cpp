// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <iterator>
#include <map>

#include "root_sph/io/series.hpp"

namespace rootsoil {
namespace {

std::string data_item(const ColumnInfo& column, std::int64_t cells, const std::string& group) {
  const std::string width = column.components == 1 ? "" : fmt::format(" {}", column.components);
  return fmt::format(
      R"(<DataItem Format="HDF" NumberType="{}" Precision="8" Dimensions="{}{}">run.h5:{}/{}</DataItem>)",
      column.is_integer ? "Int" : "Float", cells, width, group, column.name);
}

// ParaView draws a point only if something says which point it is: 0, 1, 2 ..., kept once for all frames.
std::string topology(std::int64_t cells, std::int64_t most) {
  return fmt::format(
      "<Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{0}\" NodesPerElement=\"1\">"
      "<DataItem ItemType=\"HyperSlab\" Dimensions=\"{0}\"><DataItem Format=\"XML\" Dimensions=\"3 1\">0 1 "
      "{0}</DataItem>"
      "<DataItem Format=\"HDF\" NumberType=\"Int\" Precision=\"8\" Dimensions=\"{1}\">run.h5:/point_index</DataItem>"
      "</DataItem></Topology>\n",
      cells, most);
}

// Six components go as a plain matrix: XDMF's own Tensor6 has another order (xx xy xz yy yz zz), whereas a
// nameless array of six is to ParaView what it is here, xx yy zz xy yz xz.
const char* attribute_type(int components) {
  return components == 1 ? "Scalar" : components == 3 ? "Vector" : "Matrix";
}

void add_grid(const std::string& name, double time_h, std::int64_t count, std::int64_t most,
              const std::vector<ColumnInfo>& columns, const std::string& group, std::string& text) {
  auto out = std::back_inserter(text);
  fmt::format_to(out, "<Grid Name=\"{}\">\n<Time Value=\"{}\"/>\n", name, time_h);
  text += topology(count, most);
  for (const ColumnInfo& column : columns) {
    const std::string item = data_item(column, count, group);
    if (column.name == "position") {
      fmt::format_to(out, "<Geometry GeometryType=\"{}\">{}</Geometry>\n", column.components == 2 ? "XY" : "XYZ", item);
    } else {
      fmt::format_to(out, "<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">{}</Attribute>\n", column.name,
                     attribute_type(column.components), item);
    }
  }
  text += "</Grid>\n";
}

std::string collection(const std::string& name, const std::string& grids) {
  return fmt::format("<Grid Name=\"{}\" GridType=\"Collection\" CollectionType=\"Temporal\">\n{}</Grid>\n", name,
                     grids);
}

}  // namespace

std::string xdmf_text(const std::vector<FrameInfo>& frames) {
  const std::int64_t most = most_points(frames);
  std::string cells;
  std::map<std::string, std::string> tables;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const FrameInfo& frame = frames[i];
    add_grid("cells", frame.time_h, frame.cells, most, frame.columns, frame_group(i), cells);
    for (const TableInfo& table : frame.tables) {
      if (table.count == 0 || !table.has_positions()) continue;  // ParaView does not read a grid of nothing
      add_grid(table.name, frame.time_h, table.count, most, table.columns, frame_group(i) + "/" + table.name,
               tables[table.name]);
    }
  }
  std::string text = "<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\">\n<Domain>\n" + collection("cells", cells);
  for (const auto& [name, grids] : tables) text += collection(name, grids);
  return text + "</Domain>\n</Xdmf>\n";
}

}  // namespace rootsoil
