#include "tb/device/probes.hpp"

#include <gtest/gtest.h>

namespace quadrille::tb {
namespace {

/// Members and connections of each kind, by hand from rtl/SPEC.md, Probes, and the signals of rtl/. Of the others
/// Verilator refuses a member that is missing, or that is not as wide as its signal, whenever it builds a simulator.
TEST(Probes, MembersAndConnectionsOfEachKind) {
  const std::string text = probes_header();
  for (const char* line :
       {"    logic homogeneous;\n", "    logic [4-1:0] visible;\n", "    logic [10*QGRAD_BITS-1:0] quad_gx;\n",
        "    logic [(TILE_SLOTS_LOG2+2)-1:0] tile_ptr;\n", "    logic [6*SIGNIFICAND_BITS-1:0] v_sig;\n",
        "    logic [ATTRIBUTE_SLOTS-1:0] attr_neg;\n", "    logic [ATTRIBUTE_SLOTS*EXP_BITS-1:0] attr_exp;\n",
        "  output logic probe_tile_valid_o, \\\n  output probe_tile_t probe_tile_o, \\\n",
        "  output probe_sum_t [PIXELS_PER_CLOCK-1:0] probe_sum_o\n", "    tile_x0: u_quadrille.setup.tile_x0, \\\n",
        "    slot: u_quadrille.setup.slot, \\\n", "  assign probe_stamp_valid_o = u_quadrille.u_tiles.stamp_push; \\\n",
        "  assign probe_sqrt_valid_o[g] = `QUADRILLE_LANE.valid_q[ROOT_STAGE]; \\\n",
        "    a: `QUADRILLE_LANE.diff_a, \\\n", "    on_edge: `QUADRILLE_LANE.norm_class[CLASS_BITS-4], \\\n",
        "    d_neg: distance_active ? `QUADRILLE_LANE.norm_d_neg : '0, \\\n",
        "    attr_neg: `QUADRILLE_LANE.sum_neg[3*1+:ATTRIBUTE_SLOTS], \\\n",
        "    den_w_sig: `QUADRILLE_LANE.sum_sig[1*SIGNIFICAND_BITS+:SIGNIFICAND_BITS] \\\n  };\n"})
    EXPECT_NE(text.find(line), text.npos) << line << text;
}

}  // namespace
}  // namespace quadrille::tb
