#include "tb/studies/compare/sheet.hpp"

#include "golden/io/image_diff.hpp"

#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

namespace quadrille::compare {
namespace {

using golden::Image8;

struct SurfaceDeleter {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
struct ContextDeleter {
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};
using Surface = std::unique_ptr<cairo_surface_t, SurfaceDeleter>;
using Context = std::unique_ptr<cairo_t, ContextDeleter>;

Surface make_surface(int width, int height) {
  Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height));
  if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS)
    throw std::runtime_error(std::string("contact sheet: ") +
                             cairo_status_to_string(cairo_surface_status(surface.get())));
  return surface;
}

/// Cairo keeps a pixel as one native 32-bit word, 0x00RRGGBB.
Surface to_surface(const Image8& image) {
  Surface surface = make_surface(image.width, image.height);
  cairo_surface_flush(surface.get());
  unsigned char* rows = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  std::size_t from = 0;
  for (int y = 0; y < image.height; ++y) {
    auto* row = reinterpret_cast<std::uint32_t*>(rows + static_cast<std::ptrdiff_t>(y) * stride);
    for (int x = 0; x < image.width; ++x, from += 4)
      row[x] = static_cast<std::uint32_t>(image.rgba[from] << 16 | image.rgba[from + 1] << 8 | image.rgba[from + 2]);
  }
  cairo_surface_mark_dirty(surface.get());
  return surface;
}

Image8 to_image(cairo_surface_t* surface) {
  cairo_surface_flush(surface);
  Image8 image;
  image.width = cairo_image_surface_get_width(surface);
  image.height = cairo_image_surface_get_height(surface);
  const unsigned char* rows = cairo_image_surface_get_data(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  image.rgba.reserve(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 4);
  for (int y = 0; y < image.height; ++y) {
    const auto* row = reinterpret_cast<const std::uint32_t*>(rows + static_cast<std::ptrdiff_t>(y) * stride);
    for (int x = 0; x < image.width; ++x)
      for (const int shift : {16, 8, 0, -1})
        image.rgba.push_back(shift < 0 ? std::uint8_t{255} : static_cast<std::uint8_t>(row[x] >> shift));
  }
  return image;
}

constexpr double margin = 12, gap = 10, text_size = 13, title_size = 19, label_width = 110;
constexpr double line_height = 18, caption_lines = 2;
constexpr double ink = 0.12;

void font(cairo_t* context, double size, bool bold) {
  cairo_select_font_face(context, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context, size);
}

double width_of(cairo_t* context, const std::string& text) {
  cairo_text_extents_t extents;
  cairo_text_extents(context, text.c_str(), &extents);
  return extents.x_advance;
}

/// One line, base line at y, cut with an ellipsis where it is wider than `room`.
void write_line(cairo_t* context, double x, double y, std::string text, double room) {
  if (width_of(context, text) > room) {
    while (!text.empty() && width_of(context, text + "…") > room) {
      do text.pop_back();
      while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xc0) == 0x80);
    }
    text += "…";
  }
  cairo_move_to(context, x, y);
  cairo_show_text(context, text.c_str());
}

/// Words on as many lines as they need, at most `lines`.
void write_wrapped(cairo_t* context, double x, double y, const std::string& text, double room, int lines) {
  std::string line;
  std::size_t at = 0;
  while (at < text.size() && lines > 1) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string longer = line.empty() ? text.substr(at, end - at) : line + " " + text.substr(at, end - at);
    if (!line.empty() && width_of(context, longer) > room) {
      write_line(context, x, y, line, room);
      y += line_height;
      --lines;
      line.clear();
    } else {
      line = longer;
      at = std::min(end + 1, text.size());
    }
  }
  if (at < text.size()) line += (line.empty() ? "" : " ") + text.substr(at);
  write_line(context, x, y, line, room);
}

std::string power_of_two(double value) {
  return "2^" + std::to_string(static_cast<int>(std::lround(std::log2(value))));
}

double scale_of(const Image8& picture, double cell) {
  return sheet_scale(picture.width, picture.height, static_cast<int>(cell));
}

/// Cairo's picture, enlarged without smoothing, at the context's origin.
void paint(cairo_t* context, const Image8& image, double scale) {
  const Surface picture = to_surface(image);
  cairo_save(context);
  cairo_scale(context, scale, scale);
  cairo_set_source_surface(context, picture.get(), 0, 0);
  cairo_pattern_set_filter(cairo_get_source(context), scale < 1 ? CAIRO_FILTER_GOOD : CAIRO_FILTER_NEAREST);
  cairo_pattern_set_extend(cairo_get_source(context), CAIRO_EXTEND_PAD);
  cairo_rectangle(context, 0, 0, image.width, image.height);
  cairo_fill(context);
  cairo_restore(context);
}

}  // namespace

double sheet_scale(int width, int height, int cell_width) {
  return std::min(static_cast<double>(cell_width) / width, 2.0 * cell_width / height);
}

int most_columns(int cell_width) {
  constexpr double most_side = 32767;
  return static_cast<int>((most_side - 2 * margin - label_width) / (cell_width + gap));
}

