#include "tb/studies/stress_report.hpp"

#include "golden/io/error.hpp"
#include "golden/io/json_report.hpp"
#include "golden/io/quads_file.hpp"
#include "golden/io/text_input.hpp"
#include "model/port/config.hpp"
#include "tb/judge/knob_errors.hpp"
#include "tb/options/options.hpp"
#include "tb/options/shard.hpp"
#include "tb/support/errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>

namespace quadrille::tb {
namespace {

using Json = nlohmann::ordered_json;
using golden::input_error;

/// A shard's report; `where` becomes its place among all.
Json read_part(const std::string& file, Shard& where) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw input_error(file, 0, "cannot be read; expected the --json of `quadrille stress --shard`");
  Json part = Json::parse(in, nullptr, false);
  // What the rest relies on: kinds of the values, and that families have errors.
  try {
    where = Shard::parse(part.at("shard").get<std::string>());
    part.at("command").get<std::string>();
    if (!part.at("faults").is_array() || !part.at("config").is_object()) throw UsageError("");
    for (const Json& family : part.at("families"))
      for (const char* key : {"family", "kind", "special", "knob"}) family.at(key).get<std::string>();
    for (const Json& errors : part.at("errors"))
      for (const char* key : {"family", "engine"}) errors.at(key).get<std::string>();
  } catch (const std::exception&) {
    throw input_error(file, 0, "is not the --json of `quadrille stress --shard`");
  }
  if (!where.is_part())
    throw input_error(file, 0, "is not of a shard; expected the --json of `quadrille stress --shard`");
  return part;
}

/// The entries of a list that are of a family, which lie together.
void move_family(Json& to, const Json& from, const std::string& family) {
  for (const Json& entry : from)
    if (entry["family"] == family) to.push_back(entry);
}

/// Small ones as 1e-09: 0.000 would say that there is none.
std::string units(double value) {
  char text[32];
  std::snprintf(text, sizeof text, value == 0 ? "%.0f" : value >= 1e-3 && value < 1000 ? "%.3f" : "%.1e", value);
  return text;
}

std::string units(const BodyErrors& e, Output output) { return e.fragments == 0 ? "-" : units(e.of(output).part); }

BodyErrors body_errors(const Json& entry) {
  BodyErrors errors;
  errors.fragments = entry["fragments"];
  errors.beyond = entry["beyond"];
  errors.undefined = entry["undefined"];
  errors.missing = entry["missing"];
  for (std::size_t o = 0; o < output_names.size(); ++o)
    if (const Json& value = entry[std::string(output_names[o])]; !value.is_null()) errors.largest[o].part = value;
  return errors;
}

std::string place(const Json& family, const Json& worst) {
  const int side = worst["side"];
  if (side == 0) return "special case";
  const bool approach = family["kind"] == "approach";
  return (approach ? (side < 0 ? "side -1, knob " : "knob ") : "knob 2^") + std::to_string(worst["knob"].get<int>());
}

/// One body over all families: in how many it fails, how, and its largest errors.
struct BodySummary {
  std::size_t beyond = 0, undefined = 0, missing = 0, drawn_nothing = 0;
  std::array<const Json*, output_names.size()> worst{};  ///< the family

  void add(const Json& family, const std::string& body, const BodyErrors& errors) {
    beyond += errors.beyond != 0;
    undefined += errors.undefined != 0;
    missing += errors.missing != 0;
    drawn_nothing += errors.fragments == 0;
    for (std::size_t o = 0; errors.fragments != 0 && o < output_names.size(); ++o)
      if (errors.largest[o].part > 0 && (!worst[o] || error(family, body, o) > error(*worst[o], body, o)))
        worst[o] = &family;
  }

