// What float_portable.hpp and wide_portable.hpp have in common, in the compiler's own vectors F of reals, I and U of
// integers of their size, inside their namespace. A mask is 0 or -1 in each lane.

struct Mask {
  I lanes;
};
inline Mask operator&(Mask a, Mask b) { return {a.lanes & b.lanes}; }
inline Mask operator|(Mask a, Mask b) { return {a.lanes | b.lanes}; }
inline Mask operator^(Mask a, Mask b) { return {a.lanes ^ b.lanes}; }
inline Mask without(Mask a, Mask b) { return {a.lanes & ~b.lanes}; }

inline F real(I v) { return (F)v; }
inline I bits(F v) { return (I)v; }
inline F select(Mask m, F a, F b) { return real((bits(a) & m.lanes) | (bits(b) & ~m.lanes)); }
inline I select(Mask m, I a, I b) { return (a & m.lanes) | (b & ~m.lanes); }
inline F least(F a, F b) { return select(Mask{a < b}, a, b); }
inline F greatest(F a, F b) { return select(Mask{a > b}, a, b); }
inline F keep(F v, F mask) { return real(bits(v) & bits(mask)); }
// Codes of exponents go beyond the greatest integer on the way.
inline I add(I a, I b) { return I(U(a) + U(b)); }
inline I subtract(I a, I b) { return I(U(a) - U(b)); }
template <int places>
I shift_left(I v) {
  return I(U(v) << places);
}
template <int places>
I shift_right(I v) {
  return I(U(v) >> places);
}
inline I shift_right(I v, int places) { return I(U(v) >> static_cast<unsigned>(places)); }

inline Mask sign(I v) { return {v < 0}; }
inline Mask equal(F a, F b) { return {a == b}; }
inline Mask equal(I a, I b) { return {a == b}; }
inline Mask at_least(F a, F b) { return {a >= b}; }
inline Mask no_lane() { return {I{}}; }
/// That bit in the lanes of the mask.
template <int bit>
I flag(Mask m) {
  return m.lanes & (1 << bit);
}

/// Places of a table for each lane.
struct Coefficients {
  F c0, c1, c2;
};
constexpr bool looks_up_columns = false;
