// Meshes in other formats than OBJ, read by the library assimp: of programs that are linked with it.
#pragma once

#include "golden/scenes/mesh.hpp"

#include <string>

namespace quadrille::golden {

/// Reads PLY, OFF or glTF 2 (.gltf, .glb) by the name's ending: all polygons, in the order of the file, in single
/// precision. `pairs`: merge_pairs of what was read.
///
/// - Positions; normals, texture coordinates (PLY: u, v or s, t) and colours of vertices where the file has them. v
///   points up: glTF's is turned.
/// - glTF: the meshes of the default scene, where its nodes put them, in the order of nodes. A colour is the vertex's
///   times the material's base colour factor. In a primitive with the extension FB_ngon_encoding, consecutive triangles
///   with one first vertex, each beginning where the one before ends, are one face. A note has the counts.
/// - Textures, animations and skins are not read. A note counts points and lines of glTF.
///
/// Throws InputError with the file and, where one is at fault, the vertex, face or line: what assimp refuses or
/// drops, numbers that are not finite or above 2^80, faces with one or two corners, extensions that are required and
/// not known; a file that cannot be read or has no face.
Mesh import_mesh(const std::string& path, bool pairs);

}  // namespace quadrille::golden
