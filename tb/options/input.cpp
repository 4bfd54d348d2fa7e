#include "tb/options/input.hpp"

#include "golden/io/atomic_file.hpp"
#include "golden/io/camera.hpp"
#include "golden/io/error.hpp"
#include "golden/io/json_report.hpp"
#include "golden/io/merge_pairs.hpp"
#include "golden/io/mesh_format.hpp"
#include "golden/io/obj.hpp"
#include "golden/io/quads_file.hpp"
#include "golden/io/text_input.hpp"
#include "golden/scenes/corner_quads.hpp"
#include "golden/scenes/projection.hpp"
#include "golden/scenes/scenes.hpp"
#include "golden/scenes/stress.hpp"
#include "tb/support/choices.hpp"
#include "tb/support/errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace quadrille::tb {
namespace {

using golden::AttributeSet;

AttributeLayout layout_of(AttributeSet set) {
  switch (set) {
    case AttributeSet::uv:
      return AttributeLayout::uv;
    case AttributeSet::normal:
      return AttributeLayout::normal;
    case AttributeSet::uv_normal:
      return AttributeLayout::uv_normal;
    case AttributeSet::position:
      return AttributeLayout::position;
    case AttributeSet::colour:
      return AttributeLayout::colour;
    default:
      return AttributeLayout::none;
  }
}

/// What the projection needs to carry for a shading; the weights come with every draw.
AttributeSet attributes_for(const std::string& shade) {
  const AttributeSet set = golden::attributes_for_shade(shade);
  return set == AttributeSet::weights ? AttributeSet::none : set;
}

/// An axis with or without sign, or three numbers. Throws UsageError naming `option`.
golden::Vec3 parse_direction(const std::string& option, const std::string& text, const char* others = "") {
  golden::Vec3 direction{};
  const std::string_view axis = text.find_first_of("+-") == 0 ? std::string_view(text).substr(1) : text;
  if (axis.size() == 1 && axis[0] >= 'x' && axis[0] <= 'z') {
    direction[static_cast<std::size_t>(axis[0] - 'x')] = text[0] == '-' ? -1 : 1;
    return direction;
  }
  std::string_view rest = text;
  bool good = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t end = i < 2 ? std::min(rest.find(','), rest.size()) : rest.size();
    const golden::Number number = golden::parse_number(rest.substr(0, end));
    good = good && number.problem.empty();
    direction[i] = number.value;
    rest.remove_prefix(std::min(rest.size(), end + 1));
  }
  if (!good || direction == golden::Vec3{})
    throw UsageError(option + " " + text + ": expected " + others +
                     "x, y or z with or without a sign, or a direction X,Y,Z that is not 0,0,0");
  return direction;
}

/// --up and --view.
golden::Viewpoint parse_view(const InputOptions& options) {
  golden::Viewpoint view;
  if (!options.up.empty()) view.up = parse_direction("--up", options.up);
  const golden::Sides sides = golden::sides_of(view.up);
  const auto opposite = [](const golden::Vec3& v) { return golden::Vec3{-v[0], -v[1], -v[2]}; };
  const std::array<std::pair<std::string_view, golden::Vec3>, 6> named{{{"front", sides.front},
                                                                        {"back", opposite(sides.front)},
                                                                        {"right", sides.right},
                                                                        {"left", opposite(sides.right)},
                                                                        {"top", sides.up},
                                                                        {"bottom", opposite(sides.up)}}};
  for (const auto& [name, from] : named)
    if (options.view == name) view.from = from;
  if (!options.view.empty() && !view.from)
    view.from = parse_direction("--view", options.view, "front, back, left, right, top, bottom, ");
  return view;
}

/// --light, or what suits the input: a headlight for a mesh, whose top is unknown.
void set_light(const InputOptions& options, Lighting& lighting) {
  if (options.light == "headlight" || (options.light.empty() && !options.mesh.empty()))
    lighting.to_light = lighting.to_eye;
  else if (!options.light.empty())
    lighting.to_light = parse_direction("--light", options.light, "headlight, ");
}

/// A dozen planes across the longest side of the box around the corners.
golden::CuttingPlanes planes_across(const std::vector<std::array<golden::Vec3, 4>>& corners) {
  std::size_t longest = 0;
  double length = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double low = INFINITY, high = -INFINITY;
    for (const auto& quad : corners)
      for (const golden::Vec3& p : quad) low = std::min(low, p[axis]), high = std::max(high, p[axis]);
    if (high - low > length) length = high - low, longest = axis;
  }
  golden::CuttingPlanes planes{{0, 0, 0}, length > 0 ? length / 12 : 1};
  planes.normal[longest] = 1;
  return planes;
}

