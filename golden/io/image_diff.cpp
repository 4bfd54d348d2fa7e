#include "golden/io/image_diff.hpp"

#include "golden/io/error.hpp"
#include "golden/io/heat_scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace quadrille::golden {
namespace {

constexpr int heat_octaves = 16;

template <class T>
ChannelDiff diff_channel(const std::string& name, const std::vector<T>& a, const std::vector<T>& b, int width,
                         std::vector<float>* largest) {
  ChannelDiff diff;
  diff.name = name;
  double squares = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto p = static_cast<double>(a[i]), q = static_cast<double>(b[i]);
    const bool unordered = std::isnan(p) || std::isnan(q);
    if (p == q || (std::isnan(p) && std::isnan(q))) continue;
    ++diff.count;
    const double difference = std::fabs(p - q);
    if (largest && !((*largest)[i] >= difference)) (*largest)[i] = static_cast<float>(difference);
    const auto x = static_cast<int>(i % static_cast<std::size_t>(width));
    const auto y = static_cast<int>(i / static_cast<std::size_t>(width));
    if (unordered) {
      if (diff.nans++ == 0) diff.nan_x = x, diff.nan_y = y, diff.nan_a = p, diff.nan_b = q;
      continue;
    }
    squares += difference * difference;
    if (difference > diff.max) {
      diff.max = difference;
      diff.x = x;
      diff.y = y;
    }
  }
  diff.rms = a.empty() ? 0 : std::sqrt(squares / static_cast<double>(a.size()));
  return diff;
}

template <class Channels>
void diff_channels(const Channels& a, const Channels& b, ImageDiff& diff, std::vector<float>* largest) {
  for (const auto& [name, values] : a) {
    const auto other = b.find(name);
    if (other == b.end())
      diff.only_a.push_back(name);
    else
      diff.channels.push_back(diff_channel(name, values, other->second, diff.width, largest));
  }
  for (const auto& [name, values] : b)
    if (!a.contains(name)) diff.only_b.push_back(name);
}

}  // namespace

bool ImageDiff::same() const {
  return only_a.empty() && only_b.empty() &&
         std::ranges::all_of(channels, [](const ChannelDiff& channel) { return channel.count == 0; });
}

ImageDiff diff_images(const ExrImage& a, const ExrImage& b, const std::string& a_name, const std::string& b_name) {
  if (a.width != b.width || a.height != b.height)
    throw InputError(a_name + " has " + std::to_string(a.width) + "x" + std::to_string(a.height) + " pixels, " +
                     b_name + " " + std::to_string(b.width) + "x" + std::to_string(b.height) +
                     "; only pictures of one size can be compared");
  ImageDiff diff;
  diff.width = a.width;
  diff.height = a.height;
  diff.largest.assign(static_cast<std::size_t>(a.width) * static_cast<std::size_t>(a.height), 0);
  diff_channels(a.floats, b.floats, diff, &diff.largest);
  diff_channels(a.uints, b.uints, diff, nullptr);
  std::ranges::sort(diff.channels, {}, &ChannelDiff::name);
  return diff;
}

std::array<std::uint8_t, 3> heat_colour(double value, double most, int octaves) {
  // Control points of a dark-to-light scale whose lightness rises evenly.
  constexpr std::array<std::array<double, 3>, 5> scale{
      {{40, 10, 80}, {120, 28, 109}, {203, 65, 84}, {244, 136, 40}, {252, 244, 120}}};
  if (!std::isfinite(value)) return {255, 255, 255};
  std::array<std::uint8_t, 3> colour{};
  if (!(value > 0)) return colour;
  const double place = std::clamp(1 + std::log2(value / most) / octaves, 0.0, 1.0);
  const double position = place * (scale.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(position), scale.size() - 2);
  const double part = position - static_cast<double>(below);
  for (std::size_t c = 0; c < 3; ++c)
    colour[c] = static_cast<std::uint8_t>(std::lround(scale[below][c] * (1 - part) + scale[below + 1][c] * part));
  return colour;
}

Image8 heat_map(const ImageDiff& diff) {
  double most = 0;
  for (const float value : diff.largest)
    if (std::isfinite(value)) most = std::max(most, static_cast<double>(value));
  Image8 image;
  image.width = diff.width;
  image.height = diff.height;
  image.rgba.reserve(diff.largest.size() * 4);
  for (const float value : diff.largest) {
    const std::array<std::uint8_t, 3> colour = heat_colour(static_cast<double>(value), most, heat_octaves);
    image.rgba.insert(image.rgba.end(), {colour[0], colour[1], colour[2], 255});
  }
  return with_heat_scale(image, most, heat_octaves);
}

}  // namespace quadrille::golden
