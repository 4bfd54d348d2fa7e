// Plain data that passes between the parts: what a draw is, what enters the machine, what leaves it.
// No arithmetic lives here; every part (model, test bench, reference) may include this file and config.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille {

/// A homogeneous window-space vertex as given (Hormann & Tarini eq. 1, viewport included): pixels, y down,
/// pixel centres at +0.5, window z = z/w in [0, 1].
struct WindowVertex {
  double x = 0, y = 0, z = 0, w = 1;
};

/// A quad as given: four vertices in order, `attributes` values per vertex (v0's first).
struct WindowQuad {
  std::uint32_t id = 0;
  std::array<WindowVertex, 4> vertex{};
  std::array<std::vector<double>, 4> attribute{};
};

enum class Cull : std::uint8_t { none = 0, front = 1, back = 2 };

/// What the machine may leave out, but for skip_hidden and skip_plane without changing a fragment; bits of
/// `DrawState::skip`.
enum SkipBit : std::uint32_t {
  skip_tiles = 1u << 0,  ///< blocks and tiles that no covered pixel can be in (tile_walk)
  skip_quads = 1u << 1,  ///< quads that cannot give a fragment (quad_reject)
  /// Tiles of which nothing can be seen (hierarchical_z). Asking for it promises that what comes out is drawn with
  /// depth test LESS and depth writes, that no fragment is discarded afterwards, and nothing blended: the picture is
  /// the same, the list of fragments is not.
  skip_hidden = 1u << 2,
  skip_walk = 1u << 3,  ///< homogeneous quads: what misses the scissor (scissor_separation, tile_walk)
  /// Work inside a pixel that its fragment does not depend on: its operands do not switch, in software it is left out.
  skip_operands = 1u << 4,
  /// Mean value weights of quads whose values are plane (plane_quad): the same pixels and flags, attributes and depth
  /// within the same bound of the exact ones, in other bits.
  skip_plane = 1u << 5,
};
/// Those that keep the list of fragments: on unless switched off.
inline constexpr std::uint32_t skip_default = skip_tiles | skip_quads | skip_walk | skip_operands;

/// Why a quad is left out, the first reason that holds.
enum class QuadReject : std::uint8_t {
  none,
  empty,    ///< no pixel centre of the scissor in the bounding box
  behind,   ///< no w > 0
  depth,    ///< every pixel's depth code is outside [znear, zfar]
  line,     ///< both triangles of expression (12) are degenerate
  culled,   ///< no pixel can have a face that is wanted
  outside,  ///< homogeneous: no triangle that is wanted meets the scissor
};
inline constexpr std::size_t quad_reject_count = 7;

/// Constant over a draw, given to model and RTL alike.
struct DrawState {
  int width = 512, height = 512;       ///< viewport in pixels, at most 2^viewport_bits each
  int scissor_x0 = 0, scissor_y0 = 0;  ///< half-open pixel rectangle, inside the viewport
  int scissor_x1 = 512, scissor_y1 = 512;
  Cull cull = Cull::none;
  bool perspective = true;
  bool depth = true;  ///< window z is computed and clipped; the depth test (LESS, clear 1) is the frame buffer's
  double znear = 0.0, zfar = 1.0;  ///< window z interval; fragments outside are discarded (depth on)
  int attributes = 4;              ///< attributes in use, at most attribute_slots
  std::uint32_t skip = skip_default;
};

/// Significand number at the port: value = (-1)^neg * sig * 2^(exp - (S-1)); sig has exactly S = significand_bits bits,
/// or the number is zero and all three fields are 0.
struct PortNumber {
  bool neg = false;
  std::int32_t exp = 0;
  std::uint32_t sig = 0;
};

inline constexpr int max_attribute_slots = 8;

/// One vertex: integers only. x, y, w in units of 2^-FRAC, relative to pixel CENTRES (pixel (x, y) has its centre
/// at the integers x, y); FRAC = subpixel_bits + homogeneous_frac_bits. The vertex is k times the given one.
struct SnappedVertex {
  std::int32_t x = 0, y = 0, w = 0;
  PortNumber k;  ///< k > 0, rounded to nearest
  PortNumber z;  ///< k * (z~ - base w~), the given w~
  /// k_eff * (a - base); k_eff = k, or W as a real number when perspective is off. Of vertex 0 not looked at: 0.
  std::array<PortNumber, max_attribute_slots> attribute{};
};

/// What the values of a quad are counted from, and where its depths lie. Codes of the output formats.
struct QuadBase {
  std::array<std::int64_t, max_attribute_slots> attribute{};  ///< vertex 0's, attribute_frac_bits fraction bits
  std::uint32_t depth = 0;                                    ///< in [0, 1], depth_bits fraction bits
  /// The least and greatest window z of a corner, depth_bits fraction bits: -1 is below 0, 2^depth_bits + 1 above 1.
  /// A quad with some w <= 0 has these two: its depths lie anywhere.
  std::int32_t depth_low = -1, depth_high = 0;

  friend bool operator==(const QuadBase&, const QuadBase&) = default;
};

struct SnappedQuad {
  std::uint32_t id = 0;
  QuadBase base;
  std::array<SnappedVertex, 4> vertex{};
};

/// What the vertex port takes in one clock. `id` and `base` belong to the quad: those of its first beat count.
struct VertexBeat {
  std::uint32_t id = 0;
  QuadBase base;
  SnappedVertex vertex;
};

/// Beat i of a quad.
inline VertexBeat beat_of(const SnappedQuad& quad, std::size_t i) { return {quad.id, quad.base, quad.vertex[i]}; }

/// Bits of Fragment::flags.
enum FragmentFlag : std::uint8_t {
  flag_on_edge = 1u << 0,     ///< the pixel centre is exactly on one edge
  flag_on_vertex = 1u << 1,   ///< exactly one corner is at the pixel centre
  flag_two_corner = 1u << 2,  ///< two corners are at the pixel centre
  flag_two_edge = 1u << 3,    ///< on two edges at once: the mean of the two edge interpolations
  flag_tie = 1u << 4,  ///< some edge function of expression (12), the diagonal included, is exactly 0 and was decided
                       ///< by the tie rule
  flag_homogeneous =
      1u << 5,               ///< the quad has a vertex that is not ordinary (behind the eye, or outside the guard band)
  flag_notch = 1u << 6,      ///< an edge turns backward as seen from the pixel: neighbouring A differ in sign
  flag_saturated = 1u << 7,  ///< an attribute in use was clamped to its format
};

/// One fragment. depth: unsigned, depth_bits fraction bits, in [0, 1]. attribute: signed, attribute_frac_bits fraction
/// bits.
struct Fragment {
  std::uint32_t quad = 0;
  std::uint16_t x = 0, y = 0;
  bool front = false;
  std::uint8_t flags = 0;
  std::uint32_t depth = 0;
  std::array<std::int64_t, max_attribute_slots> attribute{};

  friend bool operator==(const Fragment&, const Fragment&) = default;
};

}  // namespace quadrille
