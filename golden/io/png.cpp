#include "golden/io/png.hpp"

#include "golden/io/atomic_file.hpp"
#include "golden/io/error.hpp"
#include "golden/io/text_input.hpp"

#include <png.h>

#include <csetjmp>
#include <cstring>
#include <stdexcept>
#include <string_view>

namespace quadrille::golden {
namespace {

// libpng reports errors by longjmp, which runs no destructor. So all state lives in a Session outside, and the
// functions that can be jumped out of hold nothing but plain locals.
struct Session {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::string message;
  // reading
  std::string_view input;
  // both
  Image8 image;
  std::vector<png_bytep> rows;
  // writing
  std::string output;
};

void on_error(png_structp png, png_const_charp message) {
  auto& session = *static_cast<Session*>(png_get_error_ptr(png));
  session.message = message;
  png_longjmp(png, 1);
}

// Warnings are about ancillary data (profiles, text), none of which is used.
void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep data, std::size_t size) {
  auto& session = *static_cast<Session*>(png_get_io_ptr(png));
  if (size > session.input.size()) png_error(png, "the file ends too early");
  std::memcpy(data, session.input.data(), size);
  session.input.remove_prefix(size);
}

void on_write(png_structp png, png_bytep data, std::size_t size) {
  static_cast<Session*>(png_get_io_ptr(png))->output.append(reinterpret_cast<const char*>(data), size);
}

void on_flush(png_structp) {}

void set_rows(Session& session) {
  const std::size_t stride = 4 * static_cast<std::size_t>(session.image.width);
  session.rows.resize(static_cast<std::size_t>(session.image.height));
  for (std::size_t y = 0; y < session.rows.size(); ++y) session.rows[y] = session.image.rgba.data() + y * stride;
}

bool read_image(Session& session) {
  png_structp png = session.png;
  png_infop info = session.info;
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_read_fn(png, &session, on_read);
  png_set_user_limits(png, max_image_side, max_image_side);
  png_read_info(png, info);

  png_set_expand(png);  // palettes, 1 to 4 bit grey, transparent colours
  png_set_scale_16(png);
  png_set_gray_to_rgb(png);
  png_set_add_alpha(png, 0xff, PNG_FILLER_AFTER);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);

  session.image.width = static_cast<int>(png_get_image_width(png, info));
  session.image.height = static_cast<int>(png_get_image_height(png, info));
  session.image.rgba.resize(4 * static_cast<std::size_t>(session.image.width) *
                            static_cast<std::size_t>(session.image.height));
  set_rows(session);
  if (png_get_rowbytes(png, info) != 4 * static_cast<std::size_t>(session.image.width))
    png_error(png, "unknown pixel layout");
  png_read_image(png, session.rows.data());
  png_read_end(png, nullptr);
  return true;
}

bool write_image(Session& session, PngFormat format) {
  png_structp png = session.png;
  png_infop info = session.info;
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, &session, on_write, on_flush);
  png_set_user_limits(png, max_image_side, max_image_side);
  png_set_IHDR(png, info, static_cast<png_uint_32>(session.image.width), static_cast<png_uint_32>(session.image.height),
               8, format == PngFormat::rgb8 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  // Stated rather than left to the library's defaults, which may change between versions.
  png_set_compression_level(png, 6);
  png_set_compression_strategy(png, 1);  // Z_FILTERED
  png_set_compression_mem_level(png, 8);
  png_set_compression_window_bits(png, 15);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB | PNG_FILTER_UP);
  png_write_info(png, info);
  if (format == PngFormat::rgb8) png_set_filler(png, 0, PNG_FILLER_AFTER);  // drops the fourth byte of each pixel
  png_write_image(png, session.rows.data());
  png_write_end(png, nullptr);
  return true;
}

}  // namespace

Image8 load_png(const std::string& path) {
  const std::string bytes = read_file(path, "a PNG picture");
  Session session;
  session.input = bytes;
  session.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &session, on_error, on_warning);
  if (session.png == nullptr) throw std::bad_alloc();
  session.info = png_create_info_struct(session.png);
  const bool good = session.info != nullptr && read_image(session);
  png_destroy_read_struct(&session.png, &session.info, nullptr);
  if (!good) {
    throw InputError(path + ": is not a readable PNG: " + session.message + "; a complete PNG of at most " +
                     std::to_string(max_image_side) + " pixels a side is expected");
  }
  return std::move(session.image);
}

void save_png(const std::string& path, const Image8& image, PngFormat format) {
  if (image.width < 1 || image.height < 1 || image.width > max_image_side || image.height > max_image_side) {
    throw InputError(path + ": picture size " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                     " is impossible; 1 to " + std::to_string(max_image_side) + " pixels a side are expected");
  }
  if (image.rgba.size() != 4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height)) {
    throw std::logic_error("Image8: 4 bytes per pixel are needed");
  }
  Session session;
  session.image = image;  // libpng wants rows that are not const
  set_rows(session);
  session.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &session, on_error, on_warning);
  if (session.png == nullptr) throw std::bad_alloc();
  session.info = png_create_info_struct(session.png);
  const bool good = session.info != nullptr && write_image(session, format);
  png_destroy_write_struct(&session.png, &session.info);
  if (!good) throw InputError(path + ": cannot be encoded as PNG: " + session.message);
  write_file(path, session.output, AtomicFile::Dash::refused);
}

}  // namespace quadrille::golden
