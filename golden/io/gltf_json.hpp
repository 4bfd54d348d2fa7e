// What a reader of glTF must know of a file besides its triangles.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace quadrille::golden {

/// Of each primitive, in the order of meshes and their primitives: whether it has the extension FB_ngon_encoding.
///
/// `text`: a whole .gltf or .glb; `name` stands for the file. Throws InputError for what is not glTF 2 with valid JSON,
/// and for extensions that the file requires and that change geometry in a way not known here.
std::vector<bool> ngon_primitives(std::string_view text, const std::string& name);

}  // namespace quadrille::golden
