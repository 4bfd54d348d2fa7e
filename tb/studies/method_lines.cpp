#include "tb/studies/method_lines.hpp"

#include "golden/methods/method.hpp"
#include "tb/studies/method_input.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace quadrille::tb {
namespace {

namespace methods = golden::methods;

/// Closed lines with the mean length of their edges; the mean over all edges as `edge`.
std::vector<compare::Polyline> screen_outlines(const std::vector<std::vector<WindowVertex>>& outlines,
                                               const compare::Crop& crop, double& edge) {
  std::vector<compare::Polyline> lines;
  double length = 0;
  std::size_t edges = 0;
  for (const std::vector<WindowVertex>& outline : outlines) {
    if (outline.empty() || std::ranges::any_of(outline, [](const WindowVertex& v) { return !(v.w > 0); })) continue;
    compare::Polyline line;
    double round = 0;
    for (std::size_t i = 0; i <= outline.size(); ++i) {
      const WindowVertex& v = outline[i % outline.size()];
      line.points.push_back({v.x / v.w - crop.x0, v.y / v.w - crop.y0});
      if (i == 0) continue;
      const auto &a = line.points[i - 1], &b = line.points[i];
      round += std::hypot(b[0] - a[0], b[1] - a[1]);
    }
    edges += outline.size();
    length += round;
    line.edge = round / static_cast<double>(outline.size());
    lines.push_back(std::move(line));
  }
  edge = edges ? length / static_cast<double>(edges) : 0;
  return lines;
}

}  // namespace

std::vector<compare::Polyline> method_lines(const std::string& method, const DrawInput& input, const DrawState& state,
                                            const compare::Crop& crop, double scale) {
  constexpr double finest_edge = 5;  // pixels of the sheet
  const std::unique_ptr<methods::Method> drawn = methods::make_method(method);
  const methods::View view = method_view(state);
  std::vector<std::vector<WindowVertex>> outlines, quads;
  for (const methods::Quad& quad : method_quads(input, method)) {
    quads.emplace_back(quad.vertex.begin(), quad.vertex.end());
    const auto of_quad = drawn->wireframe(quad, view);
    outlines.insert(outlines.end(), of_quad.begin(), of_quad.end());
  }
  double edge = 0;
  std::vector<compare::Polyline> lines = screen_outlines(outlines, crop, edge);
  return edge * scale < finest_edge ? screen_outlines(quads, crop, edge) : lines;
}

}  // namespace quadrille::tb
