  // Signs and zeros that stamp_coverage finds of an edge function at the pixels of a row are those of row value + dx gx in wider integers: the odd
  // multiples of gx, and the short cut for values far from zero, which looks at CLOSE bits of the others. Of edge 0; the others are the same text.
  // From any contents of all registers. Assumed: the registered multiples are odd multiples of some gx of GRAD_BITS in size (asserted where they
  // are made), and no value in the row leaves VAL_BITS.
  localparam int WIDER = VAL + 2;
  always_comb assume (rst_ni);

  logic signed [WIDER-1:0] gx;
  assign gx = $signed(edges.gx[0+:GRAD]);

  for (genvar k = 0; k < TILE / 2; k++) begin : gen_odd
    logic signed [WIDER-1:0] multiple, made, limit;
    assign multiple = $signed(gen_edge[0].gen_multiple[k].multiple_q);
    assign limit = WIDER'(2 * k + 1) << (GRAD - 1);
    assign made = $signed(gen_edge[0].gen_multiple[k].multiple);
    always_comb begin
      assume (multiple >= -limit && multiple <= limit);
      assert (made == gx * WIDER'(2 * k + 1));
    end
  end

  for (genvar dx = 0; dx < TILE; dx++) begin : gen_check
    localparam int ZEROS = (dx % 8 == 0) ? 3 : (dx % 4 == 0) ? 2 : (dx % 2 == 0) ? 1 : 0;
    logic signed [WIDER-1:0] first, value;
    logic zero_q1, zero_q2, neg_q1, neg_q2;

    assign first = $signed(gen_edge[0].row_value_q);
    if (dx == 0) begin : gen_first
      assign value = first;
    end else begin : gen_next
      assign value = first + (gen_odd[(dx>>ZEROS)/2].multiple <<< ZEROS);
    end

    always_ff @(posedge clk_i) begin
      {zero_q1, neg_q1} <= {value == 0, value < 0};
      {zero_q2, neg_q2} <= {zero_q1, neg_q1};
    end

    always_comb begin
      assume (value[WIDER-1:VAL-1] == '0 || value[WIDER-1:VAL-1] == '1);
      assert (!row_valid_q[1] || is_zero_q2[dx] == zero_q2);
      assert (!row_valid_q[1] || is_neg_q2[dx] == neg_q2);
    end
  end
