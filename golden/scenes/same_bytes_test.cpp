// The same seed gives the same bytes with every compiler and processor: a hash of what each generator makes. One that
// differs drew twice in one call, whose arguments have no order, or took a last bit of the C library's; or a generator
// was changed on purpose: then its number here is what the failure prints.
#include "golden/scenes/approach.hpp"
#include "golden/scenes/corner_quads.hpp"
#include "golden/scenes/random_mesh.hpp"
#include "golden/scenes/random_quads.hpp"
#include "golden/scenes/scenes.hpp"
#include "golden/scenes/stress.hpp"
#include "golden/scenes/test_support.hpp"

#include <gtest/gtest.h>

namespace quadrille::golden {
namespace {

/// The hash of hashes; `make(add)` calls add(quads).
std::uint64_t hash_all(auto&& make) {
  std::uint64_t all = 0;
  make([&](const std::vector<WindowQuad>& quads) { all = all * 31 + hash_quads(quads); });
  return all;
}

/// Integers of the port as the positions and attributes of a window quad.
std::vector<WindowQuad> as_numbers(const std::vector<SnappedQuad>& snapped) {
  std::vector<WindowQuad> quads(snapped.size());
  for (std::size_t n = 0; n < snapped.size(); ++n)
    for (std::size_t i = 0; i < 4; ++i) {
      const SnappedVertex& v = snapped[n].vertex[i];
      quads[n].vertex[i] = {double(v.x), double(v.y), double(v.z.sig), double(v.w)};
      quads[n].attribute[i] = {double(v.z.exp), double(v.k.sig), double(v.k.exp), double(v.attribute[0].sig)};
    }
  return quads;
}

TEST(SameBytes, Scenes) {
  EXPECT_EQ(hash_all([](auto add) {
              for (const SceneInfo& info : list_scenes()) add(scene_quads(make_scene(info.name), 640, 360));
            }),
            0x115ac85f7c0822a2u);
}

TEST(SameBytes, StressFamilies) {
  EXPECT_EQ(hash_all([](auto add) {
              for (const StressFamilyInfo& info : stress_families()) add(make_stress(info.family, 50, 9));
            }),
            0x2b24445327c74585u);
}

TEST(SameBytes, Approaches) {
  EXPECT_EQ(hash_all([](auto add) {
              for (const Approach& a : approaches()) add(make_approach(a, a.first + 1, 1, 50, 9, 4));
            }),
            0x9cd2ae5b8cbebf89u);
}

TEST(SameBytes, CornerQuads) {
  EXPECT_EQ(hash_all([](auto add) {
              for (const CornerDraw& draw : corner_draws(Config{}, 9)) add(as_numbers(draw.quads));
            }),
            0x9ca002cb50ba31b1u);
}

TEST(SameBytes, RandomQuadsAndMeshes) {
  EXPECT_EQ(hash_all([](auto add) {
              add(as_numbers(tb::random_quads(Config{}, tb::small_state(Config{}), 9, 500)));
              add(make_random_mesh(9, {.tie_share = 0.2, .vary_w = true}).quads);
            }),
            0xe0e3dce4a0a5fce8u);
}

}  // namespace
}  // namespace quadrille::golden
