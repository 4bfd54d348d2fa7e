// `triangle`: the quad as triangles 012 and 023, rasterized in integers as MIT 6.837 (2000), lecture 6, does it. The
// lecture knows no perspective correction, so View::perspective has no effect.
#include "golden/methods/triangle.hpp"

#include "golden/methods/builders.hpp"
#include "golden/methods/weighted_triangle.hpp"

#include <algorithm>
#include <cmath>

namespace quadrille::golden::methods {
namespace integer_triangle {
namespace {

std::int64_t truncate(double value, int bits) { return static_cast<std::int64_t>(std::ldexp(value, bits)); }

/// Java's (int) cast saturates.
std::int64_t saturate(double value, double limit) {
  return static_cast<std::int64_t>(std::clamp(value, -limit, limit));
}

/// The vertices with the smallest and the largest x, by the signs of x1 - x0 (bit 0), x2 - x1 (bit 1), x0 - x2 (bit 2),
/// set where not negative: pattern 1, for example, says x0 <= x1, x2 < x1, x0 < x2. Three differences that sum to 0 are
/// never all negative; all are set only where each truncates to 0 units, and then any vertex is as good as the others.
/// (The lecture's table has six entries and is left by that seventh.)
constexpr std::array<std::array<std::uint8_t, 2>, 7> extremes{{{0, 1}, {1, 2}, {0, 2}, {2, 0}, {2, 1}, {1, 0}, {0, 0}}};

}  // namespace

EdgeEquation::EdgeEquation(Point v0, Point v1, int bits) {
  const double exact_a = v0.y - v1.y, exact_b = v1.x - v0.x;
  a = truncate(exact_a, bits);
  b = truncate(exact_b, bits);
  c = truncate(-0.5 * (exact_a * (v0.x + v1.x) + exact_b * (v0.y + v1.y)), bits);
  flag = (a >= 0 ? 8 : 0) + (b >= 0 ? 1 : 0);
}

void EdgeEquation::flip() { a = -a, b = -b, c = -c; }

std::optional<Triangle> set_up(const std::array<Point, 3>& vertex, int width, int height, int bits) {
  Triangle t;
  t.edge = {EdgeEquation(vertex[0], vertex[1], bits), EdgeEquation(vertex[1], vertex[2], bits),
            EdgeEquation(vertex[2], vertex[0], bits)};
  t.area = t.edge[0].c + t.edge[1].c + t.edge[2].c;
  if (t.area == 0) return std::nullopt;
  if (t.area < 0) {
    for (EdgeEquation& edge : t.edge) edge.flip();
    t.area = -t.area;
    t.flipped = true;
  }

  // The flags side by side: bits 0 to 2 are the signs of B, bits 3 to 5 those of A. B is a step in x from a vertex to
  // the next; A is the negated step in y, so its pattern exchanges the smallest and the largest. (The slide, as it is
  // printed, reads both pairs in the same order.)
  const int flags = t.edge[0].flag + 2 * t.edge[1].flag + 4 * t.edge[2].flag;
  const auto& [left, right] = extremes[static_cast<std::size_t>((flags & 7) - 1)];
  const auto& [bottom, top] = extremes[static_cast<std::size_t>((flags >> 3) - 1)];
  t.x_min = std::max(static_cast<int>(vertex[left].x), 0);
  t.x_max = std::min(static_cast<int>(vertex[right].x + 1), width - 1);
  t.y_min = std::max(static_cast<int>(vertex[top].y), 0);
  t.y_max = std::min(static_cast<int>(vertex[bottom].y + 1), height - 1);
  return t;
}

PlaneEquation plane_equation(const Triangle& triangle, const std::array<double, 3>& p, int bits) {
  const double scale = std::ldexp(1.0, bits) / static_cast<double>(triangle.area);
  // Vertex i faces the edge that begins at the vertex after it.
  const auto coefficient = [&](std::int64_t EdgeEquation::*k, double limit) {
    const double sum = static_cast<double>(triangle.edge[1].*k) * p[0] +
                       static_cast<double>(triangle.edge[2].*k) * p[1] +
                       static_cast<double>(triangle.edge[0].*k) * p[2];
    return saturate(sum * scale, limit);
  };
  return {coefficient(&EdgeEquation::a, 0x1p45), coefficient(&EdgeEquation::b, 0x1p45),
          coefficient(&EdgeEquation::c, 0x1p61)};
}

EdgePrecision edge_precision(std::span<const std::array<FloatPoint, 2>> edges, int bits) {
  EdgePrecision out;
  const auto add = [bits](Error& error, double difference) {
    const double units = std::ldexp(std::abs(difference), bits);
    error.max = std::max(error.max, units);
    error.rms += units * units;
  };
  for (const auto& [v0, v1] : edges) {
    // Products of two floats are exact in double; their difference is off by 2^-53 of it.
    const double exact =
        static_cast<double>(v0.x) * static_cast<double>(v1.y) - static_cast<double>(v1.x) * static_cast<double>(v0.y);
    const float naive = v0.x * v1.y - v1.x * v0.y;
    const float a = v0.y - v1.y, b = v1.x - v0.x, sum_x = v0.x + v1.x, sum_y = v0.y + v1.y;
    const float averaged = -0.5f * (a * sum_x + b * sum_y);
    const double printed = -0.5 * (static_cast<double>(a) * static_cast<double>(sum_x) +
                                   static_cast<double>(b) * static_cast<double>(sum_y));
    add(out.naive, static_cast<double>(naive) - exact);
    add(out.averaged, static_cast<double>(averaged) - exact);
    add(out.printed, printed - exact);
  }
  for (Error* error : {&out.naive, &out.averaged, &out.printed}) {
    if (!edges.empty()) error->rms = std::sqrt(error->rms / static_cast<double>(edges.size()));
  }
  return out;
}

}  // namespace integer_triangle

namespace {

constexpr double colour_max = 255;  // the lecture's parameters are bytes: opacity and three colours, here four weights
constexpr int depth_bits = 16;      // more than a colour gets

bool drawable(const Quad& quad) {
  return std::ranges::all_of(quad.vertex, [](const WindowVertex& v) {
    return v.w > 0 && std::abs(v.x / v.w) < integer_triangle::guard_band &&
           std::abs(v.y / v.w) < integer_triangle::guard_band;
  });
}

class TriangleMethod final : public Method {
 public:
  explicit TriangleMethod(int bits) : bits_(bits) {}

