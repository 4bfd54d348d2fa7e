#include "tb/lockstep/shrink.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace quadrille::tb {

namespace {

/// Of the waits that are drawn anew where a port had some, but no chance to draw them with.
constexpr double usual_chance = 0.3;

/// Leaves quads out, and with them the gaps before their beats.
void erase_quads(FailingDraw& draw, std::size_t begin, std::size_t end) {
  const bool in_the_middle = end < draw.quads.size();
  draw.quads.erase(draw.quads.begin() + static_cast<std::ptrdiff_t>(begin),
                   draw.quads.begin() + static_cast<std::ptrdiff_t>(end));
  if (!draw.waits || draw.waits->gap_beats.empty()) return;
  std::vector<std::uint64_t>& beats = draw.waits->gap_beats;
  std::erase_if(beats, [&](std::uint64_t beat) { return beat / 4 >= begin && beat / 4 < end; });
  for (std::uint64_t& beat : beats)
    if (beat / 4 >= end) beat -= 4 * (end - begin);
  if (in_the_middle) draw.stall = draw.gap = 0;  // the chances would draw others
}

class Shrinking {
 public:
  Shrinking(FailingDraw draw, const FailingRun& run, const ShrinkLimits& limits)
      : draw_(std::move(draw)), run_(run), limits_(limits), next_seed_(draw_.seed) {
    const auto chance = [&](double drawn, auto PortWaits::*listed) {
      return drawn > 0 ? drawn : draw_.waits && !((*draw_.waits).*listed).empty() ? usual_chance : 0;
    };
    stall_ = chance(draw_.stall, &PortWaits::stall_clocks);
    gap_ = chance(draw_.gap, &PortWaits::gap_beats);
  }

  std::optional<Shrunk> run() {
    ++tries_;
    const std::optional<Failure> first = run_(draw_);
    if (!first) return std::nullopt;
    draw_.waits = first->waits;
    // The quad whose beats are on offer is the last that can matter: what comes behind it need not be bisected.
    if (first->quads + 1 < draw_.quads.size())
      accept([&](FailingDraw& d) { erase_quads(d, first->quads + 1, d.quads.size()); });
    first_quads();
    without_waits();
    for (Measure before{}; before != measure();) {
      before = measure();
      simplify_state();
      fewer_quads();
      fewer_pixels();
      smaller_viewport();
      fewer_waits();
    }
    return Shrunk{std::move(draw_), tries_, ended_};
  }

 private:
  /// What every step that is taken makes less, or leaves alone and makes one behind it less: the search ends.
  using Measure = std::array<std::int64_t, 5>;
  Measure measure() const {
    const DrawState &s = draw_.state, plain;
    const int options = (s.cull != plain.cull) + (s.perspective != plain.perspective) + (s.depth != plain.depth) +
                        (s.znear != plain.znear) + (s.zfar != plain.zfar) + (s.skip != plain.skip);
    return {options, static_cast<std::int64_t>(draw_.quads.size()),
            std::int64_t{s.scissor_x1 - s.scissor_x0} * (s.scissor_y1 - s.scissor_y0), std::int64_t{s.width} * s.height,
            static_cast<std::int64_t>(draw_.waits->stall_clocks.size() + draw_.waits->gap_beats.size())};
  }

  /// Takes `less` when it fails.
  bool take(FailingDraw less) {
    ended_ = ended_ || tries_ >= limits_.tries || limits_.out_of_time();
    if (ended_) return false;
    ++tries_;
    const std::optional<Failure> failure = run_(less);
    if (!failure) return false;
    draw_ = std::move(less);
    draw_.waits = failure->waits;
    return true;
  }

  /// Takes `change` of the draw when it fails with it too.
  template <class Change>
  bool accept(Change&& change) {
    FailingDraw less = draw_;
    change(less);
    return take(std::move(less));
  }

  /// The same, and with other waits. More of them from time to time: a fault may want many in a row.
  template <class Change>
  bool accept_redrawn(Change&& change) {
    if (accept(change)) return true;
    if (stall_ == 0 && gap_ == 0) return false;
    for (unsigned i = 0; i < limits_.redraws && !ended_; ++i) {
      const auto more = [&](double chance) { return chance == 0 ? 0 : 1 - (1 - chance) / (1 << i % 6); };
      const bool taken = accept([&](FailingDraw& d) {
        change(d);
        d.waits.reset();
        d.seed = ++next_seed_;
        d.stall = more(stall_);
        d.gap = more(gap_);
      });
      if (taken) return true;
    }
    return false;
  }

