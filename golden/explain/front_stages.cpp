#include "golden/explain/numbers.hpp"
#include "golden/explain/stages.hpp"
#include "model/port/boundaries.hpp"
#include "model/port/snap.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace quadrille::explain {
namespace {

std::string at(const char* name, std::size_t i) { return name + std::to_string(i); }

// ---- Snapping ----

/// A vertex as given in exact arithmetic, with the k that makes it the port's.
struct ExactVertex {
  Float113 x, y, w, z, k;
  bool ordinary;

  ExactVertex(const WindowVertex& v, const Config& c) : w(v.w), z(v.z) {
    x = v.x - w / 2;
    y = v.y - w / 2;
    // Rounded to the grid the position must stay below the guard band's end; a tie would reach it.
    const Float113 reach = scaled(1, c.pos_int()) - scaled(1, -c.subpixel_bits - 1);
    ordinary = w > 0 && magnitude(x) < reach * w && magnitude(y) < reach * w;
    const Float113 size = std::max(magnitude(x), magnitude(y));
    k = 1 / (ordinary ? w : std::max(scaled(size, -c.pos_int()), magnitude(w)));
  }
};

/// What one vertex beat holds, beside the given vertex.
class VertexNumbers {
 public:
  VertexNumbers(const PipelineContext& context, const SnappedQuad& snapped, const WindowQuad* given)
      : context_(context), c_(context.config), snapped_(snapped), given_(given) {}

  void add(std::size_t i, Stage& stage) const {
    const VertexBeat beat = beat_of(snapped_, i);
    for (Draft& d : drafts_of([&](auto& f) { visit(beat, c_, f); })) {
      if (d.stem == "id") continue;
      const bool base = d.stem.starts_with("base_") || d.stem.starts_with("depth_");
      if (base && i != 0) continue;
      const bool attribute = d.stem == "attr" || d.stem == "base_attr";
      if (attribute && d.index >= context_.state.attributes) continue;
      if (d.stem == "attr" && i == 0) continue;
      const bool depth = d.stem == "z" || d.stem.starts_with("depth_") || d.stem == "base_depth";
      d.number.unused = depth && !context_.state.depth;
      name(d, i);
      if (given_ != nullptr) compare(d, i);
      stage.numbers.push_back(std::move(d.number));
    }
  }

 private:
  static void name(Draft& d, std::size_t i) {
    Number& n = d.number;
    const std::string corner = std::to_string(i);
    if (d.stem == "x") n.name = "X" + corner, n.meaning = "k times x, from the centre of pixel 0";
    if (d.stem == "y") n.name = "Y" + corner, n.meaning = "k times y, down";
    if (d.stem == "w") n.name = "W" + corner, n.meaning = "k times w";
    if (d.stem == "k") n.name = "k" + corner, n.meaning = "factor of the corner; 1/w of an ordinary one";
    if (d.stem == "z") n.name = "Z" + corner, n.meaning = "k times (z̃ - base · w)";
    if (d.stem == "attr")
      n.name = "b" + corner + "." + std::to_string(d.index),
      n.meaning = "k times (attribute - base), attribute " + std::to_string(d.index);
    if (d.stem == "base_attr")
      n.name = at("base a", static_cast<std::size_t>(d.index)),
      n.meaning = "attribute of corner 0: what others are counted from";
    if (d.stem == "base_depth") n.name = "base z", n.meaning = "window z of the first corner with w > 0";
    if (d.stem == "depth_low") n.name = "z low", n.meaning = "least window z of a corner, 0 and below if some w <= 0";
    if (d.stem == "depth_high") n.name = "z high", n.meaning = "greatest window z of a corner";
  }

