#include "tb/judge/skip_check.hpp"

#include "model/port/draw_state.hpp"
#include "model/skips/hierarchical_z.hpp"
#include "model/untimed.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace quadrille::tb {

namespace {

constexpr std::size_t quads_per_job = 64;

std::uint64_t mixed(std::uint64_t hash, const Fragment& f) {
  const auto add = [&](std::uint64_t word) { hash = (hash ^ word) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29; };
  add(std::uint64_t{f.x} << 48 | std::uint64_t{f.y} << 32 | std::uint64_t{f.flags} << 1 | (f.front ? 1 : 0));
  add(f.depth);
  for (const std::int64_t attribute : f.attribute) add(static_cast<std::uint64_t>(attribute));
  return hash;
}

/// A draw that is compared: its skips, and what to call it.
struct Variant {
  std::uint32_t skip;
  std::string name;
};

std::vector<Variant> variants(const DrawState& state) {
  const std::uint32_t others = state.skip & ~std::uint32_t{skip_default | skip_hidden};
  std::vector<Variant> list{{others, "without a skip"}};
  for (std::uint32_t bit = 1; bit <= skip_default; bit <<= 1)
    if ((skip_default & bit) != 0)
      list.push_back(
          {others | bit,
           "with skip " + std::string(skip_names[static_cast<std::size_t>(std::countr_zero(bit))]) + " alone"});
  list.push_back({others | (state.skip & skip_default), "with the skips of the draw"});
  return list;
}

/// The first fragment that differs, in words.
std::string difference(const Config& config, const DrawState& state, const std::vector<Variant>& list, std::size_t v,
                       const SnappedQuad& quad) {
  const auto draw = [&](std::uint32_t skip) {
    DrawState s = state;
    s.skip = skip;
    std::vector<Fragment> fragments;
    UntimedModel(config, s, PixelEngine::plain).draw(quad, [&](std::span<const Fragment> f) {
      fragments.insert(fragments.end(), f.begin(), f.end());
    });
    return fragments;
  };
  const std::vector<Fragment> wanted = draw(list[0].skip), given = draw(list[v].skip);
  const auto [a, b] = std::ranges::mismatch(wanted, given);
  std::string text = "quad " + std::to_string(quad.id) + " has " + std::to_string(given.size()) + " fragments " +
                     list[v].name + ", " + std::to_string(wanted.size()) + " " + list[0].name;
  if (a == wanted.end() && b == given.end()) return text + "; the machine drew others";
  const Fragment& f = a != wanted.end() ? *a : *b;
  return text + "; the first that differs: pixel (" + std::to_string(f.x) + ", " + std::to_string(f.y) + ")";
}

}  // namespace

void SkipResult::merge(const SkipResult& other) {
  compared += other.compared;
  differences += other.differences;
  if (first.empty()) first = other.first;
}

SkipCheck::SkipCheck(const Config& config, const DrawState& state, std::size_t quads)
    : config_(config), state_(state), hides_(skips_hidden(config, state)), drawn_(quads) {}

void SkipCheck::fragment(const Fragment& fragment) {
  last_ = fragment.quad;
  if (last_ < drawn_.size()) drawn_[last_] = mixed(drawn_[last_], fragment);
}

SkipResult SkipCheck::compare(std::span<const SnappedQuad> snapped, std::size_t quads, bool complete,
                              WorkQueue& queue) const {
  const std::vector<Variant> list = variants(state_);
  std::vector<std::vector<std::uint64_t>> hashes(list.size(), std::vector<std::uint64_t>(quads));
  std::vector<std::uint64_t> counts(quads);
  for (std::size_t v = 0; v < list.size(); ++v)
    for (std::size_t first = 0; first < quads; first += quads_per_job)
      queue.push([&, v, first] {
        DrawState state = state_;
        state.skip = list[v].skip;
        // The plain pipeline walks as the machine does; the lanes' small quads do not.
        UntimedModel model(config_, state, PixelEngine::plain);
        for (std::size_t q = first; q < std::min(quads, first + quads_per_job); ++q)
          model.draw(snapped[q], [&, q](std::span<const Fragment> fragments) {
            for (const Fragment& f : fragments) hashes[v][q] = mixed(hashes[v][q], f);
            if (v == 0) counts[q] += fragments.size();
          });
      });
  queue.drain();

  SkipResult result;
  for (std::size_t v = 1; v < list.size(); ++v)
    for (std::size_t q = 0; q < quads; ++q) {
      result.compared += counts[q];
      // Where the draw was cut off, the last quad may lack fragments.
      const bool machine = v + 1 == list.size() && !hides_ && (complete || q < last_);
      if (hashes[v][q] == hashes[0][q] && !(machine && drawn_[q] != hashes[0][q])) continue;
      if (result.differences++ == 0) result.first = difference(config_, state_, list, v, snapped[q]);
    }
  return result;
}

}  // namespace quadrille::tb
