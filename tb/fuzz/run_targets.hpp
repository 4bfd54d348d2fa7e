// The functions of the targets; fuzz_target.cpp lists them.
#pragma once

#include "tb/fuzz/fuzz_target.hpp"

namespace quadrille::fuzz {

/// Readers of texts and files: an InputError (or ConfigError) that names the place, or a value that survives being
/// written and read, where there is a writer.
Outcome read_obj(std::span<const std::uint8_t> input);
Outcome read_quads(std::span<const std::uint8_t> input);
Outcome read_camera(std::span<const std::uint8_t> input);
Outcome read_config(std::span<const std::uint8_t> input);
Outcome read_config_text(std::span<const std::uint8_t> input);
Outcome read_png(std::span<const std::uint8_t> input);
Outcome read_exr(std::span<const std::uint8_t> input);
Outcome read_manifest(std::span<const std::uint8_t> input);
/// response.hex of a sealed set of vectors of sqrt: refused with the line, or all of it is compared.
Outcome read_records(std::span<const std::uint8_t> input);
/// Lines of a sweep's journal behind its first, without their check sums.
Outcome read_journal(std::span<const std::uint8_t> input);

/// Four bytes, the draw state and one of a few configurations, then any 16 doubles x̃ ỹ z̃ w and up to eight for two
/// attributes; what is missing is 0. A vertex that cannot be snapped is refused. Both pixel engines draw it, and every
/// fragment is held against the truth.
Outcome draw_any_quad(std::span<const std::uint8_t> input);

}  // namespace quadrille::fuzz
