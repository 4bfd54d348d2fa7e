// NumPy's array file: what plotting programs read without further libraries.
#pragma once

#include <span>
#include <string>

namespace quadrille::golden {

/// Format version 1.0, little-endian float32, C order, shape (height, width). Throws InputError when writing fails; an
/// older file then stays, and std::invalid_argument when the sizes do not fit.
void save_npy(const std::string& path, std::span<const float> values, int width, int height);

}  // namespace quadrille::golden
