  // Column: row + product + carry; then column + bend + its carry: adders whose carry-ins are used.
  always_comb begin
    assert (column_d == row_i + VALUE_BITS'($signed(rise)) + VALUE_BITS'(carry));
    assert (bent == column_q + VALUE_BITS'($signed(gen_bend.bend_q)) + VALUE_BITS'(gen_bend.bend_carry_q));
  end
