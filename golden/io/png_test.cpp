#include "golden/io/png.hpp"

#include "golden/io/test_support.hpp"

#include <random>

#include <png.h>

namespace quadrille::golden {
namespace {

class PngTest : public InDirectory {};

Image8 random_image(int width, int height) {
  std::mt19937 random(3);
  Image8 image{width, height, std::vector<std::uint8_t>(4 * static_cast<std::size_t>(width * height))};
  for (std::uint8_t& byte : image.rgba) byte = static_cast<std::uint8_t>(random());
  return image;
}

TEST_F(PngTest, RoundTripsDeterministically) {
  const Image8 image = random_image(37, 19);
  save_png(path("a"), image, PngFormat::rgba8);
  save_png(path("b"), image, PngFormat::rgba8);
  EXPECT_EQ(read(path("a")), read(path("b")));
  EXPECT_EQ(read(path("a")).find("tIME"), std::string::npos);
  const Image8 back = load_png(path("a"));
  EXPECT_EQ(back.width, 37);
  EXPECT_EQ(back.height, 19);
  EXPECT_EQ(back.rgba, image.rgba);

  save_png(path("c"), image, PngFormat::rgb8);
  Image8 opaque = image;
  for (std::size_t i = 3; i < opaque.rgba.size(); i += 4) opaque.rgba[i] = 255;
  EXPECT_EQ(load_png(path("c")).rgba, opaque.rgba);
}

/// Writes raw rows with a given colour type and depth, straight through libpng.
void write_raw(const std::string& file, int width, int height, int depth, int type, std::vector<std::uint8_t> bytes,
               bool interlaced = false) {
  FILE* out = std::fopen(file.c_str(), "wb");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, out);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), depth, type,
               interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_set_benign_errors(png, 1);  // indices that the palette does not have
  png_set_gAMA(png, info, 0.1);   // must have no effect
  png_color palette[2] = {{1, 2, 3}, {200, 100, 50}};
  png_byte alpha[1] = {7};
  if (type == PNG_COLOR_TYPE_PALETTE) {
    png_set_PLTE(png, info, palette, 2);
    png_set_tRNS(png, info, alpha, 1, nullptr);
  }
  png_write_info(png, info);
  const std::size_t stride = png_get_rowbytes(png, info);
  std::vector<png_bytep> rows;
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) rows.push_back(bytes.data() + y * stride);
  png_write_image(png, rows.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  std::fclose(out);
}

TEST_F(PngTest, ReadsEveryColourType) {
  using Bytes = std::vector<std::uint8_t>;
  const auto pixels = [&] { return load_png(path("p")).rgba; };
  write_raw(path("p"), 2, 1, 8, PNG_COLOR_TYPE_GRAY, {9, 250});
  EXPECT_EQ(pixels(), (Bytes{9, 9, 9, 255, 250, 250, 250, 255}));
  write_raw(path("p"), 3, 1, 1, PNG_COLOR_TYPE_GRAY, {0b01000000});
  EXPECT_EQ(pixels(), (Bytes{0, 0, 0, 255, 255, 255, 255, 255, 0, 0, 0, 255}));
  write_raw(path("p"), 2, 1, 4, PNG_COLOR_TYPE_GRAY, {0x3f});
  EXPECT_EQ(pixels(), (Bytes{0x33, 0x33, 0x33, 255, 255, 255, 255, 255}));
  write_raw(path("p"), 1, 1, 16, PNG_COLOR_TYPE_GRAY, {0x80, 0x80});
  EXPECT_EQ(pixels(), (Bytes{0x80, 0x80, 0x80, 255}));
  write_raw(path("p"), 2, 1, 16, PNG_COLOR_TYPE_GRAY, {0x01, 0xff, 0x01, 0x7f});  // rounded, not cut
  EXPECT_EQ(pixels(), (Bytes{2, 2, 2, 255, 1, 1, 1, 255}));
  write_raw(path("p"), 1, 2, 8, PNG_COLOR_TYPE_GRAY_ALPHA, {9, 8, 7, 6});
  EXPECT_EQ(pixels(), (Bytes{9, 9, 9, 8, 7, 7, 7, 6}));
  write_raw(path("p"), 2, 1, 8, PNG_COLOR_TYPE_PALETTE, {1, 0});
  EXPECT_EQ(pixels(), (Bytes{200, 100, 50, 255, 1, 2, 3, 7}));
  write_raw(path("p"), 1, 1, 8, PNG_COLOR_TYPE_RGB, {1, 2, 3});
  EXPECT_EQ(pixels(), (Bytes{1, 2, 3, 255}));
  write_raw(path("p"), 1, 1, 16, PNG_COLOR_TYPE_RGB_ALPHA, {1, 1, 2, 2, 3, 3, 4, 4});
  EXPECT_EQ(pixels(), (Bytes{1, 2, 3, 4}));
  const Image8 image = random_image(13, 11);
  write_raw(path("p"), 13, 11, 8, PNG_COLOR_TYPE_RGB_ALPHA, image.rgba, true);
  EXPECT_EQ(pixels(), image.rgba);
}

