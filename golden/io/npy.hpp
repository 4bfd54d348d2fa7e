// NumPy's files: what plotting programs and Python read without further libraries.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::golden {

/// Format version 1.0, little-endian float32, C order, shape (height, width). Throws InputError when writing fails; an
/// older file then stays, and std::invalid_argument when the sizes do not fit.
void save_npy(const std::string& path, std::span<const float> values, int width, int height);

/// An array of an NPZ file: its values in C order.
struct NpzArray {
  std::string name;
  std::string type;  ///< as NumPy has it: "<f8", "|b1"
  std::vector<std::size_t> shape;
  std::string_view bytes;
};

/// An array of one dimension; `values` must outlive it.
template <class T>
NpzArray npz_column(std::string name, std::string type, const std::vector<T>& values) {
  return {std::move(name),
          std::move(type),
          {values.size()},
          {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)}};
}

/// What numpy.load() reads: a ZIP archive of one file NAME.npy for each array, not compressed, the same bytes at any
/// time. Throws InputError when writing fails or the file would exceed 4 GiB; an older file then stays.
void save_npz(const std::string& path, std::span<const NpzArray> arrays);

}  // namespace quadrille::golden