void need_colours(const golden::Mesh& mesh, const DrawInput& input) {
  if (input.shade == "colour" && mesh.colours.empty())
    throw UsageError("--shade colour: " + input.name + " has no colours");
}

/// For quads that were never an object in space.
void need_no_object(const DrawInput& input) {
  if (input.shade == "planes" || input.shade == "colour")
    throw UsageError("--shade " + input.shade + ": the quads of " + input.name + " have no " +
                     (input.shade == "planes" ? "positions in space; use --scene or --mesh"
                                              : "colours; a mesh may have them, or a .quads file with the line "
                                                "# attributes: red green blue"));
}

/// Projects, with what is wrong told as an input error of `place`.
void project(const golden::Mesh& mesh, const golden::Camera& camera, int width, int height, bool strict,
             unsigned threads, const std::string& place, DrawInput& input) {
  golden::ProjectOptions options;
  options.threads = threads;
  options.attributes = attributes_for(input.shade);
  options.strict = strict;
  golden::Projection projection;
  try {
    projection = golden::project_mesh(mesh, camera, width, height, options);
  } catch (const std::invalid_argument& error) {
    throw golden::InputError(place + ": " + error.what());
  }
  input.quads = std::move(projection.quads);
  input.corners = std::move(projection.corners);
  input.textures = std::move(projection.textures);
  input.planes = planes_across(input.corners);
  input.attributes = golden::attribute_count(options.attributes);
  input.layout = layout_of(options.attributes);
  const auto names = golden::attribute_names(options.attributes);
  input.attribute_names.assign(names.begin(), names.end());
  input.lighting.to_eye = golden::direction_to_eye(camera);
  input.faces = mesh.faces.size();
  input.triangles = projection.triangles;
  input.fanned_faces = projection.fanned_faces;
  input.crossed_faces = projection.crossed_faces;
  input.fan_primitives = projection.fan_primitives;
  input.skipped_lines = mesh.skipped_lines;
}

/// Faces without vt get the corners of the picture.
void remark_on_texture(const golden::Mesh& mesh, DrawInput& input) {
  if (input.layout != AttributeLayout::uv && input.layout != AttributeLayout::uv_normal) return;
  const auto bare =
      std::ranges::count_if(mesh.faces, [](const golden::Face& face) { return face.front().texcoord < 0; });
  if (bare == 0) return;
  const std::size_t faces = mesh.faces.size();
  const bool all = static_cast<std::size_t>(bare) == faces;
  input.remark = (all ? "no face" : std::to_string(bare) + " of " + std::to_string(faces) + " faces") +
                 std::string(all ? " has" : " have no") + " texture coordinates (vt); --shade " + input.shade +
                 " puts the whole picture on each";
}

/// What the reader noted; the first of many.
void remark_on_reading(const golden::Mesh& mesh, DrawInput& input) {
  if (mesh.notes.empty()) return;
  if (!input.remark.empty()) input.remark += "; ";
  input.remark += mesh.notes.front();
  if (mesh.notes.size() > 1) input.remark += " (and " + std::to_string(mesh.notes.size() - 1) + " more of these)";
}

void load_scene(const InputOptions& options, const std::string& shade, int width, int height, DrawInput& input) {
  std::vector<std::string> names = scene_names();
  std::ranges::copy(workload_names(), std::back_inserter(names));
  choose("scene", options.scene, names);
  const golden::Scene scene = golden::make_scene(options.scene);
  input.name = scene.name;
  input.title = scene.title;
  input.paper = scene.paper;
  input.option = golden::command_line(std::array<std::string, 2>{"--scene", options.scene});
  input.shade = shade.empty() ? scene.shade : shade;
  input.perspective = scene.perspective;
  input.cull = scene.cull;
  input.texture = scene.texture;
  need_colours(scene.mesh, input);
  project(scene.mesh, scene.camera, width, height, options.strict, 1, "scene " + scene.name, input);
  if (scene.planes) input.planes = *scene.planes;
  if (input.layout == AttributeLayout::position) golden::fit_positions(input.quads, input.planes);
}