TEST_F(PngTest, RefusesAPaletteIndexWithoutColour) {
  // The palette has two colours; the decoder's own answer is black for index 2 and above.
  const auto refuses = [&](const char* pixel, const char* index) {
    expect_input_error([&] { load_png(path("p")); }, path("p"), {pixel, index, "has 2 colours"});
  };
  write_raw(path("p"), 3, 2, 8, PNG_COLOR_TYPE_PALETTE, {1, 0, 1, 0, 1, 2});
  refuses("pixel (2, 1)", "palette index 2;");
  write_raw(path("p"), 3, 2, 8, PNG_COLOR_TYPE_PALETTE, {1, 255, 1, 0, 1, 0}, true);
  refuses("pixel (1, 0)", "palette index 255;");
  write_raw(path("p"), 3, 2, 2, PNG_COLOR_TYPE_PALETTE, {0b00010000, 0b01001100});
  refuses("pixel (2, 1)", "palette index 3;");
  write_raw(path("p"), 3, 1, 4, PNG_COLOR_TYPE_PALETTE, {0x10, 0x9f});
  refuses("pixel (2, 0)", "palette index 9;");
  // Bits beyond the last pixel of a row are no index.
  write_raw(path("p"), 3, 1, 4, PNG_COLOR_TYPE_PALETTE, {0x10, 0x1f});
  EXPECT_EQ(load_png(path("p")).rgba.size(), 12u);
}

TEST_F(PngTest, RefusesWhatIsNoCompletePng) {
  expect_input_error([&] { load_png(path("absent")); }, path("absent"), {"No such file", "PNG"});
  for (const std::string& bytes : {std::string(), std::string("not a picture"), std::string("\x89PNG\r\n\x1a\n")}) {
    const std::string file = write("bad", bytes);
    expect_input_error([&] { load_png(file); }, file, {"not a readable PNG"});
  }
  save_png(path("good"), random_image(20, 20), PngFormat::rgba8);
  const std::string good = read(path("good"));
  for (std::size_t size = 0; size < good.size(); size += 13) {
    const std::string file = write("cut", good.substr(0, size));
    expect_input_error([&] { load_png(file); }, file, {"not a readable PNG"});
  }
  const std::string endless = write("endless", good.substr(0, good.size() - 12));  // all pixels, no IEND
  expect_input_error([&] { load_png(endless); }, endless, {"ends too early"});
  write_raw(path("wide"), max_image_side + 1, 1, 1, PNG_COLOR_TYPE_GRAY, std::vector<std::uint8_t>(3000));
  expect_input_error([&] { load_png(path("wide")); }, path("wide"), {"16385x1", "at most 16384 pixels a side"});
}

TEST_F(PngTest, RefusesImpossibleSizesAndUnwritablePaths) {
  for (const auto& [width, height] : {std::pair{0, 5}, {5, -1}, {max_image_side + 1, 1}}) {
    Image8 image{width, height, {}};
    expect_input_error([&] { save_png(path("p"), image, PngFormat::rgb8); }, path("p"),
                       {std::to_string(width) + "x" + std::to_string(height)});
  }
  const Image8 image = random_image(4, 4);
  expect_input_error([&] { save_png("-", image, PngFormat::rgb8); }, "-", {"standard output"});
  expect_input_error([&] { save_png(path("no/p"), image, PngFormat::rgb8); }, path("no/p"), {"No such file"});
  EXPECT_EQ(entries(), 0u);
}

}  // namespace
}  // namespace quadrille::golden