  static const Json& entry(const Json& family, const std::string& body, std::size_t output) {
    return family["worst"][body][std::string(output_names[output])];
  }
  static double error(const Json& family, const std::string& body, std::size_t output) {
    return entry(family, body, output)["error"];
  }
};

void print_body(std::FILE* text, const std::string& name, const BodySummary& body, std::size_t families) {
  std::fprintf(text, "\n%s: of %zu families, %zu beyond the bound, %zu with undefined pixels, %zu with missing pixels",
               name.c_str(), families, body.beyond, body.undefined, body.missing);
  if (body.drawn_nothing != 0) std::fprintf(text, ", %zu without pixels", body.drawn_nothing);
  std::fprintf(text, "\n");
  const char* before = "  largest errors: ";
  for (std::size_t o = 0; o < output_names.size(); ++o) {
    if (!body.worst[o]) continue;
    const Json& worst = BodySummary::entry(*body.worst[o], name, o);
    std::fprintf(text, "%s%s %s (%s, %s)", before, std::string(output_names[o]).c_str(),
                 units(worst["error"].get<double>()).c_str(), (*body.worst[o])["family"].get<std::string>().c_str(),
                 place(*body.worst[o], worst).c_str());
    before = ", ";
  }
  if (!body.worst[0]) return;
  std::fprintf(text, "; command for the weight:\n  %s\n",
               BodySummary::entry(*body.worst[0], name, 0)["reproduce"].get<std::string>().c_str());
}

/// Steps at which the model draws nothing, so that nothing was shown there; a line for each family.
void print_empty_steps(std::FILE* text, const Json& report) {
  for (const Json& family : report["families"]) {
    std::string steps;
    for (const Json& entry : report["errors"])
      if (entry["family"] == family["family"] && entry["engine"] == "model" && entry["fragments"] == 0)
        steps += (steps.empty() ? "" : "; ") + place(family, entry);
    if (!steps.empty())
      std::fprintf(text, "no fragments: %s at %s\n", family["family"].get<std::string>().c_str(), steps.c_str());
  }
}

}  // namespace

std::vector<std::string> names_in_list(const std::string& list) {
  std::vector<std::string> names(1);
  for (const char c : list) {
    if (c == ',')
      names.emplace_back();
    else
      names.back() += c;
  }
  return names;
}

std::string reproduce_pixel(const WindowQuad& quad, const Config& config, int width, int height, int x, int y,
                            std::string_view engine) {
  return "echo '" + golden::quad_text(quad) + "' | quadrille fragments --quads /dev/stdin --size " +
         std::to_string(width) + "x" + std::to_string(height) + spelled(config) + " --pixel " + std::to_string(x) +
         "," + std::to_string(y) + (engine.empty() ? "" : " --engine " + std::string(engine) + " --errors") +
         " --out -";
}

Json merge_stress(const std::vector<std::string>& files) {
  std::map<std::size_t, Json> parts;
  std::map<std::size_t, std::string> names;
  std::size_t count = 0;
  for (const std::string& file : files) {
    Shard where;
    Json part = read_part(file, where);
    if (parts.empty()) count = where.count;
    const Json& first = parts.empty() ? part : parts.begin()->second;
    for (const char* key : {"schema_version", "version", "config", "seed", "command", "weight_bound", "count"})
      if (part[key] != first[key])
        throw input_error(file, 0,
                          std::string(key) + " is " + part[key].dump() + ", in " + names.begin()->second + " " +
                              first[key].dump() + "; expected shards of one command");
    if (where.count != count)
      throw input_error(file, 0,
                        "is of " + std::to_string(where.count) + " shards, " + names.begin()->second + " of " +
                            std::to_string(count));
    if (names.contains(where.index)) throw input_error(file, 0, "is the same shard as " + names[where.index]);
    names[where.index] = file;
    parts[where.index] = std::move(part);
  }
  for (std::size_t i = 0; i < count; ++i)
    if (!parts.contains(i))
      throw golden::InputError("stress --merge: shard " + std::to_string(i) + "/" + std::to_string(count) +
                               " is missing");
  Json whole = parts[0];
  whole.erase("shard");
  for (const char* list : {"families", "errors", "faults"}) whole[list] = Json::array();
  std::size_t families = 0;
  for (const auto& [index, part] : parts) families += part["families"].size();
  for (std::size_t i = 0; i < families; ++i) {
    const Json& part = parts[i % count];
    if (i / count >= part["families"].size()) throw input_error(names[i % count], 0, "lacks families of its shard");
    const Json& family = part["families"][i / count];
    whole["families"].push_back(family);
    move_family(whole["errors"], part["errors"], family["family"]);
    for (const Json& fault : family["faults"]) whole["faults"].push_back(fault);
  }
  whole["ok"] = whole["faults"].empty();
  return whole;
}

