// quadrille compare: the methods of the papers on one input, as pictures and as a table.
#include "tb/studies/studies.hpp"

#include "tb/commands/commands.hpp"

#include "golden/io/atomic_file.hpp"
#include "golden/io/exr.hpp"
#include "golden/io/image_diff.hpp"
#include "golden/io/json_report.hpp"
#include "golden/methods/method.hpp"
#include "tb/options/command_line.hpp"
#include "tb/options/input.hpp"
#include "tb/options/written_file.hpp"
#include "tb/render/frame.hpp"
#include "tb/studies/compare/creases.hpp"
#include "tb/studies/compare/crop.hpp"
#include "tb/studies/compare/frame_error.hpp"
#include "tb/studies/compare/sheet.hpp"
#include "tb/studies/compare/slopes.hpp"
#include "tb/studies/compare/table.hpp"
#include "tb/studies/compare_plot.hpp"
#include "tb/studies/method_frame.hpp"
#include "tb/studies/method_input.hpp"
#include "tb/studies/method_lines.hpp"
#include "tb/studies/method_timing.hpp"
#include "tb/support/choices.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/output.hpp"
#include "tb/support/progress.hpp"
#include "tb/support/staged_directory.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <set>

namespace quadrille::tb {
namespace {

namespace fs = std::filesystem;
namespace methods = golden::methods;

constexpr const char* default_methods =
    "split02,split13,triangle,twofold,projective,bilinear,refine:20,adaptive,hybrid:pixels,hybrid:ndc,affine,mvc";

struct CompareOptions {
  CommonOptions common;
  StateOptions state;
  InputOptions input;
  std::vector<std::string> methods;
  std::string out, shade, texture, reference = "refine:20";
  std::vector<int> crease_sizes;
  std::vector<int> crop;
  int cell = 256, zoom = 0, repeats = 3;
  bool plot = false, wireframe = false;
};

/// Colours of the difference pictures for pixels without a difference.
constexpr std::array<std::uint8_t, 3> nothing_colour{56, 56, 59}, missing_colour{225, 60, 50},
    extra_colour{60, 200, 225}, undefined_colour{255, 0, 255}, other_colour{70, 130, 90};
const compare::SheetScale differences{"difference", 1, 14}, bends{"change of slope, per picture side", 4, 12};

/// One input at one size, with what drawing and shading it takes.
struct Scene {
  DrawInput input;
  EngineSettings settings;
  ShadeSettings shading;
};

/// `width` and `height` may be another size than that of the options. A scene or mesh is then projected anew; quads
/// that were never an object in space are made for the size of the options and scaled to the other.
Scene load_scene(const CompareOptions& options, int width, int height) {
  CommonOptions common = options.common;
  const bool projected = !options.input.scene.empty() || !options.input.mesh.empty();
  if (projected) common.size = std::to_string(width) + "x" + std::to_string(height);
  Scene scene;
  scene.settings.config = common.config();
  scene.settings.state = options.state.state(common, scene.settings.config);
  scene.settings.threads = common.thread_count();
  scene.settings.snap = false;
  scene.input = load_input(options.input, shade_of(options.shade, options.texture), scene.settings.state,
                           scene.settings.config, common.seed);
  if (!projected) {
    const auto [given_width, given_height] = common.viewport(scene.settings.config);
    for (WindowQuad& quad : scene.input.quads)
      for (WindowVertex& v : quad.vertex) {
        v.x *= static_cast<double>(width) / given_width;
        v.y *= static_cast<double>(height) / given_height;
      }
    common.size = std::to_string(width) + "x" + std::to_string(height);
    scene.settings.state = options.state.state(common, scene.settings.config);
  }
  adjust_state(scene.input, scene.settings.state);
  scene.shading.shade = scene.input.shade;
  scene.shading.slots = shade_slots(scene.input.shade, scene.input);
  scene.shading.texture = make_texture(options.texture, scene.input);
  scene.shading.lighting = scene.input.lighting;
  scene.shading.depth = scene.settings.state.depth;
  scene.shading.threads = scene.settings.threads;
  return scene;
}

std::string caption_of(const compare::FrameError& error) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "max %.1e, RMS %.1e", error.error.max(), error.rms);
  std::string caption = error.error.count() ? text.data() : "nothing to compare";
  const auto count = [&](std::uint64_t n, const char* what) {
    if (n) caption += ", " + std::to_string(n) + " " + what;
  };
  count(error.method_undefined, "undefined");
  count(error.missing, "missing");
  count(error.extra, "extra");
  return caption;
}

