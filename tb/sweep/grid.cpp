#include "tb/sweep/grid.hpp"

#include "model/port/config_text.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>
#include <string_view>

namespace quadrille::sweep {
namespace {

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::string quoted(std::string_view text) { return "'" + std::string(text) + "'"; }

/// All of `text` as a whole number; too large a magnitude becomes the largest, which is outside every range.
std::int64_t whole_number(std::string_view text) {
  if (const std::optional<int> value = toml_integer(text)) return *value;  // as --set and files take it
  std::int64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (rest != end || error == std::errc::invalid_argument) throw ConfigError(quoted(text) + " is not a whole number");
  if (error != std::errc{}) {
    using Limits = std::numeric_limits<std::int64_t>;
    return text.starts_with('-') ? Limits::min() : Limits::max();
  }
  return value;
}

/// A whole number inside the range of the key, without "auto".
int in_range(const ConfigKey& key, std::string_view text) {
  const std::int64_t value = whole_number(text);
  if (value < key.minimum || value > key.maximum) {
    throw ConfigError(std::string(text) + " is outside " + std::to_string(key.minimum) + ".." +
                      std::to_string(key.maximum) + (key.standard == -1 ? " (or auto)" : ""));
  }
  return static_cast<int>(value);
}

/// "A:B" or "A:B:STEP". The ends are checked first, so a range has no more values than its key.
std::vector<int> range_values(const ConfigKey& key, std::string_view text) {
  const std::vector<std::string_view> parts = split(text, ':');
  if (parts.size() > 3) throw ConfigError(quoted(text) + " is not FIRST:LAST or FIRST:LAST:STEP");
  const int first = in_range(key, parts[0]), last = in_range(key, parts[1]);
  const std::int64_t step = parts.size() == 3 ? whole_number(parts[2]) : 1;
  if (step == 0) throw ConfigError("the step of " + quoted(text) + " is 0");
  if (step > 0 ? first > last : first < last)
    throw ConfigError("the range " + quoted(text) + " is empty: its step has the wrong sign");
  const std::int64_t count = first == last ? 1 : (std::int64_t{last} - first) / step + 1;
  std::vector<int> values;
  for (std::int64_t i = 0; i < count; ++i) values.push_back(static_cast<int>(first + i * step));
  return values;
}

std::vector<int> item_values(const ConfigKey& key, std::string_view text) {
  if (text.find(':') != std::string_view::npos) return range_values(key, text);
  if (key.standard == -1 && (text == "auto" || text == "-1")) return {-1};
  if (key.name == "notch_exact" && (text == "true" || text == "false")) return {text == "true" ? 1 : 0};
  return {in_range(key, text)};
}

/// The product, or 2^64 − 1 where it is larger.
std::uint64_t saturating_multiply(std::uint64_t a, std::uint64_t b) {
  constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  return b != 0 && a > most / b ? most : a * b;
}

}  // namespace

Axis parse_axis(const std::string& text) {
  try {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw ConfigError("expected KEY=VALUES, such as significand_bits=8:26:2");
    Axis axis{text.substr(0, equals), {}};
    const ConfigKey& key = Config::key(axis.key);
    axis.key = key.name;
    for (const std::string_view item : split(std::string_view(text).substr(equals + 1), ',')) {
      for (const int value : item_values(key, item)) {
        if (std::ranges::find(axis.values, value) != axis.values.end())
          throw ConfigError((value == -1 ? "auto" : std::to_string(value)) + " is given twice");
        axis.values.push_back(value);
      }
    }
    return axis;
  } catch (const ConfigError& e) {
    throw ConfigError("axis '" + text + "': " + e.what());
  }
}

Config resolved(const Config& config) {
  Config result;
  for (const ConfigKey& key : Config::keys()) result.set(key.name, config.resolved(key.name));
  return result;
}

Grid::Grid(const Config& base, std::vector<Axis> axes, Kind kind) : base_(base), axes_(std::move(axes)), kind_(kind) {
  if (axes_.empty()) throw ConfigError("a grid needs an axis, such as significand_bits=8:26:2");
  std::set<std::string_view> seen;
  size_ = 1;
  for (const Axis& axis : axes_) {
    if (!seen.insert(axis.key).second) throw ConfigError("axis '" + axis.key + "' is given twice");
    if (axis.values.empty()) throw ConfigError("axis '" + axis.key + "' has no values");
    Config scratch;
    for (const int value : axis.values) scratch.set(axis.key, value);
    size_ = saturating_multiply(size_, axis.values.size());
  }
  if (kind_ == Kind::full) return;

  singles_.push_back(base_);
  for (const Axis& axis : axes_) {
    std::vector<Config> known{resolved(base_)};
    for (const int value : axis.values) {
      Config config = base_;
      config.set(axis.key, value);
      if (std::ranges::find(known, resolved(config)) != known.end()) continue;
      known.push_back(resolved(config));
      singles_.push_back(config);
    }
  }
  size_ = singles_.size();
}

std::uint64_t Grid::size() const { return size_; }

GridPoint Grid::point(std::uint64_t row) const {
  if (row >= size_) throw std::out_of_range("a grid of " + std::to_string(size_) + " points has no such row");
  GridPoint point{base_, {}};
  if (kind_ == Kind::one_at_a_time) {
    point.config = singles_[row];
  } else {
    for (std::size_t i = axes_.size(); i-- > 0;) {
      const std::vector<int>& values = axes_[i].values;
      point.config.set(axes_[i].key, values[row % values.size()]);
      row /= values.size();
    }
  }
  try {
    point.config.validate();
  } catch (const ConfigError& e) {
    point.refused = e.what();
  }
  return point;
}

std::vector<Axis> default_axes() {
  std::vector<Axis> axes;
  for (const ConfigKey& key : Config::keys())
    axes.push_back(parse_axis(std::string(key.name) + "=" + std::string(key.axis)));
  return axes;
}

std::vector<Axis> thousand_point_axes() {
  return {parse_axis("significand_bits=8:26:2"), parse_axis("quadratic_frac_bits=6:30:6"),
          parse_axis("align_guard_bits=0:4"), parse_axis("depth_bits=16:28:4")};
}

}  // namespace quadrille::sweep
