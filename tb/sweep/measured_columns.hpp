// The columns that a sweep measures, in one order everywhere: the four weights, the input's attributes, three colours.
#pragma once

#include "model/port/snap.hpp"
#include "tb/sweep/evaluator.hpp"

#include <cstddef>
#include <cstdint>

namespace quadrille::sweep {

struct Columns {
  std::size_t attributes = 0;

  static constexpr std::size_t first_attribute = 4;
  constexpr std::size_t first_colour() const { return first_attribute + attributes; }
  constexpr std::size_t count() const { return first_colour() + 3; }
};
inline constexpr std::size_t max_columns = Columns{max_attribute_slots}.count();

/// Truth is computed at eight pixels at a time.
inline constexpr int lane_count = 8;
using LaneReals = double __attribute__((vector_size(8 * lane_count)));

inline std::uint32_t pack_pixel(int x, int y) {
  return static_cast<std::uint32_t>(y) << 16 | static_cast<std::uint32_t>(x);
}
inline int pixel_x(std::uint32_t pixel) { return static_cast<int>(pixel & 0xffff); }
inline int pixel_y(std::uint32_t pixel) { return static_cast<int>(pixel >> 16); }

/// A quad at the port, in the two passes that carry all columns: its own attributes, then weights and colours. The
/// position in the input is the id. Throws SnapError, which names the quad's own id.
struct PortQuad {
  SnappedQuad own, test;

  PortQuad() = default;
  PortQuad(const WindowQuad& quad, std::size_t index, std::size_t attributes, const Config& config,
           const DrawState& state);
  /// What column `column` has at the port: of a vertex the difference to the base, 0 of vertex 0, and the base, a code
  /// of the output's format.
  PortNumber difference(std::size_t column, std::size_t vertex, const Columns& columns) const;
  std::int64_t base(std::size_t column, const Columns& columns) const;

 private:
  struct Slot {
    const SnappedQuad* pass;
    std::size_t attribute;
  };
  Slot slot(std::size_t column, const Columns& columns) const;
};

/// The quad's first `attributes` attributes alone, 0 where it has fewer.
WindowQuad own_quad(const WindowQuad& quad, std::size_t attributes);
/// The same at the port, its own id with it. Throws SnapError.
SnappedQuad own_port(const WindowQuad& quad, std::size_t attributes, const Config& config, const DrawState& state);

/// Eight slots and any id, since columns are measured and quads numbered whatever the configuration's port is.
Config widest_port(Config config);

}  // namespace quadrille::sweep