golden::Image8 difference_picture(const compare::AttributeImage& image, const compare::AttributeImage& reference,
                                  const compare::FrameError& error) {
  golden::Image8 picture;
  picture.width = image.width;
  picture.height = image.height;
  picture.rgba.reserve(error.image.size() * 4);
  for (std::size_t i = 0; i < error.image.size(); ++i) {
    std::array<std::uint8_t, 3> colour = nothing_colour;
    if (image.covered(i) && !image.defined(i))
      colour = undefined_colour;
    else if (!image.covered(i) && reference.covered(i))
      colour = missing_colour;
    else if (image.covered(i) && !reference.covered(i))
      colour = extra_colour;
    else if (image.covered(i) && !reference.defined(i))
      colour = nothing_colour;
    else if (image.quad[i] != reference.quad[i])
      colour = other_colour;
    else if (image.covered(i))
      colour = golden::heat_colour(static_cast<double>(error.image[i]), differences.most, differences.octaves);
    picture.rgba.insert(picture.rgba.end(), {colour[0], colour[1], colour[2], 255});
  }
  return picture;
}

/// Where attributes bend: a crease is a line.
golden::Image8 bend_picture(const compare::AttributeImage& image) {
  golden::Image8 picture{image.width, image.height, {}};
  for (const float change : compare::slope_changes(image)) {
    const std::array<std::uint8_t, 3> colour =
        std::isnan(change) ? nothing_colour
                           : golden::heat_colour(static_cast<double>(change), bends.most, bends.octaves);
    picture.rgba.insert(picture.rgba.end(), {colour[0], colour[1], colour[2], 255});
  }
  return picture;
}

/// A method's full name; a wrong one is told with the option that holds it.
std::string method_name(const char* option, const std::string& spec) {
  try {
    return methods::make_method(spec)->name();
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string(option) + ": " + error.what());
  }
}

/// METHOD.exr; a knob's colon would make `refine:20.exr` a file on another host to some tools, and is forbidden on
/// some systems.
std::string picture_name(std::string method) {
  std::ranges::replace(method, ':', '-');
  return method + ".exr";
}

nlohmann::ordered_json value_or_null(double value, bool measured = true) {
  if (!measured || !std::isfinite(value)) return nullptr;
  return value;
}

class Compare {
 public:
  Compare(const CompareOptions& options, const std::vector<std::string>& arguments)
      : options_(options), arguments_(arguments) {}

  int run() {
    const auto [width, height] = options_.common.viewport(options_.common.config());
    width_ = width, height_ = height;
    check_options();
    const Scene scene = load_scene(options_, width, height);
    print_remark(scene.input, options_.common);
    check_methods(scene.input);
    const std::vector<int> sizes = crease_sizes();

    Progress progress("compare " + scene.input.name, options_.methods.size() * (sizes.size() + 1) + 2,
                      options_.common.show_progress());
    std::uint64_t done = 0;
    const compare::AttributeImage truth = attribute_image(draw_truth(scene.input, scene.settings), scene.input);
    progress.set(++done);
    const compare::AttributeImage reference =
        attribute_image(draw_method(options_.reference, scene.input, scene.settings), scene.input);
    progress.set(++done);
    crop_.emplace(options_.crop.empty()
                      ? compare::Crop(truth, reference)
                      : compare::Crop(options_.crop[0], options_.crop[1], options_.crop[2], options_.crop[3]));
    cell_ = cell_width();
    stage_.emplace(options_.out);

    compare::Sheet sheet = sheet_frame(scene);
    std::vector<compare::Row> rows;
    for (const std::string& method : options_.methods) {
      rows.push_back(compare_method(method, scene, reference, truth, sheet));
      progress.set(++done, method);
    }
    // Creases last: by method, each at all sizes, since they count over the diagonals that every size can measure.
    std::vector<Scene> sized;
    CompareOptions at_size = options_;
    at_size.input.save_camera.clear();  // it is that of the pictures
    at_size.state.scissor.clear();      // so is this; a crease belongs to a whole quad
    for (const int size : sizes) sized.push_back(load_scene(at_size, scaled(width_, size), scaled(height_, size)));
    for (std::size_t m = 0; m < options_.methods.size(); ++m)
      add_jumps(options_.methods[m], sizes, sized, rows[m], [&] { progress.set(++done, options_.methods[m]); });
    for (std::size_t m = 0; m < options_.methods.size(); ++m)
      rows[m]["ns_per_pixel"] = value_or_null(
          time_method(options_.methods[m], scene.input, scene.settings.state, options_.repeats).ns_per_pixel);
    progress.finish();

    golden::save_png(stage_->path("sheet.png"), compare::draw_sheet(sheet, cell_), golden::PngFormat::rgb8);
    write_tables(scene, rows, sizes);
    if (options_.plot)
      write_plot(scene.input, scene.settings, stage_->folder().string(), options_.common, arguments_, options_.repeats);
    stage_->commit(stale_files());
    print(scene, rows, sizes);
    return exit_ok;
  }

