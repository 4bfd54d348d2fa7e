#include "tb/device/probes.hpp"

#include "model/boundaries.hpp"

#include <gtest/gtest.h>

namespace quadrille::tb {
namespace {

/// Members and connections of each kind, by hand from section 6 of rtl/README.md and the signals of rtl/. Whether all
/// of them fit the RTL, Verilator says when it builds a simulator: each member has the width of its signal.
TEST(Probes, MembersAndConnectionsOfEachKind) {
  const std::string text = probes_header();
  for (const char* line :
       {"    logic homogeneous;\n", "    logic [4-1:0] visible;\n", "    logic [10*QGRAD_BITS-1:0] quad_gx;\n",
        "    logic [(TILE_SLOTS_LOG2+2)-1:0] tile_ptr;\n", "    logic [6*SIGNIFICAND_BITS-1:0] v_sig;\n",
        "    logic [ATTRIBUTE_SLOTS-1:0] attr_neg;\n", "    logic [ATTRIBUTE_SLOTS*EXP_BITS-1:0] attr_exp;\n",
        "  output logic probe_tile_valid_o, \\\n  output probe_tile_t probe_tile_o, \\\n",
        "  output probe_sum_t [PIXELS_PER_CLOCK-1:0] probe_sum_o\n", "    tile_x0: u_quadrille.tile_x0, \\\n",
        "    slot: u_quadrille.setup_slot, \\\n", "  assign probe_stamp_valid_o = u_quadrille.stamp_push; \\\n",
        "  assign probe_sqrt_valid_o[g] = `QUADRILLE_LANE.valid_q[ROOT_STAGE]; \\\n",
        "    a: `QUADRILLE_LANE.diff_a, \\\n", "    on_edge: `QUADRILLE_LANE.norm_class[CLASS_BITS-4], \\\n",
        "    d_neg: distance_active ? `QUADRILLE_LANE.norm_d_neg : '0, \\\n",
        "    attr_neg: `QUADRILLE_LANE.sum_neg[3*1+:ATTRIBUTE_SLOTS], \\\n",
        "    den_w_sig: `QUADRILLE_LANE.sum_sig[1*SIGNIFICAND_BITS+:SIGNIFICAND_BITS] \\\n  };\n"})
    EXPECT_NE(text.find(line), text.npos) << line << text;
}

/// Every field of every boundary is a member of its struct, in order, and of all but the tile connected.
TEST(Probes, HaveEveryField) {
  const std::string text = probes_header();
  std::size_t at = 0;
  for (const BoundaryDescription& boundary : describe_probes(Config{})) {
    for (const BoundaryField& field : boundary.fields) {
      at = text.find(std::string(" ") + field.type.name + ";\n", at);
      ASSERT_NE(at, text.npos) << boundary.name << ": " << field.type.name;
    }
    at = text.find("  } probe_" + boundary.name + "_t;\n", at);
    ASSERT_NE(at, text.npos) << boundary.name;
    std::size_t connected = text.find("  assign probe_" + boundary.name + "_o");
    ASSERT_EQ(connected == text.npos, boundary.name == "tile");
    for (const BoundaryField& field : boundary.fields) {
      if (boundary.name == "tile") break;
      connected = text.find(std::string("    ") + field.type.name + ": ", connected);
      ASSERT_NE(connected, text.npos) << boundary.name << ": " << field.type.name;
    }
  }
}

}  // namespace
}  // namespace quadrille::tb
