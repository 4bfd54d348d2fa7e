#include "golden/scenes/plane_pair.hpp"

#include "golden/scenes/scene_builders.hpp"

#include <utility>

namespace quadrille::golden {
namespace {

Camera camera_of(PlaneView view) {
  Camera camera = view == PlaneView::facing   ? look_from({0, 0, 50}, {0, 0, 0}, 50)
                  : view == PlaneView::turned ? look_from({15, 10, 50}, {0, 0, 0}, 50)
                                              : look_from({0, 5, 0}, {0, 0, -50}, 50);
  camera.near = 0.1;
  camera.far = 100;
  return camera;
}

/// The rectangle from x0 to x1, `down` below the nearer plane.
std::array<Vec3, 4> plane(PlaneView view, double x0, double x1, double down) {
  if (view == PlaneView::floor) return {{{x0, -down, -10}, {x1, -down, -10}, {x1, -down, -90}, {x0, -down, -90}}};
  return {{{x0, -20, -down}, {x1, -20, -down}, {x1, 20, -down}, {x0, 20, -down}}};
}

constexpr double half_width = 20;

}  // namespace

std::string_view plane_view_name(PlaneView view) {
  constexpr std::array<std::string_view, plane_views.size()> names{"facing", "turned", "floor"};
  return names[static_cast<std::size_t>(view)];
}

std::vector<WindowQuad> plane_pair(const PlanePair& pair, int width, int height) {
  Scene scene;
  scene.camera = camera_of(pair.view);
  for (const double down : {0.0, pair.apart}) add_quad(scene.mesh, plane(pair.view, -half_width, half_width, down));
  std::vector<WindowQuad> quads = scene_quads(scene, width, height, AttributeSet::none);
  if (pair.reversed)
    for (WindowQuad& quad : quads)
      for (WindowVertex& v : quad.vertex) v.z = v.w - v.z;
  return quads;
}

Scene plane_strips() {
  Scene scene;
  scene.camera = camera_of(PlaneView::turned);
  scene.camera.fovy = 26;
  scene.shade = "colour";
  constexpr double reach = 20, half_height = 9, strip = 2 * reach / plane_distances.size(), gap = 0.3;
  constexpr double inset = 0.8;  // of the farther plane, which therefore shows nowhere
  const auto add = [&](double x0, double x1, double y, double down) {
    add_quad(scene.mesh, {{{x0, -y, -down}, {x1, -y, -down}, {x1, y, -down}, {x0, y, -down}}});
  };
  for (std::size_t i = 0; i < plane_distances.size(); ++i) {
    const double x0 = -reach + strip * static_cast<double>(i), x1 = x0 + strip - gap;
    add(x0 + inset, x1 - inset, half_height - inset, plane_distances[i]);
    add(x0, x1, half_height, 0);
  }
  constexpr std::array<Vec3, 2> colours{{{0.75, 0.15, 0.1}, {0.85, 0.88, 0.9}}};  // of the farther and the nearer
  for (std::size_t i = 0; i < scene.mesh.positions.size(); ++i) scene.mesh.colours.push_back(colours[i / 4 % 2]);
  return scene;
}

}  // namespace quadrille::golden
