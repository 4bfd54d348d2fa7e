#include "tb/check/shrink.hpp"

#include <algorithm>
#include <cstddef>

namespace quadrille::cli {

namespace {

class Shrinking {
 public:
  Shrinking(FailingDraw draw, const std::function<bool(const FailingDraw&)>& fails, std::uint64_t tries)
      : draw_(std::move(draw)), fails_(fails), tries_(tries) {}

  FailingDraw run() {
    simplify_ports();
    first_quads();
    simplify_state();
    simplify_ports();  // once more: of fewer quads they may not be needed
    // Fewer quads may need fewer pixels and the other way round.
    for (std::size_t before = 0; before != draw_.quads.size();) {
      before = draw_.quads.size();
      fewer_quads();
      fewer_pixels();
    }
    smaller_viewport();
    return std::move(draw_);
  }

 private:
  /// Takes `change` of the draw when it fails with it too.
  template <class Change>
  bool accept(Change&& change) {
    if (tries_ == 0) return false;
    FailingDraw less = draw_;
    change(less);
    --tries_;
    if (!fails_(less)) return false;
    draw_ = std::move(less);
    return true;
  }

  void simplify_ports() {
    if (draw_.stall == 0 && draw_.gap == 0) return;
    if (accept([](FailingDraw& d) { d.stall = d.gap = 0; })) return;
    if (draw_.stall != 0) accept([](FailingDraw& d) { d.stall = 0; });
    if (draw_.gap != 0) accept([](FailingDraw& d) { d.gap = 0; });
  }

  void simplify_state() {
    const DrawState plain;
    const auto try_default = [&](auto DrawState::*member) {
      if (draw_.state.*member != plain.*member) accept([&](FailingDraw& d) { d.state.*member = plain.*member; });
    };
    try_default(&DrawState::cull);
    try_default(&DrawState::perspective);
    try_default(&DrawState::depth);
    try_default(&DrawState::znear);
    try_default(&DrawState::zfar);
    try_default(&DrawState::skip);
  }

  /// As few of the first quads as bisection finds.
  void first_quads() {
    std::size_t passing = 0;  // so few of them do not fail
    while (draw_.quads.size() - passing > 1) {
      const std::size_t middle = passing + (draw_.quads.size() - passing) / 2;
      if (!accept([&](FailingDraw& d) { d.quads.resize(middle); })) passing = middle;
      if (tries_ == 0) return;
    }
  }

  /// Runs of quads are left out, half of all first, in the end one by one.
  void fewer_quads() {
    for (std::size_t run = draw_.quads.size() / 2; run > 0 && tries_ > 0;) {
      bool any = false;
      for (std::size_t at = 0; at < draw_.quads.size() && draw_.quads.size() > 1;) {
        const std::size_t end = std::min(at + run, draw_.quads.size());
        const bool gone = end - at < draw_.quads.size() && accept([&](FailingDraw& d) {
                            d.quads.erase(d.quads.begin() + static_cast<std::ptrdiff_t>(at),
                                          d.quads.begin() + static_cast<std::ptrdiff_t>(end));
                          });
        any = any || gone;
        if (!gone) at = end;
      }
      run = any && run == 1 ? 1 : run / 2;
    }
  }

  void fewer_pixels() {
    const auto narrow = [&](int DrawState::*low, int DrawState::*high) {
      // From either side by as much as bisection finds.
      for (int step = (draw_.state.*high - draw_.state.*low) / 2; step > 0; step /= 2)
        while (draw_.state.*high - draw_.state.*low > step && accept([&](FailingDraw& d) { d.state.*low += step; }))
          ;
      for (int step = (draw_.state.*high - draw_.state.*low) / 2; step > 0; step /= 2)
        while (draw_.state.*high - draw_.state.*low > step && accept([&](FailingDraw& d) { d.state.*high -= step; }))
          ;
    };
    narrow(&DrawState::scissor_x0, &DrawState::scissor_x1);
    narrow(&DrawState::scissor_y0, &DrawState::scissor_y1);
  }

  void smaller_viewport() {
    accept([](FailingDraw& d) {
      d.state.width = d.state.scissor_x1;
      d.state.height = d.state.scissor_y1;
    });
  }

  FailingDraw draw_;
  const std::function<bool(const FailingDraw&)>& fails_;
  std::uint64_t tries_;
};

}  // namespace

FailingDraw shrink(FailingDraw draw, const std::function<bool(const FailingDraw&)>& fails, std::uint64_t tries) {
  return Shrinking(std::move(draw), fails, tries).run();
}

}  // namespace quadrille::cli
