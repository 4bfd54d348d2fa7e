#include "tb/studies/compare/line_jump.hpp"

#include <limits>

namespace quadrille::compare {
namespace {

/// Fits to one side's pixels, evaluated at the line; slopes away from the line.
struct SideFit {
  double line_value, line_slope, parabola_value, parabola_slope;
};

/// `f[i]` is the value at `distance + i` from the line.
SideFit fit_side(const std::array<double, fit_pixels>& f, double distance) {
  // With t = i - 3/2 the polynomials 1, t and t^2 - 5/4 are orthogonal over the four pixels; the sums of their squares
  // are 4, 5 and 4.
  const double mean = ((f[0] + f[3]) + (f[1] + f[2])) / 4;
  const double slope = (1.5 * (f[3] - f[0]) + 0.5 * (f[2] - f[1])) / 5;
  const double bend = ((f[0] + f[3]) - (f[1] + f[2])) / 4;
  const double t = -1.5 - distance;
  const double on_line = mean + slope * t;
  return {on_line, slope, on_line + bend * (t * t - 1.25), slope + 2 * bend * t};
}

/// One channel's ProfileJump::gap. `far_value[i]` is at `distance + i` from the line, `near_value[i]` at
/// `1 - distance + i` on the other side.
double gap_of(const std::array<double, fit_pixels>& far_value, const std::array<double, fit_pixels>& near_value,
              double distance, const SideFit& far_fit, const SideFit& near_fit) {
  const double far_pair = far_value[0] + (far_value[0] - far_value[1]) * distance;
  const double near_pair = near_value[0] + (near_value[0] - near_value[1]) * (1 - distance);
  const std::array differences{far_fit.parabola_value - near_fit.parabola_value,
                               far_fit.line_value - near_fit.line_value, far_pair - near_pair};
  if (!std::ranges::all_of(differences, [](double d) { return std::isfinite(d); }))
    return std::numeric_limits<double>::infinity();
  const auto [least, most] = std::ranges::minmax(differences);
  return std::max({0.0, least, -most});
}

void keep_largest(double jump, double& largest) {
  if (!(jump <= largest)) largest = std::isnan(jump) ? std::numeric_limits<double>::infinity() : jump;
}

}  // namespace

ProfileState measure_profile(const AttributeImage& image, const Profile& profile,
                             const std::array<std::uint32_t, 2>& quads, ProfileJump& jump) {
  const bool along_x = profile.axis == Axis::x;
  const int position = along_x ? profile.x : profile.y, size = along_x ? image.width : image.height;
  const int row = along_x ? profile.y : profile.x, rows = along_x ? image.height : image.width;
  if (row < 0 || row >= rows || position < fit_pixels || position > size - fit_pixels) return ProfileState::elsewhere;

  const std::size_t first = image.pixel(profile.x, profile.y);
  const std::size_t step = along_x ? 1 : static_cast<std::size_t>(image.width);
  const std::uint32_t far_quad = image.quad[first], near_quad = image.quad[first - step];
  const bool allowed =
      (near_quad == quads[0] && far_quad == quads[1]) || (near_quad == quads[1] && far_quad == quads[0]);
  if (!allowed || far_quad == AttributeImage::no_quad || near_quad == AttributeImage::no_quad)
    return ProfileState::elsewhere;

  std::array<std::size_t, fit_pixels> far_side{}, near_side{};
  bool defined = true;
  for (std::size_t i = 0; i < fit_pixels; ++i) {
    far_side[i] = first + i * step;
    near_side[i] = first - (i + 1) * step;
    if (image.quad[far_side[i]] != far_quad || image.quad[near_side[i]] != near_quad) return ProfileState::elsewhere;
    defined = defined && image.defined(far_side[i]) && image.defined(near_side[i]);
  }
  if (!defined) return ProfileState::undefined;

  const double per_side = std::max(image.width, image.height);
  jump = {};
  for (std::size_t c = 0; c < static_cast<std::size_t>(image.channels); ++c) {
    std::array<double, fit_pixels> far_value{}, near_value{};
    for (std::size_t i = 0; i < fit_pixels; ++i) {
      far_value[i] = image.values(far_side[i])[c];
      near_value[i] = image.values(near_side[i])[c];
    }
    const SideFit far_fit = fit_side(far_value, profile.distance),
                  near_fit = fit_side(near_value, 1 - profile.distance);
    // Both slopes point away from the line: equal slopes along the axis have opposite signs.
    keep_largest(std::fabs(far_fit.line_slope + near_fit.line_slope) * per_side, jump.line.slope);
    keep_largest(std::fabs(far_fit.line_value - near_fit.line_value), jump.line.value);
    keep_largest(std::fabs(far_fit.parabola_slope + near_fit.parabola_slope) * per_side, jump.parabola.slope);
    keep_largest(std::fabs(far_fit.parabola_value - near_fit.parabola_value), jump.parabola.value);
    keep_largest(gap_of(far_value, near_value, profile.distance, far_fit, near_fit), jump.gap);
    std::array<double, 2 * fit_pixels> all{};
    std::ranges::reverse_copy(near_value, all.begin());
    std::ranges::copy(far_value, all.begin() + fit_pixels);
    for (std::size_t i = 1; i + 1 < all.size(); ++i)
      keep_largest(std::fabs((all[i + 1] - all[i]) - (all[i] - all[i - 1])) * per_side, jump.step_slope);
  }
  return ProfileState::measured;
}

Profile settle_tie(const AttributeImage& image, Profile profile) {
  const bool along_x = profile.axis == Axis::x;
  int& position = along_x ? profile.x : profile.y;
  const int size = along_x ? image.width : image.height;
  if (position < 1 || position >= size) return profile;
  const std::size_t first = image.pixel(profile.x, profile.y);
  const std::size_t before = first - (along_x ? 1 : static_cast<std::size_t>(image.width));
  if (image.quad[first] != image.quad[before]) return profile;
  if (profile.distance <= edge_tolerance)
    ++position, profile.distance += 1;
  else if (1 - profile.distance <= edge_tolerance)
    --position, profile.distance -= 1;
  return profile;
}

std::vector<Profile> line_profiles(const AttributeImage& image, const golden::Vec2& p, const golden::Vec2& q) {
  std::vector<Profile> profiles;
  // `along` is the coordinate that counts the profiles, `across` the one that they run in.
  const bool rows = std::fabs(q[1] - p[1]) >= std::fabs(q[0] - p[0]);
  const std::size_t along = rows ? 1 : 0, across = rows ? 0 : 1;
  const int count = rows ? image.height : image.width, size = rows ? image.width : image.height;
  const double length = q[along] - p[along], slope = (q[across] - p[across]) / length;
  if (!std::isfinite(length) || !std::isfinite(slope)) return profiles;  // no length: 0 / 0

  const double middle = p[along] + 0.5 * length, quarter = 0.25 * std::fabs(length);
  const double first = std::max(0.0, std::ceil(middle - quarter - 0.5));
  const double last = std::min(count - 1.0, std::floor(middle + quarter - 0.5));
  if (!(first <= last)) return profiles;
  for (int i = static_cast<int>(first); i <= static_cast<int>(last); ++i) {
    const double crossing = p[across] + slope * (i + 0.5 - p[along]);
    if (!(crossing >= 0 && crossing <= size)) continue;
    const int position = static_cast<int>(std::ceil(crossing - 0.5));
    const double distance = position + 0.5 - crossing;
    profiles.push_back(rows ? Profile{Axis::x, position, i, distance} : Profile{Axis::y, i, position, distance});
  }
  return profiles;
}

void LineJump::add(const ProfileJump& jump) {
  line_slope.add(jump.line.slope);
  line_value.add(jump.line.value);
  parabola_slope.add(jump.parabola.slope);
  parabola_value.add(jump.parabola.value);
  step_slope.add(jump.step_slope);
  gap.add(jump.gap);
}

void LineJump::merge(const LineJump& other) {
  line_slope.merge(other.line_slope);
  line_value.merge(other.line_value);
  parabola_slope.merge(other.parabola_slope);
  parabola_value.merge(other.parabola_value);
  step_slope.merge(other.step_slope);
  gap.merge(other.gap);
  undefined += other.undefined;
}

LineJump measure_profiles(const AttributeImage& image, std::span<const Profile> profiles,
                          const std::array<std::uint32_t, 2>& quads) {
  LineJump result;
  for (const Profile& profile : profiles) {
    ProfileJump jump;
    const ProfileState state =
        measure_profile(image, quads[0] == quads[1] ? profile : settle_tie(image, profile), quads, jump);
    if (state == ProfileState::measured) result.add(jump);
    if (state == ProfileState::undefined) ++result.undefined;
  }
  return result;
}

LineJump measure_line(const AttributeImage& image, const golden::Vec2& p, const golden::Vec2& q,
                      const std::array<std::uint32_t, 2>& quads) {
  return measure_profiles(image, line_profiles(image, p, q), quads);
}

}  // namespace quadrille::compare
