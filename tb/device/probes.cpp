#include "tb/device/probes.hpp"

#include "model/port/boundaries.hpp"

#include <algorithm>
#include <string_view>

namespace quadrille::tb {
namespace {

/// Where a boundary is in the RTL: what says that it carries a beat, and what stands before the names of its signals.
struct Place {
  const char *valid, *scope;
};
constexpr Place places[]{{"u_quadrille.take", "u_quadrille.setup."},
                         {nullptr, nullptr},  // the tile ring's words: quadrille_probed.sv
                         {"u_quadrille.u_tiles.stamp_push", "u_quadrille.u_tiles.stamp."},
                         {"`QUADRILLE_LANE.valid_q[DIFF_STAGE]", "`QUADRILLE_LANE.diff_"},
                         {"`QUADRILLE_LANE.valid_q[NORM_STAGE]", "`QUADRILLE_LANE.norm_"},
                         {"`QUADRILLE_LANE.valid_q[ROOT_STAGE]", "`QUADRILLE_LANE.root_"},
                         {"`QUADRILLE_LANE.valid_q[RATIO_STAGE]", "`QUADRILLE_LANE.ratio_"},
                         {"`QUADRILLE_LANE.valid_q[WEIGHT_STAGE]", "`QUADRILLE_LANE.m_"},
                         {"`QUADRILLE_LANE.valid_q[SUM_STAGE]", "`QUADRILLE_LANE.sum_"}};
static_assert(std::size(places) == static_cast<std::size_t>(Boundary::fragment));

std::string width_of(const FieldType& type) {
  const std::string_view symbol = type.width.symbol == nullptr ? "" : type.width.symbol;
  if (symbol.empty()) return std::to_string(type.width);
  if (symbol == "S") return "SIGNIFICAND_BITS";
  return symbol.find('+') == symbol.npos ? std::string(symbol) : "(" + std::string(symbol) + ")";
}

/// Of all elements.
std::string bits_of(const BoundaryField& field) {
  const std::string width = width_of(field.type);
  if (field.count == 0) return width;
  const std::string count = field.count == slots_of_tables ? "ATTRIBUTE_SLOTS" : std::to_string(field.count);
  return width == "1" ? count : count + "*" + width;
}

std::string signal_of(const BoundaryField& field, const Place& place) {
  const FieldType& type = field.type;
  std::string signal = type.signal == nullptr ? type.name : type.signal;
  if (signal.find('.') == signal.npos) signal = place.scope + signal;
  if (type.element >= 0)
    signal += "[" + std::to_string(type.element) + "*" + width_of(type) + "+:" + bits_of(field) + "]";
  return type.active == nullptr ? signal : std::string(type.active) + " ? " + signal + " : '0";
}

}  // namespace

std::string probes_header() {
  Config config;
  config.attribute_slots = slots_of_tables;
  std::string structs, ports, connections, lane_connections;
  std::size_t i = 0;
  for (const BoundaryDescription& boundary : describe_probes(config)) {
    const Place& place = places[i];
    const bool lanes = has_lanes(static_cast<Boundary>(i++));
    const std::string probe = "probe_" + boundary.name, lane = lanes ? "[g]" : "";
    const std::string all_lanes = lanes ? " [PIXELS_PER_CLOCK-1:0]" : "";
    structs += "\n  typedef struct packed {\n";
    std::string pattern;
    for (const BoundaryField& field : boundary.fields) {
      const std::string bits = bits_of(field);
      structs += "    logic " + (bits == "1" ? "" : "[" + bits + "-1:0] ") + field.type.name + ";\n";
      if (place.scope != nullptr)
        pattern += (pattern.empty() ? "" : ",") + (" \\\n    " + std::string(field.type.name)) + ": " +
                   signal_of(field, place);
    }
    structs += "  } " + probe + "_t;\n";
    ports += (ports.empty() ? "" : ",") + (" \\\n  output logic" + all_lanes) + " " + probe +
             "_valid_o, \\\n  output " + probe + "_t" + all_lanes + " " + probe + "_o";
    if (place.scope != nullptr)
      (lanes ? lane_connections : connections) += " \\\n  assign " + probe + "_valid_o" + lane + " = " + place.valid +
                                                  "; \\\n  assign " + probe + "_o" + lane + " = '{" + pattern +
                                                  " \\\n  };";
  }
  return "// Written by `quadrille config --boundaries sv` from model/port/boundaries.hpp. First members are most "
         "significant.\n"
         "package quadrille_probes_pkg;\n  import quadrille_pkg::*;\n" +
         structs +
         "endpackage\n\n"
         "`define QUADRILLE_LANE u_quadrille.u_pixel.u_pipeline.gen_lane[g].u_lane\n\n"
         "`define QUADRILLE_PROBE_PORTS" +
         ports + "\n\n`define QUADRILLE_PROBES" + connections + "\n\n`define QUADRILLE_LANE_PROBES" + lane_connections +
         "\n";
}

}  // namespace quadrille::tb
