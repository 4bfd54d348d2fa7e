// Wavefront OBJ, the polygonal part.
#pragma once

#include "golden/scenes/mesh.hpp"

#include <string>
#include <string_view>

namespace quadrille::golden {

/// Reads v, vt, vn and f; every other statement is skipped and counted in Mesh::skipped_lines.
///
/// - `v x y z`, also with a weight (4 numbers), which is a number and not used, a colour (6) or both (7); colours are
///   used when every vertex has one. `vt u [v [w]]`, v defaults to 0, w is not used; `vn x y z`.
/// - `f` with three or more corners `a`, `a/b`, `a//c` or `a/b/c`, one form per face; indices from 1, with a + or
///   without, or negative ones counted back from the last element so far. Face id = 0-based index of the f statement.
/// - A backslash at the end of a line joins the next one, and where that makes a `v`, `vt`, `vn` or `f` part of a
///   statement that is skipped, Mesh::notes says so; '#' starts a comment; LF, CRLF and CR end a line.
///
/// Throws InputError with file:line for whatever does not parse completely, numbers that are not finite or above 2^80,
/// wrong counts, faces with one or two corners, index 0 and indices of elements that are not defined before the face,
/// and for a file that cannot be read, is UTF-16 or has no face.
Mesh load_obj(const std::string& path);

/// The same for a text in memory; `name` stands for the file in messages.
Mesh parse_obj(std::string_view text, const std::string& name);

}  // namespace quadrille::golden
