// quadrille golden diff: two sets of golden vectors, or two EXR pictures.
#include "golden/io/error.hpp"
#include "golden/io/image_diff.hpp"
#include "golden/io/json_report.hpp"
#include "golden/io/png.hpp"
#include "golden/vectors/manifest.hpp"
#include "tb/commands/commands.hpp"
#include "tb/options/command_line.hpp"
#include "tb/options/written_file.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/output.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace quadrille::tb {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct DiffOptions {
  std::string a, b, heat_map, json;
  bool quiet = false;
};

/// What was found, for people and for reports.
struct Findings {
  bool same = true;
  std::vector<std::string> lines;
  Json json;

  void differs(const std::string& line) {
    same = false;
    lines.push_back(line);
  }
};

/// Ids are names: how far apart two of them are means nothing.
bool is_id(const std::string& channel) { return channel == "quad"; }

std::string value_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", std::isnan(value) ? std::fabs(value) : value);
  return text;
}

/// What is said of a channel that differs: NaNs first, which have no size.
std::string difference_text(const golden::ChannelDiff& c) {
  std::string text = c.count == 1 ? "1 pixel differs" : std::to_string(c.count) + " pixels differ";
  if (is_id(c.name)) return text;
  const auto place = [](int x, int y) { return "(" + std::to_string(x) + ", " + std::to_string(y) + ")"; };
  if (c.nans > 0)
    text += ", " + std::to_string(c.nans) + " of them NaN on one side, the first at " + place(c.nan_x, c.nan_y) + ": " +
            value_text(c.nan_a) + " against " + value_text(c.nan_b);
  if (c.nans < c.count) text += ", max " + value_text(c.max) + " at " + place(c.x, c.y) + ", RMS " + value_text(c.rms);
  return text;
}

Json channels_json(const golden::ImageDiff& diff) {
  Json json = Json::array();
  for (const golden::ChannelDiff& c : diff.channels) {
    json.push_back({{"channel", c.name}, {"count", c.count}});
    if (is_id(c.name)) continue;
    // JSON has no infinity: null would be taken for "no difference".
    const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(value_text(value)); };
    json.back().update({{"max", number(c.max)}, {"rms", number(c.rms)}, {"x", c.x}, {"y", c.y}});
    json.back().update({{"nans", c.nans}, {"nan_x", c.nan_x}, {"nan_y", c.nan_y}});
  }
  return json;
}

/// Adds a picture's differences; `name` empty: the pictures themselves were asked for.
golden::ImageDiff compare_pictures(const std::string& a, const std::string& b, const std::string& name,
                                   Findings& findings) {
  golden::ImageDiff diff = golden::diff_images(golden::load_exr(a), golden::load_exr(b), a, b);
  const std::string head = name.empty() ? "" : name + ": ";
  for (const std::string& channel : diff.only_a)
    findings.differs(head + "channel " + channel + " is in the first only");
  for (const std::string& channel : diff.only_b)
    findings.differs(head + "channel " + channel + " is in the second only");
  for (const golden::ChannelDiff& c : diff.channels) {
    std::string channel = c.name;
    channel.resize(std::max<std::size_t>(channel.size(), 10), ' ');
    if (c.count > 0)
      findings.differs(head + channel + " " + difference_text(c));
    else if (name.empty())
      findings.lines.push_back(channel + " equal");
  }
  return diff;
}

/// One record file of a suite: how many lines differ, and the first of them field by field.
void compare_records(const vectors::SuiteReader& a, const vectors::SuiteReader& b, const std::string& role,
                     Findings& findings) {
  const std::string name = a.info().name + "/" + role + ".hex";
  if (a.layout(role) != b.layout(role)) {
    findings.differs(name + ": the records have different fields");
    return;
  }
  const std::uint64_t common = std::min(a.lines(role), b.lines(role));
  if (a.lines(role) != b.lines(role))
    findings.differs(name + ": " + std::to_string(a.lines(role)) + " lines against " + std::to_string(b.lines(role)));
  std::uint64_t differ = 0;
  std::string first;
  constexpr std::uint64_t chunk = 4096;
  for (std::uint64_t line = 0; line < common; line += chunk) {
    const std::uint64_t count = std::min(chunk, common - line);
    const std::vector<Record> left = a.read(role, line, count), right = b.read(role, line, count);
    for (std::uint64_t i = 0; i < count; ++i) {
      if (left[i] == right[i]) continue;
      if (differ++ > 0) continue;
      const RecordField& field = *first_different_field(a.layout(role), left[i], right[i]);
      first = "line " + std::to_string(line + i + 1) + ", " + field.label() + ": " +
              quadrille::describe(left[i], field) + " against " + quadrille::describe(right[i], field);
    }
  }
  if (differ > 0)
    findings.differs(name + ": " + std::to_string(differ) + " of " + std::to_string(common) +
                     " lines differ; the first, " + first);
}

