// SPDX-License-Identifier: MIT
#include "soil_coupling/message.hpp"

#include <nlohmann/json.hpp>

namespace rootsoil {

std::string describe_layout() {
  nlohmann::ordered_json packet, kinds, tables;
  packet = {{"magic", offsetof(Packet, magic)},
            {"version", offsetof(Packet, version)},
            {"kind", offsetof(Packet, kind)},
            {"sequence", offsetof(Packet, sequence)},
            {"block_bytes", offsetof(Packet, block_bytes)},
            {"text_bytes", offsetof(Packet, text_bytes)},
            {"rows", offsetof(Packet, rows)},
            {"interval", offsetof(Packet, interval)},
            {"time_h", offsetof(Packet, time_h)},
            {"duration_h", offsetof(Packet, duration_h)}};
  const auto kind = [&](const char* name, Kind value) { kinds[name] = static_cast<int>(value); };
  kind("hello", Kind::hello);
  kind("pack", Kind::pack);
  kind("build", Kind::build);
  kind("advance", Kind::advance);
  kind("snapshot", Kind::snapshot);
  kind("save", Kind::save);
  kind("load", Kind::load);
  kind("stop", Kind::stop);
  kind("done", Kind::done);
  kind("progress", Kind::progress);
  kind("failed", Kind::failed);
  kind("refused", Kind::refused);
  const auto table = [&](const char* name, std::span<const Column> columns) {
    constexpr std::size_t rows = 13;  // no multiple of the alignment
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (std::size_t k = 0; k < columns.size(); ++k) {
      list.push_back({columns[k].name, columns[k].type, columns[k].components, column_offset(columns, k, rows)});
    }
    list.push_back(column_offset(columns, columns.size(), rows));
    tables[name] = list;
  };
  table("body", body_table);
  table("motion", motion_table);
  table("forces", forces_table);
  table("grains", grains_table);
  table("contacts", contacts_table);
  return nlohmann::ordered_json{{"magic", packet_magic},
                                {"version", protocol_version},
                                {"bytes", sizeof(Packet)},
                                {"text_room", text_room},
                                {"progress_room", progress_room},
                                {"packet", packet},
                                {"kinds", kinds},
                                {"tables", tables}}
      .dump();
}

}  // namespace rootsoil
