// SPDX-License-Identifier: Apache-2.0
`include "quadrille_assert.svh"
`include "quadrille_types.svh"
// The quadratic functions of a tile that is hit, from its quad's vertices relative to the tile: value, gx, gy, q of
// f(dx, dy) = value + dx gx + dy gy + q (dx^2 + dy^2), each without its QDROP lowest bits, written into the tile's
// entry of the ring as they come.
//
// Ordinary quad: the four squared distances, gx = -2 X ONE, gy = -2 Y ONE, q = ONE^2; 3 clocks a tile. Homogeneous
// quad: all ten, in three words of the ring (quadrille_pkg: PART_*), 29 clocks a tile. With two pairs of dot units 2
// and 19: in a step each has a job. SPEC.md has the steps. The multipliers are those of vertex_products; a step with
// jobs here takes the clock from the setup.
//
// An entry is complete, in the order of the pushes, VERTEX_PRODUCT_CLOCKS after its last step (complete_o). An end
// entry has no step of its own but waits its turn.
module quadrille_tile_context #(
    localparam int T = quadrille_pkg::T_BITS, W = quadrille_pkg::W_BITS, V = quadrille_pkg::VIEWPORT_BITS,
    localparam int TC = quadrille_pkg::TC_BITS, GRAD = quadrille_pkg::GRAD_BITS, QVAL = quadrille_pkg::QVAL_BITS,
    localparam int QGRAD = quadrille_pkg::QGRAD_BITS, QCURV = quadrille_pkg::QCURV_BITS,
    localparam int OUT = quadrille_pkg::DOT_OUT_BITS, RING = quadrille_pkg::RING_LOG2,
    localparam int PAIRS = quadrille_pkg::PRODUCT_PAIRS, BUSES = quadrille_pkg::CONTEXT_BUSES
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    // Quad: its vertices, relative to its first tile
    input logic take_i,
    input logic [quadrille_pkg::SETUP_BITS-1:0] setup_i,
    output logic homogeneous_o,  // of the quad that was taken last
    // Tile: how far from the quad's first one, and its entry in the ring
    input logic push_i,
    output logic ready_o,
    input logic end_i,
    input logic [quadrille_pkg::TILE_BITS-1:0] tile_i,
    input logic [RING-1:0] entry_i,
    // Jobs of vertex_products, and what comes of them
    output logic job_valid_o,
    output logic [quadrille_pkg::JOBS_BITS-1:0] jobs_o,
    input logic [quadrille_pkg::PRODUCTS_BITS-1:0] products_i,
    output logic [quadrille_pkg::WORDS_BITS-1:0] words_o
);
  `QUADRILLE_IN(`QUADRILLE_SETUP_T, setup)
  `QUADRILLE_IN(`QUADRILLE_TILE_T, tile)
  `QUADRILLE_IN(`QUADRILLE_PRODUCTS_T, products)
  logic [3:0] word_value_write, word_gradient_write, word_q_write;
  logic [quadrille_pkg::RING_LOG2-1:0] word_value_entry, word_gradient_entry, word_q_entry;
  logic [quadrille_pkg::CONTEXT_BUSES*quadrille_pkg::QVAL_BITS-1:0] word_value;
  logic [quadrille_pkg::CONTEXT_BUSES*quadrille_pkg::QGRAD_BITS-1:0] word_gx, word_gy;
  logic [quadrille_pkg::PRODUCT_PAIRS*quadrille_pkg::QCURV_BITS-1:0] word_q;
  logic word_complete, word_complete_homogeneous;
  logic [PAIRS*3-1:0] kinds;
  logic [PAIRS*4-1:0] functions;
  logic [4*T-1:0] x, y;
  logic [4*W-1:0] w;
  logic [V:0] offset_x, offset_y;
  assign jobs_o = {kinds, functions, x, y, w, offset_x, offset_y};
  assign words_o = {word_value_write, word_value_entry, word_value, word_gradient_write, word_gradient_entry, word_gx,
      word_gy, word_q_write, word_q_entry, word_q, word_complete, word_complete_homogeneous};
  localparam int FRAC = quadrille_pkg::FRAC, QDROP = quadrille_pkg::QDROP, TILE_LOG2 = quadrille_pkg::TILE_LOG2;
  localparam int CLOCKS = quadrille_pkg::VERTEX_PRODUCT_CLOCKS;

  // ---- Steps -------------------------------------------------------------------------------------------------------
  // Step 0 loads the vertices, an ordinary quad's moved to the tile; then SQUARES of two pairs. A homogeneous quad:
  // MOVE of four vertices; when those of the first products are there (each next one finds its vertices in time) DOT
  // and DOT_GRADIENT of the ten functions. In a step pair p of the units has the function or vertex PAIRS n + p. The
  // next tile may come then: its own results come later than the last ones of this.
  localparam logic [5:0] MOVE_END = 6'(1 + 4 / PAIRS);
  localparam logic [5:0] PRODUCT = 6'd3 + 6'(CLOCKS);
  localparam logic [5:0] GRADIENT = PRODUCT + 6'(10 / PAIRS);
  localparam logic [5:0] LAST_HOMOGENEOUS = GRADIENT + 6'(10 / PAIRS - 1);
  localparam logic [5:0] LAST_ORDINARY = 6'(2 / PAIRS);
  localparam logic [5:0] LAST_END = 6'd1;

  logic active_q, end_q, homogeneous_q;  // homogeneous_q: of the tile
  logic [5:0] step_q, next_step, last_step;
  logic [TC-1:0] column_q, row_q;
  logic [RING-1:0] entry_q;
  logic last_q, load, complete;
  assign next_step = step_q + 6'd1;
  assign last_step = end_q ? LAST_END : homogeneous_q ? LAST_HOMOGENEOUS : LAST_ORDINARY;
  assign ready_o = !active_q || last_q;
  assign load = active_q && step_q == '0;
  assign complete = active_q && last_q;

  logic [2:0] kind;
  logic [3:0] first_function, next_function;  // of the first pair of units, and how far from it the second's

  always_comb begin
    next_function = 4'd1;
    if (!homogeneous_q) begin
      kind = quadrille_pkg::SQUARES;
      first_function = (PAIRS == 2 || step_q[0]) ? 4'd0 : 4'd2;  // pairs 01, 23
      next_function = 4'd2;
    end else if (step_q < MOVE_END) begin
      kind = quadrille_pkg::MOVE;
      first_function = 4'd6 + 4'(PAIRS) * 4'(step_q - 6'd1);  // the pair of a vertex with itself
    end else if (step_q < GRADIENT) begin
      kind = quadrille_pkg::DOT;
      first_function = 4'(PAIRS) * 4'(step_q - PRODUCT);
    end else begin
      kind = quadrille_pkg::DOT_GRADIENT;
      first_function = 4'(PAIRS) * 4'(step_q - GRADIENT);
    end
  end

  assign kinds = {PAIRS{kind}};

  for (genvar p = 0; p < PAIRS; p++) begin : gen_function
    assign functions[p*4+:4] = first_function + 4'(p) * next_function;
  end

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      active_q <= 1'b0;
      job_valid_o <= 1'b0;
    end else begin
      if (push_i) active_q <= 1'b1;
      else if (last_q) active_q <= 1'b0;
      job_valid_o <= active_q && !end_q && !last_q && (!homogeneous_q || next_step < MOVE_END || next_step >= PRODUCT);
    end
  end

  // last_q and job_valid_o are registers, for the handshakes of walk and setup begin with them.
  always_ff @(posedge clk_i) begin
    last_q <= !push_i && next_step == last_step;
    if (push_i) begin
      step_q <= '0;
      {end_q, homogeneous_q, column_q, row_q, entry_q} <= {end_i, homogeneous_o && !end_i, tile.column, tile.row,
          entry_i};
    end else begin
      step_q <= next_step;
    end
  end

  // ---- Vertices ----------------------------------------------------------------------------------------------------
  logic [4*T-1:0] quad_x_q, quad_y_q;
  logic [4*W-1:0] quad_w_q;
  logic moved;
  logic [1:0] moved_vertex;
  logic [T-1:0] shift_x, shift_y;  // ONE times the offset
  assign offset_x = {column_q, TILE_LOG2'(0)};
  assign offset_y = {row_q, TILE_LOG2'(0)};
  assign shift_x = homogeneous_q ? '0 : T'(offset_x) << FRAC;
  assign shift_y = homogeneous_q ? '0 : T'(offset_y) << FRAC;

  always_ff @(posedge clk_i) begin
    if (take_i) {homogeneous_o, quad_x_q, quad_y_q, quad_w_q} <= {setup.homogeneous, setup.x, setup.y, setup.w};
    if (load) w <= quad_w_q;
  end

  for (genvar g = 0; g < 4; g++) begin : gen_vertex
    always_ff @(posedge clk_i) begin
      if (load) begin
        x[g*T+:T] <= quad_x_q[g*T+:T] - shift_x;
        y[g*T+:T] <= quad_y_q[g*T+:T] - shift_y;
      end else if (moved && moved_vertex == 2'(g / PAIRS * PAIRS)) begin
        x[g*T+:T] <= T'(products.result0[(g%PAIRS)*OUT+:OUT]);
        y[g*T+:T] <= T'(products.result1[(g%PAIRS)*OUT+:OUT]);
      end
    end
  end

  // ---- What the jobs under way are ---------------------------------------------------------------------------------
  // A clock after the job an ordinary quad's gradients and q are there; with the results all else.
  localparam int JOB = 5 + 4 + RING + 1;
  logic [JOB-1:0] job;
  logic [CLOCKS*JOB-1:0] job_q;
  logic early_squares;
  logic [3:0] early_function, late_function;
  logic [RING-1:0] early_entry, late_entry;
  logic late_move, late_dot, late_gradient, late_squares;
  assign job = {
    {4{job_valid_o}} & {
      kind == quadrille_pkg::MOVE,
      kind == quadrille_pkg::DOT,
      kind == quadrille_pkg::DOT_GRADIENT,
      kind == quadrille_pkg::SQUARES
    },
    complete,
    first_function,
    entry_q,
    homogeneous_q
  };

  always_ff @(posedge clk_i) begin
    if (!rst_ni) job_q <= '0;
    else job_q <= {job_q[(CLOCKS-1)*JOB-1:0], job};
  end

  assign early_squares = job_q[JOB-4];
  assign {early_function, early_entry} = job_q[1+:4+RING];
  assign {late_move, late_dot, late_gradient, late_squares, word_complete, late_function, late_entry,
      word_complete_homogeneous} =
      job_q[CLOCKS*JOB-1-:JOB];
  assign moved = late_move;
  assign moved_vertex = late_function[1:0] - 2'd2;  // functions 6 to 9

  // ---- Where a function is in the ring: its word of four functions, and which of them ------------------------------
  // late_*, early_*: the first pair's function, and the lanes that it and the other pairs' fill.
  logic [3:0] late_lanes, late_squares_lanes, early_lanes;
  logic [RING-1:0] late_word;

  always_comb begin
    case (late_function)
      4'd0, 4'd4, 4'd6: late_lanes = (PAIRS == 1) ? 4'b0001 : 4'b0011;
      4'd1, 4'd5, 4'd7: late_lanes = 4'b0010;
      4'd2, 4'd8: late_lanes = (PAIRS == 1) ? 4'b0100 : 4'b1100;
      default: late_lanes = 4'b1000;
    endcase
    if (late_squares || late_function >= 4'd6) late_word = late_entry;
    else if (late_function >= 4'd4) late_word = late_entry + RING'(quadrille_pkg::PART_DIAGONALS);
    else late_word = late_entry + RING'(quadrille_pkg::PART_EDGES);
  end

  assign late_squares_lanes = (PAIRS == 2) ? 4'b1111 : (late_function == 4'd0) ? 4'b0011 : 4'b1100;
  assign early_lanes = (PAIRS == 2) ? 4'b1111 : (early_function == 4'd0) ? 4'b0011 : 4'b1100;

  // On bus b a product of pair b mod PAIRS, or of the squares of pair b / 2 of the units the one of its first or second
  // vertex. gx = -(Xi Wj + Wi Xj); of an ordinary quad's square -2 X ONE.
  localparam int CURV = quadrille_pkg::CURV_BITS;

  for (genvar b = 0; b < BUSES; b++) begin : gen_bus
    localparam int P = b % PAIRS;
    localparam int SQUARE = b / 2;
    logic [OUT-1:0] dot, square;
    logic [T-1:0] early_x, early_y;
    logic [GRAD-1:0] minus_x, minus_y, exact_x, exact_y;
    assign dot = products.result0[P*OUT+:OUT];
    assign square = (b % 2 == 0) ? products.result0[SQUARE*OUT+:OUT] : products.result1[SQUARE*OUT+:OUT];
    assign word_value[b*QVAL+:QVAL] = QVAL'((late_dot ? dot : square) >> QDROP);
    assign early_x = (b % 2 == 0) ? products.xi[SQUARE*T+:T] : products.xj[SQUARE*T+:T];
    assign early_y = (b % 2 == 0) ? products.yi[SQUARE*T+:T] : products.yj[SQUARE*T+:T];
    assign minus_x = early_squares ? GRAD'($signed(early_x)) << (FRAC + 1) : products.result0[P*OUT+:GRAD];
    assign minus_y = early_squares ? GRAD'($signed(early_y)) << (FRAC + 1) : products.result1[P*OUT+:GRAD];
    assign exact_x = GRAD'(0) - minus_x;
    assign exact_y = GRAD'(0) - minus_y;
    assign word_gx[b*QGRAD+:QGRAD] = QGRAD'(exact_x >> QDROP);
    assign word_gy[b*QGRAD+:QGRAD] = QGRAD'(exact_y >> QDROP);
  end

  for (genvar p = 0; p < PAIRS; p++) begin : gen_curvature
    logic [CURV-1:0] q;
    assign q = early_squares ? CURV'(1) << (2 * FRAC) : products.result1[p*OUT+:CURV];
    assign word_q[p*QCURV+:QCURV] = QCURV'(q >> QDROP);
  end

  assign word_value_write = ({4{late_dot}} & late_lanes) | ({4{late_squares}} & late_squares_lanes);
  assign word_value_entry = late_word;
  assign word_gradient_write = early_squares ? early_lanes : {4{late_gradient}} & late_lanes;
  assign word_gradient_entry = early_squares ? early_entry : late_word;
  assign word_q_write = early_squares ? early_lanes : {4{late_dot}} & late_lanes;
  assign word_q_entry = early_squares ? early_entry : late_word;

`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      `QUADRILLE_ASSERT(assert_push_when_ready, !push_i || ready_o, "push comes with ready")
      `QUADRILLE_ASSERT(assert_one_word, !early_squares || !(late_gradient || late_dot), "one word a clock")
    end
  end
`endif
endmodule
