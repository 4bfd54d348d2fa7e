#include "model/clocked/pixel_pipeline.hpp"

namespace quadrille::clocked {

PixelPipeline::PixelPipeline(const PipelineContext& context, Probes probes)
    : context_(context),
      lanes_(static_cast<std::size_t>(context.config.pixels_per_clock)),
      pixels_(registers * lanes_),
      fragments_(fragment_places * lanes_),
      traces_(probes == Probes::all ? pixels_.size() : 0),
      wanted_{WantedSums(context.config, context.state, false), WantedSums(context.config, context.state, true)},
      products_(context.config) {}

void PixelPipeline::set_state() {
  for (const bool hull : {false, true}) wanted_[hull ? 1 : 0] = WantedSums(context_.config, context_.state, hull);
}

void PixelPipeline::show_probes() {
  for (std::size_t lane = 0; lane < lanes_; ++lane) {
    const auto pixel = [&](int n) {
      const std::size_t at = place(n) + lane;
      return pixels_[at].valid ? &traces_[at] : nullptr;
    };
    probes_[lane] = {pixel(latency::diff_stage),  pixel(latency::norm_stage),   pixel(latency::root_stage),
                     pixel(latency::ratio_stage), pixel(latency::weight_stage), pixel(latency::sum_stage)};
  }
}

void PixelPipeline::count(PerformanceCounters& to) const {
  using enum PerformanceCounter;
  std::array<std::int64_t, pixel_kinds> seen{};  // by the stage in question
  for (const auto& lane : sent_)
    for (std::size_t kind = 0; kind < pixel_kinds; ++kind) seen[kind] += static_cast<std::int64_t>(lane[kind]);
  const auto total = [&](auto&& of_kind) {
    std::int64_t sum = 0;
    for (std::size_t kind = 0; kind < pixel_kinds; ++kind) sum += seen[kind] * of_kind(kind);
    return static_cast<std::uint64_t>(sum);
  };
  const auto sums = [&](int WantedSums::*what) {
    return total([&](std::size_t kind) { return wanted_[(kind & pixel_hull) != 0 ? 1 : 0].*what; });
  };
  // Operands that are held make no product.
  const bool held = (context_.state.skip & skip_operands) != 0;
  const auto off_corners = [&] {
    return total(
        [&](std::size_t kind) { return (kind & pixel_plane) == 0 && !(held && (kind & pixel_corner) != 0) ? 1 : 0; });
  };
  const auto product = [](int count) { return static_cast<std::uint64_t>(count); };
  for (int n = -emission; n <= last_stage; ++n) {
    const std::span<const Pixel> pixels = stage(n);
    for (std::size_t lane = 0; lane < lanes_; ++lane) seen[pixels[lane].kind] -= pixels[lane].valid ? 1 : 0;
    if (n == latency::norm_stage) {
      to[pixels_plane] += total([](std::size_t kind) { return (kind & pixel_plane) != 0 ? 1 : 0; });
      to[products_sqrt] += off_corners() * product(products_.sqrt);
    }
    if (n == latency::root_stage)
      to[products_mean_value_ratios] += off_corners() * product(products_.mean_value_ratios);
    if (n == latency::ratio_stage)
      to[products_mean_value_weights] +=
          off_corners() * product(products_.weight_ratios) +
          total([](std::size_t kind) { return (kind & pixel_areas) == 0 ? 1 : 0; }) * product(products_.weight_factors);
    if (n == latency::weight_stage) to[products_interpolate] += sums(&WantedSums::terms);
    if (n == latency::sum_stage)
      to[products_reciprocal] += sums(&WantedSums::denominators) * product(products_.reciprocal);
    if (n == latency::fragment_stage - latency::fragment_output_stages)
      to[products_fragment_output] += sums(&WantedSums::quotients);
    if (n == last_stage) to[fragments] += total([](std::size_t kind) { return (kind & pixel_drawn) != 0 ? 1 : 0; });
  }
  for (std::size_t lane = 0; lane < lanes_; ++lane) {
    std::uint64_t entered = 0;
    for (const std::uint64_t of_kind : sent_[lane]) entered += of_kind;
    for (int n = -emission; n <= 0; ++n) entered -= stage(n)[lane].valid ? 1 : 0;
    to[static_cast<PerformanceCounter>(static_cast<std::size_t>(pixels_lane0) + lane)] += entered;
  }
}

}  // namespace quadrille::clocked
