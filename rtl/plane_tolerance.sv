// Whether a quad's values are nearly plane, so that areas of triangles are good enough weights: within 2^-PLANE_TOLERANCE_BITS of their
// range (README.md section 5, Plane quads). One unit beside setup and walk, a value of a quad each clock.
//
// Looked at: ordinary quads that are not exactly plane (plane_quad). With c_i the area of the triangle without corner i, all of one sign where
// the quad is strictly convex, and values f_i:
//
//     D = c0 f0 - c1 f1 + c2 f2 - c3 f3     0 where they are plane       |D| + 2^(P+3) <= (c1 + c3) 2^(P-2-t) >> further     taken
//
// c in P bits, of one scale: the highest bit of all four is the top bit; a value's f as well, with signs. Bits below are dropped, which D may be
// off by 2^(P+3) for. further: 0 for Z, and where k_eff is the same at all corners; else 2 and the distance of the exponents of k.
//
// A quad is accepted when setup has it complete, at latest in the clock in which the walk takes it, every INTERVAL clocks one. Then:
//
//     0 areas | 1 magnitudes, convex | 2 together | 3, 4 zeros above them | 4-7 long, 5-8 short shifts, one after the other | 9 c is there
//     5 first value read | 6 highest exponents of pairs | 7 distances | 8 shifted | 9 products | 10 pairs | 11 D | 12 compared
//
// The last of VALUES values is compared in clock 11 + VALUES, 21 with eight attributes, and taken_o in the next: the slot's weights are areas. The
// first pixel's slot is read for its weights more than 24 clocks after take. Nothing is said of quads that are not taken.
module plane_tolerance #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int PE = quadrille_pkg::PORT_EXP_BITS,
    localparam int N = quadrille_pkg::ATTRIBUTE_SLOTS,
    localparam int AP = quadrille_pkg::ATTR_PORT_BITS,
    localparam int VAL = quadrille_pkg::VAL_BITS,
    localparam int SLOT = quadrille_pkg::QUAD_SLOTS_LOG2
) (
    input logic clk_i,
    input logic rst_ni,
    // Draw state
    input logic on_i,
    input logic perspective_i,
    input logic depth_on_i,
    input logic [3:0] attributes_i,
    // The quad that setup starts with, in a slot
    input logic start_i,
    input logic [SLOT-1:0] start_slot_i,
    input logic plane_i,  // exactly
    input logic [4*PE-1:0] k_exp_i,
    input logic [4*S-1:0] k_sig_i,
    input logic [3:0] z_neg_i,
    input logic [4*PE-1:0] z_exp_i,
    input logic [4*S-1:0] z_sig_i,
    input logic [4*N*AP-1:0] attr_i,
    // The quad that setup has complete, until the walk takes it
    input logic done_i,
    input logic take_i,
    input logic [SLOT-1:0] slot_i,
    input logic homogeneous_i,
    input logic [6*VAL-1:0] lin_value_i,
    output logic ready_o,  // it may be taken
    // Decision
    output logic taken_o,
    output logic [SLOT-1:0] taken_slot_o,
    output logic count_value_o  // for performance_counters: the multipliers get a value in use
);
  localparam int T = quadrille_pkg::PLANE_TOLERANCE_BITS;
  localparam int P = quadrille_pkg::PLANE_SIG_BITS;
  localparam int SLOTS = 1 << SLOT;
  localparam int VALUES = 2 + N;  // k, Z, attributes
  localparam int INDEX = $clog2(VALUES);
  localparam int WORD = 4 * AP;  // of a value: four corners, {neg, exp, sig} each
  // Areas are shifted one after the other, four clocks from the fourth on, and c stays until the last value's products.
  localparam int INTERVAL = (VALUES > 6) ? VALUES : 6;
  localparam int WAIT = $clog2(INTERVAL);

  // ---- Values, from start on: a small memory each ------------------------------------------------------------------------------
  logic [SLOT-1:0] read_slot_q;
  logic [VALUES-1:0] used;
  logic [VALUES*WORD-1:0] read_words;

  for (genvar t = 0; t < VALUES; t++) begin : gen_value
    logic [WORD-1:0] write_word;
    logic [WORD-1:0] bank_q[0:SLOTS-1];

    for (genvar v = 0; v < 4; v++) begin : gen_vertex
      if (t == 0) begin : gen_k
        assign write_word[v*AP+:AP] = {1'b0, k_exp_i[v*PE+:PE], k_sig_i[v*S+:S]};
      end else if (t == 1) begin : gen_z
        assign write_word[v*AP+:AP] = {z_neg_i[v], z_exp_i[v*PE+:PE], z_sig_i[v*S+:S]};
      end else begin : gen_attribute
        assign write_word[v*AP+:AP] = attr_i[(v*N+t-2)*AP+:AP];
      end
    end

    if (t == 0) begin : gen_k_used
      assign used[t] = perspective_i;
    end else if (t == 1) begin : gen_z_used
      assign used[t] = depth_on_i;
    end else begin : gen_attribute_used
      assign used[t] = attributes_i > 4'(t - 2);
    end

    always_ff @(posedge clk_i) if (start_i) bank_q[start_slot_i] <= write_word;
    assign read_words[t*WORD+:WORD] = bank_q[read_slot_q];
  end

  // ---- Which quads, and when ---------------------------------------------------------------------------------------------------
  logic [SLOTS-1:0] plane_q;
  logic candidate, accept, accepted_q;
  logic [WAIT-1:0] wait_q;

  assign candidate = on_i && !homogeneous_i && !plane_q[slot_i];
  assign accept = done_i && candidate && !accepted_q && wait_q == '0;
  assign ready_o = !candidate || accepted_q || wait_q == '0;

  always_ff @(posedge clk_i) begin
    if (start_i) plane_q[start_slot_i] <= plane_i;
    if (!rst_ni) begin
      accepted_q <= 1'b0;
      wait_q <= '0;
    end else begin
      accepted_q <= (accept || accepted_q) && !take_i;
      if (accept) wait_q <= WAIT'(INTERVAL - 1);
      else if (wait_q != '0) wait_q <= wait_q - WAIT'(1);
    end
  end

  // ---- Areas: sums of three edge functions, then of one scale -------------------------------------------------------------------
  // Twice those of 023, 012, 123, 013, in the order in which they are shifted: c1, c3, c0, c2.
  localparam int AREA = VAL + 2;
  localparam int MAG = AREA - 1;
  localparam int SPLIT = 3;  // shifts by 2^SPLIT and more in the first clock
  localparam int NEXT = (1 << SPLIT) - 1;  // bits from which a shorter shift is counted
  localparam int KEPT = P + (1 << SPLIT) - 1;  // bits at the top that a shorter shift can still bring into P
  localparam int WIDE = (MAG > KEPT) ? MAG : KEPT;
  localparam int COUNT = $clog2(WIDE);
  logic [7:0] step_q;  // clocks since a quad was accepted
  logic [6*AREA-1:0] value;
  logic [4*AREA-1:0] area_d, area_q;
  logic [3:0] area_neg, area_pos;
  logic [4*MAG-1:0] magnitude_d, magnitude_q;
  logic convex_q;
  logic [MAG-1:0] together_q;
  logic [WIDE-1:0] together_shifted, long_shifted;
  logic [COUNT-1:SPLIT] long_count_d, long_count_q;
  logic [SPLIT-1:0] short_count_d, short_count_q;
  logic [NEXT-1:0] next_q, next_shifted;
  logic [KEPT-1:0] long_q;
  logic [P-1:0] short_shifted;
  logic [3*P-1:0] before_q;  // c0, c3, c1
  logic [4*P-1:0] c_q;  // c3, c2, c1, c0
  logic [P:0] sum_q;  // c1 + c3
  logic [SLOT-1:0] slot_q;

  for (genvar g = 0; g < 6; g++) begin : gen_edge
    assign value[g*AREA+:AREA] = AREA'($signed(lin_value_i[g*VAL+:VAL]));
  end

  assign area_d[0+:AREA] = value[2*AREA+:AREA] + value[3*AREA+:AREA] - value[4*AREA+:AREA];
  assign area_d[AREA+:AREA] = value[0+:AREA] + value[AREA+:AREA] + value[4*AREA+:AREA];
  assign area_d[2*AREA+:AREA] = value[AREA+:AREA] + value[2*AREA+:AREA] - value[5*AREA+:AREA];
  assign area_d[3*AREA+:AREA] = value[0+:AREA] + value[5*AREA+:AREA] + value[3*AREA+:AREA];

  for (genvar g = 0; g < 4; g++) begin : gen_area
    assign area_neg[g] = area_q[g*AREA+AREA-1];
    assign area_pos[g] = !area_neg[g] && area_q[g*AREA+:AREA] != '0;
    assign magnitude_d[g*MAG+:MAG] = area_neg[g] ? MAG'(-area_q[g*AREA+:AREA]) : area_q[g*AREA+:MAG];
  end

  shift_to_top #(
      .WIDTH(WIDE),
      .LAST(SPLIT)
  ) u_long_count (
      .value_i(WIDE'(together_q) << (WIDE - MAG)),
      .count_o(long_count_d),
      .value_o(together_shifted)
  );
  shift_to_top #(.WIDTH(NEXT)) u_short_count (
      .value_i(next_q),
      .count_o(short_count_d),
      .value_o(next_shifted)
  );

  assign long_shifted = WIDE'(magnitude_q[0+:MAG]) << (WIDE - MAG) << {long_count_q, SPLIT'(0)};
  assign short_shifted = P'((long_q << short_count_q) >> (KEPT - P));

  always_ff @(posedge clk_i) begin
    if (!rst_ni) step_q <= '0;
    else step_q <= {step_q[6:0], accept};
  end

  always_ff @(posedge clk_i) begin
    if (accept) begin
      area_q <= area_d;
      slot_q <= slot_i;
    end
    if (step_q[0]) begin
      magnitude_q <= magnitude_d;
      convex_q <= area_neg == '1 || area_pos == '1;
    end else if (step_q[6:3] != '0) magnitude_q <= magnitude_q >> MAG;
    if (step_q[1]) together_q <= magnitude_q[0+:MAG] | magnitude_q[MAG+:MAG] | magnitude_q[2*MAG+:MAG] | magnitude_q[3*MAG+:MAG];
    if (step_q[2]) begin
      long_count_q <= long_count_d;
      next_q <= together_shifted[WIDE-1-:NEXT];
    end
    if (step_q[3]) short_count_q <= short_count_d;
    if (step_q[6:3] != '0) long_q <= KEPT'(long_shifted >> (WIDE - KEPT));
    if (step_q[7:4] != '0) before_q <= {short_shifted, before_q[3*P-1:P]};
    if (step_q[7]) begin
      c_q <= {before_q[P+:P], short_shifted, before_q[0+:P], before_q[2*P+:P]};
      sum_q <= (P + 1)'(before_q[0+:P]) + (P + 1)'(before_q[P+:P]);
    end
  end

  // ---- Values, one a clock -------------------------------------------------------------------------------------------------------
  // What goes with one: it is there, the first (k), Z, in use; the last; its slot.
  localparam int RANK = PE + 1;
  localparam int TAG = 5 + SLOT;
  localparam int FURTHER = 5;  // bits: 31 is more than any limit has room for
  logic reading_q;
  logic [INDEX-1:0] index_q;
  logic last_read;
  logic [TAG-1:0] read_tag, word_tag_q, pair_tag_q, distance_tag_q, shifted_tag_q, product_tag_q, half_tag_q, d_tag_q;
  logic [WORD-1:0] read_word, word_q;

  always_comb begin
    read_word = '0;
    for (int t = 0; t < VALUES; t++) if (used[t] && index_q == INDEX'(t)) read_word = read_words[t*WORD+:WORD];
  end

  assign last_read = index_q == INDEX'(VALUES - 1);
  assign read_tag = {reading_q, index_q == '0, index_q == INDEX'(1), used[index_q], last_read, read_slot_q};

  always_ff @(posedge clk_i) begin
    if (!rst_ni) reading_q <= 1'b0;
    else reading_q <= (step_q[3] && convex_q) || (reading_q && !last_read);
    if (step_q[3]) read_slot_q <= slot_q;
    index_q <= (step_q[3] || !reading_q) ? '0 : index_q + INDEX'(1);
    if (reading_q) word_q <= read_word;
    word_tag_q <= read_tag;
    pair_tag_q <= word_tag_q;
    distance_tag_q <= pair_tag_q;
    shifted_tag_q <= distance_tag_q;
    product_tag_q <= shifted_tag_q;
    half_tag_q <= product_tag_q;
    d_tag_q <= half_tag_q;
    if (!rst_ni) begin
      word_tag_q[TAG-1] <= 1'b0;
      pair_tag_q[TAG-1] <= 1'b0;
      distance_tag_q[TAG-1] <= 1'b0;
      shifted_tag_q[TAG-1] <= 1'b0;
      product_tag_q[TAG-1] <= 1'b0;
      half_tag_q[TAG-1] <= 1'b0;
      d_tag_q[TAG-1] <= 1'b0;
    end
  end

  // Highest exponents of pairs, the lowest too, for k. The rank of 0 is below all others'.
  logic [4*RANK-1:0] rank, rank_q;
  logic [2*RANK-1:0] higher_q, lower_q;
  logic same_q;
  logic [3:0] word_neg, pair_neg_q, distance_neg_q, shifted_neg_q;
  logic [4*S-1:0] word_sig, pair_sig_q, distance_sig_q;

  for (genvar v = 0; v < 4; v++) begin : gen_word
    assign {word_neg[v], word_sig[v*S+:S]} = {word_q[v*AP+AP-1], word_q[v*AP+:S]};
    assign rank[v*RANK+:RANK] = {1'b1, ~word_q[v*AP+S+PE-1], word_q[v*AP+S+:PE-1]} & {RANK{word_q[v*AP+S-1]}};
  end

  always_ff @(posedge clk_i) begin
    for (int h = 0; h < 2; h++) begin
      higher_q[h*RANK+:RANK] <= (rank[(2*h+1)*RANK+:RANK] > rank[2*h*RANK+:RANK]) ? rank[(2*h+1)*RANK+:RANK] : rank[2*h*RANK+:RANK];
      lower_q[h*RANK+:RANK] <= (rank[(2*h+1)*RANK+:RANK] > rank[2*h*RANK+:RANK]) ? rank[2*h*RANK+:RANK] : rank[(2*h+1)*RANK+:RANK];
    end
    rank_q <= rank;
    pair_neg_q <= word_neg;
    pair_sig_q <= word_sig;
    same_q <= word_q == {4{word_q[0+:AP]}};
  end

  // Distances from the highest; by k how much less there may be.
  logic [RANK-1:0] top, bottom, spread;
  logic [FURTHER-1:0] further_of_k, k_further, k_further_q, distance_further_q, shifted_further_q;
  logic [4*RANK-1:0] distance_q;
  logic distance_same_q;

  assign top = (higher_q[RANK+:RANK] > higher_q[0+:RANK]) ? higher_q[RANK+:RANK] : higher_q[0+:RANK];
  assign bottom = (lower_q[RANK+:RANK] > lower_q[0+:RANK]) ? lower_q[0+:RANK] : lower_q[RANK+:RANK];
  assign spread = top - bottom;
  assign further_of_k = (!perspective_i || same_q) ? '0 : (spread > RANK'(29)) ? '1 : FURTHER'(spread) + FURTHER'(2);
  assign k_further = pair_tag_q[TAG-2] ? further_of_k : k_further_q;

  always_ff @(posedge clk_i) begin
    for (int v = 0; v < 4; v++) distance_q[v*RANK+:RANK] <= top - rank_q[v*RANK+:RANK];
    distance_neg_q <= pair_neg_q;
    distance_sig_q <= pair_sig_q;
    distance_same_q <= pair_tag_q[TAG-2] && same_q;
    if (pair_tag_q[TAG-1]) k_further_q <= k_further;
    distance_further_q <= pair_tag_q[TAG-3] ? '0 : k_further;
  end

  // Of one scale, and multiplied. Of k that are the same nothing needs to be known.
  localparam int NEAR = $clog2(P);  // bits of a distance that leaves something
  localparam int LIMIT = 2 * P + 3;
  logic [4*P-1:0] f_q;
  logic [8*P-1:0] product_q;
  logic [3:0] product_neg_q;  // with the sign that the corner has in D
  logic [LIMIT-1:0] room_q, limit_q, d_limit_q;
  logic shifted_judged_q, product_judged_q, half_judged_q, d_judged_q;

  for (genvar v = 0; v < 4; v++) begin : gen_term
    logic far;

    assign far = distance_q[v*RANK+NEAR+:RANK-NEAR] != '0;

    always_ff @(posedge clk_i) begin
      f_q[v*P+:P] <= far ? '0 : P'(distance_sig_q[v*S+:S]) << (P - S) >> distance_q[v*RANK+:NEAR];
      product_q[v*2*P+:2*P] <= (2 * P)'(c_q[v*P+:P]) * (2 * P)'(f_q[v*P+:P]);
      product_neg_q[v] <= shifted_neg_q[v] ^ 1'(v);
    end
  end

  always_ff @(posedge clk_i) begin
    shifted_neg_q <= distance_neg_q;
    shifted_further_q <= distance_further_q;
    shifted_judged_q <= distance_tag_q[TAG-4] && !distance_same_q;
    room_q <= LIMIT'(sum_q) << (P - 2 - T) >> shifted_further_q;
    product_judged_q <= shifted_judged_q;
  end

  assign count_value_o = shifted_tag_q[TAG-1] && shifted_tag_q[TAG-4];

  // Halves of the sum, each in the sign of its first term; D in that of its first.
  localparam int HALF = 2 * P + 2;
  logic [2*HALF-1:0] half_d, half_q;
  logic across_q;
  logic [LIMIT-1:0] d_q, above, below;

  always_comb begin
    for (int h = 0; h < 2; h++) begin  // corners 0 and 2, 1 and 3
      half_d[h*HALF+:HALF] = (product_neg_q[h] != product_neg_q[h+2]) ?
          HALF'(product_q[h*2*P+:2*P]) - HALF'(product_q[(h+2)*2*P+:2*P]) : HALF'(product_q[h*2*P+:2*P]) + HALF'(product_q[(h+2)*2*P+:2*P]);
    end
  end

  always_ff @(posedge clk_i) begin
    half_q <= half_d;
    across_q <= product_neg_q[0] != product_neg_q[1];
    limit_q <= room_q - (LIMIT'(1) << (P + 3));
    half_judged_q <= product_judged_q;
    d_q <= across_q ? LIMIT'($signed(half_q[0+:HALF])) - LIMIT'($signed(half_q[HALF+:HALF])) :
        LIMIT'($signed(half_q[0+:HALF])) + LIMIT'($signed(half_q[HALF+:HALF]));
    d_limit_q <= limit_q;
    d_judged_q <= half_judged_q;
  end

  // ---- Compared, and said with the last value --------------------------------------------------------------------------------------
  logic far_off, failed_q;

  assign above = d_limit_q - d_q;
  assign below = d_limit_q + d_q;
  assign far_off = d_judged_q && (above[LIMIT-1] || below[LIMIT-1]);

  always_ff @(posedge clk_i) begin
    taken_o <= d_tag_q[TAG-1] && d_tag_q[SLOT] && !far_off && !failed_q;
    taken_slot_o <= d_tag_q[SLOT-1:0];
    if (d_tag_q[TAG-1]) failed_q <= (failed_q && !d_tag_q[TAG-2]) || far_off;
  end

  logic unused;
  assign unused = ^{together_shifted[WIDE-NEXT-1:0], next_shifted};
endmodule
