// A quad as FragmentChecker judges it, with what its counters need. Not for use outside this folder.
#pragma once

#include "tb/judge/check.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <string>
#include <tuple>

namespace quadrille::tb {

inline constexpr double near_edge_distance = 1.0 / 16;  // pixels
inline constexpr double near_vertex_distance = 1;

inline auto order(const Place& p) { return std::tuple(p.index, p.y, p.x); }

inline std::string text_of(const Place& place, const std::string& what) {
  char head[96];
  std::snprintf(head, sizeof head, "quad %u, pixel (%d, %d): ", place.quad, place.x, place.y);
  return head + what;
}

/// Distances of pixel centres to edges and corners of a quad, in double: for counting only.
class Vicinity {
 public:
  explicit Vicinity(const SnappedQuad& quad) {
    for (std::size_t i = 0; i < 4; ++i) {
      x_[i] = quad.vertex[i].x;
      y_[i] = quad.vertex[i].y;
      w_[i] = quad.vertex[i].w;
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t j = (i + 1) % 4;
      slope_[i] = std::hypot(y_[i] * w_[j] - w_[i] * y_[j], w_[i] * x_[j] - x_[i] * w_[j]);
    }
  }

  struct Near {
    bool edge = false, vertex = false;
  };
  Near at(int px, int py) const {
    Near near;
    std::array<double, 4> x, y;
    for (std::size_t i = 0; i < 4; ++i) {
      x[i] = x_[i] - w_[i] * px;
      y[i] = y_[i] - w_[i] * py;
      // Squares of integers: what is as near as the limit stays exact.
      const double square = x[i] * x[i] + y[i] * y[i], limit = w_[i] * w_[i];
      near.vertex = near.vertex || (w_[i] != 0 && square <= limit * (near_vertex_distance * near_vertex_distance));
      near.edge = near.edge || (w_[i] != 0 && square <= limit * (near_edge_distance * near_edge_distance));
    }
    for (std::size_t i = 0; i < 4 && !near.edge; ++i) {
      const std::size_t j = (i + 1) % 4;
      if (x[i] * x[j] + y[i] * y[j] > 0) continue;  // beside the edge, not on its line beyond the ends
      near.edge = std::fabs(x[i] * y[j] - y[i] * x[j]) <= slope_[i] * near_edge_distance;
    }
    return near;
  }

 private:
  std::array<double, 4> x_{}, y_{}, w_{}, slope_{};
};

/// One quad as it is judged, with what the counters need.
class FragmentChecker::Reference : public JudgedQuad {
 public:
  Reference(const FragmentChecker& checker, std::size_t index)
      : JudgedQuad(checker.snapped_[index], checker.settings_.config, checker.bounds_, truth_state(checker)),
        eye_crossing(is_eye_crossing(quad())),
        tiny(is_tiny(quad(), checker.settings_.config)),
        vicinity(quad()) {
    if (checker.settings_.snapping)
      given.emplace(pass_quad(checker.given_[index], checker.settings_.pass), truth_state(checker));
  }

  std::optional<golden::TruthQuad> given;
  bool eye_crossing, tiny;
  Vicinity vicinity;

 private:
  /// The weights come with every sample; only true attributes are asked for.
  static DrawState truth_state(const FragmentChecker& checker) {
    DrawState state = checker.settings_.state;
    const std::vector<int>& columns = checker.settings_.pass.columns;
    if (std::all_of(columns.begin(), columns.end(), [](int column) { return column < 4; })) state.attributes = 0;
    return state;
  }
};

}  // namespace quadrille::tb