  void compare(Draft& d, std::size_t i) const {
    const ExactVertex v(given_->vertex[i], c_);
    const double one = 1, half = 0.5;
    const std::optional<double> grid = v.ordinary ? std::optional(std::ldexp(1.0, -c_.subpixel_bits)) : std::nullopt;
    const auto set = [&](Float113 exact, const char* unit, std::optional<double> place = {}) {
      set_exact(d.number, {exact, one, unit, half, {}, place});
    };
    if (d.stem == "x") set(v.k * v.x, "px", grid);
    if (d.stem == "y") set(v.k * v.y, "px", grid);
    if (d.stem == "w") set(v.ordinary ? Float113(1) : v.k * v.w, "");
    if (d.stem == "k") set(v.k, "");
    if (d.stem == "z") set(v.k * (v.z - scaled(Float113(snapped_.base.depth), -c_.depth_bits) * v.w), "");
    if (d.stem == "base_attr") set(attribute(0, d.index), "");
    if (d.stem == "attr") {
      const Float113 own = attribute(i, d.index), first = attribute(0, d.index);
      const auto base =
          scaled(Float113(snapped_.base.attribute[static_cast<std::size_t>(d.index)]), -c_.attribute_frac());
      const Float113 k = context_.state.perspective ? v.k : scaled(Float113(snapped_.vertex[i].w), -c_.frac());
      set(own == first ? Float113(0) : k * (own - base), "");
    }
    if (d.stem == "base_depth") {
      const auto first = std::ranges::find_if(given_->vertex, [](const WindowVertex& g) { return g.w > 0; });
      if (first == given_->vertex.end()) return;
      const Float113 z = Float113(first->z) / first->w;
      set(std::min(std::max(z, Float113(0)), Float113(1)), "");
    }
  }

  Float113 attribute(std::size_t corner, int index) const {
    const std::vector<double>& values = given_->attribute[corner];
    return static_cast<std::size_t>(index) < values.size() ? values[static_cast<std::size_t>(index)] : 0.0;
  }

  const PipelineContext& context_;
  const Config& c_;
  const SnappedQuad& snapped_;
  const WindowQuad* given_;
};

// ---- Functions of quad and tile ----

/// Coefficients of functions around pixel (x, y), all exact but where bits are dropped.
class Functions {
 public:
  Functions(const SnappedQuad& quad, int x, int y, const Config& config) : view_(quad, x, y), c_(config) {}

  /// `part`: value, gx, gy or q.
  void set(Draft& d, std::string_view part) const {
    const bool linear = d.stem.starts_with("lin_");
    const auto k = static_cast<std::size_t>(d.index);
    const ExactForm form = linear ? view_.linear(k) : view_.quadratic(k);
    const __int128 exact = part == "gx" ? form.gx : part == "gy" ? form.gy : part == "q" ? form.q : form.value;
    const std::string function = linear             ? std::string("E") + pair_name(k)
                                 : k < linear_count ? std::string("D") + pair_name(k)
                                                    : at("R²", k - linear_count);
    d.number.name = part == "value" ? function : function + " " + std::string(part);
    if (d.number.unused) return;
    set_integer(d.number, exact, linear || c_.qdrop() == 0);
  }

  void set_length(Draft& d) const {
    const auto k = static_cast<std::size_t>(d.index);
    d.number.name = std::string("|V") + pair_name(k)[0] + "-V" + pair_name(k)[1] + "|²";
    set_integer(d.number, view_.squared_length(k), c_.qdrop() == 0);
  }

 private:
  void set_integer(Number& number, __int128 exact, bool all_bits) const {
    // Bits are dropped below: nothing, or up to one place.
    set_exact(number, {scaled(Float113(exact), -2 * c_.frac()), 1, "px²", all_bits ? 0.0 : 1.0, {}, {}});
  }

