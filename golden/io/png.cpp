#include "golden/io/png.hpp"

#include "golden/io/atomic_file.hpp"
#include "golden/io/error.hpp"
#include "golden/io/text_input.hpp"

#include <png.h>

#include <algorithm>
#include <array>
#include <memory>
#include <new>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace quadrille::golden {
namespace {

struct ImageDeleter {
  void operator()(png_image* image) const { png_image_free(image); }
};

/// The simplified interface converts to sRGB what a file declares to be something else, and it does not look behind the
/// last row. So the file goes in without the chunks that declare a colour space, and complete.
std::string without_colour_space(std::string_view file) {
  constexpr std::size_t signature = 8, length_and_type = 8, crc = 4;
  constexpr std::array<std::string_view, 4> declarations{"gAMA", "cHRM", "sRGB", "iCCP"};
  if (file.size() < signature || png_sig_cmp(reinterpret_cast<png_const_bytep>(file.data()), 0, signature) != 0)
    throw std::runtime_error("Not a PNG file");
  std::string kept(file.substr(0, signature));
  for (std::string_view rest = file.substr(signature); rest.size() >= length_and_type + crc;) {
    const std::size_t size =
        length_and_type + png_get_uint_32(reinterpret_cast<png_const_bytep>(rest.data())) + std::size_t{crc};
    if (size > rest.size()) break;
    const std::string_view type = rest.substr(4, 4);
    if (std::ranges::find(declarations, type) == declarations.end()) kept += rest.substr(0, size);
    if (type == "IEND") return kept;
    rest.remove_prefix(size);
  }
  throw std::runtime_error("the file ends too early");
}

/// The simplified interface draws a palette index that has no colour as black, so such a file is decoded to indices
/// first.
void check_palette(const std::string& bytes) {
  // After the signature comes IHDR: length, type, width, height, depth, colour type.
  constexpr std::size_t colour_type_at = 25;
  if (bytes.size() <= colour_type_at || bytes[colour_type_at] != PNG_COLOR_TYPE_PALETTE) return;
  struct Reader {
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, throw_error, ignore_warning);
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
    std::string_view rest;
    ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
    [[noreturn]] static void throw_error(png_structp, png_const_charp message) { throw std::runtime_error(message); }
    static void ignore_warning(png_structp, png_const_charp) {}
    static void take(png_structp png, png_bytep to, std::size_t size) {
      std::string_view& rest = static_cast<Reader*>(png_get_io_ptr(png))->rest;
      if (size > rest.size()) throw std::runtime_error("the file ends too early");
      std::ranges::copy(rest.substr(0, size), to);
      rest.remove_prefix(size);
    }
  } reader;
  if (reader.info == nullptr) throw std::bad_alloc();
  reader.rest = bytes;
  png_set_read_fn(reader.png, &reader, Reader::take);
  png_read_info(reader.png, reader.info);
  const std::size_t width = png_get_image_width(reader.png, reader.info);
  const std::size_t height = png_get_image_height(reader.png, reader.info);
  if (width > max_image_side || height > max_image_side) return;  // refused below
  png_colorp palette = nullptr;
  int colours = 0;
  png_get_PLTE(reader.png, reader.info, &palette, &colours);
  png_set_packing(reader.png);
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  std::vector<std::uint8_t> indices(width * height);
  std::vector<png_bytep> rows;
  for (std::size_t y = 0; y < height; ++y) rows.push_back(indices.data() + y * width);
  png_read_image(reader.png, rows.data());
  const auto found = std::ranges::find_if(indices, [&](std::uint8_t index) { return index >= colours; });
  if (found == indices.end()) return;
  const auto at = static_cast<std::size_t>(found - indices.begin());
  throw std::runtime_error("the pixel (" + std::to_string(at % width) + ", " + std::to_string(at / width) +
                           ") has the palette index " + std::to_string(*found) + "; the palette (PLTE) has " +
                           std::to_string(colours) + " colours");
}

Image8 decode(std::string_view file) {
  const std::string bytes = without_colour_space(file);
  check_palette(bytes);
  png_image png{};
  const std::unique_ptr<png_image, ImageDeleter> owner(&png);
  png.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&png, bytes.data(), bytes.size())) throw std::runtime_error(png.message);
  if (png.width > max_image_side || png.height > max_image_side)
    throw std::runtime_error(std::to_string(png.width) + "x" + std::to_string(png.height) + " pixels");
  png.format = PNG_FORMAT_RGBA;
  png.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;  // 16-bit values are to be rounded, not converted from linear ones
  Image8 image;
  image.width = static_cast<int>(png.width);
  image.height = static_cast<int>(png.height);
  image.rgba.resize(PNG_IMAGE_SIZE(png));
  if (!png_image_finish_read(&png, nullptr, image.rgba.data(), 0, nullptr)) throw std::runtime_error(png.message);
  return image;
}

}  // namespace

Image8 load_png(const std::string& path) {
  try {
    return decode(read_file(path, "a PNG picture"));
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw InputError(path + ": is not a readable PNG: " + error.what() + "; a complete PNG of at most " +
                     std::to_string(max_image_side) + " pixels a side is expected");
  }
}

void save_png(const std::string& path, const Image8& image, PngFormat format) {
  if (image.width < 1 || image.height < 1 || image.width > max_image_side || image.height > max_image_side) {
    throw InputError(path + ": picture size " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                     " is impossible; 1 to " + std::to_string(max_image_side) + " pixels a side are expected");
  }
  const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.rgba.size() != 4 * pixels) throw std::logic_error("Image8: 4 bytes per pixel are needed");
  std::vector<std::uint8_t> rgb;
  if (format == PngFormat::rgb8)
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
      if (i % 4 != 3) rgb.push_back(image.rgba[i]);

  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = format == PngFormat::rgb8 ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
  const void* rows = format == PngFormat::rgb8 ? rgb.data() : image.rgba.data();
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(png), '\0');
  png_alloc_size_t size = bytes.size();
  if (!png_image_write_to_memory(&png, bytes.data(), &size, 0, rows, 0, nullptr))
    throw InputError(path + ": cannot be encoded as PNG: " + png.message);
  bytes.resize(size);
  write_file(path, bytes, AtomicFile::Dash::refused);
}

}  // namespace quadrille::golden