 private:
  void check_options() {
    if (options_.out.empty()) throw UsageError("--out DIR is missing");
    if (fs::exists(options_.out) && !fs::is_directory(options_.out))
      throw UsageError("--out " + options_.out + ": is a file; expected a directory");
    if (inputs_given(options_.input) != 1)
      throw UsageError(
          "one input is needed: --scene NAME, --mesh F.obj, --quads F.quads, --stress FAMILY or --corner GROUP");
    if (options_.methods.empty()) throw UsageError("--methods: expected at least one method");
    method_name("--reference", options_.reference);
    std::set<std::string> seen;
    for (const std::string& method : options_.methods)
      if (!seen.insert(method_name("--methods", method)).second)
        throw UsageError("--methods: " + method + " is named twice");
    if (const int most = compare::most_columns(options_.cell); static_cast<int>(options_.methods.size()) > most)
      throw UsageError("--methods: " + std::to_string(options_.methods.size()) + " columns of --cell " +
                       std::to_string(options_.cell) + " pixels do not fit the sheet; at most " + std::to_string(most));
    if (const std::vector<int>& c = options_.crop;
        !c.empty() && (c[0] < 0 || c[1] < 0 || c[2] <= c[0] || c[3] <= c[1] || c[2] > width_ || c[3] > height_))
      throw UsageError("--crop: expected X0,Y0,X1,Y1 with 0 <= X0 < X1 <= " + std::to_string(width_) +
                       " and 0 <= Y0 < Y1 <= " + std::to_string(height_) + ", such as --crop 0,0," +
                       std::to_string((width_ + 1) / 2) + "," + std::to_string((height_ + 1) / 2));
    std::vector<std::string> read = options_.input.files();
    read.insert(read.end(), {options_.common.config_file, options_.texture});
    check_outputs({options_.input.save_camera, options_.common.json}, read);
  }

  void check_methods(const DrawInput& input) const {
    for (const std::string& method : options_.methods) method_quads(input, method);
    method_quads(input, options_.reference);
  }

  /// The longer side of the pictures that creases are measured in.
  std::vector<int> crease_sizes() const {
    std::vector<int> sizes = options_.crease_sizes;
    const int side = std::max(width_, height_);
    if (sizes.empty()) sizes = {side / 2, side, side * 2};
    const int limit = 1 << options_.common.config().viewport_bits;
    std::erase_if(sizes, [&](int size) { return options_.crease_sizes.empty() && (size < 16 || size > limit); });
    for (const int size : sizes)
      if (size < 16 || size > limit)
        throw UsageError("--crease-sizes " + std::to_string(size) + ": expected 16 to " + std::to_string(limit) +
                         " pixels");
    std::ranges::sort(sizes);
    sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
    return sizes;
  }

  int scaled(int side, int size) const {
    return std::max(1, static_cast<int>(std::lround(static_cast<double>(side) * size / std::max(width_, height_))));
  }

