  // stamp_coverage never pushes more stamps than the FIFO behind it has places, whatever rows are covered; a row is issued in each clock in which
  // one waits and a place is left, so that when the FIFO is empty nothing waits for ever.
  // By induction. Assumed: freed_i only for a stamp that was pushed and has not been freed.
  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb assume (rst_ni == started_q);

  logic [ROOM-1:0] stamps_q;  // in the FIFO
  logic [ROOM+1:0] claimed;  // places that stamps have, that rows on their way may need, or that are just given back

  always_ff @(posedge clk_i) begin
    if (!rst_ni) stamps_q <= '0;
    else stamps_q <= stamps_q + ROOM'(push_o) - ROOM'(freed_i);
  end

  assign claimed = {2'b00, stamps_q} + (ROOM + 2)'(row_valid_q[0]) + (ROOM + 2)'(row_valid_q[1]) + (ROOM + 2)'(row_valid_q[2]) + (ROOM + 2)'(freed_q);

  always_comb begin
    if (rst_ni) begin
      assume (!freed_i || stamps_q != '0);
      assert (!push_o || stamps_q < ROOM'(PLACES));
      assert (!rows_valid_q || issue || claimed == (ROOM + 2)'(PLACES));
      // Invariants
      assert (!rows_valid_q || !rows_end_q || row_q == '0);
      assert (!row_valid_q[0] || !end_q1 || row_q1 == '0);
      assert (!row_valid_q[1] || !end_q2 || row_q2 == '0);
      assert (!row_valid_q[2] || !end_q3 || (row_q3 == '0 && mask_q3 == '0));
      assert ({2'b00, room_q} + claimed == (ROOM + 2)'(PLACES));
    end
  end
