// Creases and gaps of a whole frame: jumps of the slope across the quads' diagonals and anywhere inside them, jumps of
// the value and holes along the edges that quads share.
#pragma once

#include "golden/methods/method.hpp"
#include "tb/studies/compare/line_jump.hpp"
#include "tb/support/error_stats.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace quadrille::compare {

/// One of the two diagonals, over all quads.
struct DiagonalCreases {
  std::uint64_t quads = 0;  ///< with a profile at least
  LineJump jump;
  std::uint32_t worst = AttributeImage::no_quad;  ///< has the largest jump.line_slope, the first of equal ones
};

struct Diagonals {
  DiagonalCreases d02, d13;
};

/// The diagonals of one quad.
struct QuadCreases {
  LineJump d02, d13;
};

/// Per quad, whether its diagonal counts: 0-2 in [0], 1-3 in [1].
using DiagonalSet = std::array<std::vector<bool>, 2>;

/// Element i is of `quads[i]`, which the image calls quad i. Quads with a vertex of w <= 0 have no diagonal on the
/// screen; of the others every profile of a diagonal's middle half counts whose pixels show the quad: none of a
/// diagonal outside of a concave quad or behind another quad. Profiles that the other diagonal crosses as well do not
/// count, so that a crease along one is not found on both. Throws std::invalid_argument when the image shows a quad
/// that is not there.
std::vector<QuadCreases> measure_quad_diagonals(const AttributeImage& image,
                                                std::span<const golden::methods::Quad> quads);

/// The diagonals with a profile at least. Which these are depends on the size of the picture: creases at several sizes
/// compare over the diagonals that are measured at each.
DiagonalSet measured_diagonals(std::span<const QuadCreases> creases);

/// What is in both. Throws std::invalid_argument for sets of different numbers of quads, as combine_diagonals does.
DiagonalSet in_both(const DiagonalSet& a, const DiagonalSet& b);

/// Over the diagonals in `use`.
Diagonals combine_diagonals(std::span<const QuadCreases> creases, const DiagonalSet& use);

/// Over all that are measured.
Diagonals measure_diagonals(const AttributeImage& image, std::span<const golden::methods::Quad> quads);

/// The boundaries between pixels of one quad, each taken for a line with its four pixels on either side.
struct InnerJumps {
  /// Slope jumps as in ProfileJump. count() is the number of boundaries; p999() as in FrameError::error.
  tb::ErrorStats line_slope, parabola_slope;
  std::uint64_t undefined = 0;  ///< boundaries that only an undefined pixel kept from being measured
  /// The largest line_slope, the first of equal ones in rows, x before y: beyond the boundary. x is -1 without any.
  Profile worst{Axis::x, -1, -1, 0};
  std::uint32_t worst_quad = AttributeImage::no_quad;
};

InnerJumps measure_inside(const AttributeImage& image);

/// An edge of exactly two quads: both of its ends are at the same window position and depth in either, in front of the
/// eye, and carry equal attributes.
struct SharedEdge {
  std::array<std::uint32_t, 2> quad{};   ///< rising
  std::array<golden::Vec2, 2> window{};  ///< in pixels
};

/// In the order of the first quad, then of its edges. Positions and attributes are compared bit for bit, which is what
/// vertices of one mesh have; edges of no length are none. An edge that more than two quads touch is left out: its
/// sides are not told apart.
std::vector<SharedEdge> shared_edges(std::span<const golden::methods::Quad> quads);

struct Gaps {
  std::uint64_t edges = 0;     ///< shared ones
  std::uint64_t measured = 0;  ///< of them, with a profile in `jump`
  /// Over the profiles of an edge's middle half in which no diagonal of its quads passes between the eight pixels.
  /// `gap` is how far the two quads' attributes are apart on the edge; their other fits may run across a crease near
  /// it.
  LineJump jump;
  /// The same, of the edges of a quad that is not convex on the screen or reaches behind the eye; not part of `jump`. A
  /// method may fold such a quad over: the picture then jumps where another sheet is in front of the one that ends at
  /// the edge, though the method is continuous.
  LineJump concave;
  std::array<std::uint32_t, 2> worst{AttributeImage::no_quad, AttributeImage::no_quad};  ///< by jump.gap
  /// Pixels whose centre is at most 1 from the middle half of an edge, along the profile, while the profile's fourth
  /// pixels on both sides show the edge's quads, one each.
  std::uint64_t empty = 0;    ///< of these: that show nothing
  std::uint64_t foreign = 0;  ///< of these: that show a third quad, a background seen through the gap for example
};

/// Throws std::invalid_argument when the image shows a quad that is not there.
Gaps measure_gaps(const AttributeImage& image, std::span<const golden::methods::Quad> quads);

}  // namespace quadrille::compare