  /// --zoom in sheet pixels a pixel, or --cell.
  int cell_width() const {
    if (options_.zoom == 0) return options_.cell;
    const int width = crop_->x1 - crop_->x0, height = crop_->y1 - crop_->y0;
    const int cell = options_.zoom * std::max(width, (height + 1) / 2), most = 2048;
    if (cell > most || static_cast<int>(options_.methods.size()) > compare::most_columns(cell))
      throw UsageError("--zoom " + std::to_string(options_.zoom) + ": makes columns of " + std::to_string(cell) +
                       " pixels, and the sheet takes " + std::to_string(options_.methods.size()) + " of at most " +
                       std::to_string(most) + "; a smaller --crop or fewer --methods help");
    return cell;
  }

  compare::Sheet sheet_frame(const Scene& scene) const {
    const DrawInput& input = scene.input;
    compare::Sheet sheet;
    sheet.title = input.title + (input.paper.empty() ? "" : " (" + input.paper + ")");
    sheet.subtitle = input.name + ", " + std::to_string(width_) + " × " + std::to_string(height_) + ", " + input.shade +
                     (scene.settings.state.perspective
                          ? ""
                          : ", without perspective correction (refined cells are small: they come near the corrected "
                            "picture)") +
                     "; differences of " + compared_values(input);
    sheet.columns = options_.methods;
    if (crop_->x1 - crop_->x0 < width_ || crop_->y1 - crop_->y0 < height_)
      sheet.subtitle += "; shown from (" + std::to_string(crop_->x0) + ", " + std::to_string(crop_->y0) + ") to (" +
                        std::to_string(crop_->x1) + ", " + std::to_string(crop_->y1) + ")";
    sheet.rows = {{"picture", {}},
                  {"change of slope: a crease is a line", {}},
                  {"difference from " + options_.reference, {}},
                  {"difference from exact mean value", {}}};
    if (options_.wireframe) sheet.rows.push_back({"mesh", {}});
    sheet.scales = {differences, bends};
    sheet.keys = {{{0, 0, 0}, "equal"},
                  {missing_colour, "missing"},
                  {extra_colour, "extra"},
                  {undefined_colour, "undefined"},
                  {other_colour, "another quad is in front"}};
    return sheet;
  }

  compare::Row compare_method(const std::string& method, const Scene& scene, const compare::AttributeImage& reference,
                              const compare::AttributeImage& truth, compare::Sheet& sheet) const {
    const EngineSettings& settings = scene.settings;
    const FrameBuffer frame = draw_method(method, scene.input, settings);
    golden::FrameImage picture = shade_frame(frame, scene.shading);
    add_error_layers(frame, scene.input.quads, settings.config, settings.state, false, settings.threads, picture);
    golden::save_exr(stage_->path(picture_name(method)), picture);

    const compare::AttributeImage image = attribute_image(frame, scene.input);
    const compare::FrameError against_reference = compare::compare_frames(image, reference);
    const compare::FrameError against_truth = compare::compare_frames(image, truth);
    const auto add = [&](std::size_t at, const golden::Image8& whole, const std::string& caption) {
      sheet.rows[at].cells.emplace_back(compare::SheetCell{crop_->of(whole), caption});
    };
    add(0, frame_picture(picture), std::to_string(against_truth.method_covered) + " pixels");
    add(1, bend_picture(image), "");
    add(2, difference_picture(image, reference, against_reference), caption_of(against_reference));
    add(3, difference_picture(image, truth, against_truth), caption_of(against_truth));
    if (options_.wireframe) {
      const golden::Image8& shown = sheet.rows[0].cells.back()->picture;
      const auto lines = method_lines(method, scene.input, settings.state, *crop_,
                                      compare::sheet_scale(shown.width, shown.height, cell_));
      sheet.rows[4].cells.emplace_back(compare::SheetCell{compare::draw_mesh(shown, lines, cell_), ""});
    }

    const methods::Census census =
        methods::make_method(method)->census(method_quads(scene.input, method), method_view(settings.state));
    compare::Row row;
    row["method"] = method;
    row["fragments"] = frame.fragments();
    row["covered"] = against_truth.method_covered;
    row["missing"] = against_truth.missing;
    row["extra"] = against_truth.extra;
    row["undefined"] = against_truth.method_undefined;
    row["other_quad"] = against_truth.other_quad;
    for (const auto& [name, error] : {std::pair{"reference", &against_reference}, std::pair{"truth", &against_truth}}) {
      const std::string prefix = name;
      const bool measured = error->error.count() > 0;
      row[prefix + "_max"] = value_or_null(error->error.max(), measured);
      row[prefix + "_p999"] = value_or_null(error->error.p999(), measured);
      row[prefix + "_rms"] = value_or_null(error->rms, measured);
      row[prefix + "_wrong"] = error->wrong;
    }
    row["quads"] = census.quads;
    row["refused"] = census.refused;
    row["emitted_quads"] = census.emitted_quads;
    row["triangles"] = census.triangles;
    row["t_vertices"] = census.t_vertices;
    row["affine"] = census.affine;
    return row;
  }

