  // The row's value is value + product + carry of small_multiply: one adder whose carry-in is used.
  always_comb assert (row == value_i + VALUE_BITS'($signed(rise)) + VALUE_BITS'(carry));
