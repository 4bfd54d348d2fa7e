#include "model/port/tables.hpp"

#include <bit>
#include <cstdint>
#include <locale>
#include <sstream>

namespace quadrille {
namespace {

// Everything here is integers, so the coefficients are the same on every platform and in every rounding mode.
__extension__ using Wide = unsigned __int128;

/// Units (2^-(S + table_guard)) added to c0. Of the reciprocal: so that the evaluated polynomial is never below the
/// function: approximation (<= 1 unit at the automatic segment counts), coefficient rounding (1.5 units at most) and
/// the truncation of t0 and t1. Of the root: half of the last bit, so that the truncation behind it rounds to nearest;
/// roots stand in the numerators of weights as often as in the denominators.
constexpr std::uint32_t recip_bias_units = 3, root_bias_units = 4;

/// a0, |a1|, |a2| of a segment's polynomial in u, 0 to 1 from its begin to its end, in units 2^-(S + table_guard),
/// rounded to nearest. It interpolates the function in the Chebyshev points of its degree: (1 ± k)/2, k = sqrt(1/2),
/// for a line; 1/2 and (1 ± k)/2, k = sqrt(3)/2, for a parabola. The line is close to the minimax one of a function
/// that bends one way.
struct Coefficients {
  std::uint64_t a0 = 0, a1 = 0, a2 = 0;
};

/// floor(sqrt(v)), v below 2^126: Newton's iteration, which falls to the root from a power of two above it.
constexpr std::uint64_t floor_sqrt(Wide v) {
  const auto high = static_cast<std::uint64_t>(v >> 64);
  const int bits = high != 0 ? 128 - std::countl_zero(high) : 64 - std::countl_zero(static_cast<std::uint64_t>(v));
  std::uint64_t root = std::uint64_t{1} << (bits + 1) / 2;
  for (;;) {
    const auto next = static_cast<std::uint64_t>((root + v / root) / 2);
    if (next >= root) return root;
    root = next;
  }
}

/// 1 / x on [1 + i/n, 1 + (i + 1)/n]. 1 - x p(x) is a multiple of the product of u less each point, so p is a quotient
/// of integers; they are written in p = 2 (n + i) + 1, twice the segment's middle in segments.
Coefficients recip_coefficients(std::uint64_t n, std::uint64_t i, int degree, int unit_bits) {
  const std::uint64_t p = 2 * (n + i) + 1;
  const auto rounded = [&](Wide numerator, Wide denominator) {
    return static_cast<std::uint64_t>(((numerator << (unit_bits + 1)) + denominator) / (2 * denominator));
  };
  if (degree == 1) {
    const Wide denominator = 2 * Wide{p} * p - 1;
    return {rounded(4 * Wide{n} * (p + 1), denominator), rounded(8 * Wide{n}, denominator), 0};
  }
  const Wide denominator = p * (4 * Wide{p} * p - 3);
  return {rounded(2 * Wide{n} * (2 * p + 1) * (2 * p + 1), denominator), rounded(16 * Wide{n} * (p + 2), denominator),
          rounded(32 * Wide{n}, denominator)};
}

/// sqrt(x) / 2 on the segment of 2^-shift that begins at `begin` of them. From the roots r of the points: what they
/// divide are sums of two, as (r1 - r0) / (x1 - x0) = 1 / (r1 + r0), so that nothing cancels. Numbers have 62 or 63
/// fraction bits, more than 30 below the last place of the coefficients.
Coefficients root_coefficients(std::uint64_t begin, int shift, int degree, int unit_bits) {
  constexpr int f = 62;
  constexpr Wide one = Wide{1} << f, k_line = floor_sqrt(Wide{1} << (2 * f - 1)),
                 k_parabola = floor_sqrt(Wide{3} << (2 * f - 2));
  const Wide k = degree == 1 ? k_line : k_parabola;
  // A point's root: x has 2 f fraction bits.
  const auto root = [&](Wide u) { return Wide{floor_sqrt((Wide{begin} << (2 * f - shift)) + (u << (f - shift)))}; };
  const auto reciprocal = [&](Wide r, Wide r1) { return (Wide{1} << (2 * f + 1)) / (r + r1); };  // f + 1 fraction bits
  const auto times = [](Wide a, Wide b) { return (a * b) >> (f + 1); };
  // v has `fraction` fraction bits and is twice a coefficient.
  const auto rounded = [&](Wide v, int fraction) {
    const int drop = fraction + 1 - unit_bits;
    return static_cast<std::uint64_t>((v + (Wide{1} << (drop - 1))) >> drop);
  };
  const Wide low = (one - k) / 2, r0 = root(low), r2 = root(one - low);
  if (degree == 1) {
    const Wide d = reciprocal(r0, r2);
    return {rounded((r0 << shift) - ((low * d) >> (f + 1)), f + shift), rounded(d, f + 1 + shift), 0};
  }
  const Wide r1 = root(one / 2);
  const Wide d01 = reciprocal(r0, r1), d12 = reciprocal(r1, r2), d02 = reciprocal(r0, r2);
  const Wide bend = times(times(d01, d12), d02);  // a2 is half of it, 2 shift places lower
  const Wide slope = (d01 << shift) + ((bend * (2 * one - k)) >> (f + 1));
  const Wide value = (r0 << 2 * shift) - (((low * d01) >> (f + 1)) << shift) - ((bend * (one - k)) >> (f + 3));
  return {rounded(value, f + 2 * shift), rounded(slope, f + 1 + 2 * shift), rounded(bend, f + 1 + 2 * shift)};
}

TableEntry make_entry(const Coefficients& a, std::uint32_t bias, const Config& config, const char* key) {
  const std::uint64_t limit = std::uint64_t{1} << config.significand_bits;
  if (a.a1 >= limit || a.a2 >= limit || a.a1 < a.a2)
    throw ConfigError(
        std::string("impossible configuration: a coefficient of the table does not fit significand_bits; raise ") +
        key);
  return {static_cast<std::uint32_t>(a.a0) + bias, static_cast<std::uint32_t>(a.a1), static_cast<std::uint32_t>(a.a2)};
}

int unit_bits(const Config& config) { return config.significand_bits + Config::table_guard; }

Table empty_table(int segments_log2, const Config& config) {
  return {segments_log2, config.significand_bits - 1 - segments_log2, {}};
}

void emit_rom(std::ostringstream& out, const char* name, const Table& table, const Config& config) {
  const int s = config.significand_bits;
  const int index_bits = std::countr_zero(table.entries.size());
  const int word = 3 * s + 4;
  out << "  function automatic logic [" << word - 1 << ":0] " << name << "(input logic [" << index_bits - 1
      << ":0] index);\n    case (index)\n";
  for (std::size_t i = 0; i < table.entries.size(); ++i) {
    const TableEntry& e = table.entries[i];
    out << "      " << index_bits << "'d" << i << ": " << name << " = {" << s + 4 << "'d" << e.c0 << ", " << s << "'d"
        << e.c1 << ", " << s << "'d" << e.c2 << "};\n";
  }
  out << "      default: " << name << " = '0;\n    endcase\n  endfunction\n";
}

}  // namespace

Table make_sqrt_table(const Config& config) {
  Table table = empty_table(config.sqrt_segments(), config);
  const std::uint64_t n = std::uint64_t{1} << table.segments_log2;
  for (int octave = 0; octave < 2; ++octave)
    for (std::uint64_t i = 0; i < n; ++i) {
      const int shift = table.segments_log2 - octave;
      const Coefficients a = root_coefficients(n + i, shift, config.sqrt_degree, unit_bits(config));
      table.entries.push_back(make_entry(a, root_bias_units, config, "sqrt_segments_log2"));
    }
  return table;
}

Table make_recip_table(const Config& config) {
  Table table = empty_table(config.recip_segments(), config);
  const std::uint64_t n = std::uint64_t{1} << table.segments_log2;
  for (std::uint64_t i = 0; i < n; ++i) {
    const Coefficients a = recip_coefficients(n, i, config.recip_degree, unit_bits(config));
    table.entries.push_back(make_entry(a, recip_bias_units, config, "recip_segments_log2"));
  }
  return table;
}

std::string tables_package(const Config& config) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << "// SPDX-License-Identifier: Apache-2.0\n"
      << "// Generated by `quadrille config --emit-tables`. Words are {c0, c1, c2}; see rtl/SPEC.md, Numbers.\n"
      << "package quadrille_tables_pkg;\n"
      << "  // What the tables were made for; quadrille_config_check compares.\n"
      << "  localparam int SIGNIFICAND_BITS = " << config.significand_bits << ";\n"
      << "  localparam int SQRT_SEGMENTS_LOG2 = " << config.sqrt_segments() << ";\n"
      << "  localparam int SQRT_DEGREE = " << config.sqrt_degree << ";\n"
      << "  localparam int RECIP_SEGMENTS_LOG2 = " << config.recip_segments() << ";\n"
      << "  localparam int RECIP_DEGREE = " << config.recip_degree << ";\n";
  emit_rom(out, "sqrt_rom", make_sqrt_table(config), config);
  emit_rom(out, "recip_rom", make_recip_table(config), config);
  out << "endpackage\n";
  return out.str();
}

}  // namespace quadrille