  template <class Tick>
  static void add_jumps(const std::string& method, const std::vector<int>& sizes, const std::vector<Scene>& sized,
                        compare::Row& row, Tick&& tick) {
    std::vector<std::vector<compare::QuadCreases>> creases;
    std::vector<compare::InnerJumps> inside;
    compare::DiagonalSet use;
    std::optional<compare::Gaps> gaps;  // of the largest size, which comes last
    for (const Scene& scene : sized) {
      const std::vector<methods::Quad> quads = method_quads(scene.input, method);
      const compare::AttributeImage image =
          attribute_image(draw_method(method, scene.input, scene.settings), scene.input);
      creases.push_back(compare::measure_quad_diagonals(image, quads));
      const compare::DiagonalSet measured = compare::measured_diagonals(creases.back());
      use = creases.size() == 1 ? measured : compare::in_both(use, measured);
      inside.push_back(compare::measure_inside(image));
      gaps = compare::measure_gaps(image, quads);
      tick();
    }
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const std::string at = "_" + std::to_string(sizes[i]);
      const compare::Diagonals diagonals = compare::combine_diagonals(creases[i], use);
      for (const auto& [name, diagonal] :
           {std::pair{"crease02", &diagonals.d02}, std::pair{"crease13", &diagonals.d13}}) {
        const compare::LineJump& jump = diagonal->jump;
        const bool measured = jump.profiles() > 0;
        row[name + at] = value_or_null(jump.step_slope.max(), measured);
        row[name + ("_rms" + at)] = value_or_null(jump.step_slope.rms(), measured);
        row[name + ("_fit" + at)] = value_or_null(jump.line_slope.max(), measured);
        row[name + ("_fit_rms" + at)] = value_or_null(jump.line_slope.rms(), measured);
        row[name + ("_at_line" + at)] = value_or_null(jump.parabola_slope.max(), measured);
        row[name + ("_at_line_rms" + at)] = value_or_null(jump.parabola_slope.rms(), measured);
        row[name + ("_quads" + at)] = diagonal->quads;
        row[name + ("_profiles" + at)] = jump.profiles();
      }
      row["jump_inside" + at] = value_or_null(inside[i].line_slope.max(), inside[i].line_slope.count() > 0);
      row["jump_inside_p999" + at] = value_or_null(inside[i].line_slope.p999(), inside[i].line_slope.count() > 0);
    }
    const bool measured = gaps && gaps->measured > 0;
    row["gap_max"] = value_or_null(measured ? gaps->jump.gap.max() : 0, measured);
    row["gap_rms"] = value_or_null(measured ? gaps->jump.gap.rms() : 0, measured);
    row["gap_pixels"] = gaps ? gaps->empty + gaps->foreign : 0;
  }

  /// Pictures and plots that an earlier run into the same directory may have left.
  std::vector<std::string> stale_files() const {
    std::ifstream table(fs::path(options_.out) / "table.json");
    const nlohmann::json earlier = nlohmann::json::parse(table, nullptr, false);
    if (!earlier.is_object() || !earlier.contains("methods") || !earlier["methods"].is_array()) return {};
    std::vector<std::string> names{"plot.json", "plot_time.png", "plot_setup.png"};
    for (const nlohmann::json& row : earlier["methods"])
      if (row.is_object() && row.contains("method") && row["method"].is_string())
        names.push_back(picture_name(row["method"].get<std::string>()));
    return names;
  }

  void write_tables(const Scene& scene, const std::vector<compare::Row>& rows, const std::vector<int>& sizes) const {
    const DrawInput& input = scene.input;
    nlohmann::ordered_json json = golden::begin_report(scene.settings.config, options_.common.seed, arguments_);
    json["input"] = input.name;
    json["size"] = std::to_string(width_) + "x" + std::to_string(height_);
    json["shade"] = input.shade;
    json["perspective"] = scene.settings.state.perspective;
    json["reference"] = options_.reference;
    json["differences_of"] = compared_values(input);
    json["crease_sizes"] = sizes;
    json["methods"] = rows;
    golden::save_json(stage_->path("table.json"), json);
    golden::write_file(stage_->path("table.csv"), compare::table_csv(rows), golden::AtomicFile::Dash::refused);
    golden::write_file(stage_->path("table.md"), compare::table_markdown(rows, sizes, options_.reference),
                       golden::AtomicFile::Dash::refused);
    if (!options_.common.json.empty()) golden::save_json(options_.common.json, json);
  }

  void print(const Scene& scene, const std::vector<compare::Row>& rows, const std::vector<int>& sizes) const {
    std::FILE* out = options_.common.text();
    if (out == nullptr) return;
    const auto text = [](const compare::Row& value, const char* format) {
      std::array<char, 32> buffer{};
      if (value.is_null()) return std::string("-");
      std::snprintf(buffer.data(), buffer.size(), format, value.get<double>());
      return std::string(buffer.data());
    };
    std::fprintf(out, "%s, %dx%d, %s; differences of %s\n", scene.input.name.c_str(), width_, height_,
                 scene.input.shade.c_str(), compared_values(scene.input));
    const std::string size = sizes.empty() ? "" : std::to_string(sizes[(sizes.size() - 1) / 2]);
    std::fprintf(out, "%-18s %8s %8s %8s %9s %8s  %-19s %-19s %-19s %9s %9s %8s\n", "method", "pixels", "missing",
                 "extra", "undefined", "wrong", ("from " + options_.reference).c_str(), "from exact MV",
                 sizes.empty() ? "" : ("crease at " + size + " px").c_str(), "quads", "triangles", "ns/px");
    std::fprintf(out, "%-18s %8s %8s %8s %9s %8s  %9s %9s %9s %9s %9s %9s\n", "", "", "", "", "", "", "max", "RMS",
                 "max", "RMS", sizes.empty() ? "" : "0-2", sizes.empty() ? "" : "1-3");
    for (const compare::Row& row : rows)
      std::fprintf(out, "%-18s %8llu %8llu %8llu %9llu %8llu  %9s %9s %9s %9s %9s %9s %9llu %9llu %8s\n",
                   row["method"].get<std::string>().c_str(), row["covered"].get<unsigned long long>(),
                   row["missing"].get<unsigned long long>(), row["extra"].get<unsigned long long>(),
                   row["undefined"].get<unsigned long long>(), row["truth_wrong"].get<unsigned long long>(),
                   text(row["reference_max"], "%.1e").c_str(), text(row["reference_rms"], "%.1e").c_str(),
                   text(row["truth_max"], "%.1e").c_str(), text(row["truth_rms"], "%.1e").c_str(),
                   sizes.empty() ? "" : text(row["crease02_" + size], "%.1e").c_str(),
                   sizes.empty() ? "" : text(row["crease13_" + size], "%.1e").c_str(),
                   row["emitted_quads"].get<unsigned long long>(), row["triangles"].get<unsigned long long>(),
                   text(row["ns_per_pixel"], "%.3g").c_str());
    std::fprintf(
        out,
        "wrong: pixels with an attribute error above %g from exact mean value coordinates (exact MV), which mvc "
        "computes by definition\n",
        compare::default_wrong_above);
    const bool no_crease = !sizes.empty() && std::ranges::all_of(rows, [&](const compare::Row& row) {
      return row["crease02_" + size].is_null() && row["crease13_" + size].is_null();
    });
    if (no_crease)
      std::fprintf(
          out,
          "No crease: the quads are too small or not convex in front of the eye (eight pixels of a row or column at "
          "each size are needed); larger --crease-sizes may help\n");
    for (const compare::Row& row : rows)
      if (row["refused"].get<std::uint64_t>() > 0)
        std::fprintf(out, "%s refuses %llu of %llu quads\n", row["method"].get<std::string>().c_str(),
                     row["refused"].get<unsigned long long>(), row["quads"].get<unsigned long long>());
    std::fprintf(out, "wrote %s: sheet.png, METHOD.exr, table.json, table.csv, table.md%s\n", options_.out.c_str(),
                 options_.plot ? ", plot.json, plot_time.png, plot_setup.png" : "");
  }

  const CompareOptions& options_;
  const std::vector<std::string>& arguments_;
  std::optional<StagedDirectory> stage_;
  std::optional<compare::Crop> crop_;
  int width_ = 0, height_ = 0, cell_ = 0;
};

