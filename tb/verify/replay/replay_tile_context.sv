`include "quadrille_types.svh"

// Suite `tile_context`: a quad's vertices and the place of one of its tiles in, the quadratic functions out, collected from the words of
// the ring as they are written. One tile at a time, as long as tile_context takes; each in the next entry of the ring.
module replay_tile_context (
    `include "replay_ports.svh"
);
  `include "replay_fields.svh"
  localparam int QVAL = quadrille_pkg::QVAL_BITS;
  localparam int QGRAD = quadrille_pkg::QGRAD_BITS;
  localparam int QCURV = quadrille_pkg::QCURV_BITS;
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
  logic [quadrille_pkg::JOBS_BITS-1:0] jobs;
  logic [quadrille_pkg::PRODUCTS_BITS-1:0] products;
  logic [quadrille_pkg::WORDS_BITS-1:0] words_i;
  `QUADRILLE_IN(`QUADRILLE_WORDS_T, words)
  `QUADRILLE_SETUP_T setup;
  `QUADRILLE_TILE_T tile;
  logic quad_homogeneous;

  assign complete = words.complete;

  always_comb begin
    setup = '0;
    setup.homogeneous = homogeneous_i;
    setup.x = x_i;
    setup.y = y_i;
    setup.w = w_i;
    tile = '0;
    tile.column = column_i;
    tile.row = row_i;
  end

  quadrille_vertex_products u_products (
      .clk_i,
      .tile_valid_i(job_valid),
      .tile_i(jobs),
      .setup_valid_i(1'b0),
      .setup_i(quadrille_pkg::JOBS_BITS'(0)),
      .edges_i((PAIRS * (quadrille_pkg::VAL_BITS + 2 * quadrille_pkg::GRAD_BITS))'(0)),
      .products_o(products)
  );

  quadrille_tile_context u_context (
      .clk_i,
      .rst_ni,
      .take_i(take),
      .setup_i(setup),
      .homogeneous_o(quad_homogeneous),
      .push_i(push),
      .ready_o(tile_ready),
      .end_i(1'b0),
      .tile_i(tile),
      .entry_i(entry_q),
      .job_valid_o(job_valid),
      .jobs_o(jobs),
      .products_i(products),
      .words_o(words_i)
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
        if (words.value_write[LANE] && words.value_entry == place) quad_value_o[g*QVAL+:QVAL] <= words.value[LANE%BUSES*QVAL+:QVAL];
        if (words.gradient_write[LANE] && words.gradient_entry == place) begin
          quad_gx_o[g*QGRAD+:QGRAD] <= words.gx[LANE%BUSES*QGRAD+:QGRAD];
          quad_gy_o[g*QGRAD+:QGRAD] <= words.gy[LANE%BUSES*QGRAD+:QGRAD];
        end
        if (words.q_write[LANE] && words.q_entry == place) quad_q_o[g*QCURV+:QCURV] <= words.q[LANE%PAIRS*QCURV+:QCURV];
      end
    end
  end

  logic unused;
  assign unused = quad_homogeneous;
endmodule
