#include "golden/io/npy.hpp"

#include "golden/io/atomic_file.hpp"

#include <bit>
#include <cstdint>
#include <cstring>
#include <stdexcept>

namespace quadrille::golden {

static_assert(std::endian::native == std::endian::little, "the header says little-endian");

void save_npy(const std::string& path, std::span<const float> values, int width, int height) {
  if (width < 0 || height < 0 || values.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    throw std::invalid_argument("save_npy: the values do not fill the array");
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (" + std::to_string(height) + ", " +
                       std::to_string(width) + "), }";
  constexpr std::size_t fixed = 10, alignment = 64;  // magic, version, length; data starts at a multiple of 64
  header.resize((fixed + header.size() + 1 + alignment - 1) / alignment * alignment - fixed, ' ');
  header.back() = '\n';
  const auto length = static_cast<std::uint16_t>(header.size());
  std::string bytes = std::string("\x93NUMPY\x01", 7) + '\0';
  bytes += static_cast<char>(length & 0xff);
  bytes += static_cast<char>(length >> 8);
  bytes += header;
  const std::size_t start = bytes.size();
  bytes.resize(start + values.size() * sizeof(float));
  if (!values.empty()) std::memcpy(bytes.data() + start, values.data(), values.size() * sizeof(float));
  write_file(path, bytes, AtomicFile::Dash::refused);
}

}  // namespace quadrille::golden
