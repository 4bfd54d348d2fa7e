// Suite `tile_context`: a quad's vertices and the place of one of its tiles in, the quadratic functions out, collected from the words of
// the ring as they are written. One tile at a time, as long as tile_context takes; each in the next entry of the ring.
module replay_tile_context (
    `include "replay_ports.svh"
);
  `include "replay_fields.svh"
  localparam int T = quadrille_pkg::T_BITS;
  localparam int W = quadrille_pkg::W_BITS;
  localparam int V = quadrille_pkg::VIEWPORT_BITS;
  localparam int QVAL = quadrille_pkg::QVAL_BITS;
  localparam int QGRAD = quadrille_pkg::QGRAD_BITS;
  localparam int QCURV = quadrille_pkg::QCURV_BITS;
  localparam int OUT = quadrille_pkg::DOT_OUT_BITS;
  localparam int RING = quadrille_pkg::RING_LOG2;

  // ---- Quad, then tile, until the entry is complete -------------------------------------------------------------------------
  logic taken_q, pushed_q, take, push, tile_ready, complete;
  logic [RING-1:0] entry_q;

  assign take = valid_i && !taken_q;
  assign push = taken_q && !pushed_q && tile_ready;
  assign ready_o = complete;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      {taken_q, pushed_q, valid_o} <= '0;
      entry_q <= '0;
    end else begin
      taken_q <= (taken_q || take) && !complete;
      pushed_q <= (pushed_q || push) && !complete;
      valid_o <= complete;
      if (valid_o) entry_q <= entry_q + RING'(1);
    end
  end

  // ---- Device ---------------------------------------------------------------------------------------------------------------
  logic job_valid;
  localparam int PAIRS = quadrille_pkg::PRODUCT_PAIRS;
  localparam int BUSES = quadrille_pkg::CONTEXT_BUSES;
  logic [PAIRS*3-1:0] job_kind;
  logic [PAIRS*4-1:0] job_function;
  logic [4*T-1:0] job_x, job_y;
  logic [4*W-1:0] job_w;
  logic [V:0] offset_x, offset_y;
  logic [PAIRS*T-1:0] xi, yi, xj, yj;
  logic [PAIRS*OUT-1:0] result0, result1;
  logic [3:0] value_write, gradient_write, q_write;
  logic [RING-1:0] value_entry, gradient_entry, q_entry;
  logic [BUSES*QVAL-1:0] value;
  logic [BUSES*QGRAD-1:0] gx, gy;
  logic [PAIRS*QCURV-1:0] q;
  logic quad_homogeneous, complete_homogeneous;
  localparam int APART = PAIRS * quadrille_pkg::RISE_BITS;
  logic [2*APART-1:0] apart;

  quadrille_vertex_products u_products (
      .clk_i,
      .tile_valid_i(job_valid),
      .tile_kind_i(job_kind),
      .tile_function_i(job_function),
      .tile_x_i(job_x),
      .tile_y_i(job_y),
      .tile_w_i(job_w),
      .offset_x_i(offset_x),
      .offset_y_i(offset_y),
      .setup_kind_i((PAIRS * 3)'(0)),
      .setup_function_i((PAIRS * 4)'(0)),
      .setup_x_i((4 * T)'(0)),
      .setup_y_i((4 * T)'(0)),
      .setup_w_i((4 * W)'(0)),
      .setup_offset_x_i((V + 1)'(0)),
      .setup_offset_y_i((V + 1)'(0)),
      .edge_value_i((PAIRS * quadrille_pkg::VAL_BITS)'(0)),
      .edge_gx_i((PAIRS * quadrille_pkg::GRAD_BITS)'(0)),
      .edge_gy_i((PAIRS * quadrille_pkg::GRAD_BITS)'(0)),
      .xi_o(xi),
      .yi_o(yi),
      .xj_o(xj),
      .yj_o(yj),
      .apart_x_o(apart[0+:APART]),
      .apart_y_o(apart[APART+:APART]),
      .result0_o(result0),
      .result1_o(result1)
  );

  quadrille_tile_context u_context (
      .take_i(take),
      .homogeneous_o(quad_homogeneous),
      .push_i(push),
      .ready_o(tile_ready),
      .end_i(1'b0),
      .entry_i(entry_q),
      .job_valid_o(job_valid),
      .kind_o(job_kind),
      .function_o(job_function),
      .x_o(job_x),
      .y_o(job_y),
      .w_o(job_w),
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
      .value_o(value),
      .gradient_write_o(gradient_write),
      .gradient_entry_o(gradient_entry),
      .gx_o(gx),
      .gy_o(gy),
      .q_write_o(q_write),
      .q_entry_o(q_entry),
      .q_o(q),
      .complete_o(complete),
      .complete_homogeneous_o(complete_homogeneous),
      .*
  );

  // ---- Where each function is in the ring: squared distances in the tile's own word, then the edges' D, then the diagonals' ----
  for (genvar g = 0; g < 10; g++) begin : gen_function
    localparam logic [RING-1:0] PART = g >= 6 ? '0 : g >= 4 ? RING'(quadrille_pkg::PART_DIAGONALS) : RING'(quadrille_pkg::PART_EDGES);
    localparam int LANE = g < 4 ? g : g < 6 ? g - 4 : g - 6;
    logic [RING-1:0] place;
    assign place = entry_q + PART;

    always_ff @(posedge clk_i) begin
      if (take) begin  // what is not written counts as zero
        quad_value_o[g*QVAL+:QVAL] <= '0;
        quad_gx_o[g*QGRAD+:QGRAD] <= '0;
        quad_gy_o[g*QGRAD+:QGRAD] <= '0;
        quad_q_o[g*QCURV+:QCURV] <= '0;
      end else begin
        if (value_write[LANE] && value_entry == place) quad_value_o[g*QVAL+:QVAL] <= value[LANE%BUSES*QVAL+:QVAL];
        if (gradient_write[LANE] && gradient_entry == place) begin
          quad_gx_o[g*QGRAD+:QGRAD] <= gx[LANE%BUSES*QGRAD+:QGRAD];
          quad_gy_o[g*QGRAD+:QGRAD] <= gy[LANE%BUSES*QGRAD+:QGRAD];
        end
        if (q_write[LANE] && q_entry == place) quad_q_o[g*QCURV+:QCURV] <= q[LANE%PAIRS*QCURV+:QCURV];
      end
    end
  end

  logic unused;
  assign unused = ^{quad_homogeneous, complete_homogeneous, apart};
endmodule
