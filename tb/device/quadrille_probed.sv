// The machine with probes: what crosses each boundary between its units, as outputs (rtl/SPEC.md, Probes). Verilator's alone: they are
// taken out of the machine by hierarchical reference, so that rtl/ has no port and no register for them.
//
// probe_<name>_valid_o: the boundary carries a beat in this clock: setup when the walk takes a quad, tile when coverage may see it first,
// stamp when the FIFO takes it, the others, one for each lane, with the register that they are named after.
module quadrille_probed (
    input logic clk_i,
    input logic rst_ni,
    input logic [quadrille_pkg::STATE_BITS-1:0] state_i,
    input logic clear_hidden_i,
    input logic flush_i,
    input logic [quadrille_pkg::VERTEX_BITS-1:0] vertex_i,
    input logic vertex_valid_i,
    output logic vertex_ready_o,
    output logic [quadrille_pkg::PIXELS_PER_CLOCK*quadrille_pkg::FRAGMENT_BITS-1:0] fragment_o,
    output logic [quadrille_pkg::PIXELS_PER_CLOCK-1:0] fragment_mask_o,
    output logic fragment_valid_o,
    input logic fragment_ready_i,
    output logic busy_o,
    input logic [quadrille_pkg::COUNTER_INDEX_BITS-1:0] counter_index_i,
    output logic [quadrille_pkg::COUNTER_BITS-1:0] counter_o,
    // Probes
    output logic probe_setup_valid_o,
    output quadrille_probes_pkg::probe_setup_t probe_setup_o,
    output logic probe_tile_valid_o,
    output quadrille_probes_pkg::probe_tile_t probe_tile_o,
    output logic probe_stamp_valid_o,
    output quadrille_probes_pkg::probe_stamp_t probe_stamp_o,
    output logic [quadrille_pkg::PIXELS_PER_CLOCK-1:0] probe_diff_valid_o,
    output quadrille_probes_pkg::probe_diff_t [quadrille_pkg::PIXELS_PER_CLOCK-1:0] probe_diff_o,
    output logic [quadrille_pkg::PIXELS_PER_CLOCK-1:0] probe_norm_valid_o,
    output quadrille_probes_pkg::probe_norm_t [quadrille_pkg::PIXELS_PER_CLOCK-1:0] probe_norm_o,
    output logic [quadrille_pkg::PIXELS_PER_CLOCK-1:0] probe_sqrt_valid_o,
    output quadrille_probes_pkg::probe_sqrt_t [quadrille_pkg::PIXELS_PER_CLOCK-1:0] probe_sqrt_o,
    output logic [quadrille_pkg::PIXELS_PER_CLOCK-1:0] probe_ratio_valid_o,
    output quadrille_probes_pkg::probe_ratio_t [quadrille_pkg::PIXELS_PER_CLOCK-1:0] probe_ratio_o,
    output logic [quadrille_pkg::PIXELS_PER_CLOCK-1:0] probe_weight_valid_o,
    output quadrille_probes_pkg::probe_weight_t [quadrille_pkg::PIXELS_PER_CLOCK-1:0] probe_weight_o,
    output logic [quadrille_pkg::PIXELS_PER_CLOCK-1:0] probe_sum_valid_o,
    output quadrille_probes_pkg::probe_sum_t [quadrille_pkg::PIXELS_PER_CLOCK-1:0] probe_sum_o
);
  quadrille u_quadrille (
      .clk_i,
      .rst_ni,
      .state_i,
      .clear_hidden_i,
      .flush_i,
      .vertex_i,
      .vertex_valid_i,
      .vertex_ready_o,
      .fragment_o,
      .fragment_mask_o,
      .fragment_valid_o,
      .fragment_ready_i,
      .busy_o,
      .counter_index_i,
      .counter_o
  );

  // ---- Setup, stamp ---------------------------------------------------------------------------------------------------------
  assign probe_setup_valid_o = u_quadrille.take;
  assign probe_setup_o = {
    u_quadrille.setup_slot,
    u_quadrille.tile_x0,
    u_quadrille.tile_y0,
    u_quadrille.tiles_x,
    u_quadrille.tiles_y,
    u_quadrille.homogeneous,
    u_quadrille.hull,
    u_quadrille.visible,
    u_quadrille.setup_lin_value,
    u_quadrille.setup_lin_gx,
    u_quadrille.setup_lin_gy,
    u_quadrille.setup_length2
  };

  assign probe_stamp_valid_o = u_quadrille.stamp_push;
  assign probe_stamp_o = u_quadrille.stamp;

  // ---- Tile: its entry of the ring and, of a homogeneous quad, the two behind ------------------------------------------------
  // Read in that clock alone, which is what a simulator has to do. An end entry's context means nothing.
  localparam int RING = quadrille_pkg::RING_LOG2;
  localparam int TC = quadrille_pkg::TC_BITS;
  localparam int VAL = quadrille_pkg::VAL_BITS;
  localparam int QVAL = quadrille_pkg::QVAL_BITS;
  localparam int QGRAD = quadrille_pkg::QGRAD_BITS;
  localparam int QCURV = quadrille_pkg::QCURV_BITS;
  localparam int CONTEXT = 2 * TC + 6 * VAL + 10 * QVAL + 20 * QGRAD + 10 * QCURV;

  logic [RING-1:0] entry_q;
  logic tile_end, tile_homogeneous;
  logic [quadrille_pkg::QUAD_SLOTS_LOG2-1:0] tile_slot;
  logic [TC-1:0] tile_x, tile_y;
  logic [6*VAL-1:0] lin_value;
  logic [10*QVAL-1:0] quad_value;
  logic [10*QGRAD-1:0] quad_gx, quad_gy;
  logic [10*QCURV-1:0] quad_q;
  logic [CONTEXT-1:0] context_bits;

  always_ff @(posedge clk_i) begin
    probe_tile_valid_o <= rst_ni && u_quadrille.u_ring.complete_i;
    entry_q <= u_quadrille.u_ring.complete_q[RING-1:0];
  end

  assign {tile_end, tile_homogeneous, tile_slot, tile_x, tile_y} = probe_tile_valid_o ? u_quadrille.u_ring.tag_q[entry_q] : '0;

  for (genvar g = 0; g < 6; g++) begin : gen_linear
    assign lin_value[g*VAL+:VAL] = probe_tile_valid_o ? u_quadrille.u_ring.gen_linear[g].value_q[entry_q] : '0;
  end

  for (genvar g = 0; g < 10; g++) begin : gen_quadratic
    localparam int LANE = (g < 6) ? g % 4 : g - 6;
    localparam logic [1:0] PART = (g >= 6) ? 2'd0 : (g >= 4) ? quadrille_pkg::PART_DIAGONALS : quadrille_pkg::PART_EDGES;
    logic there;
    logic [RING-1:0] entry;
    assign there = probe_tile_valid_o && (g >= 6 || tile_homogeneous);
    assign entry = entry_q + RING'(PART);
    assign quad_value[g*QVAL+:QVAL] = there ? u_quadrille.u_ring.gen_quadratic[LANE].value_q[entry] : '0;
    assign quad_gx[g*QGRAD+:QGRAD] = there ? u_quadrille.u_ring.gen_quadratic[LANE].gx_q[entry] : '0;
    assign quad_gy[g*QGRAD+:QGRAD] = there ? u_quadrille.u_ring.gen_quadratic[LANE].gy_q[entry] : '0;
    assign quad_q[g*QCURV+:QCURV] = there ? u_quadrille.u_ring.gen_quadratic[LANE].curv_q[entry] : '0;
  end

  assign context_bits = {tile_x, tile_y, lin_value, quad_value, quad_gx, quad_gy, quad_q};
  assign probe_tile_o = {tile_end, tile_slot, tile_end ? CONTEXT'(0) : context_bits};

  // ---- Pixels, lane by lane -------------------------------------------------------------------------------------------------
  localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2;
  localparam int CLASS = quadrille_pkg::CLASS_BITS;
  localparam int E = quadrille_pkg::EXP_BITS;
  localparam int S = quadrille_pkg::SIGNIFICAND_BITS;
  localparam int SETS = 3 + quadrille_pkg::ATTRIBUTE_SLOTS;

  for (genvar g = 0; g < quadrille_pkg::PIXELS_PER_CLOCK; g++) begin : gen_lane
    logic [SETS-1:0] sum_neg;
    logic [SETS*E-1:0] sum_exp;
    logic [SETS*S-1:0] sum_sig;

    // Numbers that the lane does not take on, and what comes of them, are shown as zeros.
    logic norm_active, distance_active, root_active, ratio_active;
    logic ratio_v_active;  // of A alone

    delay_line u_norm_active (
        .clk_i,
        .data_i(u_quadrille.u_pipeline.gen_lane[g].u_lane.norm_active_q),
        .data_o(norm_active)
    );
    delay_line u_distance_active (
        .clk_i,
        .data_i(u_quadrille.u_pipeline.gen_lane[g].u_lane.distance_active_q),
        .data_o(distance_active)
    );
    delay_line #(.DEPTH(quadrille_pkg::RATIO_STAGE - quadrille_pkg::NORM_STAGE)) u_ratio_v_active (
        .clk_i,
        .data_i(norm_active),
        .data_o(ratio_v_active)
    );
    delay_line #(.DEPTH(quadrille_pkg::ROOT_STAGE - quadrille_pkg::NORM_STAGE)) u_root_active (
        .clk_i,
        .data_i(distance_active),
        .data_o(root_active)
    );
    delay_line #(.DEPTH(quadrille_pkg::RATIO_STAGE - quadrille_pkg::ROOT_STAGE)) u_ratio_active (
        .clk_i,
        .data_i(root_active),
        .data_o(ratio_active)
    );

    assign probe_diff_valid_o[g] = u_quadrille.u_pipeline.gen_lane[g].u_lane.valid_q[quadrille_pkg::DIFF_STAGE];
    assign probe_diff_o[g] = {
      u_quadrille.u_pipeline.diff_tag.slot,
      u_quadrille.u_pipeline.diff_tag.tile_x,
      u_quadrille.u_pipeline.gen_lane[g].u_lane.diff_tag[2+:TILE_LOG2],
      u_quadrille.u_pipeline.diff_tag.y,
      u_quadrille.u_pipeline.gen_lane[g].u_lane.diff_tag[1:0],
      u_quadrille.u_pipeline.gen_lane[g].u_lane.diff_a,
      u_quadrille.u_pipeline.gen_lane[g].u_lane.diff_d,
      u_quadrille.u_pipeline.gen_lane[g].u_lane.diff_r2
    };

    assign probe_norm_valid_o[g] = u_quadrille.u_pipeline.gen_lane[g].u_lane.valid_q[quadrille_pkg::NORM_STAGE];
    assign probe_norm_o[g] = {
      u_quadrille.u_pipeline.gen_lane[g].u_lane.norm_class[CLASS-1-:quadrille_pkg::CLASS_KINDS],
      {6 + 6 * (E + S) {norm_active}} & {
        u_quadrille.u_pipeline.gen_lane[g].u_lane.norm_a_neg,
        u_quadrille.u_pipeline.gen_lane[g].u_lane.norm_a_exp,
        u_quadrille.u_pipeline.gen_lane[g].u_lane.norm_a_sig
      },
      {6 + 10 * (E + S) {distance_active}} & {
        u_quadrille.u_pipeline.gen_lane[g].u_lane.norm_d_neg,
        u_quadrille.u_pipeline.gen_lane[g].u_lane.norm_d_exp,
        u_quadrille.u_pipeline.gen_lane[g].u_lane.norm_d_sig,
        u_quadrille.u_pipeline.gen_lane[g].u_lane.norm_r2_exp,
        u_quadrille.u_pipeline.gen_lane[g].u_lane.norm_r2_sig
      }
    };

    assign probe_sqrt_valid_o[g] = u_quadrille.u_pipeline.gen_lane[g].u_lane.valid_q[quadrille_pkg::ROOT_STAGE];
    assign probe_sqrt_o[g] = {4 * (E + S) {root_active}} & {
      u_quadrille.u_pipeline.gen_lane[g].u_lane.root_exp, u_quadrille.u_pipeline.gen_lane[g].u_lane.root_sig
    };

    assign probe_ratio_valid_o[g] = u_quadrille.u_pipeline.gen_lane[g].u_lane.valid_q[quadrille_pkg::RATIO_STAGE];
    assign probe_ratio_o[g] = {
      {6 * (E + S) {ratio_active}} & {
        u_quadrille.u_pipeline.gen_lane[g].u_lane.ratio_u_exp, u_quadrille.u_pipeline.gen_lane[g].u_lane.ratio_u_sig
      },
      {6 * (E + S) {ratio_v_active}} & {
        u_quadrille.u_pipeline.gen_lane[g].u_lane.ratio_v_exp, u_quadrille.u_pipeline.gen_lane[g].u_lane.ratio_v_sig
      }
    };

    assign probe_weight_valid_o[g] = u_quadrille.u_pipeline.gen_lane[g].u_lane.valid_q[quadrille_pkg::WEIGHT_STAGE];
    assign probe_weight_o[g] = {u_quadrille.u_pipeline.gen_lane[g].u_lane.m_exp, u_quadrille.u_pipeline.gen_lane[g].u_lane.m_sig};

    assign sum_neg = u_quadrille.u_pipeline.gen_lane[g].u_lane.sum_neg;
    assign sum_exp = u_quadrille.u_pipeline.gen_lane[g].u_lane.sum_exp;
    assign sum_sig = u_quadrille.u_pipeline.gen_lane[g].u_lane.sum_sig;
    assign probe_sum_valid_o[g] = u_quadrille.u_pipeline.gen_lane[g].u_lane.valid_q[quadrille_pkg::SUM_STAGE];
    assign probe_sum_o[g] = {
      sum_neg[SETS-1:3],
      sum_exp[SETS*E-1:3*E],
      sum_sig[SETS*S-1:3*S],
      sum_neg[2],
      sum_exp[2*E+:E],
      sum_sig[2*S+:S],
      sum_neg[0],
      sum_exp[0+:E],
      sum_sig[0+:S],
      sum_neg[1],
      sum_exp[E+:E],
      sum_sig[S+:S]
    };
  end
endmodule
