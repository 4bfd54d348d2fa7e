#include "tb/commands/cosim_options.hpp"

#include "tb/support/errors.hpp"
#include "tb/support/output.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <stdexcept>

namespace quadrille::tb {
namespace {

/// parse(text), {} of an option that was not given.
template <class Parse>
auto parsed_option(const char* option, const std::string& text, Parse&& parse) {
  try {
    return text.empty() ? decltype(parse(text)){} : parse(text);
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string(option) + " " + error.what());
  }
}

}  // namespace

void check_rtl(const std::string& rtl) {
  if (rtl.empty()) return;
  const std::filesystem::path path(rtl);
  if (!std::filesystem::exists(path)) throw UsageError("--rtl " + rtl + ": no such file or directory");
  if (std::filesystem::is_directory(path) && !std::filesystem::exists(path / "quadrille.sv"))
    throw UsageError("--rtl " + rtl + ": no quadrille.sv in this directory; copy the folder rtl/ and change its units");
}

void CosimOptions::check(const Config& config) const {
  parsed_option("--stall-clocks", stall_clocks, parse_stall_clocks);
  parsed_option("--gap-beats", gap_beats, parse_gap_beats);
  parsed_option("--waits", waits, parse_wait_kind);
  probability("--stall", stall);
  probability("--gap", gap);
  if (attributes > config.attribute_slots)
    throw UsageError("--attributes " + std::to_string(attributes) +
                     ": more than attribute_slots = " + std::to_string(config.attribute_slots));
  if (!draw_state.empty()) {
    drawn_state_seed();
    const std::string given = state.spelled() + (attributes > 0 ? " --attributes " + std::to_string(attributes) : "");
    if (!given.empty()) throw UsageError("--draw-state " + draw_state + " conflicts with" + given);
  }
  if (!battery.empty()) {
    if (inputs_given(input) > 0 || draws > 0 || limit_fragments > 0 || !common.settings.empty() ||
        !common.config_file.empty() || !state.spelled().empty() || !draw_state.empty() || attributes > 0 ||
        !out.empty() || !png.empty() || !trace.empty())
      throw UsageError(
          "--battery sets inputs, configurations and draw states; use it only with --rtl, --seed, --threads, "
          "--json, --shrink and --quiet");
  }
  if (judge != "lockstep" && judge != "truth") throw UsageError("--judge " + judge + ": expected lockstep or truth");
  if (by_truth() && (draws > 0 || !battery.empty()))
    throw UsageError("--judge truth conflicts with --" + std::string(draws > 0 ? "draws" : "battery") +
                     ", which compares with the model");
  if (draws > 0) {
    const std::string given = state.spelled() + (attributes > 0 ? " --attributes" : "") +
                              (draw_state.empty() ? "" : " --draw-state") + (out.empty() ? "" : " --out") +
                              (png.empty() ? "" : " --png");
    if (!given.empty()) throw UsageError("--draws conflicts with" + given);
  }
  std::vector<std::string> read = input.files();
  read.insert(read.end(), {common.config_file, texture});
  check_outputs({trace, shrink, out, png, input.save_camera, common.json}, read);
  check_rtl(rtl);
  if (all_scenes() && (!out.empty() || !png.empty() || !trace.empty()))
    throw UsageError("--out, --png and --trace need one input, not all scenes");
}

std::uint64_t CosimOptions::drawn_state_seed() const {
  const std::string& text = draw_state;
  const std::size_t colon = std::min(text.find(':'), text.size());
  std::uint64_t seed = common.seed;
  const char *first = text.data() + colon + 1, *last = text.data() + text.size();
  const bool good = colon == text.size() || (first != last && std::from_chars(first, last, seed).ptr == last);
  if (text.substr(0, colon) != "random" || !good)
    throw UsageError("--draw-state " + text + ": expected random or random:SEED");
  return seed;
}

std::vector<InputOptions> CosimOptions::inputs() const {
  if (!all_scenes()) return {input};
  if (inputs_given(input) > 1) throw UsageError("--scene all conflicts with another input");
  std::vector<InputOptions> list;
  for (const std::string& name : scene_names()) {
    list.push_back(input);
    list.back().scene = name;
  }
  return list;
}

LockstepOptions CosimOptions::lockstep(const Config& config, const DrawState& draw) const {
  LockstepOptions lockstep;
  lockstep.config = config;
  lockstep.state = draw;
  lockstep.seed = common.seed;
  lockstep.stall = stall;
  lockstep.gap = gap;
  lockstep.waits = {parsed_option("--stall-clocks", stall_clocks, parse_stall_clocks),
                    parsed_option("--gap-beats", gap_beats, parse_gap_beats)};
  lockstep.pattern = parsed_option("--waits", waits, parse_wait_kind);
  lockstep.limit_fragments = limit_fragments;
  lockstep.source = rtl;
  lockstep.compare = !by_truth();
  // One file has none: ports alone are compared.
  lockstep.probes = lockstep.compare && !std::filesystem::is_regular_file(rtl);
  lockstep.threads = common.thread_count();
  return lockstep;
}

}  // namespace quadrille::tb