std::string stress_csv(const Json& report) {
  std::map<std::string, std::string> kinds;
  for (const Json& family : report["families"]) kinds[family["family"]] = family["kind"];
  constexpr std::array<const char*, 7> columns{"fragments", "beyond",    "undefined", "missing",
                                               "weight",    "attribute", "depth"};
  std::string out = "family,kind,knob,side,engine";
  for (const char* prefix : {",", ",near_"})
    for (const char* column : columns) out += prefix + std::string(column);
  out += "\n";
  for (const Json& entry : report["errors"]) {
    const std::string family = entry["family"];
    out += family + "," + kinds[family];
    for (const char* key : {"knob", "side"}) out += "," + std::to_string(entry[key].get<int>());
    out += "," + entry["engine"].get<std::string>();
    for (const Json* errors : {&entry, &entry["near"]})
      for (const char* column : columns) {
        char text[40] = ",";
        const Json* value = errors->is_null() ? errors : &(*errors)[column];
        if (value->is_number_integer())
          std::snprintf(text, sizeof text, ",%llu", value->get<unsigned long long>());
        else if (!value->is_null())
          std::snprintf(text, sizeof text, ",%.17g", value->get<double>());
        out += text;
      }
    out += "\n";
  }
  return out;
}

void print_stress(std::FILE* text, const Json& report) {
  Config config;
  for (const auto& [key, value] : report["config"].items()) config.set(key, value.get<int>());
  std::vector<std::string> bodies;  // the model first
  for (const EngineKind body : knob_engines)
    if (const std::string_view name = engine_info(body).name;
        std::ranges::any_of(report["errors"], [&](const Json& e) { return e["engine"] == name; }))
      bodies.emplace_back(name);
  std::map<std::pair<std::string, std::string>, BodyErrors> sums;
  std::map<std::string, double> near_weight;  // of the model
  for (const Json& entry : report["errors"]) {
    sums[{entry["family"], entry["engine"]}].merge(body_errors(entry));
    if (entry["engine"] == "model" && !entry["near"].is_null() && !entry["near"]["weight"].is_null()) {
      double& largest = near_weight[entry["family"]];
      largest = std::max(largest, entry["near"]["weight"].get<double>());
    }
  }

  std::fprintf(
      text,
      "%s\n%llu quads per step, configuration %s; largest errors over all steps in units of the bound (weight: 2^%.0f)"
      "\n\n%-18s %9s %7s %9s %7s %7s %7s",
      report["command"].get<std::string>().c_str(), report["count"].get<unsigned long long>(), summary(config).c_str(),
      std::log2(report["weight_bound"].get<double>()), "", "fragments", "weight", "attribute", "depth", "near", "jump");
  for (std::size_t b = 1; b < bodies.size(); ++b)
    std::fprintf(text, " | %8s %8s %9s %7s", bodies[b].c_str(), "beyond", "undefined", "missing");
  std::fprintf(text, "\n");
  std::map<std::string, BodySummary> summaries;
  for (const Json& family : report["families"]) {
    const std::string name = family["family"];
    const BodyErrors& model = sums[{name, "model"}];
    std::string jump;
    if (!family["jump"].is_null()) {
      jump = "-";
      double largest = 0;
      for (const std::string_view output : output_names)
        if (const Json& value = family["jump"][std::string(output)]; !value.is_null())
          largest = std::max(largest, value.get<double>()), jump = units(largest);
    }
    std::fprintf(text, "%-18s %9llu %7s %9s %7s %7s %7s", name.c_str(),
                 static_cast<unsigned long long>(model.fragments), units(model, Output::weight).c_str(),
                 units(model, Output::attribute).c_str(), units(model, Output::depth).c_str(),
                 near_weight.contains(name) ? units(near_weight[name]).c_str() : "", jump.c_str());
    for (const std::string& body : bodies) {
      const BodyErrors& errors = sums[{name, body}];
      summaries[body].add(family, body, errors);
      if (body != "model")
        std::fprintf(text, " | %8s %8llu %9llu %7llu", units(errors, Output::weight).c_str(),
                     static_cast<unsigned long long>(errors.beyond), static_cast<unsigned long long>(errors.undefined),
                     static_cast<unsigned long long>(errors.missing));
    }
    std::fprintf(text, "\n");
  }
  std::fprintf(text, "\n");
  print_empty_steps(text, report);
  for (const std::string& body : bodies) print_body(text, body, summaries[body], report["families"].size());
}

}  // namespace quadrille::tb
