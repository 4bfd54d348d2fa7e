  // range_empty: of the beats so far, of an ordinary quad, empty_o if and only if no integer lies both between the least and the greatest coordinate,
  // ends included, and inside the scissor; of a homogeneous one if and only if the scissor has none.
  // By induction. Assumed: low_i is the least coordinate of the beats before (vertex_assembly: low_x_o, low_y_o, its proof); the scissor does not
  // change between a quad's beats and its judgement (quadrille: state_i is static while busy_o).
  logic have_q = 1'b0;
  logic [T-1:0] low_q, high_q;
  logic [V:0] scissor0_q, scissor1_q;
  logic signed [IW:0] first_inside, last_inside, scissor_first, scissor_last;  // pixels, a bit to spare

  always_ff @(posedge clk_i) begin
    if (accept_i) begin
      have_q <= 1'b1;
      low_q <= (first_i || $signed(coordinate_i) < $signed(low_q)) ? coordinate_i : low_q;
      high_q <= (first_i || $signed(coordinate_i) > $signed(high_q)) ? coordinate_i : high_q;
      {scissor0_q, scissor1_q} <= {scissor0_i, scissor1_i};
    end
  end

  // ceil of the least, floor of the greatest
  assign first_inside = $signed(low_q[T-1:FRAC]) + $signed({1'b0, low_q[FRAC-1:0] != '0});
  assign last_inside = $signed(high_q[T-1:FRAC]);
  assign scissor_first = (IW + 1)'(scissor0_q);
  assign scissor_last = (IW + 1)'(scissor1_q) - (IW + 1)'(1);

  logic none_in_scissor, none_inside, none_both;
  assign none_in_scissor = scissor_first > scissor_last;
  assign none_inside = first_inside > last_inside;
  assign none_both = first_inside > scissor_last || scissor_first > last_inside;

  always_comb begin
    assume (have_q || !accept_i || first_i);
    assume (!accept_i || first_i || (low_i == low_q && scissor0_i == scissor0_q && scissor1_i == scissor1_q));
    assert (!have_q || empty_o == (none_in_scissor || (ordinary_i && (none_inside || none_both))));
    // Invariants
    assert (!have_q || $signed(low_q) <= $signed(high_q));
    assert (!have_q || before_q == (last_inside < scissor_first));
    assert (!have_q || behind_q == (first_inside > scissor_last));
    assert (!have_q || apart_q == none_inside);
    assert (!have_q || closed_q == none_in_scissor);
  end
