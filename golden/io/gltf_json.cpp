#include "golden/io/gltf_json.hpp"

#include "golden/io/error.hpp"
#include "golden/io/text_input.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

namespace quadrille::golden {
namespace {

using nlohmann::json;

/// The JSON of a file: all of a .gltf, the first chunk of a .glb (little-endian words: "glTF", version, length; then
/// the chunk's length, "JSON").
std::string_view json_text(std::string_view file, const std::string& name) {
  if (!file.starts_with("glTF")) return file;
  std::uint32_t size = 0;
  constexpr std::size_t head = 20;
  if (file.size() >= head) std::memcpy(&size, file.data() + 12, sizeof size);
  if (file.size() < head || file.substr(16, 4) != "JSON" || size > file.size() - head)
    throw input_error(name, 0,
                      "the binary glTF is cut off or its first chunk is not JSON; a complete file is expected");
  return file.substr(head, size);
}

/// Those that assimp reads, and those that change no face.
bool is_known(const std::string& extension) {
  constexpr std::array<std::string_view, 6> starts{
      "FB_ngon_encoding", "KHR_draco_mesh_compression", "KHR_lights", "KHR_materials_", "KHR_texture_", "EXT_texture_"};
  return std::ranges::any_of(starts, [&](std::string_view start) { return extension.starts_with(start); });
}

}  // namespace

std::vector<bool> ngon_primitives(std::string_view text, const std::string& name) {
  std::vector<bool> ngons;
  try {
    const json root = json::parse(json_text(text, name));
    const std::string version = root.at("asset").at("version").get<std::string>();
    if (!version.starts_with("2."))
      throw input_error(name, 0, "is glTF " + in_quotes(version) + "; version 2 is expected");
    for (const json& extension : root.value("extensionsRequired", json::array()))
      if (!is_known(extension.get<std::string>()))
        throw input_error(name, 0,
                          "requires the extension " + in_quotes(extension.get<std::string>()) +
                              ", which is not read; export without it (compression, quantization)");
    for (const json& mesh : root.value("meshes", json::array()))
      for (const json& primitive : mesh.at("primitives"))
        ngons.push_back(primitive.value("extensions", json::object()).contains("FB_ngon_encoding"));
  } catch (const json::exception& error) {
    throw input_error(name, 0, "is no glTF: " + printable(error.what()) + "; glTF 2 in JSON or binary is expected");
  }
  return ngons;
}

}  // namespace quadrille::golden