std::string method_list() {
  std::string text = "Methods, with a knob after a colon:\n";
  for (const methods::MethodInfo& info : methods::list_methods()) {
    text += "  " + std::string(info.name) + std::string(12 - std::min<std::size_t>(11, info.name.size()), ' ') +
            std::string(info.what);
    if (!info.knob.empty()) text += "; " + std::string(info.knob);
    text += "\n";
  }
  return text;
}

}  // namespace

void add_compare_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("compare", compare_description);
  end_help(*command,
           method_list() +
               "\nWrites sheet.png (a column per method), METHOD.exr, table.json, table.csv and table.md. A crease is "
               "the largest change of an attribute's slope across a quad's diagonal (tb/studies/compare/README.md).",
           "0 done; 2 usage or input error; 3 missing tool",
           {"compare --scene phong_mesh --methods split02,mvc --out fig11",
            "compare --scene fig10_concave --crop 180,180,280,280 --out crease",
            "compare --mesh spot.obj --shade uv --plot --out spot"});
  const auto options = std::make_shared<CompareOptions>();
  options->input.add_to(*command);
  options->common.add_to(*command);
  options->state.add_to(*command);
  command->add_option("--methods", options->methods, "Methods in the order of the columns (default: all that apply)")
      ->delimiter(',')
      ->type_name("A,B,…");
  command->add_option("--reference", options->reference, "Method to measure differences from")
      ->type_name("METHOD")
      ->capture_default_str();
  command
      ->add_option("--crease-sizes", options->crease_sizes,
                   "Longer sides of the viewports for creases (default: half, same, double)")
      ->delimiter(',')
      ->type_name("N,N,…");
  command->add_option("--repeats", options->repeats, "Timed draws; the fastest counts")
      ->check(CLI::Range(1, 100))
      ->capture_default_str()
      ->type_name("N");
  options->input.add_picture_options(*command, options->shade, options->texture);
  writes_folder(command->add_option("--out", options->out, "Directory of the results; made if missing"))
      ->group(output_group);
  command
      ->add_option(
          "--crop", options->crop,
          "Pixels that the sheet shows, without column X1 and row Y1\n(default: what is drawn, where that is small)")
      ->delimiter(',')
      ->expected(4)
      ->type_name("X0,Y0,X1,Y1")
      ->group(output_group);
  CLI::Option* cell = command->add_option("--cell", options->cell, "Width of a picture on the sheet in pixels")
                          ->check(CLI::Range(32, 2048))
                          ->capture_default_str()
                          ->type_name("N")
                          ->group(output_group);
  command->add_option("--zoom", options->zoom, "Show a pixel as N by N, instead of --cell")
      ->check(CLI::Range(1, 64))
      ->excludes(cell)
      ->type_name("N")
      ->group(output_group);
  command->add_flag("--wireframe", options->wireframe, "Add a row with each method's mesh")->group(output_group);
  command->add_flag("--plot", options->plot, "Plot error against time and against triangles")->group(output_group);
  command->callback([options, &invocation] {
    invocation.run = [options, &invocation] {
      if (options->methods.empty()) {
        const bool object_space = !options->input.scene.empty() || !options->input.mesh.empty();
        std::string_view rest = default_methods;
        while (!rest.empty()) {
          const std::size_t comma = std::min(rest.find(','), rest.size());
          const std::string method(rest.substr(0, comma));
          rest.remove_prefix(std::min(rest.size(), comma + 1));
          if (object_space || !methods::make_method(method)->needs_object_space()) options->methods.push_back(method);
        }
      }
      return Compare(*options, invocation.arguments).run();
    };
  });
}

}  // namespace quadrille::tb
