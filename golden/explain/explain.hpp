// One pixel of a draw, taken apart: each number that the machine forms on the way, what it stands for, what exact
// arithmetic has there, and which rule covered the pixel or did not. Plain records, without files or options; text,
// JSON and HTML are made from them.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace quadrille::explain {

/// A field of a boundary's record (model/port/boundaries.hpp, golden/vectors), which holds a number or a part of it.
struct Field {
  std::string name;
  int index = -1;  ///< element of an array, or -1
  int width = 1;
  bool is_signed = false;   ///< two's complement
  std::uint64_t value = 0;  ///< its bits, extended by sign where is_signed

  std::string label() const;  ///< "a[3]", as manifests of golden vectors and messages of `cosim` have it
  std::string text() const;   ///< its integer in decimal
};

/// A number as the machine stores it, beside the exact one.
struct Number {
  /// integer: a count, a place, bits. fixed: integer · 2^-fraction_bits. significand: ± sig · 2^(exp - fraction_bits).
  enum class Format { integer, fixed, significand };

  std::string name;  ///< "A01": edge function of corners 0 and 1
  std::string meaning;
  std::string unit;  ///< of `value` and `exact`: px, px², or none
  Format format = Format::integer;
  int fraction_bits = 0;
  std::vector<Field> stored;  ///< significand: sign, exponent, significand
  double value = 0;           ///< what it stands for, in `unit`
  bool unused = false;        ///< the machine does not need it at this pixel; it holds 0

  // With exact arithmetic on the same snapped corners; none where nothing but the stored integer says more.
  std::optional<double> exact;  ///< in `unit`, rounded to double
  std::string exact_digits;     ///< with 30 significant digits, of 113 bits
  double error_ulp = 0;         ///< (value - exact) in units of the last stored place
  /// How many such units the error may have; 0: none, it is exact by construction. None where no bound is stated.
  std::optional<double> bound_ulp;
  std::optional<double> of_bound;  ///< |error| / bound; 0 where both are 0
  std::optional<double> given;     ///< of outputs: the exact value of the corners as given, without snapping

  /// The same fields of another machine (compare()).
  std::vector<Field> other;
  bool differs = false;
};

/// What one unit of the machine makes of the pixel.
struct Stage {
  std::string name;      ///< "diff"
  std::string title;     ///< one sentence
  std::string unit;      ///< module of rtl/
  std::string boundary;  ///< whose record the numbers are: probe or port; empty: of none
  std::vector<std::string> formulas;
  std::string source;  ///< of the formula: the paper's equation
  std::vector<std::string> remarks;
  std::vector<Number> numbers;
  enum class Compared { no, same, differs } compared = Compared::no;  ///< with another machine
};

/// One of the five edge functions of expression (12) at the pixel.
struct Edge {
  std::string name;     ///< "E01"
  double value = 0;     ///< px²; 0 on the line through the two corners
  double distance = 0;  ///< of the pixel centre from that line in px, with the sign of `value`
  int sign = 0;         ///< -1, 1; 0: the corners coincide, and it decides nothing
  bool tie = false;     ///< `value` is 0, and the tie rule chose the sign
  std::string why;      ///< how the tie rule chose
};

enum class Outcome {
  drawn,
  refused,       ///< the quad's corners are no input of the machine
  left_out,      ///< the whole quad cannot give a fragment (QuadReject)
  outside,       ///< no clause of expression (12) holds
  behind_eye,    ///< one does, for the part of the quad behind the eye
  culled,        ///< its face is not wanted
  scissor,       ///< outside the scissor rectangle
  eye_in_hull,   ///< covered, but the sum of M W says behind the eye
  depth_limits,  ///< covered, but window z is outside [znear, zfar]
};
const char* outcome_name(Outcome outcome);

/// One quad at the pixel.
struct Explanation {
  std::uint32_t quad = 0;  ///< its id
  std::size_t index = 0;   ///< its position in the draw
  int x = 0, y = 0;        ///< the pixel
  Outcome outcome = Outcome::outside;
  QuadReject reject = QuadReject::none;  ///< of left_out
  std::string why;                       ///< a sentence: the rule that covered the pixel or rejected it
  double missed_by = 0;                  ///< of outside: px from the quad's outline; infinite if some w <= 0
  bool seen = false;  ///< of the fragments at the pixel the nearest (depth test LESS), or without depth the last

  bool homogeneous = false;
  int clause = 0;                  ///< of expression (12): 1 or 2; 0: none holds
  bool front = false;              ///< counter-clockwise on the screen: the negated form of (12)
  std::array<Edge, 5> edges{};     ///< E01 E12 E23 E30 E20
  std::string place;               ///< of the pixel in the quad: "inside", "on an edge", …
  std::vector<std::string> flags;  ///< of the fragment, by name
  std::vector<std::string> remarks;
  std::vector<Stage> stages;  ///< of a quad that is not refused; from `setup` on of one that is not left out

  /// Covered by (12), in front of the eye, not culled, inside the scissor: the machine's pipeline sees it.
  bool covered() const;
};

/// Every quad of a draw at pixel (x, y), each by itself: with skip_hidden the machine may draw fewer. Stages stand
/// where covered() is true, and of quads that are not covered where the draw has only one. Attributes beyond
/// state.attributes are not looked at. Throws ConfigError, DrawStateError, and std::invalid_argument for a pixel
/// outside the viewport.
std::vector<Explanation> explain(const Config& config, const DrawState& state, std::span<const WindowQuad> quads, int x,
                                 int y);

/// The same of a quad at the port; without the stages `snapping` has of the given corners and `lambda`.
Explanation explain(const Config& config, const DrawState& state, const SnappedQuad& quad, int x, int y);

/// An object: keys are the members' names. Text is UTF-8.
std::string to_json(const Explanation& explanation);
/// For a terminal of 100 columns. `whole`: with the coefficients of quad and tile.
std::string to_text(const Explanation& explanation, bool whole = false);
/// One self-contained page about several quads at a pixel; `title` and `command` are shown as they are.
std::string to_html(std::span<const Explanation> explanations, const std::string& title, const std::string& command);
/// Of a pixel that no quad covers: how many each rule rejected, and the nearest of them.
std::string summary(std::span<const Explanation> explanations);

/// Of the quads outside the one that misses the pixel by least; null: none is outside.
const Explanation* nearest_outside(std::span<const Explanation> explanations);

}  // namespace quadrille::explain
