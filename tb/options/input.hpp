// What is drawn: a scene, a mesh with a camera, a quads file, a stress family, a corner group; all become quads with
// attributes.
#pragma once

#include "golden/scenes/mesh.hpp"
#include "golden/scenes/procedural_texture.hpp"
#include "golden/scenes/scenes.hpp"
#include "model/port/records.hpp"
#include "model/port/snap.hpp"
#include "tb/options/options.hpp"

#include <array>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::tb {

/// What the attributes of an input's quads are.
enum class AttributeLayout {
  none,
  uv,
  normal,
  uv_normal,
  position,
  colour,
  file,  ///< by place: u, v, then a normal
  named  ///< by attribute_names
};

/// What pictures are lit by: directions in the mesh's space, from the surface.
struct Lighting {
  golden::Vec3 to_eye{0, 0, 1};           ///< unit, for highlights and for which side is seen
  golden::Vec3 to_light{0.35, 0.8, 0.6};  ///< of any length; both sides of a surface are lit alike
};

struct DrawInput {
  std::string name;  ///< of the scene, file or family
  std::string title;
  std::string paper;   ///< of a scene: paper and figure
  std::string option;  ///< the options that name it, as a command line gives them
  std::vector<WindowQuad> quads;
  std::vector<std::array<golden::Vec3, 4>> corners;  ///< of every quad in the mesh's space; none for files and families
  std::vector<std::array<golden::Vec2, 4>> textures;  ///< texture coordinates of every quad, likewise
  int attributes = 0;                                 ///< per vertex
  AttributeLayout layout = AttributeLayout::none;
  std::vector<std::string> attribute_names;  ///< u, v, …; without names a0, a1, …
  bool perspective = true;                   ///< as the scene wants it
  Cull cull = Cull::none;                    ///< likewise
  std::string shade = "lambda";              ///< shading that suits it
  golden::TextureKind texture = golden::TextureKind::checker;
  Lighting lighting;
  golden::CuttingPlanes planes;  ///< of shade `planes`, in the unit of the position attributes (a power of two)
  std::size_t faces = 0, triangles = 0, fanned_faces = 0, fan_primitives = 0, crossed_faces = 0, skipped_lines = 0;
  std::string quads_file;  ///< where the quads came from, if a .quads file
  /// Attribute from which on they have these names; -1: none.
  int slot_of(std::initializer_list<std::string_view> names) const;

  std::string remark;  ///< what the input lacks for its shading or its reader noted; empty: nothing
};

/// Reads a --mesh that is no OBJ (golden/io/import_mesh.hpp); the studies set it.
inline golden::Mesh (*mesh_importer)(const std::string& path, bool pairs) = nullptr;

/// How many of --scene, --mesh, --quads, --stress and --corner are given.
int inputs_given(const InputOptions& options);

/// Loads the one input of the options, and writes the automatic camera where --save-camera wants it. `shade` empty:
/// what suits the input; otherwise the attributes are what that shading needs. A viewport of the state's size; corner
/// groups look at the rest of the state and at the configuration too. Throws UsageError when not exactly one
/// is given, a name is unknown or the input lacks what the shading needs, InputError for what a file holds, StudyNeeded
/// for a mesh that is no OBJ without mesh_importer.
DrawInput load_input(const InputOptions& options, const std::string& shade, const DrawState& state,
                     const Config& config, std::uint64_t seed, unsigned threads = 1);

/// The draw state of an input: perspective off where the scene has none, the scene's culling where no other is asked
/// for.
void adjust_state(const DrawInput& input, DrawState& state);

/// Says the remark of an input, if there is one, on standard error unless --quiet.
void print_remark(const DrawInput& input, const CommonOptions& common);

/// What --shade is when --texture is given too: texture. Throws UsageError for another explicit --shade.
std::string shade_of(const std::string& shade, const std::string& texture);

/// Shading modes, names of scenes (figures and loads apart), families and corner groups.
std::vector<std::string> shade_modes();
std::vector<std::string> scene_names();
std::vector<std::string> workload_names();
std::vector<std::string> stress_names();
std::vector<std::string> corner_names();

/// The text of a SnapError with the place in the file where there is one.
std::string describe(const SnapError& error, const DrawInput& input);

}  // namespace quadrille::tb
