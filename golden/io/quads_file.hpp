// The .quads file: quads in homogeneous window coordinates, with attributes.
#pragma once

#include "model/port/records.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::golden {

/// Reads a .quads text. A quad per line: 16 numbers (x̃ ỹ z̃ w) × 4, then v0's n attributes, v1's, v2's, v3's; the same
/// n, at most max_attribute_slots, on every line. Pixels, y down, pixel centres at +0.5. '#' starts a comment. Quad id
/// = 0-based index of the data line.
///
/// A comment before the first quad may name the attributes: `# attributes: u v`. `names`, where given, gets these
/// names, or none. A name is letters, digits and _, differs from the others and from the other columns of fragments.
///
/// Throws InputError with file:line, the field's number, name and column for whatever does not parse completely, wrong
/// counts, numbers that are not finite or above 2^80 in magnitude, vertices with x̃ = ỹ = w = 0 (no point of the plane),
/// and for a file that cannot be read or holds no quad.
std::vector<WindowQuad> load_quads(const std::string& path, std::vector<std::string>* names = nullptr);

/// The same for a text in memory; `name` stands for the file in messages.
std::vector<WindowQuad> parse_quads(std::string_view text, const std::string& name,
                                    std::vector<std::string>* names = nullptr);

/// The line of a quad, without a line's end.
std::string quad_text(const WindowQuad& quad);

/// Writes the quads in order (ids are not stored) so that load_quads gives the same doubles and names back; no names:
/// as many attributes without. "-" is standard output. Throws InputError for what load_quads would refuse, and when
/// writing fails; an older file then stays as it was.
void save_quads(const std::string& path, std::span<const WindowQuad> quads, std::span<const std::string> names = {});

}  // namespace quadrille::golden
