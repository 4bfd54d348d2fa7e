// How much an attribute and its slope jump across a line of the picture, from one-sided fits to the pixels on either
// side.
#pragma once

#include "golden/scenes/mesh.hpp"
#include "tb/studies/compare/attribute_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace quadrille::compare {

/// Pixels that a fit takes on each side of the line.
inline constexpr int fit_pixels = 4;

enum class Axis { x, y };

/// Eight pixels in a row (axis x) or a column (axis y), four on each side of a line that crosses them.
struct Profile {
  Axis axis = Axis::x;
  int x = 0, y = 0;     ///< the first pixel beyond the line, in the direction of growing x or y
  double distance = 0;  ///< from the line to that pixel's centre along the axis, in pixels
};

/// |difference| of the two sides' fits at the line.
struct Jump {
  double slope = 0;  ///< attribute per image side: per pixel along the axis, times max(width, height)
  double value = 0;  ///< attribute
};

/// A profile's jumps, each the largest of all channels; infinite where finite values are so large that a fit overflows,
/// never NaN.
struct ProfileJump {
  Jump line;      ///< by least-squares straight lines: a second derivative f'' (per pixel) adds 4 f'' to the slope's
  Jump parabola;  ///< by least-squares parabolas: exact for second derivatives
  /// The largest change of the slope from one pixel to the next within the eight pixels, attribute per image side: f''
  /// of a smooth attribute; of a crease half of its jump at least (it may fall between two changes), all of it at most.
  double step_slope = 0;
  /// Per channel the smallest |difference| at the line of three fits to either side: the parabola, the straight line,
  /// and the straight line through the two nearest pixels; 0 where they differ in sign. A step shows in all three; a
  /// crease beyond the second pixel misleads the first two alone, and curvature the last two. A lower estimate.
  double gap = 0;
};

enum class ProfileState {
  measured,
  undefined,  ///< of the allowed quads, but a pixel has no number
  elsewhere,  ///< a pixel shows something else, or lies outside of the image
};

/// Fills `jump` when the four pixels on one side all show one of the two quads and those on the other side the other;
/// which is where does not matter. The two may be the same.
ProfileState measure_profile(const AttributeImage& image, const Profile& profile,
                             const std::array<std::uint32_t, 2>& quads, ProfileJump& jump);

/// The profiles of the middle half of the segment from p to q (window positions): the pixel rows whose centre lines
/// cross it, or columns when it is closer to the horizontal; so they cross it at 45 degrees or more. One per pixel of
/// the segment's longer extent. 0 <= distance < 1. None for a segment of no length, too short to cross a centre line,
/// or with a position that is not finite, and none where the crossing lies outside of the image.
std::vector<Profile> line_profiles(const AttributeImage& image, const golden::Vec2& p, const golden::Vec2& q);

/// Largest and root mean square; 0 of nothing.
class JumpStats {
 public:
  void add(double jump) {
    max_ = std::max(max_, jump);
    squares_ += jump * jump, ++count_;
  }
  void merge(const JumpStats& other) {
    max_ = std::max(max_, other.max_);
    squares_ += other.squares_, count_ += other.count_;
  }
  double max() const { return max_; }
  double rms() const { return count_ == 0 ? 0 : std::sqrt(squares_ / static_cast<double>(count_)); }
  std::uint64_t count() const { return count_; }

 private:
  double max_ = 0, squares_ = 0;
  std::uint64_t count_ = 0;
};

/// Over the profiles of one segment, or of many.
struct LineJump {
  JumpStats line_slope, line_value, parabola_slope, parabola_value, step_slope, gap;
  std::uint64_t undefined = 0;  ///< profiles that only an undefined pixel kept from being measured

  /// 0: not measurable.
  std::uint64_t profiles() const { return line_slope.count(); }
  void add(const ProfileJump& jump);
  void merge(const LineJump& other);
};

/// The profile of an edge between two quads, moved by a pixel where needed: a pixel centre on the edge, or as close to
/// it as snapped vertices may move it (edge_tolerance), counts to the side of the quad that it shows.
Profile settle_tie(const AttributeImage& image, Profile profile);

/// The jumps over the given profiles. `quads`: the same twice for a line inside a quad, where a pixel centre on the
/// line counts to the far side; two for an edge that they share, with its ties settled.
LineJump measure_profiles(const AttributeImage& image, std::span<const Profile> profiles,
                          const std::array<std::uint32_t, 2>& quads);

/// Over line_profiles(image, p, q).
LineJump measure_line(const AttributeImage& image, const golden::Vec2& p, const golden::Vec2& q,
                      const std::array<std::uint32_t, 2>& quads);

/// Pixels along the axis: two half subpixels of the machine's default grid, one of either coordinate.
inline constexpr double edge_tolerance = 0x1p-8;

}  // namespace quadrille::compare
