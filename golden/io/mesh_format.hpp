// Formats of mesh files, told by the ending of a name.
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>

namespace quadrille::golden {

enum class MeshFormat { obj, ply, off, gltf };  ///< obj is read by obj.hpp, the others by import_mesh.hpp

/// .ply, .off, .gltf and .glb in any case; every other name is one of an OBJ file.
inline MeshFormat format_of_mesh(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending == ".ply") return MeshFormat::ply;
  if (ending == ".off") return MeshFormat::off;
  return ending == ".gltf" || ending == ".glb" ? MeshFormat::gltf : MeshFormat::obj;
}

constexpr std::string_view name_of(MeshFormat format) {
  constexpr std::string_view names[] = {"OBJ", "PLY", "OFF", "glTF"};
  return names[static_cast<std::size_t>(format)];
}

}  // namespace quadrille::golden