  /// Calls leave_out(begin, end) for runs of `size()` things, half of all first, in the end one by one; it says whether
  /// they are gone. (One that can go when another has gone is found when all is gone through again.)
  template <class Size, class LeaveOut>
  void fewer(std::size_t least, Size&& size, LeaveOut&& leave_out) {
    for (std::size_t run = size() / 2 + size() % 2; run > 0 && !ended_; run /= 2)
      for (std::size_t at = 0; at < size() && size() > least;) {
        const std::size_t end = std::min(at + run, size());
        const bool gone = size() - (end - at) >= least && leave_out(at, end);
        if (!gone) at = end;
      }
  }

  /// As few of the first quads as bisection finds.
  void first_quads() {
    std::size_t passing = 0;  // so few of them do not fail
    while (draw_.quads.size() - passing > 1 && !ended_) {
      const std::size_t middle = passing + (draw_.quads.size() - passing) / 2;
      if (!accept([&](FailingDraw& d) { erase_quads(d, middle, d.quads.size()); })) passing = middle;
    }
  }

  /// No waits at either port, or at one: then none are drawn for it again.
  void without_waits() {
    const auto none = [&](bool stalls, bool gaps) {
      return accept([&](FailingDraw& d) {
        d.stall = d.gap = 0;
        if (stalls) d.waits->stall_clocks.clear();
        if (gaps) d.waits->gap_beats.clear();
      });
    };
    if (draw_.waits->empty() || none(true, true)) {
      stall_ = gap_ = 0;
    } else {
      if (draw_.waits->gap_beats.empty() || none(false, true)) gap_ = 0;
      if (draw_.waits->stall_clocks.empty() || none(true, false)) stall_ = 0;
    }
  }

  void simplify_state() {
    const DrawState plain;
    const auto try_default = [&](auto DrawState::*member) {
      if (draw_.state.*member != plain.*member)
        accept_redrawn([&](FailingDraw& d) { d.state.*member = plain.*member; });
    };
    try_default(&DrawState::cull);
    try_default(&DrawState::perspective);
    try_default(&DrawState::depth);
    try_default(&DrawState::znear);
    try_default(&DrawState::zfar);
    try_default(&DrawState::skip);
  }

  void fewer_quads() {
    fewer(
        1, [&] { return draw_.quads.size(); },
        [&](std::size_t begin, std::size_t end) {
          return accept_redrawn([&](FailingDraw& d) { erase_quads(d, begin, end); });
        });
  }

  /// From either side by as much as bisection finds.
  void fewer_pixels() {
    const auto narrow = [&](int DrawState::*low, int DrawState::*high) {
      const auto side = [&](int DrawState::*moved, int sign) {
        const auto size = [&] { return draw_.state.*high - draw_.state.*low; };
        for (int step = size() / 2; step > 0; step /= 2)
          while (size() > step && accept_redrawn([&](FailingDraw& d) { d.state.*moved += sign * step; }))
            ;
      };
      side(low, 1);
      side(high, -1);
    };
    narrow(&DrawState::scissor_x0, &DrawState::scissor_x1);
    narrow(&DrawState::scissor_y0, &DrawState::scissor_y1);
  }

  void smaller_viewport() {
    const DrawState& s = draw_.state;
    if (s.width == s.scissor_x1 && s.height == s.scissor_y1) return;
    accept_redrawn([](FailingDraw& d) {
      d.state.width = d.state.scissor_x1;
      d.state.height = d.state.scissor_y1;
    });
  }

  void fewer_waits() {
    if (draw_.waits->empty()) return;
    without_waits();
    for (const auto member : {&PortWaits::gap_beats, &PortWaits::stall_clocks})
      fewer(
          0, [&] { return ((*draw_.waits).*member).size(); },
          [&](std::size_t begin, std::size_t end) {
            return accept([&](FailingDraw& d) {
              std::vector<std::uint64_t>& waits = (*d.waits).*member;
              waits.erase(waits.begin() + static_cast<std::ptrdiff_t>(begin),
                          waits.begin() + static_cast<std::ptrdiff_t>(end));
              d.stall = d.gap = 0;
            });
          });
  }

  FailingDraw draw_;  ///< which fails; with waits from the first run on
  const FailingRun& run_;
  const ShrinkLimits& limits_;
  std::uint64_t tries_ = 0, next_seed_;
  double stall_ = 0, gap_ = 0;  ///< chances of waits that are drawn anew
  bool ended_ = false;
};

}  // namespace

std::optional<Shrunk> shrink(FailingDraw draw, const FailingRun& run, const ShrinkLimits& limits) {
  return Shrinking(std::move(draw), run, limits).run();
}

}  // namespace quadrille::tb
