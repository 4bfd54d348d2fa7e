#include "tb/studies/stress_search.hpp"

#include "golden/io/atomic_file.hpp"
#include "golden/io/json_report.hpp"
#include "golden/scenes/approach.hpp"
#include "golden/scenes/stress.hpp"
#include "model/support/parallel.hpp"
#include "tb/judge/family_search.hpp"
#include "tb/judge/worst_quads.hpp"
#include "tb/options/command_line.hpp"
#include "tb/options/input.hpp"
#include "tb/options/written_file.hpp"
#include "tb/studies/stress_report.hpp"
#include "tb/support/choices.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/output.hpp"
#include "tb/support/progress.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <tuple>

namespace quadrille::tb {
namespace {

using Json = nlohmann::ordered_json;

std::vector<golden::StressFamily> families_in(const std::string& list) {
  const std::vector<std::string> all = stress_names();
  std::vector<golden::StressFamily> families;
  for (const std::string& name : list.empty() ? all : names_in_list(list)) {
    if (golden::find_approach(name) != nullptr)
      throw UsageError("--search: " + name + " is an approach; expected a stress family");
    families.push_back(golden::parse_stress_family(all[choose("family", name, all)]));
  }
  return families;
}

std::string_view name_of(Output output) { return output_names[static_cast<std::size_t>(output)]; }

/// The report's text: a line for each family and output, with the command that draws its pixel.
void print_table(std::FILE* text, const Json& report) {
  const bool kept = report.contains("kept");
  std::fprintf(text, "%s; errors in units of 2^-s (of a weight); bound %g\n\n%-16s %-9s %9s%s\n",
               report["title"].get<std::string>().c_str(), bound_units, "", "output", "error",
               kept ? "  recorded" : "      knob");
  const Json* worst = nullptr;
  for (const Json& row : report["worst"]) {
    const double units = row["units"];
    std::fprintf(text, "%-16s %-9s", row["family"].get<std::string>().c_str(),
                 row["output"].get<std::string>().c_str());
    if (units < 0) {
      std::fprintf(text, " no fragments\n");
      continue;
    }
    std::fprintf(text, " %9.6f %9.*f  %s\n", units, kept ? 6 : 3, row[kept ? "recorded" : "knob"].get<double>(),
                 row["reproduce"].get<std::string>().c_str());
    if (worst == nullptr || units > (*worst)["units"].get<double>()) worst = &row;
  }
  if (worst != nullptr)
    std::fprintf(text, "\nworst: %.3f of %g, %s of %s\n", (*worst)["units"].get<double>(), bound_units,
                 (*worst)["output"].get<std::string>().c_str(), (*worst)["family"].get<std::string>().c_str());
}

Json row_of(const WorstQuads& all, const WorstQuad& worst, double units) {
  Json row;
  row["family"] = golden::stress_family_name(worst.family);
  row["output"] = name_of(worst.output);
  row["units"] = units;
  row["pixel"] = {worst.at.x, worst.at.y};
  WindowQuad quad = worst.quad;
  if (worst.output != Output::attribute) quad.attribute = {};
  row["reproduce"] = reproduce_pixel(quad, all.config, all.width, all.height, worst.at.x, worst.at.y);
  return row;
}

int finish(const CommonOptions& common, const std::string& keep, const WorstQuads& quads, Json report,
           const std::vector<std::string>& faults) {
  report["ok"] = faults.empty();
  report["faults"] = faults;
  if (!keep.empty()) golden::write_file(keep, quads.text(), golden::AtomicFile::Dash::refused);
  if (!common.json.empty()) golden::save_json(common.json, report);
  if (std::FILE* text = common.text()) print_table(text, report);
  for (const std::string& fault : faults) std::fprintf(stderr, "quadrille: %s\n", fault.c_str());
  return faults.empty() ? exit_ok : exit_mismatch;
}

}  // namespace

void StressSearchOptions::add_to(CLI::App& app) {
  constexpr const char* group = "Search";
  CLI::Option* one = app.add_flag("--search", search, "Search the worst quads of the stress families")->group(group);
  app.add_option("--evaluations", evaluations, "Pixels per family and output")
      ->type_name("N")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 40))
      ->capture_default_str()
      ->group(group)
      ->needs(one);
  app.add_flag("--leave", leave, "Move vertices freely, beyond the family's shape")->group(group)->needs(one);
  CLI::Option* replay = app.add_option("--kept", kept, "Check quads and errors of a file of --keep")
                            ->type_name("F.quads")
                            ->group(group)
                            ->excludes(one);
  writes_file(app, app.add_option("--keep", keep, "Write the quads found or checked, with their errors"), "quads")
      ->group(group);
  for (const char* other : {"--engines", "--count", "--csv", "--shard", "--merge"}) {
    one->excludes(app.get_option(other));
    replay->excludes(app.get_option(other));
  }
  // The file has these.
  for (const char* other : {"--families", "--config", "--set", "--size", "--seed"})
    replay->excludes(app.get_option(other));
}

