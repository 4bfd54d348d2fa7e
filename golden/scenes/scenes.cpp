#include "golden/scenes/scenes.hpp"

#include "golden/scenes/scene_builders.hpp"
#include "model/support/edit_distance.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace quadrille::golden {
namespace {

std::vector<SceneEntry> figure_entries() {
  std::vector<SceneEntry> all;
  for (const auto part :
       {figure_scenes(), exterior_scenes(), surface_scenes(), affinity_scenes(), sphere_scenes(), adaptive_scenes()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

Scene build(const SceneEntry& entry) {
  Scene scene = entry.build();
  scene.name = entry.name;
  scene.title = entry.title;
  scene.paper = entry.paper;
  return scene;
}

std::vector<SceneInfo> list(std::span<const SceneEntry> entries) {
  std::vector<SceneInfo> list;
  for (const SceneEntry& entry : entries) {
    const Scene scene = build(entry);
    list.push_back({scene.name, scene.title, scene.paper, scene.mesh.faces.size()});
  }
  return list;
}

}  // namespace

void add_quad(Mesh& mesh, const std::array<Vec3, 4>& corners, const std::array<Vec2, 4>& textures) {
  Face face;
  for (std::size_t i = 0; i < 4; ++i) {
    face.push_back({static_cast<int>(mesh.positions.size()), static_cast<int>(mesh.texcoords.size()), -1});
    mesh.positions.push_back(corners[i]);
    mesh.texcoords.push_back(textures[i]);
  }
  mesh.faces.push_back(std::move(face));
}

Camera look_from(const Vec3& eye, const Vec3& target, double fovy) {
  Camera camera;
  camera.eye = eye;
  camera.target = target;
  camera.fovy = fovy;
  camera.near = 0.5;
  camera.far = 50;
  return camera;
}

std::vector<SceneInfo> list_scenes() { return list(figure_entries()); }
std::vector<SceneInfo> list_workloads() { return list(workload_scenes()); }

Scene make_scene(std::string_view name) {
  auto entries = figure_entries();
  entries.insert(entries.end(), workload_scenes().begin(), workload_scenes().end());
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const SceneEntry& e) { return e.name == name; });
  if (found != entries.end()) return build(*found);
  throw std::invalid_argument("no scene '" + std::string(name) + "'" + did_you_mean(name, entries, &SceneEntry::name));
}

std::vector<WindowQuad> scene_quads(const Scene& scene, int width, int height, AttributeSet attributes) {
  return project_mesh(scene.mesh, scene.camera, width, height, {attributes, false}).quads;
}

void fit_positions(std::vector<WindowQuad>& quads, CuttingPlanes& planes) {
  double largest = 0;
  for (const WindowQuad& quad : quads)
    for (const std::vector<double>& position : quad.attribute)
      for (const double c : position) largest = std::max(largest, std::fabs(c));
  double scale = 1;
  while (largest * scale > 2) scale /= 2;
  for (WindowQuad& quad : quads)
    for (std::vector<double>& position : quad.attribute)
      for (double& c : position) c *= scale;
  planes.spacing *= scale;
}

}  // namespace quadrille::golden
