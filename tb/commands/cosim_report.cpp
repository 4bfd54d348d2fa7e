#include "tb/commands/cosim_report.hpp"

#include "golden/analysis/error_bound.hpp"
#include "golden/io/json_report.hpp"
#include "tb/commands/counters_report.hpp"
#include "tb/device/verilate.hpp"

#include <algorithm>
#include <cmath>

namespace quadrille::tb {
namespace {

double ratio(double a, double b) { return b > 0 ? a / b : 0; }
double per_clock(const InputResult& r) {
  return ratio(static_cast<double>(r["covered_pixels"]), static_cast<double>(r["cycles_rtl"]));
}
double rate(const InputResult& r) { return ratio(static_cast<double>(r["cycles_all_passes"]), r.loop_seconds); }
double alone_rate(const InputResult& r) { return ratio(static_cast<double>(r["alone_cycles"]), r.alone_seconds); }
auto llu(std::uint64_t value) { return static_cast<unsigned long long>(value); }

/// What the metrics of a line of the summary show.
std::string line_of(MetricLine line, const InputResult& r) {
  std::string text;
  r.for_each_metric([&](const Metric& metric, std::uint64_t) {
    if (metric.line != line) return;
    std::string_view form = metric.shown;
    for (std::size_t open; (open = form.find('{')) != form.npos;) {
      const std::size_t close = form.find('}', open);
      text += form.substr(0, open);
      const std::string_view key = form.substr(open + 1, close - open - 1);
      r.for_each_metric([&](const Metric& other, std::uint64_t value) {
        if (other.key == key) text += std::to_string(value);
      });
      form.remove_prefix(close + 1);
    }
    text += form;
  });
  return text;
}

void put_metrics(nlohmann::ordered_json& json, MetricGroup group, const InputResult& r) {
  r.for_each_metric([&](const Metric& metric, std::uint64_t value) {
    if (metric.group == group) json[metric.key] = value;
  });
}

nlohmann::ordered_json error_json(const QuantityErrors& e) {
  return {{"lambda_max", e.lambda.max()},       {"lambda_p999", e.lambda.p999()},       {"lambda_rms", e.lambda.rms()},
          {"attribute_max", e.attribute.max()}, {"attribute_p999", e.attribute.p999()}, {"depth_max", e.depth.max()},
          {"depth_p999", e.depth.p999()},       {"fragments", e.lambda.count()}};
}

nlohmann::ordered_json model_json(const ModelCheck& model) {
  nlohmann::ordered_json json;
  json["ok"] = model.ok();
  json["function_arguments"] = model.functions.arguments();
  json["function_beyond"] = model.functions.beyond();
  for (const FunctionResult& f : model.functions.functions)
    json["functions"][std::string(f.name)] = {{"arguments", f.arguments}, {"beyond", f.beyond}};
  json["directed_compared"] = model.directed.compared;
  for (const CheckCounter& fault : fault_counters) json["directed"][fault.key] = model.directed.*fault.value;
  if (!model.ok()) json["first_fault"] = model.fault();
  return json;
}

/// The outcome in a few words.
const char* outcome(const InputResult& r, const ModelCheck* model, bool ok) {
  if (ok) return model != nullptr ? "RTL and model agree, errors within bounds" : "RTL within the bounds of the truth";
  if (!r.lockstep_ok()) return model != nullptr ? "FAILED: RTL and model differ" : "FAILED: the RTL stopped";
  if (r.check.compared == 0) return "FAILED: no fragments compared";
  if (!r.check.ok()) return "FAILED: fragments differ from the truth or exceed a bound";
  if (r.skips.differences > 0) return "FAILED: a skip changes fragments";
  return model == nullptr || model->ok() ? "FAILED: regression limits exceeded" : "FAILED: model checks";
}

}  // namespace

std::string CosimReport::command_at(const InputResult& result, const std::string& command, std::uint32_t quad, int x,
                                    int y) const {
  std::string text = "quadrille " + command + " " + result.option;
  if (!options_.common.config_file.empty()) text += " --config " + quoted(options_.common.config_file);
  for (const std::string& setting : options_.common.settings) text += " --set " + quoted(setting);
  text += " --size " + options_.common.size + " --seed " + std::to_string(options_.common.seed) + result.state;
  return text + " --quad " + std::to_string(quad) + " --pixel " + std::to_string(x) + "," + std::to_string(y);
}

std::string CosimReport::explain(const InputResult& r) const {
  if (!r.first_pixel) return "";
  const std::string rtl = options_.rtl.empty() ? "" : " --rtl " + quoted(options_.rtl);
  return command_at(r, "explain --engine rtl" + rtl, r.first_pixel->quad, r.first_pixel->x, r.first_pixel->y);
}

nlohmann::ordered_json CosimReport::result(const InputResult& r) const {
  const CheckResult& c = r.check;
  nlohmann::ordered_json json;
  json["input"] = r.name;
  json["draw_state"] = r.state + r.attributes;
  json["ok"] = r.ok();
  json["complete"] = r.complete;
  put_metrics(json, MetricGroup::draw, r);
  put_metrics(json, MetricGroup::faults, r);
  put_metrics(json, MetricGroup::cycles, r);
  json["covered_pixels_per_clock"] = per_clock(r);
  char hash[20];
  std::snprintf(hash, sizeof hash, "%016llx", llu(r.fragment_hash));
  json["fragment_hash"] = hash;
  json["error"] = {{"arithmetic", error_json(c.arithmetic)}, {"snapping", error_json(c.snapping)}};
  json["bound"] = {{"lambda_max", weight_bound(config_)},
                   {"applies", bound_applies()},
                   {"held", bound_applies() && c.compared > 0 && c.within_bound()},
                   {"value_factor", value_bound_factor(config_)},
                   {"attribute_over_bound", c.attribute.max},
                   {"depth_over_bound", c.depth.max},
                   {"exempt_fragments", c.bound_exempt}};
  if (c.worst.ratio >= 0) {
    json["worst"] = {
        {"quad", c.worst.place.quad}, {"position", c.worst.place.index}, {"x", c.worst.place.x},
        {"y", c.worst.place.y},       {"weight", c.worst.weight},        {"lambda_error", c.worst.error},
        {"bound", c.worst.bound},     {"condition", c.worst.condition},  {"error_over_bound", c.worst.ratio}};
    if (r.name != "all")
      json["worst"]["reproduce"] =
          command_at(r, "fragments --engine model", c.worst.place.index, c.worst.place.x, c.worst.place.y) + " --out -";
  }
  put_metrics(json["counts"], MetricGroup::counts, r);
  json["skips"] = {{"compared", r.skips.compared}, {"quads_that_differ", r.skips.differences}};
  if (r.skips.differences > 0) json["skips"]["first"] = r.skips.first;
  json["counters"] = counters_json(r.counters);
  json["regression"] = {{"inputs_with_limits", r["limits_checked"]}, {"beyond", r.beyond_limits}};
  if (r.first_divergence) json["first_divergence"] = *r.first_divergence;
  if (c.first.any) json["first_reference_difference"] = c.first.text;
  if (const std::string command = explain(r); !command.empty()) json["explain"] = command;
  json["wall_seconds"] = r.seconds;
  json["rtl_cycles_per_second"] = rate(r);
  json["rtl_alone_cycles_per_second"] = alone_rate(r);
  json["rtl_alone_over_lockstep"] = ratio(alone_rate(r), rate(r));
  return json;
}

nlohmann::ordered_json CosimReport::all(const InputResult& total, const std::vector<InputResult>& results,
                                        const ModelCheck* model, bool ok,
                                        const std::vector<std::string>& arguments) const {
  nlohmann::ordered_json json = golden::begin_report(config_, options_.common.seed, arguments);
  json.update(result(total));
  json["ok"] = ok;
  json["judge"] = options_.judge;
  if (model != nullptr) json["model_alone"] = model_json(*model);
  json["stall"] = options_.stall;
  json["gap"] = options_.gap;
  if (!options_.stall_clocks.empty()) json["stall_clocks"] = options_.stall_clocks;
  if (!options_.gap_beats.empty()) json["gap_beats"] = options_.gap_beats;
  json["size"] = options_.common.size;
  if (results.size() > 1) {
    json["inputs"] = nlohmann::ordered_json::array();
    for (const InputResult& one : results) json["inputs"].push_back(result(one));
    const auto worst = std::max_element(results.begin(), results.end(), [](const InputResult& a, const InputResult& b) {
      return a.check.worst.ratio < b.check.worst.ratio;
    });
    if (worst->check.worst.ratio >= 0) {
      json["worst"] = result(*worst)["worst"];
      json["worst"]["input"] = worst->name;
    }
  }
  return json;
}

void print_row(std::FILE* out, const InputResult& r, bool head) {
  if (head)
    std::fprintf(out, "%-22s %7s %10s %11s %5s  %-9s %-9s %s\n", "input", "quads", "fragments", "cycles", "px/ck",
                 "max error", "of bound", "");
  std::fprintf(out, "%-22s %7llu %10llu %11llu ", r.name.c_str(), llu(r["quads"]), llu(r["fragments"]),
               llu(r["cycles_rtl"]));
  if (r.check.compared == 0)
    std::fprintf(out, "no fragments compared %11s", "");
  else
    std::fprintf(out, "%5.2f  %-9.2e %8.1f%%", per_clock(r), r.check.arithmetic.lambda.max(),
                 100 * std::max(0.0, r.check.worst.ratio));
  std::fprintf(out, " %s\n", r.ok() ? "ok" : "FAILED");
  std::fflush(out);
}

void CosimReport::print_summary(std::FILE* out, const InputResult& r, const ModelCheck* model, bool ok) const {
  const CheckResult& c = r.check;
  const auto print = [&](MetricLine line) { std::fputs(line_of(line, r).c_str(), out); };
  std::fprintf(out, "\n%s: %s\n(%s; seed %llu, stall %g, gap %g; configuration %s)\n\n", r.name.c_str(),
               outcome(r, model, ok), options_.common.size.c_str(), llu(options_.common.seed), options_.stall,
               options_.gap, summary(config_).c_str());
  if (const std::string state = r.state + r.attributes; !state.empty())
    std::fprintf(out, "  draw state    %s\n", state.c_str());
  if (r["draws"] > 0) print(MetricLine::draws);
  std::string drawn = line_of(MetricLine::lockstep, r);
  if (model == nullptr) drawn.replace(drawn.find("lockstep"), 8, "drawn   ");
  std::fputs(drawn.c_str(), out);
  std::fputs(r.complete ? "\n" : " (ended early)\n", out);
  if (r["left_out"] != 0) print(MetricLine::left_out);
  if (r["fanned_faces"] != 0) print(MetricLine::fanned);
  if (model != nullptr)
    print(MetricLine::mismatches);
  else
    std::fputs("  judge          truth: exact coverage, bounds of errors; nothing is compared with the model\n", out);
  if (c.compared == 0)
    std::fputs("  coverage       no fragments compared", out);
  else
    std::fprintf(out, "  coverage       %llu fragments against the truth", llu(c.compared));
  print(MetricLine::reference);
  if (r.skips.compared > 0)
    std::fprintf(out, "  skips          %llu fragments of draws with other skips, %llu quads differ\n",
                 llu(r.skips.compared), llu(r.skips.differences));
  if (c.tolerated_depth + c.tolerated_visible > 0) {
    print(MetricLine::tolerated_depth);
    print(MetricLine::tolerated_visible);
  }
  if (model != nullptr)
    std::fprintf(
        out, "  model checks   %llu function arguments, %llu beyond the limit; %llu directed fragments, %llu faults\n",
        llu(model->functions.arguments()), llu(model->functions.beyond()), llu(model->directed.compared),
        llu(model->directed.faults()));
  if (c.compared > 0 && model != nullptr)
    std::fprintf(out, "  throughput     %.3f covered pixels per clock\n", per_clock(r));
  const bool counts = config_.performance_counters != 0;
  if (model != nullptr)
    print_counters(out, r.counters, counts ? "the RTL's are the same" : "of the model (performance_counters=0)");
  else if (counts)
    print_counters(out, r.counters, "of the RTL");
  if (c.compared > 0) print_errors(out, r);
  std::fprintf(out, "\n  speed          %.0f cycles/s with all comparisons", rate(r));
  if (alone_rate(r) > 0) std::fprintf(out, "; RTL alone %.0f (%.1f x)", alone_rate(r), ratio(alone_rate(r), rate(r)));
  std::fprintf(out, "; %.1f s in all\n\n%s\n", r.seconds, ok ? "OK" : "FAILED");
}

/// The errors of what was compared, and where its fragments lie.
void CosimReport::print_errors(std::FILE* out, const InputResult& r) const {
  const CheckResult& c = r.check;
  std::fprintf(out, "\n  error                   max        p99.9      rms        attribute  depth\n");
  const auto row = [&](const char* name, const QuantityErrors& e) {
    std::fprintf(out, "    %-18s %9.2e  %9.2e  %9.2e  %9.2e  %9.2e\n", name, e.lambda.max(), e.lambda.p999(),
                 e.lambda.rms(), e.attribute.max(), e.depth.max());
  };
  row("arithmetic", c.arithmetic);
  if (!options_.no_snapping) row("snapping", c.snapping);
  if (!bound_applies())
    std::fprintf(out, "    bound              none: quadratic_frac_bits drops bits of D and R^2\n");
  else
    std::fprintf(out,
                 "    bound              %9.2e  %s; weight %.1f %%, attribute %.1f %%, depth %.1f %% of it; c = %.3f\n",
                 weight_bound(config_), c.within_bound() ? "held" : "EXCEEDED", 100 * std::max(0.0, c.worst.ratio),
                 100 * c.attribute.max, 100 * c.depth.max, value_bound_factor(config_));
  if (r["limits_checked"] > 0)
    std::fprintf(out, "    regression limits  %s\n", r.beyond_limits.empty() ? "held" : "EXCEEDED");
  for (const MetricLine line : {MetricLine::fragments, MetricLine::near, MetricLine::singular})
    std::fputs(line_of(line, r).c_str(), out);
  if (options_.common.verbose) std::fputs(line_of(MetricLine::verbose, r).c_str(), out);
}

void complain(const InputResult& r) {
  if (r.first_divergence)
    std::fprintf(stderr, "quadrille: %s: lockstep: %s\n", r.name.c_str(), r.first_divergence->c_str());
  if (r.check.first.any)
    std::fprintf(stderr, "quadrille: %s: %llu differences from the truth; the first: %s\n", r.name.c_str(),
                 llu(r.check.mismatches), r.check.first.text.c_str());
  if (r.check.beyond_bound)
    std::fprintf(
        stderr,
        "quadrille: %s: %llu weights beyond the bound; the worst: quad %u, pixel (%d, %d), error %.3e, bound %.3e\n",
        r.name.c_str(), llu(r.check.beyond_bound), r.check.worst.place.quad, r.check.worst.place.x,
        r.check.worst.place.y, r.check.worst.error, r.check.worst.bound);
  if (r.check.beyond_attribute || r.check.beyond_depth)
    std::fprintf(stderr, "quadrille: %s: %llu attributes and %llu depths beyond the bound\n", r.name.c_str(),
                 llu(r.check.beyond_attribute), llu(r.check.beyond_depth));
  if (r.skips.differences > 0)
    std::fprintf(stderr, "quadrille: %s: a skip changes the fragments of %llu quads; the first: %s\n", r.name.c_str(),
                 llu(r.skips.differences), r.skips.first.c_str());
  for (const std::string& text : r.beyond_limits)
    std::fprintf(stderr, "quadrille: %s: regression limit exceeded: %s\n", r.name.c_str(), text.c_str());
  if (r.check.compared == 0) std::fprintf(stderr, "quadrille: %s: no fragments compared\n", r.name.c_str());
}

std::string list_metrics() {
  std::string text = "| key | of | meaning |\n|---|---|---|\n";
  InputResult{}.for_each_metric([&](const Metric& metric, std::uint64_t) {
    if (metric.group == MetricGroup::none) return;
    text += std::string("| `") + (metric.group == MetricGroup::counts ? "counts." : "") + metric.key + "` | " +
            std::string(metric.unit) + " | " + std::string(metric.meaning) + " |\n";
  });
  return text;
}

}  // namespace quadrille::tb
