// What positions, significand_bits and the formats of the outputs fix together (port_key): the numbers at the port,
// exact arithmetic on them, and what snapping alone did.
#pragma once

#include "tb/support/error_stats.hpp"
#include "tb/sweep/position_data.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace quadrille::sweep {

/// Errors by Output.
using OutputStats = std::array<tb::ErrorStats, outputs.size()>;

/// A quad's numbers at the port as exact arithmetic sees them (W is not cut to S bits): bases, and differences to them.
struct TruthNumbers {
  std::array<double, 4> k{}, w{}, z{};
  double depth = 0, depth_low = 0, depth_high = 0;
  std::array<std::array<double, 4>, max_columns> b{};
  std::array<double, max_columns> base{};
  bool measured = true;
};

/// How far values are apart at the corners of a quad: what errors of attributes and depth are bounded by. Largest of
/// all quads that cover a pixel and are measured.
struct Spread {
  double attribute = 0;
  std::optional<double> depth = 0.0;  ///< none: some quad has a vertex that is not before the eye, its depths no bound

  void merge(const Spread& other);
};

/// Truth of a block: window z, then the columns.
inline constexpr std::size_t truth_per_block(const Columns& columns) { return 1 + columns.count(); }

class PortQuads {
 public:
  PortQuads(const SweepInput& input, const GivenTruth& given, const PositionData& positions, const Config& config,
            unsigned threads, const Stop& stop = {});

  const PortQuad& quad(std::size_t quad) const { return quads_[quad]; }
  /// Truth on the snapped quads against truth on the given ones, at pixels that both draw.
  const OutputStats& snapping() const { return snapping_; }
  const Spread& spread() const { return spread_; }
  /// Pixels that exact arithmetic on the snapped quads draws.
  std::uint64_t drawn() const { return drawn_; }
  std::size_t bytes() const;

  /// Exact arithmetic at `count` blocks from `first`: truth_per_block() values each, and masks of the lanes that it
  /// draws (visible, window z in the interval) and of those where errors are measured: visible, and not of a quad with
  /// a vertex behind the eye drawn without perspective, whose weights may cancel without limit.
  ///
  /// Window z is clamped to the codes of the quad's corners, and its interval ends at the codes of znear and zfar.
  ///
  /// Plain double is enough. M has one sign where the quad covers (Hormann & Tarini) and k > 0, so Σ M k does not
  /// cancel and λ' carries a few 2^-53: 2^-24 of the smallest unit, 2^-29. Window z and what has no perspective may
  /// have W of mixed signs in Σ M W and carry z_condition times that, as the machine's own results do with 2^-S.
  void truth(const SweepInput& input, const PositionData& positions, std::size_t first, std::size_t count,
             LaneReals* values, std::uint8_t* draws, std::uint8_t* measured) const;

 private:
  /// M at a singular pixel holds k.
  struct SingularPixel {
    std::size_t block, lane;
    bool visible;
    std::array<double, 4> m;
  };

  std::vector<PortQuad> quads_;
  std::vector<TruthNumbers> truth_;
  std::vector<SingularPixel> singular_;  ///< by block
  double znear_, zfar_;                  ///< as the machine's codes
  OutputStats snapping_;
  std::uint64_t drawn_ = 0;
  Spread spread_;
};

}  // namespace quadrille::sweep
