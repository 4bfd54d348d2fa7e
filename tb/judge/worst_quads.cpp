#include "tb/judge/worst_quads.hpp"

#include "golden/io/error.hpp"
#include "golden/io/quads_file.hpp"
#include "golden/io/text_input.hpp"
#include "model/port/config_text.hpp"
#include "tb/judge/family_search.hpp"
#include "tb/judge/judge.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace quadrille::tb {
namespace {

using golden::input_error;

constexpr std::string_view found_by_key = "# found by: ", size_key = "# size ", set_key = "# set ";

std::string record_text(const WorstQuad& worst) {
  char units[48];
  std::snprintf(units, sizeof units, " %.6f at %d,%d", worst.units, worst.at.x, worst.at.y);
  return std::string(golden::stress_family_name(worst.family)) + " " +
         std::string(output_names[static_cast<std::size_t>(worst.output)]) + units;
}

class Reader {
 public:
  Reader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  WorstQuads read() {
    // Whatever .quads readers refuse is refused in their words.
    const std::vector<WindowQuad> quads = golden::parse_quads(text_, name_);
    std::istringstream lines{std::string(text_)};
    for (std::string line; std::getline(lines, line);) {
      ++line_;
      if (!line.empty() && line.back() == '\r') line.pop_back();
      if (line.starts_with("#"))
        comment(line);
      else if (line.find_first_not_of(" \t") != std::string::npos)
        quad(quads[out_.quads.size()]);
    }
    if (pending_) throw failure("record without a quad after it");
    try {
      out_.config.validate();
    } catch (const ConfigError& error) {
      throw input_error(name_, 0, error.what());
    }
    for (const WorstQuad& worst : out_.quads)
      if (worst.at.x >= out_.width || worst.at.y >= out_.height)
        throw input_error(
            name_, 0,
            record_text(worst) + " is outside " + std::to_string(out_.width) + "x" + std::to_string(out_.height));
    return std::move(out_);
  }

 private:
  golden::InputError failure(const std::string& what) const { return input_error(name_, line_, what); }

  void comment(const std::string& line) {
    int end = 0;
    if (line.starts_with(found_by_key)) {
      out_.found_by = line.substr(found_by_key.size());
    } else if (line.starts_with(size_key)) {
      if (std::sscanf(line.c_str(), "# size %5dx%5d%n", &out_.width, &out_.height, &end) != 2 ||
          static_cast<std::size_t>(end) != line.size() || out_.width < 1 || out_.height < 1 || out_.width > 32768 ||
          out_.height > 32768)
        throw failure("expected # size WxH");
    } else if (line.starts_with(set_key)) {
      set(line.substr(set_key.size()));
    } else {
      record(line);
    }
  }

  void set(const std::string& setting) {
    const std::size_t equals = setting.find('=');
    int value = 0, end = 0;
    if (equals == setting.npos || std::sscanf(setting.c_str() + equals, "=%9d%n", &value, &end) != 1 ||
        equals + static_cast<std::size_t>(end) != setting.size())
      throw failure("expected # set key=value");
    try {
      out_.config.set(setting.substr(0, equals), value);
    } catch (const std::exception& error) {
      throw failure(error.what());
    }
  }

  /// "# family output units at x,y"; other comments are comments.
  void record(const std::string& line) {
    std::istringstream words(line.substr(1));
    std::string family, output, rest;
    words >> family >> output;
    const auto families = golden::stress_families();
    const auto known = std::ranges::find(families, family, &golden::StressFamilyInfo::name);
    const auto which = std::ranges::find(output_names, output);
    if (known == families.end() || which == output_names.end()) return;
    std::getline(words, rest);
    WorstQuad worst;
    int end = 0;
    if (std::sscanf(rest.c_str(), " %lf at %5d,%5d%n", &worst.units, &worst.at.x, &worst.at.y, &end) != 3 ||
        static_cast<std::size_t>(end) != rest.size() || !std::isfinite(worst.units) || worst.units < 0 ||
        worst.at.x < 0 || worst.at.y < 0)
      throw failure("expected # " + family + " " + output + " ERROR at X,Y");
    if (pending_) throw failure("record without a quad after it");
    worst.family = known->family;
    worst.output = static_cast<Output>(which - output_names.begin());
    next_ = worst;
    pending_ = true;
  }

  void quad(const WindowQuad& quad) {
    if (!pending_) throw failure("quad without a record; expected # FAMILY OUTPUT ERROR at X,Y before it");
    if (quad.attribute[0].size() != 1)
      throw failure("the quad has " + std::to_string(quad.attribute[0].size()) + " attributes; one is expected");
    next_.quad = quad;
    out_.quads.push_back(next_);
    pending_ = false;
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t line_ = 0;
  bool pending_ = false;
  WorstQuad next_;
  WorstQuads out_;
};

}  // namespace

WorstQuads WorstQuads::parse(std::string_view text, const std::string& name) { return Reader(text, name).read(); }

WorstQuads WorstQuads::load(const std::string& path) {
  return parse(golden::read_file(path, "kept quads of a search"), path);
}

std::string WorstQuads::text() const {
  std::string out =
      "# Quads with the largest errors found: family, output, error in units of which the bound allows 8 (2^-s of a\n"
      "# weight), pixel; checked and recorded anew by `quadrille stress --kept`. Attribute: one.\n";
  out.append(found_by_key).append(found_by).append("\n");
  out.append(size_key).append(std::to_string(width) + "x" + std::to_string(height)).append("\n");
  out.pop_back();  // the line's end: each key begins with one
  out += changed_keys(config, "\n" + std::string(set_key)) + "\n";
  for (const WorstQuad& worst : quads) out += "# " + record_text(worst) + "\n" + golden::quad_text(worst.quad) + "\n";
  return out;
}

std::vector<PixelError> WorstQuads::measure() const {
  std::vector<PixelError> now;
  for (const WorstQuad& worst : quads)
    now.push_back(PixelErrors(config, search_state(width, height), worst.output)
                      .judge(quad_for(worst.quad, worst.output), worst.at.x, worst.at.y));
  return now;
}

bool same_units(double recorded, double now) { return std::fabs(recorded - now) < 0.6e-6; }

std::vector<std::string> WorstQuads::faults(const std::vector<PixelError>& now) const {
  std::vector<std::string> out;
  std::vector<WindowQuad> all;
  for (std::size_t i = 0; i < quads.size(); ++i) {
    const auto fault = [&](const std::string& what) { out.push_back(record_text(quads[i]) + ": " + what); };
    char units[48];
    std::snprintf(units, sizeof units, "%.6f", now[i].units);
    if (now[i].units < 0)
      fault("nothing is drawn there, or no bound is claimed");
    else if (!same_units(quads[i].units, now[i].units))
      fault("the error is now " + std::string(units));
    if (now[i].units > bound_units) fault("beyond the bound of 8: " + std::string(units));
    all.push_back(quads[i].quad);
  }
  const CheckResult whole = judge_untimed(all, 1, config, search_state(width, height), PixelEngine::lanes);
  if (!whole.ok())
    out.push_back(std::to_string(whole.faults()) + " faults in the draw of all quads" +
                  (whole.first.any ? ": " + whole.first.text : std::string()));
  return out;
}

}  // namespace quadrille::tb