  ExactView view_;
  const Config& c_;
};

std::string_view part_of(const std::string& stem) { return std::string_view(stem).substr(stem.find('_') + 1); }

Stage setup_stage(const Subject& s) {
  const SetupResult& setup = s.machine.setup;
  Stage stage{"setup",
              "The quad's edge functions, from its first tile's corner pixel",
              "quad_setup",
              "setup",
              {"E_ij(x, y) = S_i × S_j, with S_i = (X_i - W_i x, Y_i - W_i y)",
               "            = value + dx gx + dy gy, at dx columns and dy rows from pixel (" +
                   std::to_string(setup.tile_x0 << s.config().tile_log2) + ", " +
                   std::to_string(setup.tile_y0 << s.config().tile_log2) + ")"},
              "Hormann & Tarini, section 4.1: the edge functions of expression (12)",
              {},
              {},
              {}};
  stage.remarks.push_back(
      "E_ij is 0 on the line through corners i and j. It is linear, so a step to the next pixel is an addition.");
  const Functions functions(s.snapped, setup.tile_x0 << s.config().tile_log2, setup.tile_y0 << s.config().tile_log2,
                            s.config());
  for (Draft& d : drafts_of([&](auto& f) { visit(setup, s.config(), f); })) {
    if (d.stem == "slot") continue;
    if (d.stem.starts_with("lin_"))
      functions.set(d, part_of(d.stem));
    else if (d.stem == "length2")
      functions.set_length(d);
    else
      d.number.name = d.stem;
    stage.numbers.push_back(std::move(d.number));
  }
  return stage;
}

Stage tile_stage(const Subject& s) {
  const TileEntry& tile = s.machine.tile;
  const int x = tile.tile_x << s.config().tile_log2, y = tile.tile_y << s.config().tile_log2;
  Stage stage{"tile",
              "The same functions from the tile's corner pixel, and the quadratic ones",
              "tile_context",
              "tile",
              {"f(dx, dy) = value + dx gx + dy gy + q (dx² + dy²), from pixel (" + std::to_string(x) + ", " +
                   std::to_string(y) + ")",
               "D_ij = S_i · S_j and R²_i = |S_i|²"},
              "Hormann & Tarini, section 4.2: D_i, and the squares of r_i",
              {},
              {},
              {}};
  if (!s.machine.setup.homogeneous)
    stage.remarks.push_back("All W are 1: D follows from three squared lengths, so its own functions are not formed.");
  const Functions functions(s.snapped, x, y, s.config());
  for (Draft& d : drafts_of([&](auto& f) { visit(tile, s.config(), f); })) {
    if (d.stem == "slot" || d.stem == "end_token") continue;
    if (d.stem.starts_with("quad_") || d.stem.starts_with("lin_")) {
      d.number.unused = d.stem.starts_with("quad_") && d.index < linear_count && !s.machine.setup.homogeneous;
      functions.set(d, part_of(d.stem));
    } else {
      d.number.name = d.stem;
    }
    stage.numbers.push_back(std::move(d.number));
  }
  return stage;
}

Stage stamp_stage(const Subject& s) {
  const int row = s.machine.trace.y & (s.config().tile() - 1), dx = s.machine.trace.x & (s.config().tile() - 1);
  Stage stage{"stamp",
              "Which pixels of the tile's row the quad covers",
              "stamp_coverage",
              "stamp",
              {"E20 and E01 and E12 and (E23 or E30), or not E20 and E23 and E30 and (E01 or E12)",
               "E stands for E > 0 (back face), or in all places for E < 0 (front face)"},
              "Hormann & Tarini, expression (12)",
              {},
              {},
              {}};
  stage.remarks.push_back("A mask has a bit for each pixel of the row, the first at the right end. This pixel is bit " +
                          std::to_string(dx) + ".");
  const StampEntry stamp{false, 0, row, s.machine.row.mask, s.machine.row.front, s.machine.row.tie};
  for (Draft& d : drafts_of([&](auto& f) { visit(stamp, s.config(), f); })) {
    if (d.stem == "end_token" || d.stem == "tile_ptr") continue;
    d.number.name = d.stem;
    stage.numbers.push_back(std::move(d.number));
  }
  return stage;
}

}  // namespace

Stage snapping_stage(const PipelineContext& context, const SnappedQuad& snapped, const WindowQuad* given) {
  Stage stage{"snapping",
              "The corners become integers",
              "",
              "vertex",
              {"(X, Y, W) = k (x̃ - w/2, ỹ - w/2, w): pixel centres become whole numbers",
               "Z = k (z̃ - base w), b = k (a - base)"},
              "Hormann & Tarini, eq. (1), shifted by half a pixel",
              {},
              {},
              {}};
  if (!context.state.perspective) stage.remarks.push_back("Perspective is off: b has W for k.");
  for (std::size_t i = 0; given != nullptr && i < 4; ++i) {
    if (ExactVertex(given->vertex[i], context.config).ordinary) continue;
    stage.remarks.push_back("Corner " + std::to_string(i) +
                            (given->vertex[i].w > 0 ? " is outside the guard band" : " is not in front of the eye") +
                            ": k makes the largest of |X|, |Y| and |W| fill its format.");
  }
  stage.remarks.insert(
      stage.remarks.begin(),
      {"An ordinary corner has k = 1/w: its place on the screen is rounded to 1/" +
           std::to_string(1 << context.config.subpixel_bits) + " px, and W is 1.",
       "base: the value at corner 0 (of z: at the first corner with w > 0). What is stored for the others is "
       "a difference, so that errors are relative to what varies over the quad."});
  if (given != nullptr)
    stage.remarks.push_back("exact: of the corners as given. All later exact values are of the snapped corners.");
  const VertexNumbers numbers(context, snapped, given);
  for (std::size_t i = 0; i < 4; ++i) numbers.add(i, stage);
  return stage;
}

std::vector<Stage> front_stages(const Subject& s) { return {setup_stage(s), tile_stage(s), stamp_stage(s)}; }

}  // namespace quadrille::explain