Image8 draw_sheet(const Sheet& sheet, int cell_width) {
  const double cell = cell_width;
  std::vector<double> heights;
  for (const SheetRow& row : sheet.rows) {
    double height = 0;
    for (const std::optional<SheetCell>& entry : row.cells)
      if (entry) height = std::max(height, entry->picture.height * scale_of(entry->picture, cell));
    heights.push_back(std::round(height));
  }
  const bool legend = !sheet.scales.empty() || !sheet.keys.empty();
  const double left = margin + label_width, top = margin + title_size + line_height + gap + line_height;
  double width = left + static_cast<double>(sheet.columns.size()) * (cell + gap) - gap + margin;
  width = std::max(width, 760.0);
  double height = top + (legend ? static_cast<double>(2 + sheet.scales.size()) * line_height + gap : 0) + margin;
  for (const double h : heights) height += h + caption_lines * line_height + gap;

  const Surface surface = make_surface(static_cast<int>(std::ceil(width)), static_cast<int>(std::ceil(height)));
  const Context owner(cairo_create(surface.get()));
  cairo_t* context = owner.get();
  // No hinting: the text's width then depends on the font alone.
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_set_font_options(context, options);
  cairo_font_options_destroy(options);
  cairo_set_source_rgb(context, 0.97, 0.97, 0.96);
  cairo_paint(context);

  cairo_set_source_rgb(context, ink, ink, ink);
  // A long title on a narrow sheet is set smaller rather than cut.
  double size = title_size;
  for (font(context, size, true); size > text_size && width_of(context, sheet.title) > width - 2 * margin; --size)
    font(context, size - 1, true);
  write_line(context, margin, margin + title_size, sheet.title, width - 2 * margin);
  font(context, text_size, false);
  write_line(context, margin, margin + title_size + line_height + 2, sheet.subtitle, width - 2 * margin);

  font(context, text_size + 1, true);
  for (std::size_t column = 0; column < sheet.columns.size(); ++column)
    write_line(context, left + static_cast<double>(column) * (cell + gap), top - 6, sheet.columns[column], cell);

  double y = top;
  for (std::size_t r = 0; r < sheet.rows.size(); ++r) {
    font(context, text_size, false);
    cairo_set_source_rgb(context, ink, ink, ink);
    write_wrapped(context, margin, y + text_size, sheet.rows[r].label, label_width - gap, 4);
    for (std::size_t column = 0; column < sheet.rows[r].cells.size(); ++column) {
      const std::optional<SheetCell>& entry = sheet.rows[r].cells[column];
      if (!entry) continue;
      const double x = left + static_cast<double>(column) * (cell + gap);
      cairo_save(context);
      cairo_translate(context, x, y);
      paint(context, entry->picture, scale_of(entry->picture, cell));
      cairo_restore(context);
      cairo_set_source_rgb(context, ink, ink, ink);
      font(context, text_size - 1.5, false);
      write_wrapped(context, x, y + heights[r] + text_size + 1, entry->caption, cell, static_cast<int>(caption_lines));
    }
    y += heights[r] + caption_lines * line_height + gap;
  }

  if (legend) {
    font(context, text_size, false);
    double x = left;
    for (const SheetScale& scale : sheet.scales) {
      const double least = std::ldexp(scale.most, -scale.octaves);
      const std::string low = "≤ " + power_of_two(least), high = "≥ " + power_of_two(scale.most);
      write_line(context, x, y + text_size, scale.text, width);
      x += width_of(context, scale.text + " ") + 4;
      write_line(context, x, y + text_size, low, width);
      x = std::ceil(x + width_of(context, low) + 6);  // whole pixels, so that no colour is mixed
      constexpr int steps = 96;
      for (int i = 0; i < steps; ++i) {
        const auto colour =
            golden::heat_colour(least * std::exp2(scale.octaves * (i + 0.5) / steps), scale.most, scale.octaves);
        cairo_set_source_rgb(context, colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0);
        cairo_rectangle(context, x + i, std::round(y) + 2, 1, text_size);
        cairo_fill(context);
      }
      x += steps + 6;
      cairo_set_source_rgb(context, ink, ink, ink);
      write_line(context, x, y + text_size, high, width);
      x = left, y += line_height;
    }
    for (const SheetKey& key : sheet.keys) {
      const double needed = text_size + 6 + width_of(context, key.text);
      if (x > left && x + needed > width - margin) x = left, y += line_height;
      cairo_set_source_rgb(context, key.colour[0] / 255.0, key.colour[1] / 255.0, key.colour[2] / 255.0);
      cairo_rectangle(context, x, y + 2, text_size, text_size);
      cairo_fill(context);
      cairo_set_source_rgb(context, ink, ink, ink);
      write_line(context, x + text_size + 6, y + text_size, key.text, width);
      x += needed + 24;
    }
  }
  return to_image(surface.get());
}

Image8 draw_mesh(const Image8& picture, const std::vector<Polyline>& lines, int cell_width) {
  // Neighbours draw the edge between them twice: lines fill 2·width/edge of the picture.
  constexpr double width = 1, share = 0.05, pale = 0.7;
  const double scale = scale_of(picture, cell_width);
  const Surface surface = make_surface(std::max(1, static_cast<int>(std::lround(picture.width * scale))),
                                       std::max(1, static_cast<int>(std::lround(picture.height * scale))));
  const Context owner(cairo_create(surface.get()));
  cairo_t* context = owner.get();
  paint(context, picture, scale);
  cairo_set_source_rgba(context, 1, 1, 1, pale);
  cairo_paint(context);
  cairo_set_line_width(context, width);
  cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
  for (const Polyline& line : lines) {
    cairo_set_source_rgba(context, ink, ink, ink, std::clamp(share * line.edge * scale / width, 0.0, 1.0));
    bool first = true;
    for (const auto& [x, y] : line.points) {
      first ? cairo_move_to(context, x * scale, y * scale) : cairo_line_to(context, x * scale, y * scale);
      first = false;
    }
    cairo_stroke(context);
  }
  return to_image(surface.get());
}

}  // namespace quadrille::compare
