#include "tb/commands/cosim_picture.hpp"

#include "golden/io/exr.hpp"

#include <algorithm>

namespace quadrille::tb {

CosimPicture::CosimPicture(const CosimOptions& options, const Config& config, const DrawInput& input,
                           const DrawState& state)
    : options_(options), config_(config), input_(input), state_(state), frame_(state.width, state.height, state.depth) {
  shading_.shade = input_.shade;
  shading_.slots = shade_slots(input_.shade, input_);
  shading_.texture = make_texture(options_.texture, input_);
  shading_.lighting = input_.lighting;
  shading_.depth = state_.depth;
  shading_.threads = options_.common.thread_count();
}

void CosimPicture::begin_pass(const Pass& pass, std::size_t number, std::size_t weight_passes) {
  pass_ = &pass;
  number_ = number;
  weight_passes_ = weight_passes;
  position_ = 0;
}

void CosimPicture::fragment(const Fragment& fragment) {
  if (fragment.quad >= input_.quads.size() || fragment.x >= state_.width || fragment.y >= state_.height) return;
  if (number_ >= weight_passes_) {
    frame_.amend(fragment, fragment.quad, *pass_, config_);
  } else if (number_ == 0) {
    EngineSample& sample = samples_.emplace_back();
    sample.index = fragment.quad;
    sample.quad = input_.quads[fragment.quad].id;
    read_columns(fragment, *pass_, config_, sample);
  } else {
    // Of plane quads a pass may discard pixels by depth that another draws (state_of_pass).
    const auto same = [&](const EngineSample& s) {
      return s.index == fragment.quad && s.x == fragment.x && s.y == fragment.y;
    };
    constexpr std::size_t most_missing = 1024;
    const auto first = samples_.begin() + static_cast<std::ptrdiff_t>(position_);
    const auto last = first + static_cast<std::ptrdiff_t>(std::min(most_missing, samples_.size() - position_));
    const auto found = std::find_if(first, last, same);
    if (found == last) return;
    read_columns(fragment, *pass_, config_, *found, false);
    position_ = static_cast<std::size_t>(found - samples_.begin()) + 1;
  }
}

void CosimPicture::end_pass() {
  if (number_ + 1 != weight_passes_) return;
  frame_.add(samples_);
  samples_.clear();
}

void CosimPicture::save() {
  golden::FrameImage image = shade_frame(frame_, shading_);
  if (!options_.out.empty()) {
    add_error_layers(frame_, input_.quads, config_, state_, true, options_.common.thread_count(), image);
    golden::save_exr(options_.out, image);
  }
  if (!options_.png.empty()) save_frame_png(options_.png, image);
}

}  // namespace quadrille::tb
