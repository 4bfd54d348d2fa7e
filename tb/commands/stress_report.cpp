#include "tb/commands/stress_report.hpp"

#include "golden/io/error.hpp"
#include "golden/io/json_report.hpp"
#include "golden/io/quads_file.hpp"
#include "golden/io/text_input.hpp"
#include "model/config.hpp"
#include "tb/check/knob_errors.hpp"
#include "tb/options/options.hpp"
#include "tb/options/shard.hpp"
#include "tb/support/errors.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

namespace quadrille::cli {
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
  if (!where.is_part()) throw input_error(file, 0, "is not of a shard; there is nothing to put it together with");
  return part;
}

/// The entries of a list that are of a family, which lie together.
void move_family(Json& to, const Json& from, const std::string& family) {
  for (const Json& entry : from)
    if (entry["family"] == family) to.push_back(entry);
}

bool fails(const BodyErrors& e) { return e.weight > 1 || e.undefined != 0 || e.missing != 0; }

std::string units(const BodyErrors& e, double value) {
  if (e.fragments == 0) return "-";
  char text[32];
  std::snprintf(text, sizeof text, value < 1000 ? "%.3f" : "%.1e", value);
  return text;
}

BodyErrors body_errors(const Json& entry) {
  BodyErrors errors;
  errors.fragments = entry["fragments"];
  errors.undefined = entry["undefined"];
  errors.missing = entry["missing"];
  for (const auto& [key, value] :
       {std::pair{"weight", &errors.weight}, {"attribute", &errors.attribute}, {"depth", &errors.depth}})
    if (!entry[key].is_null()) *value = entry[key];
  return errors;
}

std::string place(const Json& family, const Json& worst) {
  const int side = worst["side"];
  if (side == 0) return "special case";
  const bool approach = family["kind"] == "approach";
  return (approach ? (side < 0 ? "side -1, knob " : "knob ") : "knob 2^") + std::to_string(worst["knob"].get<int>());
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

std::string reproduce_pixel(const WindowQuad& quad, const Config& config, int width, int height, int x, int y) {
  return "echo '" + golden::quad_text(quad) + "' | quadrille fragments --quads /dev/stdin --size " +
         std::to_string(width) + "x" + std::to_string(height) + spelled(config) + " --pixel " + std::to_string(x) +
         "," + std::to_string(y) + " --out -";
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
                              first[key].dump() + "; shards of one command are expected");
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
  std::string out = "family,kind,knob,side,engine,fragments,undefined,missing,weight,attribute,depth\n";
  for (const Json& entry : report["errors"]) {
    const std::string family = entry["family"];
    out += family + "," + kinds[family];
    for (const char* key : {"knob", "side"}) out += "," + std::to_string(entry[key].get<int>());
    out += "," + entry["engine"].get<std::string>();
    for (const char* key : {"fragments", "undefined", "missing"})
      out += "," + std::to_string(entry[key].get<std::uint64_t>());
    for (const char* key : {"weight", "attribute", "depth"}) {
      char text[40] = ",";
      if (!entry[key].is_null()) std::snprintf(text, sizeof text, ",%.17g", entry[key].get<double>());
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
  for (const std::string_view name : knob_body_names)
    if (std::ranges::any_of(report["errors"], [&](const Json& e) { return e["engine"] == name; }))
      bodies.emplace_back(name);
  std::map<std::pair<std::string, std::string>, BodyErrors> sums;
  for (const Json& entry : report["errors"]) sums[{entry["family"], entry["engine"]}].merge(body_errors(entry));

  std::fprintf(text,
               "%s\n%llu quads a step, configuration %s; errors in units of the bound, 2^%.0f of a weight, the "
               "largest over all steps\n\n%-18s %9s %7s %9s %7s",
               report["command"].get<std::string>().c_str(), report["count"].get<unsigned long long>(),
               summary(config).c_str(), std::log2(report["weight_bound"].get<double>()), "", "fragments", "weight",
               "attribute", "depth");
  for (std::size_t b = 1; b < bodies.size(); ++b) std::fprintf(text, " %10s %9s", bodies[b].c_str(), "lost");
  std::fprintf(text, " %7s\n", "jump");
  std::map<std::string, std::size_t> failing;
  const Json* worst = nullptr;
  for (const Json& family : report["families"]) {
    const std::string name = family["family"];
    const BodyErrors& model = sums[{name, "model"}];
    std::fprintf(text, "%-18s %9llu %7s %9s %7s", name.c_str(), static_cast<unsigned long long>(model.fragments),
                 units(model, model.weight).c_str(), units(model, model.attribute).c_str(),
                 units(model, model.depth).c_str());
    for (std::size_t b = 1; b < bodies.size(); ++b) {
      const BodyErrors& body = sums[{name, bodies[b]}];
      failing[bodies[b]] += fails(body);
      std::fprintf(text, " %10s %9llu", units(body, body.weight).c_str(),
                   static_cast<unsigned long long>(body.undefined + body.missing));
    }
    if (!family["jump"].is_null()) std::fprintf(text, " %7.3f", family["jump"].get<double>());
    std::fprintf(text, "\n");
    if (model.fragments != 0 && (worst == nullptr || model.weight > (*worst)["worst"]["model"]["weight"].get<double>()))
      worst = &family;
  }
  std::fprintf(text, "\n");
  for (std::size_t b = 1; b < bodies.size(); ++b)
    std::fprintf(text, "%s is beyond the bound, undefined or without a fragment in %zu of %zu\n", bodies[b].c_str(),
                 failing[bodies[b]], report["families"].size());
  if (worst == nullptr) return;
  const Json& pixel = (*worst)["worst"]["model"];
  std::fprintf(text, "worst weight of the model, %.3f of the bound (%s, %s):\n%s\n", pixel["weight"].get<double>(),
               (*worst)["family"].get<std::string>().c_str(), place(*worst, pixel).c_str(),
               pixel["reproduce"].get<std::string>().c_str());
}

}  // namespace quadrille::cli
