// Quads out of triangles, for files whose format or writer knows no quads.
#pragma once

#include "golden/scenes/mesh.hpp"

namespace quadrille::golden {

/// Joins pairs of triangles that follow each other in the file to quads.
///
/// - Two triangles may join that share an edge, which they walk in opposite directions, with the same position, texture
///   coordinates and normal at both ends, and that are bent by at most 120 degrees (a known test mesh has quads of 96).
/// - A triangle joins at most once. As many pairs as possible join; of several ways that with the squarest quads, by
/// the
///   sum over quads of the corner angle furthest from 90 degrees.
/// - The shared edge becomes the diagonal from corner 0 to corner 2; corner 0 is its end that the first triangle names
///   first.
///
/// Other faces stay as they are and separate triangles. Adds a note with the counts.
void merge_pairs(Mesh& mesh);

}  // namespace quadrille::golden
