// `twofold`: the scan-line rasterizer for a whole projected quad (Hormann & Tarini section 1, after Segal & Akeley
// 2003; Duff 1979): linear along the edges to the scan line, then linear along the span. Its derivative jumps across
// the horizontal lines through the corners.
#include "golden/methods/builders.hpp"

#include <algorithm>
#include <cmath>

namespace quadrille::golden::methods {
namespace {

/// A corner on the screen.
struct Corner {
  double x = 0, y = 0, z = 0;
  double inverse_w = 1;  ///< 1 where attributes are interpolated in screen space
};

/// Where a scan line meets an edge. `weight` holds the corners' weights over w, whose sum is 1/w: both are linear on
/// the screen.
struct Crossing {
  double x = 0, z = 0;
  std::array<double, 4> weight{};
  bool down = false;  ///< the edge runs down the screen, from corner i to corner i + 1
};

bool drawable(const Quad& quad) {
  return std::ranges::all_of(quad.vertex, [](const WindowVertex& v) {
    return v.w > 0 && std::isfinite(1 / v.w) && std::isfinite(v.x / v.w) && std::isfinite(v.y / v.w);
  });
}

/// The first pixel whose centre is at or right of (below) a coordinate, clipped to [0, size].
int first_centre(double coordinate, int size) {
  return static_cast<int>(std::clamp(std::ceil(coordinate - 0.5), 0.0, static_cast<double>(size)));
}

/// The crossing of the line y with the edge between two corners, from the upper to the lower end whichever way the quad
/// walks it: neighbours get the same x in every bit. The product comes before the quotient so that a crossing which a
/// double holds comes out exactly.
Crossing cross(const std::array<Corner, 4>& corner, std::size_t from, std::size_t to, double y) {
  Crossing c{.down = corner[from].y < corner[to].y};
  const std::size_t high = c.down ? from : to, low = c.down ? to : from;
  const Corner &a = corner[high], &b = corner[low];
  const double t = (y - a.y) / (b.y - a.y);
  c.x = a.x + (y - a.y) * (b.x - a.x) / (b.y - a.y);
  c.z = std::lerp(a.z, b.z, t);
  c.weight[high] = (1 - t) * a.inverse_w;
  c.weight[low] = t * b.inverse_w;
  return c;
}

/// The crossings of the line y with the quad's edges, sorted by x: none, 2 or 4. An edge holds its upper end and not
/// its lower one, so that horizontal edges are never met.
void find_crossings(const std::array<Corner, 4>& corner, double y, std::vector<Crossing>& out) {
  out.clear();
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t next = (i + 1) & 3;
    if ((corner[i].y <= y) != (corner[next].y <= y)) out.push_back(cross(corner, i, next, y));
  }
  std::ranges::sort(out, {}, &Crossing::x);
}

void draw_span(const Crossing& left, const Crossing& right, bool front, int y, int width,
               std::vector<MethodSample>& out) {
  const int end = first_centre(right.x, width);
  for (int x = first_centre(left.x, width); x < end; ++x) {
    // Evaluated at every centre: no error adds up along the span, and the fractional offset from the edge to the first
    // centre (lecture 6 of MIT 6.837, slide 8) needs no step of its own.
    const double s = (x + 0.5 - left.x) / (right.x - left.x);
    MethodSample sample{.x = x, .y = y, .front = front};
    sample.z = std::lerp(left.z, right.z, s);
    double inverse_w = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      sample.lambda[i] = std::lerp(left.weight[i], right.weight[i], s);
      inverse_w += sample.lambda[i];
    }
    for (double& lambda : sample.lambda) lambda /= inverse_w;
    out.push_back(sample);
  }
}

class Twofold final : public Method {
 public:
  std::string name() const override { return "twofold"; }

  void draw(const Quad& quad, const View& view, std::vector<MethodSample>& out) const override {
    if (!drawable(quad)) return;
    std::array<Corner, 4> corner;
    for (std::size_t i = 0; i < 4; ++i) {
      const WindowVertex& v = quad.vertex[i];
      corner[i] = {v.x / v.w, v.y / v.w, v.z / v.w, view.perspective ? 1 / v.w : 1};
    }
    const auto [highest, lowest] = std::ranges::minmax(corner, {}, &Corner::y);
    std::vector<Crossing> crossings;
    const int end = first_centre(lowest.y, view.height);
    for (int y = first_centre(highest.y, view.height); y < end; ++y) {
      find_crossings(corner, y + 0.5, crossings);
      if (crossings.empty()) continue;
      // Down on the left or up on the right is counter-clockwise. Asked of the outer crossings: where two spans touch,
      // the inner ones are in no particular order.
      draw_span(crossings[0], crossings[1], crossings.front().down, y, view.width, out);
      if (crossings.size() == 4) draw_span(crossings[2], crossings[3], !crossings.back().down, y, view.width, out);
    }
  }

  Census census(std::span<const Quad> quads, const View&) const override {
    Census census{.quads = quads.size()};
    census.emitted_quads = static_cast<std::uint64_t>(std::ranges::count_if(quads, drawable));
    census.refused = census.quads - census.emitted_quads;
    return census;
  }

  std::vector<std::vector<WindowVertex>> wireframe(const Quad& quad, const View& view) const override {
    if (!drawable(quad)) return {};
    return Method::wireframe(quad, view);
  }
};

}  // namespace

std::unique_ptr<Method> make_twofold() { return std::make_unique<Twofold>(); }

}  // namespace quadrille::golden::methods
