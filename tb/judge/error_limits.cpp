#include "tb/judge/error_limits.hpp"

#include "tb/judge/error_limits_data.hpp"
#include "tb/judge/family_search.hpp"
#include "tb/judge/judge.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <stdexcept>

namespace quadrille::tb {
namespace {

/// Four significant digits, upward or downward: what is in the file is not tighter than what was measured.
double rounded(double value, bool up) {
  if (value == 0) return 0;
  const double scale = std::pow(10.0, 3 - std::floor(std::log10(std::fabs(value))));
  return (up ? std::ceil(value * scale) : std::floor(value * scale)) / scale;
}

std::array<const RelativeErrors*, output_names.size()> outputs_of(const CheckResult& result) {
  return {&result.weight, &result.attribute, &result.depth};
}

}  // namespace

MeasuredErrors::MeasuredErrors(const CheckResult& result) {
  const auto errors = outputs_of(result);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    max[i] = errors[i]->max;
    mean[i] = errors[i]->mean.mean();
  }
}

LimitRange LimitRange::around(const std::vector<double>& values, double headroom) {
  const auto [low, high] = std::ranges::minmax(values);
  const double room = headroom * (high - low);
  return {rounded(low - room, false), rounded(high + room, true)};
}

void ErrorLimits::set(golden::StressFamily family, int significand_bits, const std::vector<MeasuredErrors>& draws,
                      double headroom) {
  if (draws.size() < 2) throw std::invalid_argument("limits need at least two draws");
  Family& limits = families_[std::string(golden::stress_family_name(family))][significand_bits];
  for (std::size_t i = 0; i < output_names.size(); ++i) {
    std::vector<double> max, mean;
    for (const MeasuredErrors& draw : draws) {
      max.push_back(draw.max[i]);
      mean.push_back(draw.mean[i]);
    }
    limits.max[i] = {0, LimitRange::around(max, 2 * headroom).high()};
    limits.mean[i] = LimitRange::around(mean, headroom);
  }
}

std::string ErrorLimits::text() const {
  std::string out = "{\n \"climb\": {";
  const char* comma = "";
  for (const auto& [bits, units] : climb_) {
    out += comma + ('"' + std::to_string(bits)) + "\": " + nlohmann::json(rounded(units, true)).dump();
    comma = ", ";
  }
  out += "},\n \"families\": {";
  const char* family_comma = "";
  for (const auto& [name, widths] : families_) {
    out += family_comma + ("\n  \"" + name) + "\": {";
    family_comma = ",";
    const char* width_comma = "";
    for (const auto& [bits, limits] : widths) {
      nlohmann::ordered_json of_outputs;
      for (std::size_t i = 0; i < output_names.size(); ++i)
        of_outputs[std::string(output_names[i])] = {limits.max[i].high(), limits.mean[i].low(), limits.mean[i].high()};
      out += width_comma + ("\n   \"" + std::to_string(bits)) + "\": " + of_outputs.dump();
      width_comma = ",";
    }
    out += "}";
  }
  return out + "}\n}\n";
}

ErrorLimits ErrorLimits::parse(std::string_view text) {
  ErrorLimits out;
  try {
    const auto json = nlohmann::json::parse(text);
    for (const auto& [bits, units] : json.at("climb").items()) out.climb_[std::stoi(bits)] = units.get<double>();
    for (const auto& [name, widths] : json.at("families").items())
      for (const auto& [bits, of_outputs] : widths.items()) {
        Family& limits = out.families_[name][std::stoi(bits)];
        for (std::size_t i = 0; i < output_names.size(); ++i) {
          const auto& output = of_outputs.at(std::string(output_names[i]));
          limits.max[i] = {0, output.at(0).get<double>()};
          limits.mean[i] = {output.at(1).get<double>(), output.at(2).get<double>()};
        }
      }
  } catch (const std::exception& error) {
    throw std::runtime_error(std::string("error limits: ") + error.what());
  }
  return out;
}

const ErrorLimits& ErrorLimits::recorded() {
  static const ErrorLimits limits = parse(error_limits_data);
  return limits;
}

const ErrorLimits::Family* ErrorLimits::find(std::string_view family, int significand_bits) const {
  const auto widths = families_.find(family);
  if (widths == families_.end()) return nullptr;
  const auto limits = widths->second.find(significand_bits);
  return limits == widths->second.end() ? nullptr : &limits->second;
}

double ErrorLimits::climb(int significand_bits) const {
  const auto limit = climb_.find(significand_bits);
  return limit == climb_.end() ? std::numeric_limits<double>::infinity() : limit->second;
}

std::size_t limit_quads(golden::StressFamily family) {
  using enum golden::StressFamily;
  switch (family) {
    case any_w:
    case huge:
    case eye_crossing:
    case eye_in_hull:
    case w_zero:
      return 30;
    case coplanar:
    case long_span:
      return 100;
    default:
      return 300;
  }
}

CheckResult judge_limit_draw(golden::StressFamily family, int significand_bits, std::uint64_t seed,
                             PixelEngine engine) {
  Config config;
  config.set("significand_bits", significand_bits);
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = limit_extent;
  constexpr int attributes = 4;
  const std::vector<WindowQuad> quads =
      golden::make_stress_without_weights(family, limit_quads(family), seed, limit_extent, limit_extent, attributes);
  return judge_untimed(quads, attributes, config, state, engine);
}

double limit_climb(golden::StressFamily family, int significand_bits, std::uint64_t seed) {
  FamilySearch search;
  search.family = family;
  search.config.set("significand_bits", significand_bits);
  search.width = search.height = 512;
  search.evaluations = 10'000;
  search.seed = seed;
  search.leave = true;
  const std::optional<FamilySummit> worst = worst_of_family(search);
  return worst ? worst->units : -1;
}

bool limits_apply(const Config& config, const DrawState& state, golden::StressFamily family, std::size_t quads) {
  Config usual;
  usual.significand_bits = config.significand_bits;
  const DrawState whole;
  return config == usual && quads == limit_quads(family) && state.width == limit_extent &&
         state.height == limit_extent && state.scissor_x0 == 0 && state.scissor_y0 == 0 &&
         state.scissor_x1 == limit_extent && state.scissor_y1 == limit_extent && state.cull == whole.cull &&
         state.perspective && state.depth && state.znear == whole.znear && state.zfar == whole.zfar;
}

std::vector<std::string> beyond_limits(const ErrorLimits::Family& limits, const CheckResult& result) {
  std::vector<std::string> out;
  const MeasuredErrors measured(result);
  const auto errors = outputs_of(result);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (errors[i]->mean.count() == 0) continue;
    const auto check = [&](const char* what, const LimitRange& range, double value) {
      if (range.holds(value)) return;
      char text[160];
      std::snprintf(text, sizeof text, "%s %s error %.4g of its bound, limits %.4g to %.4g", what,
                    std::string(output_names[i]).c_str(), value, range.low(), range.high());
      out.emplace_back(text);
    };
    check("largest", limits.max[i], measured.max[i]);
    check("mean", limits.mean[i], measured.mean[i]);
  }
  return out;
}

}  // namespace quadrille::tb