  std::string name() const override { return "triangle:" + std::to_string(bits_); }

  void draw(const Quad& quad, const View& view, std::vector<MethodSample>& out) const override {
    if (!drawable(quad)) return;
    draw_part(quad, {0, 1, 2}, view, out);
    if (!is_triangle(quad)) draw_part(quad, {0, 2, 3}, view, out);
  }

  Census census(std::span<const Quad> quads, const View&) const override {
    Census census{.quads = quads.size()};
    for (const Quad& quad : quads) {
      if (drawable(quad)) {
        ++census.emitted_quads;
        census.triangles += is_triangle(quad) ? 1 : 2;
      } else {
        ++census.refused;
      }
    }
    return census;
  }

  std::vector<std::vector<WindowVertex>> wireframe(const Quad& quad, const View&) const override {
    if (!drawable(quad)) return {};
    const auto& [v0, v1, v2, v3] = quad.vertex;
    if (is_triangle(quad)) return {{v0, v1, v2}};
    return {{v0, v1, v2}, {v0, v2, v3}};
  }

 private:
  void draw_part(const Quad& quad, const std::array<std::size_t, 3>& corner, const View& view,
                 std::vector<MethodSample>& out) const {
    std::array<integer_triangle::Point, 3> vertex;
    std::array<double, 3> depth{};
    for (std::size_t i = 0; i < 3; ++i) {
      const WindowVertex& v = quad.vertex[corner[i]];
      vertex[i] = {v.x / v.w - 0.5, v.y / v.w - 0.5};
      depth[i] = std::ldexp(v.z / v.w, depth_bits);
    }
    const auto triangle = integer_triangle::set_up(vertex, view.width, view.height, bits_);
    if (!triangle) return;

    std::array<integer_triangle::PlaneEquation, 5> plane;
    for (std::size_t k = 0; k < 4; ++k) {
      std::array<double, 3> colour{};
      for (std::size_t i = 0; i < 3; ++i) colour[i] = corner[i] == k ? colour_max : 0;
      plane[k] = integer_triangle::plane_equation(*triangle, colour, bits_);
    }
    plane[4] = integer_triangle::plane_equation(*triangle, depth, bits_);

    const double top = std::ldexp(colour_max, bits_);
    integer_triangle::scan(*triangle, plane, true, [&](int x, int y, const std::array<std::int64_t, 5>& value) {
      MethodSample sample{.x = x, .y = y, .front = triangle->flipped};
      // The lecture drops the fraction bits and then clamps to a byte; here they stay.
      for (std::size_t k = 0; k < 4; ++k) {
        sample.lambda[k] = std::clamp(static_cast<double>(value[k]), 0.0, top) / top;
      }
      sample.z = std::ldexp(static_cast<double>(value[4]), -bits_ - depth_bits);
      out.push_back(sample);
    });
  }

  int bits_;
};

}  // namespace

std::unique_ptr<Method> make_triangle(int fraction_bits) { return std::make_unique<TriangleMethod>(fraction_bits); }

}  // namespace quadrille::golden::methods
