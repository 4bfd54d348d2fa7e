  // quad_reject: limits_o, used as fragment_output uses it, is the rule: a depth is clamped to the corners' codes, and discarded when it is then
  // outside [znear, zfar]. depth_o, with depth on, if and only if no depth is inside then: a quad with a code inside is never rejected.
  // Two clocks from any contents. Assumed: corners' codes as snapping gives them, the least not above the greatest; nothing changes.
  localparam int WIDE = CODE + 2;
  (* anyconst *) logic [CODE-1:0] low, high;
  (* anyconst *) logic [DB:0] znear_kept, zfar_kept;
  (* anyconst *) logic [WIDE-1:0] z;  // any depth before the clamp
  logic [WIDE-1:0] wide_low, wide_high, wide_near, wide_far, clamped, used;
  logic below, beyond, discard, discard_spec;

  assign wide_low = WIDE'($signed(low));
  assign wide_high = WIDE'($signed(high));
  assign wide_near = WIDE'(znear_kept);
  assign wide_far = WIDE'(zfar_kept);
  assign clamped = $signed(z) < $signed(wide_low) ? wide_low : $signed(z) > $signed(wide_high) ? wide_high : z;
  assign discard_spec = $signed(clamped) < $signed(wide_near) || $signed(clamped) > $signed(wide_far);
  assign below = $signed(z) < $signed(WIDE'(least_q));
  assign beyond = $signed(z) > $signed(WIDE'(greatest_q));
  assign used = beyond ? WIDE'(greatest_q) : below ? WIDE'(least_q) : z;
  assign discard = outside_q || (below && near_cuts_q) || (beyond && far_cuts_q);

  always_comb begin
    assume (low_i == low && high_i == high && znear_i == znear_kept && zfar_i == zfar_kept);
    assume ($signed(wide_low) <= $signed(wide_high) && $signed(wide_low) >= -1 && $signed(wide_high) <= (1 << DB) + 1);
    assert (discard == discard_spec);
    assert (discard || used == clamped);
    assert (depth_o == (depth_on_i && ($signed(wide_high) < $signed(wide_near) || $signed(wide_low) > $signed(wide_far))));
    assert (!depth_o || discard_spec);
    assert (limits_o == {outside_q, near_cuts_q, far_cuts_q, least_q, greatest_q});
  end