void compare_suites(const vectors::SuiteReader& a, const vectors::SuiteReader& b, Findings& findings) {
  const Json &files = a.manifest().at("files"), &others = b.manifest().at("files");
  const std::string suite = a.info().name;
  for (const auto& [name, entry] : others.items())
    if (!files.contains(name)) findings.differs(suite + "/" + name + " is in the second only");
  for (const auto& [name, entry] : files.items()) {
    if (!others.contains(name)) {
      findings.differs(suite + "/" + name + " is in the first only");
    } else if (entry.at("sha256") != others.at(name).at("sha256")) {
      const fs::path file(name);
      if (file.extension() == ".exr")
        compare_pictures((a.directory() / file).string(), (b.directory() / file).string(), suite + "/" + name,
                         findings);
      else
        compare_records(a, b, file.stem().string(), findings);
    }
  }
}

void compare_sets(const std::string& a, const std::string& b, Findings& findings) {
  const vectors::SetReader left(a), right(b);
  for (const auto& [directory, set] : {std::pair{&a, &left}, std::pair{&b, &right}})
    findings.json["sets"].push_back({{"set", *directory},
                                     {"level", set->info().level},
                                     {"seed", set->info().seed},
                                     {"config", vectors::config_json(set->info().config)}});
  const auto has = [](const vectors::SetReader& set, const std::string& name) {
    return std::ranges::find(set.suites(), name) != set.suites().end();
  };
  for (const ConfigKey& key : Config::keys()) {
    const int p = left.info().config.resolved(key.name), q = right.info().config.resolved(key.name);
    if (p != q)
      findings.differs("configuration: " + std::string(key.name) + " = " + std::to_string(p) + " against " +
                       std::to_string(q));
  }
  for (const std::string& name : right.suites())
    if (!has(left, name)) findings.differs("suite " + name + " is in the second only");
  std::size_t compared = 0;
  for (const std::string& name : left.suites()) {
    if (!has(right, name)) {
      findings.differs("suite " + name + " is in the first only");
      continue;
    }
    compare_suites(left.suite(name), right.suite(name), findings);
    ++compared;
  }
  findings.json["suites"] = compared;
  if (findings.same)
    findings.lines.push_back(std::to_string(compared) + (compared == 1 ? " suite is equal" : " suites are equal"));
}

int run_diff(const DiffOptions& options, const std::vector<std::string>& arguments) {
  const bool sets = fs::is_directory(options.a);
  if (sets != fs::is_directory(options.b))
    throw UsageError("golden diff: expected two sets (directories) or two EXR pictures, not one of each");
  if (sets && !options.heat_map.empty()) throw UsageError("--heat-map needs two pictures");
  check_outputs({options.heat_map, options.json}, {options.a, options.b});

  Findings findings;
  if (sets) {
    compare_sets(options.a, options.b, findings);
  } else {
    const golden::ImageDiff diff = compare_pictures(options.a, options.b, {}, findings);
    findings.json["channels"] = channels_json(diff);
    if (!options.heat_map.empty()) golden::save_png(options.heat_map, golden::heat_map(diff), golden::PngFormat::rgb8);
  }
  if (!options.json.empty()) {
    Json json = golden::begin_report(Config{}, 0, arguments);
    for (const char* key : {"config", "seed"}) json.erase(key);  // there are two of each, or none
    json["same"] = findings.same;
    json["differences"] = findings.same ? std::vector<std::string>{} : findings.lines;
    json.update(findings.json);
    golden::save_json(options.json, json);
  }
  if (!options.quiet && options.json != "-")
    for (const std::string& line : findings.lines) std::printf("%s\n", line.c_str());
  return findings.same ? exit_ok : exit_mismatch;
}

}  // namespace

void add_golden_diff_command(CLI::App& golden, Invocation& invocation) {
  CLI::App* command = golden.add_subcommand("diff", "Compare two sets of golden vectors, or two EXR pictures");
  end_help(*command, "", "0 equal; 1 different; 2 usage or input error",
           {"golden diff mine theirs", "golden diff rtl.exr model.exr --heat-map difference.png"});
  const auto options = std::make_shared<DiffOptions>();
  command->add_option("A", options->a, "Set (directory) or picture")->required()->check(CLI::ExistingPath);
  command->add_option("B", options->b, "The other set or picture")->required()->check(CLI::ExistingPath);
  writes_file(*command,
              command->add_option("--heat-map", options->heat_map, "Picture of the differences, with a scale"), "png")
      ->group(output_group);
  writes_file(*command, command->add_option("--json", options->json, "JSON report; - is standard output"), "json")
      ->group(output_group);
  command->add_flag("--quiet", options->quiet, "Print only errors")->group(output_group);
  command->callback([options, &invocation] {
    invocation.run = [options, &invocation] { return run_diff(*options, invocation.arguments); };
  });
}

}  // namespace quadrille::tb
