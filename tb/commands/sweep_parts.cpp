#include "tb/commands/sweep_parts.hpp"

#include "tb/sweep/search.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>

namespace quadrille::tb {
namespace {

using sweep::ErrorKind;
using sweep::Output;

constexpr double worth_saying = 0.9;  ///< of the part before: a key that lowers it by less is no remedy

std::string number(const char* format, double value) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string_view kind_name(ErrorKind kind) { return sweep::error_kind_names[static_cast<std::size_t>(kind)]; }

/// Keys that a part of an output's error may depend on, the most likely first.
std::vector<std::string_view> candidate_keys(ErrorKind part, Output output, bool ordinary) {
  constexpr std::array<std::string_view, 5> of_snapping{"subpixel_bits", "homogeneous_frac_bits", "significand_bits",
                                                        "attribute_frac_bits", "depth_bits"};
  constexpr std::array<std::string_view, 7> of_arithmetic{
      "significand_bits",    "align_guard_bits",    "quadratic_frac_bits", "sqrt_segments_log2",
      "recip_segments_log2", "attribute_frac_bits", "depth_bits"};
  std::vector<std::string_view> keys;
  if (part == ErrorKind::snapping)
    keys.assign(of_snapping.begin(), of_snapping.end());
  else
    keys.assign(of_arithmetic.begin(), of_arithmetic.end());
  std::vector<std::string_view> idle = sweep::idle_keys(std::span(&output, 1));
  if (ordinary) idle.emplace_back("homogeneous_frac_bits");  // no vertex uses those bits
  std::erase_if(keys, [&](std::string_view key) { return std::ranges::find(idle, key) != idle.end(); });
  return keys;
}

bool possible(const Config& config) {
  try {
    config.validate();
    return true;
  } catch (const ConfigError&) {
    return false;
  }
}

/// `config` with one more of `key`; where a position then has too many bits, in a viewport just large enough.
std::optional<Config> one_more(const Config& config, std::string_view key, const DrawState& state) {
  const int value = config.resolved(key) + 1;
  if (value > Config::key(key).maximum) return std::nullopt;
  Config more = config;
  more.set(key, value);
  if (possible(more)) return more;
  const auto pixels = static_cast<unsigned>(std::max({state.width, state.height, 2}));
  const int least = std::max(static_cast<int>(std::bit_width(pixels - 1)), Config::key("viewport_bits").minimum);
  if (least >= config.viewport_bits) return std::nullopt;
  more.set("viewport_bits", least);
  if (possible(more)) return more;
  return std::nullopt;
}

std::string change(const Config& from, const Config& to) {
  std::string text;
  for (const ConfigKey& key : Config::keys())
    if (from.get(key.name) != to.get(key.name))
      text += (text.empty() ? "" : " ") + std::string(key.name) + "=" + std::to_string(to.get(key.name));
  return text;
}

}  // namespace

TargetParts target_parts(const ErrorTarget& target, const Config& config, const sweep::PointResult& result,
                         bool ordinary, const DrawState& state, const EvaluateAll& evaluate) {
  const auto error = [&](ErrorKind kind, const sweep::PointResult& of) {
    return sweep::ErrorColumn{kind, target.column.output, target.column.statistic}.value(of);
  };
  TargetParts parts{.target = target,
                    .arithmetic = error(ErrorKind::arithmetic, result),
                    .snapping = error(ErrorKind::snapping, result),
                    .total = error(ErrorKind::total, result),
                    .in_the_way = {},
                    .remedy = {},
                    .no_remedy = {}};
  if (!(parts.total > target.limit)) return parts;
  const ErrorKind part = parts.snapping > parts.arithmetic ? ErrorKind::snapping : ErrorKind::arithmetic;
  parts.in_the_way = part;

  std::vector<Config> tried;
  std::vector<std::string_view> keys;
  for (const std::string_view key : candidate_keys(part, target.column.output, ordinary)) {
    if (const std::optional<Config> more = one_more(config, key, state)) {
      tried.push_back(*more);
      keys.push_back(key);
    } else {
      parts.no_remedy.push_back(std::string(key) + " cannot grow beyond " + std::to_string(config.resolved(key)));
    }
  }
  const std::vector<sweep::PointResult> results = evaluate(tried);
  for (std::size_t i = 0; i < tried.size(); ++i) {
    const Remedy remedy{change(config, tried[i]), error(part, results[i]), error(ErrorKind::total, results[i])};
    if (remedy.part <= worth_saying * parts.part()) {
      if (!parts.remedy || remedy.total < parts.remedy->total) parts.remedy = remedy;
    } else {
      parts.no_remedy.push_back(remedy.change + " leaves it at " + number("%.3e", remedy.part));
    }
  }
  return parts;
}

std::string verdict(const TargetParts& parts) {
  const std::string& given = parts.target.text;
  if (std::isnan(parts.total)) {
    const bool both = std::isnan(parts.arithmetic) && std::isnan(parts.snapping);
    return std::string(both                           ? "Neither part of the error was"
                       : std::isnan(parts.arithmetic) ? "Arithmetic error was not"
                                                      : "Snapping error was not") +
           " measured on this input, so its total is not known.";
  }
  const double ratio = parts.total / parts.target.limit;
  if (!parts.in_the_way)
    return "The total error meets " + given + " too: " + number("%.0f %%", 100 * ratio) + " of it.";
  const std::string part(kind_name(*parts.in_the_way));
  std::string text = "The total error is " + number("%.3g", ratio) + " times " + given;
  if (parts.target.column.output == Output::colour)
    text += ", " + number("%.2g", parts.total * 255) + " steps of 8 bits";
  text += ". The " + part + " error is in the way";
  if (parts.remedy)
    return text + ": " + parts.remedy->change + " lowers it from " + number("%.3e", parts.part()) + " to " +
           number("%.3e", parts.remedy->part) + ", and the total to " +
           number("%.3g", parts.remedy->total / parts.target.limit) + " times the target.";
  text += ", and no key lowers it by a tenth:";
  for (std::size_t i = 0; i < parts.no_remedy.size(); ++i) text += (i == 0 ? " " : ", ") + parts.no_remedy[i];
  text += ".";
  if (*parts.in_the_way == ErrorKind::snapping) text += " It is smaller where quads cover more pixels.";
  return text;
}

nlohmann::ordered_json to_json(const TargetParts& parts) {
  const auto json_number = [](double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
  };
  nlohmann::ordered_json json{{"given", parts.target.text},
                              {"column", parts.target.column.name()},
                              {"limit", parts.target.limit},
                              {"arithmetic", json_number(parts.arithmetic)},
                              {"snapping", json_number(parts.snapping)},
                              {"total", json_number(parts.total)},
                              {"in_the_way", nullptr},
                              {"remedy", nullptr},
                              {"verdict", verdict(parts)}};
  if (parts.in_the_way) json["in_the_way"] = kind_name(*parts.in_the_way);
  if (parts.remedy)
    json["remedy"] = {{"change", parts.remedy->change},
                      {"part", json_number(parts.remedy->part)},
                      {"total", json_number(parts.remedy->total)}};
  return json;
}

}  // namespace quadrille::tb
