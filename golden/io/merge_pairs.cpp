#include "golden/io/merge_pairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace quadrille::golden {
namespace {

Vec3 difference(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A way to join two neighbours.
struct Pair {
  Face quad;
  double skew = 0;  ///< largest distance of a corner's angle from 90 degrees, in radians
};

class Merger {
 public:
  explicit Merger(Mesh& mesh) : mesh_(mesh) {}

  void run() {
    const std::size_t count = mesh_.faces.size();
    // best[i]: of the first i faces. More pairs first, then less skew.
    struct Best {
      std::size_t pairs = 0;
      double skew = 0;
      bool joined = false;  // the last two
    };
    std::vector<Best> best(count + 1);
    std::vector<std::optional<Pair>> pairs(count + 1);
    for (std::size_t i = 1; i <= count; ++i) {
      best[i] = {best[i - 1].pairs, best[i - 1].skew, false};
      if (i < 2) continue;
      pairs[i] = join(mesh_.faces[i - 2], mesh_.faces[i - 1]);
      if (!pairs[i]) continue;
      const Best with{best[i - 2].pairs + 1, best[i - 2].skew + pairs[i]->skew, true};
      if (with.pairs > best[i].pairs || (with.pairs == best[i].pairs && with.skew < best[i].skew)) best[i] = with;
    }
    std::vector<Face> faces;
    std::size_t left = 0;
    for (std::size_t i = count; i > 0;) {
      const bool joined = best[i].joined;
      faces.push_back(std::move(joined ? pairs[i]->quad : mesh_.faces[i - 1]));
      left += faces.back().size() == 3;
      i -= joined ? 2 : 1;
    }
    std::ranges::reverse(faces);
    mesh_.faces = std::move(faces);
    const std::size_t merged = best[count].pairs;
    mesh_.notes.insert(mesh_.notes.begin(), "--merge-pairs: " + std::to_string(2 * merged + left) +
                                                " triangles became " + std::to_string(merged) + " quads, " +
                                                std::to_string(left) + " stayed triangles");
  }

 private:
  const Vec3& position(const Corner& corner) const {
    return mesh_.positions[static_cast<std::size_t>(corner.position)];
  }

  /// By value: some writers repeat a vertex for each face.
  template <class Values>
  static bool same(const Values& values, int a, int b) {
    return a == b || (a >= 0 && b >= 0 && values[static_cast<std::size_t>(a)] == values[static_cast<std::size_t>(b)]);
  }

  bool same(const Corner& a, const Corner& b) const {
    return same(mesh_.positions, a.position, b.position) && same(mesh_.texcoords, a.texcoord, b.texcoord) &&
           same(mesh_.normals, a.normal, b.normal) &&
           (mesh_.colours.empty() || same(mesh_.colours, a.position, b.position));
  }

  std::optional<Pair> join(const Face& first, const Face& second) const {
    if (first.size() != 3 || second.size() != 3) return {};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        // The edge from corner i of the first is that to corner j of the second.
        const Corner &from = first[i], &to = first[(i + 1) % 3];
        if (!same(from, second[(j + 1) % 3]) || !same(to, second[j])) continue;
        const Corner &own = first[(i + 2) % 3], &other = second[(j + 2) % 3];
        // Round the quad: from, other, to, own. Corner 0 is the end of the diagonal that the first triangle names
        // first.
        Pair pair{i < 2 ? Face{from, other, to, own} : Face{to, own, from, other}, 0};
        if (bend_cosine(first, second) < -0.5) return {};
        pair.skew = skew(pair.quad);
        return pair;
      }
    return {};
  }

  /// Of the angle between the normals; 1 where one has none.
  double bend_cosine(const Face& first, const Face& second) const {
    const Vec3 a = normal(first), b = normal(second);
    const double lengths = std::sqrt(dot(a, a) * dot(b, b));
    return lengths > 0 ? dot(a, b) / lengths : 1;
  }

  Vec3 normal(const Face& triangle) const {
    const Vec3& origin = position(triangle[0]);
    return cross(difference(position(triangle[1]), origin), difference(position(triangle[2]), origin));
  }

  /// Of its corners by the plane of their neighbours: a reflex one counts as what is left to a full turn.
  double skew(const Face& quad) const {
    double largest = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3& at = position(quad[i]);
      const Vec3 a = difference(position(quad[(i + 1) % 4]), at), b = difference(position(quad[(i + 3) % 4]), at);
      const Vec3 turn = cross(a, b);
      const double angle = std::atan2(std::sqrt(dot(turn, turn)), dot(a, b));
      largest = std::max(largest, std::abs(angle - std::numbers::pi / 2));
    }
    return largest;
  }

  Mesh& mesh_;
};

}  // namespace

void merge_pairs(Mesh& mesh) { Merger(mesh).run(); }

}  // namespace quadrille::golden