golden::Mesh read_mesh(const InputOptions& options) {
  if (const golden::MeshFormat format = golden::format_of_mesh(options.mesh); format != golden::MeshFormat::obj) {
    if (mesh_importer == nullptr)
      throw StudyNeeded("--mesh " + options.mesh + ": the reader of " + std::string(golden::name_of(format)));
    return mesh_importer(options.mesh, options.merge_pairs);
  }
  golden::Mesh mesh = golden::load_obj(options.mesh);
  if (options.merge_pairs) golden::merge_pairs(mesh);
  return mesh;
}

void load_mesh(const InputOptions& options, const std::string& shade, int width, int height, unsigned threads,
               DrawInput& input) {
  const golden::Mesh mesh = read_mesh(options);
  input.name = golden::readable(std::filesystem::path(options.mesh).filename().string());
  input.title = "mesh " + input.name;
  std::vector<std::string> arguments{"--mesh", options.mesh};
  for (const auto& [name, value] :
       {std::pair{"--camera", &options.camera}, std::pair{"--view", &options.view}, std::pair{"--up", &options.up}})
    if (!value->empty()) arguments.insert(arguments.end(), {name, *value});
  if (options.merge_pairs) arguments.emplace_back("--merge-pairs");
  if (options.strict) arguments.emplace_back("--strict");
  input.option = golden::command_line(arguments);
  input.shade = shade.empty() ? "normal" : shade;
  need_colours(mesh, input);
  const golden::Camera camera = options.camera.empty() ? golden::frame_mesh(mesh, width, height, parse_view(options))
                                                       : golden::load_camera(options.camera);
  if (!options.save_camera.empty())
    golden::write_file(options.save_camera, golden::camera_text(camera), golden::AtomicFile::Dash::refused);
  project(mesh, camera, width, height, options.strict, threads, options.mesh, input);
  remark_on_texture(mesh, input);
  remark_on_reading(mesh, input);
  if (input.layout == AttributeLayout::position) golden::fit_positions(input.quads, input.planes);
}

void load_quads_file(const InputOptions& options, const std::string& shade, DrawInput& input) {
  input.quads = golden::load_quads(options.quads, &input.attribute_names);
  input.name = golden::readable(std::filesystem::path(options.quads).filename().string());
  input.title = "quads " + input.name;
  input.option = golden::command_line(std::array<std::string, 2>{"--quads", options.quads});
  input.quads_file = options.quads;
  input.attributes = static_cast<int>(input.quads.front().attribute[0].size());
  input.layout = input.attribute_names.empty() ? AttributeLayout::file : AttributeLayout::named;
  const bool coloured = input.slot_of({"red", "green", "blue"}) >= 0;
  if (!shade.empty())
    input.shade = shade;
  else if (input.slot_of({"u", "v"}) >= 0)
    input.shade = "uv";
  else if (input.slot_of({"nx", "ny", "nz"}) >= 0)
    input.shade = "normal";
  else
    input.shade = coloured ? "colour" : "lambda";
  if (input.shade != "colour" || !coloured) need_no_object(input);
}

void load_stress(const InputOptions& options, const std::string& shade, int width, int height, std::uint64_t seed,
                 DrawInput& input) {
  choose("stress family", options.stress, stress_names());
  input.name = options.stress;
  input.title = "random quads, " + options.stress;
  input.option = golden::command_line(
      std::array<std::string, 4>{"--stress", options.stress, "--count", std::to_string(options.count)});
  input.shade = shade.empty() ? "lambda" : shade;
  need_no_object(input);
  input.attributes = 4;
  input.quads = golden::make_stress_without_weights(golden::parse_stress_family(options.stress), options.count, seed,
                                                    width, height, input.attributes);
  input.layout = AttributeLayout::file;
}

void load_corner(const InputOptions& options, const std::string& shade, const DrawState& state, const Config& config,
                 std::uint64_t seed, DrawInput& input) {
  choose("corner group", options.corner, corner_names());
  input.name = options.corner;
  input.title = "directed quads, " + options.corner;
  input.option = golden::command_line(std::array<std::string, 2>{"--corner", options.corner});
  input.shade = shade.empty() ? "lambda" : shade;
  need_no_object(input);
  input.attributes = 4;
  input.quads = golden::make_corner(golden::parse_corner_group(options.corner), config, state, seed, input.attributes);
  input.layout = AttributeLayout::file;
}

std::vector<std::string> names_of(const std::vector<golden::SceneInfo>& scenes) {
  std::vector<std::string> names;
  for (const golden::SceneInfo& scene : scenes) names.push_back(scene.name);
  return names;
}

}  // namespace

