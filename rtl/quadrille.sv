// SPDX-License-Identifier: Apache-2.0
`include "quadrille_assert.svh"

// Quadrille: rasterizer whose primitive is the quadrilateral, with mean value coordinates. Top level: wiring only.
//
//     vertex_assembly -> quad_setup -> tile_walk -> tile_ring -> stamp_coverage -> sync_fifo -> pixel_emit -> pixel_pipeline -> fragment_fifo
//                             \____ vertex_products ____ tile_context __/
//
// Ports: README.md; number formats and clocks: SPEC.md. Both streams are valid/ready: valid never depends on ready, payload is stable while
// valid and not ready. state_i is static while quads are under way (asserted). The pixel pipeline never waits: pixel_emit counts the
// places of the fragment FIFO. clear_hidden_i goes with a clear of the depth buffer (hierarchical_z) and is ignored while busy_o.
// flush_i, in any clock, discards the beats of a quad that is not complete, that of the same clock among them, and nothing else.
module quadrille (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
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
    // A performance counter by its index; 0 without them
    input logic [quadrille_pkg::COUNTER_INDEX_BITS-1:0] counter_index_i,
    output logic [quadrille_pkg::COUNTER_BITS-1:0] counter_o
);
  localparam int S = quadrille_pkg::SIGNIFICAND_BITS;
  localparam int PE = quadrille_pkg::PORT_EXP_BITS;
  localparam int N = quadrille_pkg::ATTRIBUTE_SLOTS;
  localparam int AP = quadrille_pkg::ATTR_PORT_BITS;
  localparam int AO = quadrille_pkg::ATTR_OUT_BITS;
  localparam int DB = quadrille_pkg::DEPTH_BITS;
  localparam int LIMITS = quadrille_pkg::DEPTH_LIMIT_BITS;
  localparam int TERMS = quadrille_pkg::BLEND_TERMS;
  localparam int ID = quadrille_pkg::QUAD_ID_BITS;
  localparam int V = quadrille_pkg::VIEWPORT_BITS;
  localparam int T = quadrille_pkg::T_BITS;
  localparam int W = quadrille_pkg::W_BITS;
  localparam int TC = quadrille_pkg::TC_BITS;
  localparam int VAL = quadrille_pkg::VAL_BITS;
  localparam int GRAD = quadrille_pkg::GRAD_BITS;
  localparam int REACH = quadrille_pkg::REACH_BITS;
  localparam int QVAL = quadrille_pkg::QVAL_BITS;
  localparam int QGRAD = quadrille_pkg::QGRAD_BITS;
  localparam int QCURV = quadrille_pkg::QCURV_BITS;
  localparam int RISE = quadrille_pkg::RISE_BITS;
  localparam int LENGTH2 = quadrille_pkg::LENGTH2_BITS;
  localparam int OUT = quadrille_pkg::DOT_OUT_BITS;
  localparam int SLOT = quadrille_pkg::QUAD_SLOTS_LOG2;
  localparam int RING = quadrille_pkg::RING_LOG2;
  localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2;
  localparam int TILE = quadrille_pkg::TILE;
  localparam int SETS = 3 + N;
  localparam int H = quadrille_pkg::DEPTH_CODE_BITS;

  quadrille_config_check u_config_check ();

  // ---- Draw state ---------------------------------------------------------------------------------------------------------
  typedef struct packed {
    logic [V:0] scissor_x0;
    logic [V:0] scissor_y0;
    logic [V:0] scissor_x1;
    logic [V:0] scissor_y1;
    logic [1:0] cull;
    logic perspective;
    logic depth;
    logic [DB:0] znear;
    logic [DB:0] zfar;
    logic [3:0] attributes;
    logic [7:0] skip;
  } state_t;

  state_t state;
  logic depth_on, unused_skip;

  assign state = state_i;
  assign depth_on = state.depth;
  assign unused_skip = ^state.skip[7:6];

  // ---- For performance_counters: 0 without them -----------------------------------------------------------------------------
  logic count_line, count_setup_job, count_setup, count_block, count_enter, count_block_hidden, count_tile, count_hidden, count_walk;
  logic count_masked, count_row, count_rows, count_rows_behind, count_head_waits;
  logic [quadrille_pkg::PIXELS_PER_CLOCK*quadrille_pkg::LATENCY-1:0] lane_valid;
  logic [quadrille_pkg::PIXELS_PER_CLOCK-1:0] count_norm, count_area;
  logic [SETS-1:0] count_sum;

  // ---- Vertices -----------------------------------------------------------------------------------------------------------
  logic start, full, assembly_busy;
  logic drop_vertices, empty, behind, outside_depth;
  logic [ID-1:0] quad_id;
  logic [4*T-1:0] quad_x, quad_y;
  logic [4*W-1:0] quad_w;
  logic quad_ordinary;
  logic [3:0] quad_w_neg;
  logic [4*PE-1:0] quad_w_exp;
  logic [4*S-1:0] quad_w_sig;
  logic [T-1:0] quad_low_x, quad_high_x, quad_low_y, quad_high_y;
  logic [4*PE-1:0] quad_k_exp, quad_z_exp;
  logic [4*S-1:0] quad_k_sig, quad_z_sig;
  logic [3:0] quad_z_neg;
  logic [3*N*AP-1:0] quad_attr;
  logic [N*AO-1:0] quad_base_attr;
  logic [DB:0] quad_base_depth;
  logic [LIMITS-1:0] quad_depth_limits;

  logic assembly_ready, depths_ready;  // hierarchical_z is not wiping
  logic [H-1:0] quad_near, quad_far;
  logic quad_lowers;

  assign vertex_ready_o = assembly_ready && depths_ready;

  quadrille_vertex_assembly u_assembly (
      .clk_i,
      .rst_ni,
      .vertex_i,
      .vertex_valid_i(vertex_valid_i && depths_ready),
      .vertex_ready_o(assembly_ready),
      .flush_i,
      .start_i(start),
      .drop_i(drop_vertices),
      .depth_on_i(depth_on),
      .znear_i(state.znear),
      .zfar_i(state.zfar),
      .scissor_x0_i(state.scissor_x0),
      .scissor_y0_i(state.scissor_y0),
      .scissor_x1_i(state.scissor_x1),
      .scissor_y1_i(state.scissor_y1),
      .empty_o(empty),
      .behind_o(behind),
      .depth_o(outside_depth),
      .near_o(quad_near),
      .far_o(quad_far),
      .lowers_o(quad_lowers),
      .full_o(full),
      .busy_o(assembly_busy),
      .id_o(quad_id),
      .x_o(quad_x),
      .y_o(quad_y),
      .w_o(quad_w),
      .w_neg_o(quad_w_neg),
      .w_exp_o(quad_w_exp),
      .w_sig_o(quad_w_sig),
      .ordinary_o(quad_ordinary),
      .low_x_o(quad_low_x),
      .high_x_o(quad_high_x),
      .low_y_o(quad_low_y),
      .high_y_o(quad_high_y),
      .k_exp_o(quad_k_exp),
      .k_sig_o(quad_k_sig),
      .z_neg_o(quad_z_neg),
      .z_exp_o(quad_z_exp),
      .z_sig_o(quad_z_sig),
      .attr_o(quad_attr),
      .base_attr_o(quad_base_attr),
      .base_depth_o(quad_base_depth),
      .depth_limits_o(quad_depth_limits)
  );

  // ---- Setup, and the multipliers that it shares with the tiles -----------------------------------------------------------
  logic context_job;
  localparam int PAIRS = quadrille_pkg::PRODUCT_PAIRS;
  localparam int BUSES = quadrille_pkg::CONTEXT_BUSES;
  logic [PAIRS*3-1:0] setup_kind, context_kind;
  logic [PAIRS*4-1:0] setup_function, context_function;
  logic [4*T-1:0] setup_job_x, setup_job_y, context_x, context_y;
  logic [4*W-1:0] setup_job_w, context_w;
  logic [V:0] offset_x, offset_y, setup_offset_x, setup_offset_y;
  logic [PAIRS*VAL-1:0] edge_value;
  logic [PAIRS*GRAD-1:0] edge_gx, edge_gy;
  logic [PAIRS*T-1:0] xi, yi, xj, yj;
  logic [PAIRS*RISE-1:0] apart_x, apart_y;
  logic [PAIRS*OUT-1:0] result0, result1;
  logic setup_ready, setup_done, take, drop;
  logic slot_available, slots_busy, fragments_busy, slot_release, stamp_load;
  logic [SLOT-1:0] alloc_slot, setup_slot, drop_slot;
  logic [TC-1:0] tile_x0, tile_y0, tiles_x, tiles_y;
  logic [TILE_LOG2-1:0] setup_last_row;
  logic homogeneous, hull;
  logic [3:0] visible;
  logic [6*VAL-1:0] setup_lin_value;
  logic [6*GRAD-1:0] setup_lin_gx, setup_lin_gy;
  logic [4:0] setup_tie_pos, setup_tie_neg;
  logic [5*REACH-1:0] setup_fall_tile, setup_rise_tile, setup_fall_block, setup_rise_block;
  logic [6*LENGTH2-1:0] setup_length2;
  logic [4*T-1:0] setup_x, setup_y;
  logic [4*W-1:0] setup_w;

  assign drop_vertices = full && state.skip[1] && (empty || behind || outside_depth);
  assign start = full && !drop_vertices && setup_ready && slot_available;
  assign busy_o = assembly_busy || slots_busy || fragments_busy || !depths_ready;

  quadrille_quad_setup u_setup (
      .clk_i,
      .rst_ni,
      .held_i(full && !drop_vertices),
      .start_i(start),
      .ready_o(setup_ready),
      .empty_i(empty),
      .slot_i(alloc_slot),
      .x_i(quad_x),
      .y_i(quad_y),
      .w_i(quad_w),
      .ordinary_i(quad_ordinary),
      .low_x_i(quad_low_x),
      .high_x_i(quad_high_x),
      .low_y_i(quad_low_y),
      .high_y_i(quad_high_y),
      .scissor_x0_i(state.scissor_x0),
      .scissor_y0_i(state.scissor_y0),
      .scissor_x1_i(state.scissor_x1),
      .scissor_y1_i(state.scissor_y1),
      .wait_i(context_job),
      .kind_o(setup_kind),
      .function_o(setup_function),
      .x_o(setup_job_x),
      .y_o(setup_job_y),
      .w_o(setup_job_w),
      .offset_x_o(setup_offset_x),
      .offset_y_o(setup_offset_y),
      .edge_value_o(edge_value),
      .edge_gx_o(edge_gx),
      .edge_gy_o(edge_gy),
      .apart_x_i(apart_x),
      .apart_y_i(apart_y),
      .result0_i(result0),
      .result1_i(result1),
      .reject_i(state.skip[1]),
      .separate_i(state.skip[3]),
      .cull_i(state.cull),
      .take_i(take),
      .done_o(setup_done),
      .drop_o(drop),
      .drop_slot_o(drop_slot),
      .count_line_o(count_line),
      .count_job_o(count_setup_job),
      .count_busy_o(count_setup),
      .slot_o(setup_slot),
      .tile_x0_o(tile_x0),
      .tile_y0_o(tile_y0),
      .tiles_x_o(tiles_x),
      .tiles_y_o(tiles_y),
      .last_row_o(setup_last_row),
      .homogeneous_o(homogeneous),
      .hull_o(hull),
      .visible_o(visible),
      .lin_value_o(setup_lin_value),
      .lin_gx_o(setup_lin_gx),
      .lin_gy_o(setup_lin_gy),
      .tie_pos_o(setup_tie_pos),
      .tie_neg_o(setup_tie_neg),
      .fall_tile_o(setup_fall_tile),
      .rise_tile_o(setup_rise_tile),
      .fall_block_o(setup_fall_block),
      .rise_block_o(setup_rise_block),
      .length2_o(setup_length2),
      .vertex_x_o(setup_x),
      .vertex_y_o(setup_y),
      .vertex_w_o(setup_w)
  );

  quadrille_vertex_products u_products (
      .clk_i,
      .tile_valid_i(context_job),
      .tile_kind_i(context_kind),
      .tile_function_i(context_function),
      .tile_x_i(context_x),
      .tile_y_i(context_y),
      .tile_w_i(context_w),
      .offset_x_i(offset_x),
      .offset_y_i(offset_y),
      .setup_kind_i(setup_kind),
      .setup_function_i(setup_function),
      .setup_x_i(setup_job_x),
      .setup_y_i(setup_job_y),
      .setup_w_i(setup_job_w),
      .setup_offset_x_i(setup_offset_x),
      .setup_offset_y_i(setup_offset_y),
      .edge_value_i(edge_value),
      .edge_gx_i(edge_gx),
      .edge_gy_i(edge_gy),
      .xi_o(xi),
      .yi_o(yi),
      .xj_o(xj),
      .yj_o(yj),
      .apart_x_o(apart_x),
      .apart_y_o(apart_y),
      .result0_o(result0),
      .result1_o(result1)
  );

  // ---- Quad slots ---------------------------------------------------------------------------------------------------------
  logic [SLOT-1:0] stamp_slot, tag_slot, emit_slot, product_slot, override_slot, blend_slot, base_slot, output_slot;
  logic [5*GRAD-1:0] stamp_gx, stamp_gy;
  logic [4:0] stamp_tie_pos, stamp_tie_neg;
  logic [3:0] stamp_visible;
  logic [6*GRAD-1:0] emit_gx, emit_gy;
  logic [SLOT-1:0] length2_slot;
  logic [6*LENGTH2-1:0] length2;
  logic quad_plane, norm_plane;
  logic [SLOT-1:0] norm_slot;
  logic [3:0] product_k_neg;
  logic [4*PE-1:0] product_k_exp, override_k_exp;
  logic [4*S-1:0] product_k_sig, override_k_sig;
  logic [TERMS-1:0] blend_neg;
  logic [TERMS*PE-1:0] blend_exp;
  logic [TERMS*S-1:0] blend_sig;
  logic blend_hull;
  logic [N*AO-1:0] base_attr;
  logic [DB:0] base_depth;
  logic [LIMITS-1:0] base_limits;
  logic [ID-1:0] output_id;
  logic output_hull, output_homogeneous;

  if (quadrille_pkg::PLANE_QUADS != 0) begin : gen_plane
    quadrille_plane_quad u_plane (
        .clk_i,
        .on_i(state.skip[5]),
        .perspective_i(state.perspective),
        .depth_on_i(depth_on),
        .attributes_i(state.attributes),
        .ordinary_i(quad_ordinary),
        .x_i(quad_x),
        .y_i(quad_y),
        .k_exp_i(quad_k_exp),
        .k_sig_i(quad_k_sig),
        .z_neg_i(quad_z_neg),
        .z_exp_i(quad_z_exp),
        .z_sig_i(quad_z_sig),
        .attr_i(quad_attr),
        .plane_o(quad_plane)
    );
  end else begin : gen_no_plane
    logic unused_plane;
    assign unused_plane = state.skip[5];
    assign quad_plane = 1'b0;
  end

  quadrille_quad_slots u_slots (
      .clk_i,
      .rst_ni,
      .start_i(start),
      .release_i(slot_release),
      .drop_i(drop),
      .drop_slot_i(drop_slot),
      .alloc_o(alloc_slot),
      .available_o(slot_available),
      .busy_o(slots_busy),
      .perspective_i(state.perspective),
      .plane_i(quad_plane),
      .id_i(quad_id),
      .w_neg_i(quad_w_neg),
      .w_exp_i(quad_w_exp),
      .w_sig_i(quad_w_sig),
      .k_exp_i(quad_k_exp),
      .k_sig_i(quad_k_sig),
      .z_neg_i(quad_z_neg),
      .z_exp_i(quad_z_exp),
      .z_sig_i(quad_z_sig),
      .attr_i(quad_attr),
      .base_attr_i(quad_base_attr),
      .base_depth_i(quad_base_depth),
      .depth_limits_i(quad_depth_limits),
      .take_i(take),
      .take_slot_i(setup_slot),
      .lin_gx_i(setup_lin_gx),
      .lin_gy_i(setup_lin_gy),
      .length2_i(setup_length2),
      .tie_pos_i(setup_tie_pos),
      .tie_neg_i(setup_tie_neg),
      .visible_i(visible),
      .hull_i(hull),
      .homogeneous_i(homogeneous),
      .stamp_load_i(stamp_load),
      .stamp_slot_i(stamp_slot),
      .stamp_gx_o(stamp_gx),
      .stamp_gy_o(stamp_gy),
      .stamp_tie_pos_o(stamp_tie_pos),
      .stamp_tie_neg_o(stamp_tie_neg),
      .stamp_visible_o(stamp_visible),
      .emit_slot_i(tag_slot),
      .emit_gx_o(emit_gx),
      .emit_gy_o(emit_gy),
      .length2_slot_i(length2_slot),
      .length2_o(length2),
      .norm_slot_i(norm_slot),
      .norm_plane_o(norm_plane),
      .product_slot_i(product_slot),
      .product_k_neg_o(product_k_neg),
      .product_k_exp_o(product_k_exp),
      .product_k_sig_o(product_k_sig),
      .override_slot_i(override_slot),
      .override_k_exp_o(override_k_exp),
      .override_k_sig_o(override_k_sig),
      .blend_slot_i(blend_slot),
      .blend_neg_o(blend_neg),
      .blend_exp_o(blend_exp),
      .blend_sig_o(blend_sig),
      .blend_hull_o(blend_hull),
      .base_slot_i(base_slot),
      .base_attr_o(base_attr),
      .base_depth_o(base_depth),
      .base_limits_o(base_limits),
      .output_slot_i(output_slot),
      .output_id_o(output_id),
      .output_hull_o(output_hull),
      .output_homogeneous_o(output_homogeneous)
  );

  // ---- Walk ---------------------------------------------------------------------------------------------------------------
  logic ring_full, context_ready, tile_push, tile_end, tile_homogeneous;
  logic [SLOT-1:0] tile_slot;
  logic [TC-1:0] tile_x, tile_y, tile_column, tile_row;
  logic [TILE_LOG2-1:0] tile_last_row;
  logic [6*VAL-1:0] tile_lin_value;
  logic walk_go, tile_tested, tile_covered, tile_hidden, block_test, block_hidden;
  logic [TC-1:0] test_column, test_row, block_column, block_row;
  logic [quadrille_pkg::BLOCK_LOG2-1:0] block_last_column, block_last_row;

  quadrille_tile_walk u_walk (
      .clk_i,
      .rst_ni,
      .cull_i(state.cull),
      .reject_tiles_i(state.skip[0]),
      .bound_i(state.skip[3]),
      .scissor_x0_i(state.scissor_x0),
      .scissor_y0_i(state.scissor_y0),
      .setup_done_i(setup_done),
      .take_o(take),
      .slot_i(setup_slot),
      .tile_x0_i(tile_x0),
      .tile_y0_i(tile_y0),
      .tiles_x_i(tiles_x),
      .tiles_y_i(tiles_y),
      .last_row_i(setup_last_row),
      .homogeneous_i(homogeneous),
      .visible_i(visible),
      .lin_value_i(setup_lin_value),
      .lin_gx_i(setup_lin_gx),
      .lin_gy_i(setup_lin_gy),
      .fall_tile_i(setup_fall_tile),
      .rise_tile_i(setup_rise_tile),
      .fall_block_i(setup_fall_block),
      .rise_block_i(setup_rise_block),
      .ready_i(context_ready && !ring_full),
      .push_o(tile_push),
      .count_block_o(count_block),
      .count_enter_o(count_enter),
      .count_block_hidden_o(count_block_hidden),
      .count_tile_o(count_tile),
      .count_hidden_o(count_hidden),
      .count_busy_o(count_walk),
      .end_o(tile_end),
      .slot_o(tile_slot),
      .tile_x_o(tile_x),
      .tile_y_o(tile_y),
      .column_o(tile_column),
      .row_o(tile_row),
      .last_row_o(tile_last_row),
      .lin_value_o(tile_lin_value),
      .go_o(walk_go),
      .test_column_o(test_column),
      .test_row_o(test_row),
      .block_test_o(block_test),
      .block_column_o(block_column),
      .block_row_o(block_row),
      .block_last_column_o(block_last_column),
      .block_last_row_o(block_last_row),
      .tested_o(tile_tested),
      .covered_o(tile_covered),
      .hidden_i(tile_hidden),
      .block_hidden_i(block_hidden)
  );

  // ---- Hidden tiles -------------------------------------------------------------------------------------------------------
  logic [quadrille_pkg::HIERARCHICAL_Z_TILES_LOG2-1:0] wipe_place;
  logic [quadrille_pkg::HIDDEN_EPOCH_BITS-1:0] epoch;

  if (quadrille_pkg::HIERARCHICAL_Z_BITS != 0) begin : gen_hidden
    quadrille_hierarchical_z u_hidden (
        .clk_i,
        .rst_ni,
        .clear_i(clear_hidden_i && !busy_o),
        .ready_o(depths_ready),
        .wipe_place_o(wipe_place),
        .epoch_o(epoch),
        .on_i(depth_on && state.skip[2]),
        .scissor_x0_i(state.scissor_x0),
        .scissor_y0_i(state.scissor_y0),
        .scissor_x1_i(state.scissor_x1),
        .scissor_y1_i(state.scissor_y1),
        .start_i(start),
        .start_slot_i(alloc_slot),
        .near_i(quad_near),
        .far_i(quad_far),
        .lowers_i(quad_lowers),
        .take_i(take),
        .take_slot_i(setup_slot),
        .tile_x0_i(tile_x0),
        .tile_y0_i(tile_y0),
        .go_i(walk_go),
        .column_i(test_column),
        .row_i(test_row),
        .block_test_i(block_test),
        .block_column_i(block_column),
        .block_row_i(block_row),
        .block_last_column_i(block_last_column),
        .block_last_row_i(block_last_row),
        .tested_i(tile_tested),
        .covered_i(tile_covered),
        .hidden_o(tile_hidden),
        .block_hidden_o(block_hidden)
    );
  end else begin : gen_nothing_hidden
    logic unused_hidden;
    assign {wipe_place, epoch} = '0;
    assign unused_hidden = ^{wipe_place, epoch, clear_hidden_i, state.skip[2], quad_near, quad_far, quad_lowers, walk_go, test_column, test_row, block_test, block_column, block_row,
        block_last_column, block_last_row, tile_tested, tile_covered};
    assign depths_ready = 1'b1;
    assign {tile_hidden, block_hidden} = '0;
  end

  // ---- Quadratic functions of a tile --------------------------------------------------------------------------------------
  logic [RING-1:0] tile_entry, value_entry, gradient_entry, q_entry;
  logic [3:0] value_write, gradient_write, q_write;
  logic [BUSES*QVAL-1:0] word_value;
  logic [BUSES*QGRAD-1:0] word_gx, word_gy;
  logic [PAIRS*QCURV-1:0] word_q;
  logic complete, complete_homogeneous;

  quadrille_tile_context u_context (
      .clk_i,
      .rst_ni,
      .take_i(take),
      .homogeneous_i(homogeneous),
      .x_i(setup_x),
      .y_i(setup_y),
      .w_i(setup_w),
      .homogeneous_o(tile_homogeneous),
      .push_i(tile_push),
      .ready_o(context_ready),
      .end_i(tile_end),
      .column_i(tile_column),
      .row_i(tile_row),
      .entry_i(tile_entry),
      .job_valid_o(context_job),
      .kind_o(context_kind),
      .function_o(context_function),
      .x_o(context_x),
      .y_o(context_y),
      .w_o(context_w),
      .offset_x_o(offset_x),
      .offset_y_o(offset_y),
      .xi_i(xi),
      .yi_i(yi),
      .xj_i(xj),
      .yj_i(yj),
      .result0_i(result0),
      .result1_i(result1),
      .value_write_o(value_write),
      .value_entry_o(value_entry),
      .value_o(word_value),
      .gradient_write_o(gradient_write),
      .gradient_entry_o(gradient_entry),
      .gx_o(word_gx),
      .gy_o(word_gy),
      .q_write_o(q_write),
      .q_entry_o(q_entry),
      .q_o(word_q),
      .complete_o(complete),
      .complete_homogeneous_o(complete_homogeneous)
  );

  // ---- Tile ring ----------------------------------------------------------------------------------------------------------
  logic [RING:0] fetch_ptr, load_ptr, stamp_ptr, head_ptr, emit_ptr;
  logic stamp_present, stamp_end, stamp_homogeneous, stamps_empty, head_valid, fetch, fetch_homogeneous;
  logic emit_end;
  logic [1:0] emit_part;
  logic [TC-1:0] stamp_tile_x, stamp_tile_y, emit_tile_x, emit_tile_y;
  logic [TILE_LOG2-1:0] stamp_last_row;
  logic [5*VAL-1:0] stamp_lin_value;
  logic [6*VAL-1:0] emit_lin_value;
  logic [4*QVAL-1:0] emit_quad_value;
  logic [4*QGRAD-1:0] emit_quad_gx, emit_quad_gy;
  logic [4*QCURV-1:0] emit_quad_q;

  quadrille_tile_ring u_ring (
      .clk_i,
      .rst_ni,
      .push_i(tile_push),
      .full_o(ring_full),
      .entry_o(tile_entry),
      .end_i(tile_end),
      .homogeneous_i(tile_homogeneous),
      .slot_i(tile_slot),
      .tile_x_i(tile_x),
      .tile_y_i(tile_y),
      .last_row_i(tile_last_row),
      .lin_value_i(tile_lin_value),
      .value_write_i(value_write),
      .value_entry_i(value_entry),
      .value_i(word_value),
      .gradient_write_i(gradient_write),
      .gradient_entry_i(gradient_entry),
      .gx_i(word_gx),
      .gy_i(word_gy),
      .q_write_i(q_write),
      .q_entry_i(q_entry),
      .q_i(word_q),
      .complete_i(complete),
      .complete_homogeneous_i(complete_homogeneous),
      .fetch_i(fetch),
      .fetch_ptr_i(fetch_ptr),
      .stamp_present_o(stamp_present),
      .fetch_homogeneous_o(fetch_homogeneous),
      .stamp_end_o(stamp_end),
      .stamp_homogeneous_o(stamp_homogeneous),
      .stamp_slot_o(stamp_slot),
      .stamp_tile_x_o(stamp_tile_x),
      .stamp_tile_y_o(stamp_tile_y),
      .stamp_last_row_o(stamp_last_row),
      .load_i(stamp_load),
      .load_ptr_i(load_ptr),
      .stamp_lin_value_o(stamp_lin_value),
      .stamp_ptr_i(stamp_ptr),
      .stamps_empty_i(stamps_empty),
      .head_valid_i(head_valid),
      .head_ptr_i(head_ptr),
      .emit_valid_i(emit_valid != '0),
      .emit_ptr_i(emit_ptr),
      .emit_part_i(emit_part),
      .tag_slot_o(tag_slot),
      .emit_slot_o(emit_slot),
      .emit_tile_x_o(emit_tile_x),
      .emit_tile_y_o(emit_tile_y),
      .emit_lin_value_o(emit_lin_value),
      .emit_quad_value_o(emit_quad_value),
      .emit_quad_gx_o(emit_quad_gx),
      .emit_quad_gy_o(emit_quad_gy),
      .emit_quad_q_o(emit_quad_q)
  );

  // ---- Coverage and its FIFO ----------------------------------------------------------------------------------------------
  localparam int STAMP = 1 + RING + 1 + TILE_LOG2 + 3 * TILE;  // {end, tile pointer, row, mask, front, tie}
  logic stamp_push, stamp_push_end, pop;
  logic [TILE_LOG2-1:0] stamp_row, head_row;
  logic [TILE-1:0] stamp_mask, stamp_front, stamp_tie;
  logic [TILE-1:0] head_mask, head_front, head_tie;
  logic head_end, stamp_push_homogeneous, head_homogeneous;
  logic [STAMP-1:0] stamp;
  logic coverage_wait, tile_masked, rows_load, row_issue, rows_done;
  logic [TILE_LOG2-1:0] issue_row;
  logic [TILE-1:0] row_covered, row_seen;

  quadrille_stamp_coverage u_coverage (
      .clk_i,
      .rst_ni,
      .cull_i(state.cull),
      .scissor_x0_i(state.scissor_x0),
      .scissor_y0_i(state.scissor_y0),
      .scissor_x1_i(state.scissor_x1),
      .scissor_y1_i(state.scissor_y1),
      .present_i(stamp_present),
      .fetch_o(fetch),
      .fetch_ptr_o(fetch_ptr),
      .fetch_homogeneous_i(fetch_homogeneous),
      .end_i(stamp_end),
      .homogeneous_i(stamp_homogeneous),
      .tile_x_i(stamp_tile_x),
      .tile_y_i(stamp_tile_y),
      .last_row_i(stamp_last_row),
      .load_o(stamp_load),
      .load_ptr_o(load_ptr),
      .lin_value_i(stamp_lin_value),
      .lin_gx_i(stamp_gx),
      .lin_gy_i(stamp_gy),
      .tie_pos_i(stamp_tie_pos),
      .tie_neg_i(stamp_tie_neg),
      .visible_i(stamp_visible),
      .wait_i(coverage_wait),
      .hidden_i(tile_masked),
      .rows_load_o(rows_load),
      .issue_o(row_issue),
      .rows_done_o(rows_done),
      .issue_row_o(issue_row),
      .covered_o(row_covered),
      .seen_i(row_seen),
      .freed_i(pop),
      .push_o(stamp_push),
      .count_masked_o(count_masked),
      .count_row_o(count_row),
      .count_busy_o(count_rows),
      .count_behind_o(count_rows_behind),
      .end_o(stamp_push_end),
      .homogeneous_o(stamp_push_homogeneous),
      .stamp_ptr_o(stamp_ptr),
      .row_o(stamp_row),
      .mask_o(stamp_mask),
      .front_o(stamp_front),
      .tie_o(stamp_tie)
  );

  if (quadrille_pkg::HIERARCHICAL_Z_BITS != 0) begin : gen_masked
    quadrille_masked_depth u_masked (
        .clk_i,
        .rst_ni,
        .wipe_i(!depths_ready),
        .wipe_place_i(wipe_place),
        .epoch_i(epoch),
        .on_i(depth_on && state.skip[2]),
        .start_i(start),
        .start_slot_i(alloc_slot),
        .near_i(quad_near),
        .far_i(quad_far),
        .lowers_i(quad_lowers),
        .end_i(stamp_end),
        .slot_i(stamp_slot),
        .tile_x_i(stamp_tile_x),
        .tile_y_i(stamp_tile_y),
        .last_row_i(stamp_last_row),
        .wait_o(coverage_wait),
        .load_i(stamp_load),
        .rows_load_i(rows_load),
        .hidden_o(tile_masked),
        .issue_i(row_issue),
        .done_i(rows_done),
        .row_i(issue_row),
        .covered_i(row_covered),
        .seen_o(row_seen)
    );
  end else begin : gen_nothing_masked
    logic unused_masked;
    assign unused_masked = ^{rows_load, row_issue, rows_done, issue_row, row_covered};
    assign {coverage_wait, tile_masked} = '0;
    assign row_seen = '1;
  end

  assign stamp = {stamp_push_end, stamp_ptr, stamp_row, stamp_mask, stamp_front, stamp_tie};

  quadrille_sync_fifo #(
      .WIDTH(1 + STAMP),
      .DEPTH(quadrille_pkg::STAMP_PLACES)
  ) u_fifo (
      .clk_i,
      .rst_ni,
      .push_i(stamp_push),
      .data_i({stamp_push_homogeneous, stamp}),
      .pop_i(pop),
      .empty_o(stamps_empty),
      .valid_o(head_valid),
      .data_o({head_homogeneous, head_end, head_ptr, head_row, head_mask, head_front, head_tie})
  );

  // ---- Pixels -------------------------------------------------------------------------------------------------------------
  localparam int P = quadrille_pkg::PIXELS_PER_CLOCK;
  localparam int PIXEL = TILE_LOG2 + 3;  // {dx, valid, front, tie}
  localparam int OFFSET_DIGITS = TILE_LOG2 / 2 + 1;
  localparam int PIXELS = 1 + 2 + TILE_LOG2 + 2 * OFFSET_DIGITS + P * PIXEL;  // {end, part, row, its digits} and the pixels of the lanes
  logic freed, discard;
  logic [P-1:0] emit_valid, emit_front, emit_tie;
  logic [P*TILE_LOG2-1:0] emit_dx;
  logic [TILE_LOG2-1:0] emit_row;
  logic [2*OFFSET_DIGITS-1:0] emit_row_digits;
  logic [P-1:0] pixel_valid, pixel_front, pixel_tie, drawn;
  logic [P*TILE_LOG2-1:0] pixel_dx;
  logic [TILE_LOG2-1:0] pixel_row;
  logic [2*OFFSET_DIGITS-1:0] pixel_row_digits;
  logic pixel_end;
  logic [1:0] pixel_part;
  logic [P*quadrille_pkg::FRAGMENT_BITS-1:0] fragment;

  quadrille_pixel_emit u_emit (
      .clk_i,
      .rst_ni,
      .head_valid_i(head_valid),
      .head_end_i(head_end),
      .head_homogeneous_i(head_homogeneous),
      .head_ptr_i(head_ptr),
      .head_row_i(head_row),
      .head_mask_i(head_mask),
      .head_front_i(head_front),
      .head_tie_i(head_tie),
      .pop_o(pop),
      .count_wait_o(count_head_waits),
      .freed_i(freed),
      .discard_i(discard),
      .end_o(emit_end),
      .part_o(emit_part),
      .ptr_o(emit_ptr),
      .row_o(emit_row),
      .row_digits_o(emit_row_digits),
      .valid_o(emit_valid),
      .dx_o(emit_dx),
      .front_o(emit_front),
      .tie_o(emit_tie)
  );

  // Pixels wait for what ring and slots have of their tile and quad.
  logic [2*PIXELS-1:0] pixels_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) pixels_q <= '0;
    else
      pixels_q <= {
        pixels_q[PIXELS-1:0],
        emit_end,
        emit_part,
        emit_row,
        emit_row_digits,
        emit_dx,
        emit_valid,
        emit_front,
        emit_tie
      };
  end

  assign {
    pixel_end,
    pixel_part,
    pixel_row,
    pixel_row_digits,
    pixel_dx,
    pixel_valid,
    pixel_front,
    pixel_tie
  } = pixels_q[2*PIXELS-1:PIXELS];

  quadrille_pixel_pipeline u_pipeline (
      .clk_i,
      .rst_ni,
      .hold_i(state.skip[4]),
      .depth_on_i(depth_on),
      .attributes_i(state.attributes),
      .end_i(pixel_end),
      .part_i(pixel_part),
      .slot_i(emit_slot),
      .tile_x_i((V - TILE_LOG2)'({emit_tile_x})),
      .y_i(V'({emit_tile_y, pixel_row})),
      .row_digits_i(pixel_row_digits),
      .lin_value_i(emit_lin_value),
      .lin_gx_i(emit_gx),
      .lin_gy_i(emit_gy),
      .quad_value_i(emit_quad_value),
      .quad_gx_i(emit_quad_gx),
      .quad_gy_i(emit_quad_gy),
      .quad_q_i(emit_quad_q),
      .valid_i(pixel_valid),
      .dx_i(pixel_dx),
      .front_i(pixel_front),
      .tie_i(pixel_tie),
      .length2_slot_o(length2_slot),
      .length2_i(length2),
      .norm_slot_o(norm_slot),
      .norm_plane_i(norm_plane),
      .product_slot_o(product_slot),
      .product_k_neg_i(product_k_neg),
      .product_k_exp_i(product_k_exp),
      .product_k_sig_i(product_k_sig),
      .override_slot_o(override_slot),
      .override_k_exp_i(override_k_exp),
      .override_k_sig_i(override_k_sig),
      .blend_slot_o(blend_slot),
      .blend_neg_i(blend_neg),
      .blend_exp_i(blend_exp),
      .blend_sig_i(blend_sig),
      .blend_hull_i(blend_hull),
      .base_slot_o(base_slot),
      .base_attr_i(base_attr),
      .base_depth_i(base_depth),
      .base_limits_i(base_limits),
      .output_slot_o(output_slot),
      .output_id_i(output_id),
      .output_hull_i(output_hull),
      .output_homogeneous_i(output_homogeneous),
      .release_o(slot_release),
      .discard_o(discard),
      .lane_valid_o(lane_valid),
      .count_norm_o(count_norm),
      .count_area_o(count_area),
      .count_sum_o(count_sum),
      .fragment_valid_o(drawn),
      .fragment_o(fragment)
  );

  // ---- Fragments ----------------------------------------------------------------------------------------------------------
  quadrille_fragment_fifo u_fragments (
      .clk_i,
      .rst_ni,
      .push_i(drawn),
      .data_i(fragment),
      .busy_o(fragments_busy),
      .freed_o(freed),
      .valid_o(fragment_valid_o),
      .ready_i(fragment_ready_i),
      .mask_o(fragment_mask_o),
      .data_o(fragment_o)
  );

  // ---- Performance counters -------------------------------------------------------------------------------------------------
  if (quadrille_pkg::PERFORMANCE_COUNTERS != 0) begin : gen_counters
    quadrille_performance_counters u_counters (
        .clk_i,
        .rst_ni,
        .index_i(counter_index_i),
        .value_o(counter_o),
        .start_i(start),
        .plane_i(quad_plane),
        .drop_vertices_i(drop_vertices),
        .empty_i(empty),
        .behind_i(behind),
        .drop_i(drop),
        .drop_line_i(count_line),
        .take_i(take),
        .homogeneous_i(homogeneous),
        .block_test_i(count_block),
        .block_enter_i(count_enter),
        .block_hidden_i(count_block_hidden),
        .tile_test_i(count_tile),
        .tile_push_i(tile_push && !tile_end),
        .tile_hidden_i(count_hidden),
        .tile_masked_i(count_masked),
        .row_i(count_row),
        .stamp_push_i(stamp_push && !stamp_push_end),
        .lane_valid_i(lane_valid),
        .drawn_i(drawn),
        .norm_active_i(count_norm),
        .area_i(count_area),
        .norm_plane_i(norm_plane),
        .sum_active_i(count_sum),
        .context_job_i(context_job),
        .setup_job_i(count_setup_job),
        .head_i(head_valid),
        .head_waits_i(count_head_waits),
        .rows_i(count_rows),
        .rows_behind_i(count_rows_behind),
        .walk_i(count_walk),
        .walk_behind_i(setup_done && !take),
        .setup_i(count_setup),
        .setup_behind_i(full && !start && !drop_vertices),
        .assembly_i(assembly_busy),
        .wipe_i(!depths_ready),
        .busy_i(busy_o)
    );
  end else begin : gen_no_counters
    logic unused_counters;
    assign counter_o = '0;
    assign unused_counters = ^{
      counter_index_i,
      count_line,
      count_setup_job,
      count_setup,
      count_block,
      count_enter,
      count_block_hidden,
      count_tile,
      count_hidden,
      count_walk,
      count_masked,
      count_row,
      count_rows,
      count_rows_behind,
      count_head_waits,
      count_norm,
      count_area,
      count_sum,
      lane_valid
    };
  end

`ifndef SYNTHESIS
  localparam int LATENCY = quadrille_pkg::LATENCY;
  localparam int LENGTH2_READ = quadrille_pkg::FORWARD_DIFFERENCE_STAGES - 2;  // a read of quad_slots goes with the pixel in this register
  localparam int BLEND_READ = quadrille_pkg::WEIGHT_STAGE - 2;
  localparam int BASE_READ = LATENCY - 6;
  logic [LATENCY-1:0] pixel_at;  // some lane has a pixel in the register
  logic [quadrille_pkg::STATE_BITS-1:0] state_q;

  always_comb begin
    pixel_at = '0;
    for (int g = 0; g < P; g++) pixel_at |= lane_valid[g*LATENCY+:LATENCY];
  end

  always_ff @(posedge clk_i) begin
    state_q <= state_i;
    if (rst_ni) begin
      `QUADRILLE_ASSERT(assert_state_static,
          !(assembly_busy || slots_busy || fragments_busy) || state_i == state_q,
          "the draw state is static while quads are under way")
      `QUADRILLE_ASSERT(assert_drop_in_time,
          !drop_vertices || !setup_ready,
          "a quad leaves in its first clock, or is not dropped: setup is ready in its third")
      // no_rw_check in quad_slots: what a pixel reads is not written in that clock.
      `QUADRILLE_ASSERT(assert_blend_race,
          !start || !pixel_at[BLEND_READ] || blend_slot != alloc_slot,
          "blend operands are not read in the clock of their write")
      `QUADRILLE_ASSERT(assert_base_race,
          !start || !pixel_at[BASE_READ] || base_slot != alloc_slot,
          "bases are not read in the clock of their write")
      `QUADRILLE_ASSERT(assert_length2_race,
          !take || !pixel_at[LENGTH2_READ] || length2_slot != setup_slot,
          "lengths are not read in the clock of their write")
    end
  end
`endif
endmodule
