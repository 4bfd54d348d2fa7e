// The machine with probes: what crosses each boundary between its units, as outputs (rtl/SPEC.md, Probes). Verilator's alone: they are
// taken out of the machine by hierarchical reference, so that rtl/ has no port and no register for them.
//
// probe_<name>_valid_o: the boundary carries a beat in this clock: setup when the walk takes a quad, tile when coverage may see it first,
// stamp when the FIFO takes it, the others, one for each lane, with the register that they are named after. Structs, ports and connections
// are written by the program from the list of boundaries, for each simulator anew.
`include "quadrille_probes_pkg.svh"

module quadrille_probed
  import quadrille_pkg::*;
  import quadrille_probes_pkg::*;
(
    input logic clk_i,
    input logic rst_ni,
    input logic [STATE_BITS-1:0] state_i,
    input logic clear_hidden_i,
    input logic flush_i,
    input logic [VERTEX_BITS-1:0] vertex_i,
    input logic vertex_valid_i,
    output logic vertex_ready_o,
    output logic [PIXELS_PER_CLOCK*FRAGMENT_BITS-1:0] fragment_o,
    output logic [PIXELS_PER_CLOCK-1:0] fragment_mask_o,
    output logic fragment_valid_o,
    input logic fragment_ready_i,
    output logic busy_o,
    input logic [COUNTER_INDEX_BITS-1:0] counter_index_i,
    output logic [COUNTER_BITS-1:0] counter_o,
    `QUADRILLE_PROBE_PORTS
);
  quadrille u_quadrille (.*);

  `QUADRILLE_PROBES

  // ---- Tile: its entry of the ring and, of a homogeneous quad, the two behind ------------------------------------------------
  // Read in that clock alone, which is what a simulator has to do. An end entry's context means nothing.
  logic [RING_LOG2-1:0] entry_q;
  logic tile_homogeneous;
  probe_tile_t tile;

  always_ff @(posedge clk_i) begin
    probe_tile_valid_o <= rst_ni && u_quadrille.u_tiles.u_ring.words.complete;
    entry_q <= u_quadrille.u_tiles.u_ring.complete_q[RING_LOG2-1:0];
  end

  assign {tile.end_token, tile_homogeneous, tile.slot, tile.tile_x, tile.tile_y} =
      probe_tile_valid_o ? u_quadrille.u_tiles.u_ring.u_tag.word_q[entry_q][TAG_BITS-1:TILE_LOG2] : '0;

  assign tile.lin_value = probe_tile_valid_o ? u_quadrille.u_tiles.u_ring.u_emit_value.word_q[entry_q] : '0;

  for (genvar g = 0; g < 10; g++) begin : gen_quadratic
    localparam int LANE = (g < 6) ? g % 4 : g - 6;
    localparam logic [1:0] PART = (g >= 6) ? 2'd0 : (g >= 4) ? PART_DIAGONALS : PART_EDGES;
    logic there;
    logic [RING_LOG2-1:0] entry;
    assign there = probe_tile_valid_o && (g >= 6 || tile_homogeneous);
    assign entry = entry_q + RING_LOG2'(PART);
    assign tile.quad_value[g*QVAL_BITS+:QVAL_BITS] = there ? u_quadrille.u_tiles.u_ring.gen_quadratic[LANE].u_value.word_q[entry] : '0;
    assign {tile.quad_gx[g*QGRAD_BITS+:QGRAD_BITS], tile.quad_gy[g*QGRAD_BITS+:QGRAD_BITS]} =
        there ? u_quadrille.u_tiles.u_ring.gen_quadratic[LANE].u_gradient.word_q[entry] : '0;
    assign tile.quad_q[g*QCURV_BITS+:QCURV_BITS] = there ? u_quadrille.u_tiles.u_ring.gen_quadratic[LANE].u_q.word_q[entry] : '0;
  end

  assign probe_tile_o = tile.end_token ? '{end_token: 1'b1, slot: tile.slot, default: '0} : tile;

  // ---- Pixels, lane by lane -------------------------------------------------------------------------------------------------
  for (genvar g = 0; g < PIXELS_PER_CLOCK; g++) begin : gen_lane
    // Numbers that the lane does not take on, and what comes of them, are shown as zeros.
    logic norm_active, distance_active, root_active, ratio_active;
    logic ratio_v_active;  // of A alone

    quadrille_delay_line u_norm_active (.clk_i, .data_i(`QUADRILLE_LANE.norm_active_q), .data_o(norm_active));
    quadrille_delay_line u_distance_active (.clk_i, .data_i(`QUADRILLE_LANE.distance_active_q), .data_o(distance_active));
    quadrille_delay_line #(.DEPTH(RATIO_STAGE - NORM_STAGE)) u_ratio_v_active (.clk_i, .data_i(norm_active), .data_o(ratio_v_active));
    quadrille_delay_line #(.DEPTH(ROOT_STAGE - NORM_STAGE)) u_root_active (.clk_i, .data_i(distance_active), .data_o(root_active));
    quadrille_delay_line #(.DEPTH(RATIO_STAGE - ROOT_STAGE)) u_ratio_active (.clk_i, .data_i(root_active), .data_o(ratio_active));

    `QUADRILLE_LANE_PROBES
  end
endmodule
