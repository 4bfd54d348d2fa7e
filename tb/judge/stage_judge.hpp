// What every stage must make of its input, in exact integers and numbers (exact_number.hpp), from rtl/SPEC.md alone.
// check_functions() holds the model's functions to it, verify_exact() the vectors of the stage suites. Each function
// says what is wrong, or nothing.
#pragma once

#include "model/front/stamp_coverage.hpp"
#include "model/front/tile_walk.hpp"
#include "model/pixel/pixel_pipeline.hpp"
#include "tb/judge/exact_number.hpp"
#include "tb/judge/function_check.hpp"

#include <optional>
#include <string>

namespace quadrille::tb {

// ---- Front ----

struct SnappingFault {
  std::string text;
  bool undecided = false;  ///< some number needs more than 127 bits; the others were compared
};
/// Of the integers that the port has of a quad, unless it was refused.
SnappingFault snapping_fault(const WindowQuad& given, bool refused, const SnappedQuad& quad, const Config& config,
                             const DrawState& state);

std::string setup_fault(const SnappedQuad& quad, const SetupResult& result, const Config& config,
                        const DrawState& state);

/// A quad seen from a pixel: what its linear and quadratic functions are there.
struct SeenFrom {
  std::array<exact::Wide, 4> x, y, w;

  /// Vertex: SnappedVertex, or RelativeVertex with the pixel counted from its origin.
  template <class Vertex>
  SeenFrom(const std::array<Vertex, 4>& vertex, exact::Wide px, exact::Wide py) {
    for (std::size_t i = 0; i < 4; ++i) {
      w[i] = vertex[i].w;
      x[i] = vertex[i].x - w[i] * px;
      y[i] = vertex[i].y - w[i] * py;
    }
  }
  exact::Wide linear(std::size_t k) const {
    const auto [i, j] = vertex_pair[k];
    return x[i] * y[j] - y[i] * x[j];
  }
  /// Of D (0 to 5) or R² (6 to 9).
  exact::Wide quadratic(std::size_t k) const {
    const auto [i, j] = vertices(k);
    return x[i] * x[j] + y[i] * y[j];
  }
  /// Value, gx, gy and q around this pixel, each without its `drop` lowest bits.
  std::array<exact::Wide, 4> coefficients(std::size_t k, int drop) const {
    const auto [i, j] = vertices(k);
    return {quadratic(k) >> drop, -(x[i] * w[j] + w[i] * x[j]) >> drop, -(y[i] * w[j] + w[i] * y[j]) >> drop,
            (w[i] * w[j]) >> drop};
  }

 private:
  static std::array<std::size_t, 2> vertices(std::size_t k) {
    return k < linear_count ? vertex_pair[k] : std::array{k - linear_count, k - linear_count};
  }
};

/// Of the quadratic functions around a tile's first pixel; an ordinary quad has no dot products there.
std::string quadratic_fault(const SeenFrom& origin, bool homogeneous, const TileEntry& tile, int drop);
/// Of A, D and R² at pixel (dx, dy) of a tile by the tile's functions, and D of an ordinary quad by the law of cosines.
std::string difference_fault(const TileEntry& tile, const QuadConstants& quad, int dx, int dy, const PixelTrace& p);
/// Of a row of a tile, by expression (12) and the tie rule.
std::string coverage_fault(const TileEntry& tile, const QuadConstants& quad, int row, const StampMasks& masks,
                           const Config& config, const DrawState& state);

// ---- Tables and their functions ----

bool is_sqrt(const PipelineFloat& a, const PipelineFloat& root, const TableLimit& limit, int s);
bool is_reciprocal(const PipelineFloat& a, const PipelineFloat& inverse, const TableLimit& limit, int s);
/// Of one entry: every coefficient is specified (golden/README.md, "The tables").
std::string table_fault(bool sqrt, const Config& config, std::size_t index, const TableEntry& entry);

// ---- Pixel ----

/// The stages behind the front, each by what the stage before gave. The tables' own values are taken as they come.
class PixelJudge {
 public:
  explicit PixelJudge(const Config& config) : context_(config, {}), s_(config.significand_bits) {}

  /// What fragment_output makes of the sums.
  struct Output {
    bool drawn = false, saturated = false;
    std::int64_t depth = 0;
    std::array<std::int64_t, max_attribute_slots> attribute{};
  };

  std::string normalised(const PixelTrace& t) const;
  bool notch(const PixelTrace& t) const;
  std::string ratios(const PixelTrace& t) const;
  std::string weights(const PixelTrace& t, const QuadData& quad) const;
  std::string sums(const PixelTrace& t, const QuadData& quad) const;
  Output output(const PixelTrace& t, const QuadData& quad, const DrawState& state) const;
  static std::string values_fault(const Fragment& fragment, const Output& expected);

  /// The singular class by A, D and r², as rtl/SPEC.md defines it.
  struct Class {
    explicit Class(const PixelTrace& t);

    int corners = 0, edges = 0;
    std::array<bool, 4> corner{}, edge{};

    bool two_corner() const { return corners > 1; }
    bool on_vertex() const { return corners == 1; }
    bool two_edge() const { return corners == 0 && edges > 1; }
    bool on_edge() const { return corners == 0 && edges == 1; }
    bool singular() const { return corners > 0 || two_edge(); }
  };

 private:
  bool same(const PipelineFloat& v, const exact::Number& wanted) const { return exact::is(v, wanted, s_); }
  exact::Number real(const PipelineFloat& v) const { return exact::value_of(v, s_); }
  exact::Number size(const PipelineFloat& v) const { return positive(real(v)); }
  static exact::Number positive(exact::Number v) { return {exact::magnitude(v.m), v.e}; }
  exact::Number multiply(const exact::Number& a, const exact::Number& b) const {
    return exact::cut(exact::product(a, b), s_);
  }
  exact::Number sum(std::span<const exact::Term> terms) const {
    return exact::sum(terms, s_, context_.config.align_guard_bits);
  }
  std::array<exact::Number, 2> root_ratio(const PixelTrace& t, std::size_t a, std::size_t b) const;
  std::array<exact::Number, 4> regular_weights(const PixelTrace& t) const;
  std::array<exact::Number, 4> singular_weights(const PixelTrace& t, const Class& is, const QuadData& quad) const;
  std::optional<exact::Wide> quotient(const PipelineFloat& num, const PipelineFloat& den, int int_bits,
                                      int fraction) const;

  const PipelineContext context_;
  const int s_;
};

}  // namespace quadrille::tb
