#include "tb/judge/check.hpp"

#include "model/skips/hierarchical_z.hpp"
#include "tb/judge/drawn_depths.hpp"
#include "tb/judge/fragment_reference.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>

namespace quadrille::tb {
namespace {

using golden::Coverage;
using golden::ReferenceSample;

// Sizes of jobs. Without threads of their own they stand in the lockstep's way: while one is done the device must not
// run out of room to go on (DeviceAhead keeps 768 clocks).
constexpr std::size_t fragments_per_job = 512;
constexpr std::size_t quads_per_job = 256;
constexpr std::size_t pixels_per_job = 4096;

}  // namespace

FragmentChecker::FragmentChecker(const Settings& settings, std::span<const WindowQuad> given,
                                 std::span<const SnappedQuad> snapped, WorkQueue& queue)
    : settings_(settings), given_(given), snapped_(snapped), queue_(queue), bounds_(settings.config) {
  covered_.emplace_back();
  if (settings.first_pass && skips_hidden(settings.config, settings.state))
    hidden_ = std::make_unique<HiddenCheck>(settings.config, settings.state, settings.depths, settings.exact);
}

void FragmentChecker::add(const CheckResult& part) {
  std::lock_guard lock(mutex_);
  result_.merge(part);
}

void FragmentChecker::fragment(const Fragment& fragment) {
  if (settings_.first_pass) {
    if (fragment.quad < current_ || fragment.quad >= snapped_.size()) {
      CheckResult part;
      part.mismatches = 1;
      part.first = {true, {fragment.quad, fragment.quad, fragment.x, fragment.y}, ""};
      part.first.text = text_of(part.first.place, "a fragment of a quad that is not being drawn");
      add(part);
      return;
    }
    if (fragment.quad != current_) quads_done(fragment.quad);
    covered_.back().push_back(static_cast<std::uint32_t>(fragment.y) << 16 | fragment.x);
    ++covered_pixels_;
    if (hidden_) hidden_->fragment(fragment);
  }
  batch_.push_back(fragment);
  if (batch_.size() >= fragments_per_job) flush_fragments();
}

void FragmentChecker::flush_fragments() {
  if (batch_.empty()) return;
  queue_.push([this, fragments = std::move(batch_)] { compare(fragments); });
  batch_ = {};
}

/// The quads before `end` are complete.
void FragmentChecker::quads_done(std::size_t end) {
  while (current_ < end) {
    if (hidden_) judge_hidden();
    ++current_;
    if (hidden_ || current_ - covered_first_ >= quads_per_job || covered_pixels_ >= pixels_per_job) flush_coverage();
    covered_.emplace_back();
  }
}

/// The quad current_ is complete: what of it is missing, against the depth buffer of the quads before.
void FragmentChecker::judge_hidden() {
  const auto fault = hidden_->quad_done(snapped_[current_]);
  if (!fault) return;
  CheckResult part;
  part.mismatches = 1;
  part.first = {true, {static_cast<std::uint32_t>(current_), given_[current_].id, fault->x, fault->y}, ""};
  part.first.text = text_of(part.first.place, fault->text);
  add(part);
}

/// Hands the complete quads covered_first_ … current_-1 over.
void FragmentChecker::flush_coverage() {
  if (current_ == covered_first_) return;
  const auto pixels = std::make_shared<const std::vector<std::vector<std::uint32_t>>>(std::move(covered_));
  if (hidden_) {  // in this thread: the depth buffer goes on with the next quad
    cover(covered_first_, *pixels, 0, settings_.state.height);
    covered_.clear();
    covered_first_ = current_;
    covered_pixels_ = 0;
    return;
  }
  // One quad over much of the viewport is worth several jobs.
  const int height = settings_.state.height;
  const int rows = current_ - covered_first_ == 1 ? std::max(1, settings_.state.height / 8) : height;
  for (int y = 0; y < height; y += rows)
    queue_.push(
        [this, first = covered_first_, pixels, y, end = std::min(height, y + rows)] { cover(first, *pixels, y, end); });
  covered_.clear();
  covered_first_ = current_;
  covered_pixels_ = 0;
}

void FragmentChecker::finish(bool complete) {
  flush_fragments();
  if (!settings_.first_pass) return;
  if (complete) {
    quads_done(snapped_.size());
    covered_.pop_back();
  } else if (!covered_.empty()) {
    covered_.pop_back();  // the last quad was cut off
  }
  flush_coverage();
}

/// Every pixel of rows y0 … y1-1 that the truth covers must have been drawn, once.
void FragmentChecker::cover(std::size_t first, const std::vector<std::vector<std::uint32_t>>& pixels, int y0, int y1) {
  CheckResult part;
  const DrawState& state = settings_.state;
  const DepthLimits limits(settings_.config, state);
  std::vector<std::uint32_t> drawn;
  for (std::size_t n = 0; n < pixels.size(); ++n) {
    const std::size_t index = first + n;
    const auto differs = [&](int x, int y, const char* what) {
      const Place place{static_cast<std::uint32_t>(index), given_[index].id, x, y};
      ++part.mismatches;
      if (!part.first.any || order(place) < order(part.first.place)) part.first = {true, place, text_of(place, what)};
    };
    drawn.clear();
    for (const std::uint32_t pixel : pixels[n])
      if (const int y = static_cast<int>(pixel >> 16); y >= y0 && y < y1) drawn.push_back(pixel);
    std::sort(drawn.begin(), drawn.end());
    for (std::size_t i = 1; i < drawn.size(); ++i)
      if (drawn[i] == drawn[i - 1])
        differs(static_cast<int>(drawn[i] & 0xffff), static_cast<int>(drawn[i] >> 16), "drawn twice");

    const Reference reference(*this, index);
    const golden::PixelRect bounds = reference.truth().bounds();  // what is drawn beyond, compare() finds
    std::size_t next = 0;
    for (int y = std::max(y0, bounds.y0); y < std::min(y1, bounds.y1); ++y) {
      const golden::PixelSpan row = reference.truth().rows().row(y);
      for (int x = row.x0; x < row.x1; ++x) {
        const std::uint32_t pixel = static_cast<std::uint32_t>(y) << 16 | static_cast<std::uint32_t>(x);
        while (next < drawn.size() && drawn[next] < pixel) ++next;
        if (next < drawn.size() && drawn[next] == pixel) continue;  // compare() judges what was drawn
        const Coverage coverage = reference.truth().cover(x, y);
        if (!coverage.covered || !coverage.visible || state.cull == (coverage.front ? Cull::front : Cull::back))
          continue;
        const ReferenceSample truth = reference.truth().sample(x, y);
        if (reference.tolerates_visibility(truth)) {
          ++part.tolerated_visible;
          continue;
        }
        // A quad whose depths are all within the limits loses no pixel to them.
        if (const QuadBase& base = reference.quad().base; state.depth && !limits.hold_all_of(base)) {
          // As far as the truth can tell it was discarded rightly, unless the machine is exact at this pixel.
          std::optional<std::int64_t> code;
          if ((truth.flags & flag_on_vertex) != 0 && settings_.config.qdrop() == 0)
            code = reference.exact_depth(reference.corner_at(x, y));
          if (limits.hold_none_of(base) || (code ? !limits.holds(*code) : limits.side(truth.z, 0) < 0)) {
            ++part.discarded;
            continue;
          }
          if (!code && limits.side(truth.z, reference.depth_tolerance(x, y)) == 0) {
            ++part.tolerated_depth;
            continue;
          }
        }
        if (hidden_) {
          if (hidden_->may_refuse(x, y, truth.z, reference.depth_tolerance(x, y))) {
            ++part.hidden;
            continue;
          }
          differs(x, y, "not drawn, but in front of the depth buffer in the truth");
          continue;
        }
        differs(x, y, "not drawn, but covered in the truth");
      }
    }
  }
  add(part);
}

CheckResult check_here(const FragmentChecker::Settings& settings, std::span<const WindowQuad> given,
                       std::span<const SnappedQuad> snapped,
                       const std::function<bool(const std::function<void(const Fragment&)>&)>& draw) {
  WorkQueue queue(0, 1);
  FragmentChecker checker(settings, given, snapped, queue);
  checker.finish(draw([&](const Fragment& fragment) { checker.fragment(fragment); }));
  queue.drain();
  CheckResult result = checker.result();
  if (!settings.first_pass) result.compared = 0;
  return result;
}

}  // namespace quadrille::tb
