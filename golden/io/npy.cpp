#include "golden/io/npy.hpp"

#include "golden/io/atomic_file.hpp"

#include "golden/io/error.hpp"

#include <zlib.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace quadrille::golden {

static_assert(std::endian::native == std::endian::little, "the header says little-endian");

namespace {

/// What stands before the values: version 1.0.
std::string npy_header(const std::string& type, std::span<const std::size_t> shape) {
  std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (";
  for (std::size_t i = 0; i < shape.size(); ++i) header += (i == 0 ? "" : ", ") + std::to_string(shape[i]);
  header += shape.size() == 1 ? ",), }" : "), }";
  constexpr std::size_t fixed = 10, alignment = 64;  // magic, version, length; data starts at a multiple of 64
  header.resize((fixed + header.size() + 1 + alignment - 1) / alignment * alignment - fixed, ' ');
  header.back() = '\n';
  const auto length = static_cast<std::uint16_t>(header.size());
  std::string bytes = std::string("\x93NUMPY\x01", 7) + '\0';
  bytes += static_cast<char>(length & 0xff);
  bytes += static_cast<char>(length >> 8);
  return bytes + header;
}

/// A record of a ZIP archive: its signature, then numbers of two or four bytes.
class ZipRecord {
 public:
  explicit ZipRecord(std::uint32_t signature) { four(signature); }
  ZipRecord& two(std::size_t value) { return put(value, 2); }
  ZipRecord& four(std::size_t value) { return put(value, 4); }
  const std::string& bytes() const { return bytes_; }

 private:
  ZipRecord& put(std::size_t value, int size) {
    for (int i = 0; i < size; ++i) bytes_ += static_cast<char>(value >> (8 * i) & 0xff);
    return *this;
  }

  std::string bytes_;
};

/// What a local header and the directory say alike of a stored file, dated 1980-01-01.
ZipRecord& describe(ZipRecord& record, std::uint32_t crc, std::size_t size, std::size_t name) {
  constexpr std::size_t version = 20, stored = 0, midnight = 0, first_day = 0x21;
  record.two(version).two(0).two(stored).two(midnight).two(first_day);
  return record.four(crc).four(size).four(size).two(name).two(0);
}

std::uint32_t crc_of(std::string_view bytes, std::uint32_t before) {
  return static_cast<std::uint32_t>(crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace

void save_npy(const std::string& path, std::span<const float> values, int width, int height) {
  if (width < 0 || height < 0 || values.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    throw std::invalid_argument("save_npy: the values do not fill the array");
  std::string bytes = npy_header("<f4", std::array{static_cast<std::size_t>(height), static_cast<std::size_t>(width)});
  const std::size_t start = bytes.size();
  bytes.resize(start + values.size() * sizeof(float));
  if (!values.empty()) std::memcpy(bytes.data() + start, values.data(), values.size() * sizeof(float));
  write_file(path, bytes, AtomicFile::Dash::refused);
}

void save_npz(const std::string& path, std::span<const NpzArray> arrays) {
  AtomicFile file(path, AtomicFile::Dash::refused);
  std::string directory;
  std::size_t offset = 0;
  const auto write = [&](std::string_view bytes) {
    offset += bytes.size();
    if (offset > std::numeric_limits<std::uint32_t>::max())
      throw InputError(path + ": more than 4 GiB, which an NPZ file does not hold; CSV does");
    file.write(bytes);
  };
  for (const NpzArray& array : arrays) {
    const std::string header = npy_header(array.type, array.shape), name = array.name + ".npy";
    const std::size_t size = header.size() + array.bytes.size(), start = offset;
    const std::uint32_t crc = crc_of(array.bytes, crc_of(header, 0));
    ZipRecord local(0x04034b50), entry(0x02014b50);
    write(describe(local, crc, size, name.size()).bytes() + name);
    write(header);
    write(array.bytes);
    describe(entry.two(20), crc, size, name.size()).two(0).two(0).two(0).four(0).four(start);
    directory += entry.bytes() + name;
  }
  const std::size_t start = offset, count = arrays.size();
  write(directory);
  write(ZipRecord(0x06054b50).two(0).two(0).two(count).two(count).four(directory.size()).four(start).two(0).bytes());
  file.commit();
}

}  // namespace quadrille::golden