int search_stress(const CommonOptions& common, const std::string& list, const StressSearchOptions& options) {
  const Config config = common.config();
  if (config.qdrop() != 0) throw UsageError("stress: no bound with quadratic_frac_bits that drops bits of D and R²");
  const std::vector<golden::StressFamily> families = families_in(list);
  int width = 0, height = 0;
  std::tie(width, height) = common.viewport(config);
  check_outputs({options.keep, common.json}, {common.config_file});

  WorstQuads kept;
  kept.config = config;
  kept.width = width;
  kept.height = height;
  kept.found_by = "quadrille stress --search --evaluations " + std::to_string(options.evaluations) +
                  (options.leave ? " --leave" : "") + " --seed " + std::to_string(common.seed) + " --size " +
                  std::to_string(width) + "x" + std::to_string(height) + spelled(config) +
                  (list.empty() ? "" : " --families " + list);
  Json report = golden::begin_report(config, common.seed, std::vector<std::string>{});
  report["command"] = report["title"] = kept.found_by;
  report["bound"] = bound_units;
  report["evaluations"] = options.evaluations;
  report["worst"] = Json::array();
  std::vector<std::string> faults;
  Progress progress("search", families.size() * output_names.size(), common.show_progress());
  ordered_parallel(
      families.size() * output_names.size(), common.thread_count(),
      [&](std::size_t i) {
        FamilySearch search;
        search.family = families[i / output_names.size()];
        search.output = static_cast<Output>(i % output_names.size());
        search.config = config;
        search.width = width;
        search.height = height;
        search.evaluations = options.evaluations;
        search.seed = common.seed;
        search.leave = options.leave;
        return worst_of_family(search);
      },
      [&](std::size_t i, std::optional<FamilySummit>&& found) {
        const std::string family(golden::stress_family_name(families[i / output_names.size()]));
        const auto output = static_cast<Output>(i % output_names.size());
        progress.set(i + 1, family);
        if (!found) {
          report["worst"].push_back({{"family", family}, {"output", name_of(output)}, {"units", -1.0}});
          faults.push_back(family + " " + std::string(name_of(output)) +
                           ": nothing was drawn, so nothing was shown; give more --evaluations than " +
                           std::to_string(options.evaluations));
          return;
        }
        const FamilyCandidate& c = found->candidate;
        WorstQuad worst{families[i / output_names.size()], output, found->units, c.at, c.quad};
        worst.quad.id = static_cast<std::uint32_t>(kept.quads.size());
        Json row = row_of(kept, worst, worst.units);
        row["knob"] = c.drawing.knob;
        kept.quads.push_back(std::move(worst));
        report["worst"].push_back(std::move(row));
      });
  progress.finish();
  std::vector<PixelError> errors;
  for (const WorstQuad& worst : kept.quads) errors.push_back({worst.units});
  if (!kept.quads.empty()) std::ranges::copy(kept.faults(errors), std::back_inserter(faults));
  const bool keeps = !options.keep.empty() && !kept.quads.empty();
  return finish(common, keeps ? options.keep : "", kept, std::move(report), faults);
}

int check_kept_stress(const CommonOptions& common, const StressSearchOptions& options) {
  WorstQuads kept = WorstQuads::load(options.kept);
  check_outputs({options.keep == options.kept ? "" : options.keep, common.json}, {options.kept});
  const std::vector<PixelError> now = kept.measure();
  Json report = golden::begin_report(kept.config, common.seed, std::vector<std::string>{});
  report["command"] = "quadrille stress --kept " + options.kept;
  report["title"] = kept.found_by;
  report["bound"] = bound_units;
  report["kept"] = options.kept;
  report["worst"] = Json::array();
  for (std::size_t i = 0; i < now.size(); ++i) {
    Json row = row_of(kept, kept.quads[i], now[i].units);
    row["recorded"] = kept.quads[i].units;
    report["worst"].push_back(std::move(row));
  }
  // Errors that are recorded anew are those that they are.
  const bool keeps =
      !options.keep.empty() && std::ranges::all_of(now, [](const PixelError& e) { return e.units >= 0; });
  if (keeps)
    for (std::size_t i = 0; i < now.size(); ++i) kept.quads[i].units = now[i].units;
  return finish(common, keeps ? options.keep : "", kept, std::move(report), kept.faults(now));
}

}  // namespace quadrille::tb