int DrawInput::slot_of(std::initializer_list<std::string_view> names) const {
  const auto found = std::search(attribute_names.begin(), attribute_names.end(), names.begin(), names.end());
  return found == attribute_names.end() ? -1 : static_cast<int>(found - attribute_names.begin());
}

int inputs_given(const InputOptions& options) {
  return static_cast<int>(!options.scene.empty()) + static_cast<int>(!options.mesh.empty()) +
         static_cast<int>(!options.quads.empty()) + static_cast<int>(!options.stress.empty()) +
         static_cast<int>(!options.corner.empty());
}

std::string shade_of(const std::string& shade, const std::string& texture) {
  if (texture.empty()) return shade;
  if (!shade.empty() && shade != "texture")
    throw UsageError("--texture " + texture + " needs --shade texture, not --shade " + shade);
  return "texture";
}

DrawInput load_input(const InputOptions& options, const std::string& shade, const DrawState& state,
                     const Config& config, std::uint64_t seed, unsigned threads) {
  if (inputs_given(options) != 1)
    throw UsageError(
        "one input is needed: --scene NAME, --mesh F.obj, --quads F.quads, --stress FAMILY or --corner GROUP (" +
        std::to_string(inputs_given(options)) + " were given)");
  for (const auto& [name, value] : {std::pair{"--camera", &options.camera}, std::pair{"--view", &options.view},
                                    std::pair{"--up", &options.up}, std::pair{"--save-camera", &options.save_camera}}) {
    if (!value->empty() && options.mesh.empty()) throw UsageError(std::string(name) + " needs --mesh");
    if ((value == &options.view || value == &options.up) && !value->empty() && !options.camera.empty())
      throw UsageError(std::string(name) + " conflicts with --camera " + options.camera);
  }
  if (options.merge_pairs && options.mesh.empty()) throw UsageError("--merge-pairs needs --mesh");
  if (options.strict && options.mesh.empty()) throw UsageError("--strict needs --mesh");
  if (options.count != InputOptions().count && options.stress.empty()) throw UsageError("--count needs --stress");
  if (!shade.empty()) choose("shading", shade, shade_modes());
  DrawInput input;
  if (!options.scene.empty())
    load_scene(options, shade, state.width, state.height, input);
  else if (!options.mesh.empty())
    load_mesh(options, shade, state.width, state.height, threads, input);
  else if (!options.quads.empty())
    load_quads_file(options, shade, input);
  else if (!options.stress.empty())
    load_stress(options, shade, state.width, state.height, seed, input);
  else
    load_corner(options, shade, state, config, seed, input);
  for (auto j = static_cast<int>(input.attribute_names.size()); j < input.attributes; ++j)
    input.attribute_names.push_back("a" + std::to_string(j));
  set_light(options, input.lighting);
  return input;
}

void adjust_state(const DrawInput& input, DrawState& state) {
  state.perspective = state.perspective && input.perspective;
  if (state.cull == Cull::none) state.cull = input.cull;
}

void print_remark(const DrawInput& input, const CommonOptions& common) {
  if (!input.remark.empty() && !common.quiet)
    std::fprintf(stderr, "quadrille: %s: %s\n", input.name.c_str(), input.remark.c_str());
}

std::vector<std::string> shade_modes() {
  return {"uv", "texture", "normal", "lambda", "depth", "quad", "planes", "colour"};
}

std::vector<std::string> scene_names() { return names_of(golden::list_scenes()); }
std::vector<std::string> workload_names() { return names_of(golden::list_workloads()); }

std::vector<std::string> stress_names() {
  std::vector<std::string> names;
  for (const golden::StressFamilyInfo& family : golden::stress_families()) names.emplace_back(family.name);
  return names;
}

std::vector<std::string> corner_names() {
  std::vector<std::string> names;
  for (const golden::CornerGroupInfo& group : golden::corner_groups()) names.emplace_back(group.name);
  return names;
}

std::string describe(const SnapError& error, const DrawInput& input) {
  if (input.quads_file.empty()) return input.name + ": " + error.what();
  const std::string text = golden::read_file(input.quads_file, "quads");
  golden::TokenLines lines(text, golden::TokenLines::Continuation::none);
  std::vector<golden::Token> tokens;
  for (std::uint32_t quad = 0; lines.next(tokens); ++quad)
    if (quad == error.quad) return input.quads_file + ":" + std::to_string(tokens.front().line) + ": " + error.what();
  return input.quads_file + ": " + error.what();
}

}  // namespace quadrille::tb
