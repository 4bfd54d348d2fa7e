// quadrille scenes: the built-in scenes.
#include "tb/commands/commands.hpp"
#include "tb/options/command_line.hpp"
#include "tb/options/written_file.hpp"

#include "golden/io/json_report.hpp"
#include "golden/scenes/approach.hpp"
#include "golden/scenes/corner_quads.hpp"
#include "golden/scenes/scenes.hpp"
#include "golden/scenes/stress.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/output.hpp"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <memory>
#include <string>

namespace quadrille::tb {
namespace {

struct ScenesOptions {
  std::string json;
  bool stress = false, corner = false;
};

int list(const ScenesOptions& options) {
  if (options.stress) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    const auto add = [&](const char* kind, std::string_view name, std::string_view what) {
      json.push_back({{"name", name}, {"stresses", what}, {"kind", kind}});
      if (options.json != "-") std::printf("%-20s %s\n", std::string(name).c_str(), std::string(what).c_str());
    };
    for (const golden::StressFamilyInfo& family : golden::stress_families())
      add("family", family.name, family.stresses);
    if (options.json != "-") std::printf("\nApproaches (only of `quadrille stress`), each with its special case\n");
    for (const golden::Approach& approach : golden::approaches())
      add("approach", approach.name, approach.special.empty() ? approach.knob : approach.special);
    if (!options.json.empty()) golden::save_json(options.json, json);
    return exit_ok;
  }
  if (options.corner) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const golden::CornerGroupInfo& group : golden::corner_groups()) {
      json.push_back({{"name", group.name}, {"holds", group.holds}, {"needs", group.needs}});
      if (options.json != "-")
        std::printf("%-16s %s%s%s\n", std::string(group.name).c_str(), std::string(group.holds).c_str(),
                    group.needs.empty() ? "" : "; needs ", std::string(group.needs).c_str());
    }
    if (!options.json.empty()) golden::save_json(options.json, json);
    return exit_ok;
  }
  std::vector<golden::SceneInfo> scenes = golden::list_scenes();
  std::ranges::copy(golden::list_workloads(), std::back_inserter(scenes));
  if (!options.json.empty()) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const golden::SceneInfo& scene : scenes)
      json.push_back({{"name", scene.name}, {"title", scene.title}, {"paper", scene.paper}, {"quads", scene.quads}});
    golden::save_json(options.json, json);
    if (options.json == "-") return exit_ok;
  }
  std::size_t width = 0;
  for (const golden::SceneInfo& scene : scenes) width = std::max(width, scene.name.size());
  for (const golden::SceneInfo& scene : scenes)
    std::printf("%-*s %5zu %s  %s (%s)\n", static_cast<int>(width), scene.name.c_str(), scene.quads,
                scene.quads == 1 ? "quad " : "quads", scene.title.c_str(), scene.paper.c_str());
  return exit_ok;
}

}  // namespace

void add_scenes_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("scenes", "List the built-in scenes, stress families or corner groups");
  end_help(*command, "", "0 done; 2 usage error", {"scenes", "scenes --json", "scenes --stress"});
  const auto options = std::make_shared<ScenesOptions>();
  CLI::Option* json = command->add_option("--json", options->json, "JSON list (default: standard output)");
  writes_file(*command, json, "json")->type_name("[F.json]")->expected(0, 1)->group(output_group);
  CLI::Option* stress =
      command->add_flag("--stress", options->stress, "Stress families, and approaches of `quadrille stress`");
  command->add_flag("--corner", options->corner, "Corner groups: directed quads of rare cases")->excludes(stress);
  command->callback([options, json, &invocation] {
    if (json->count() > 0 && options->json.empty()) options->json = "-";
    invocation.run = [options] {
      check_outputs({options->json}, {});
      return list(*options);
    };
  });
}

}  // namespace quadrille::tb
