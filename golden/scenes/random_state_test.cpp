#include "golden/scenes/random_state.hpp"

#include "golden/scenes/stress.hpp"
#include "model/port/stages.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <string>

namespace quadrille::golden {
namespace {

TEST(RandomState, IsAValidStateAndEveryKindOccurs) {
  const Config config;
  std::map<std::string, int> kinds;
  constexpr int seeds = 400;
  for (int seed = 0; seed < seeds; ++seed) {
    const DrawState s = random_draw_state(config, 60, 300, {}, static_cast<std::uint64_t>(seed));
    EXPECT_TRUE(0 <= s.scissor_x0 && s.scissor_x0 + 15 <= s.scissor_x1 && s.scissor_x1 <= 60) << seed;
    EXPECT_TRUE(0 <= s.scissor_y0 && s.scissor_y0 + 75 <= s.scissor_y1 && s.scissor_y1 <= 300) << seed;
    EXPECT_TRUE(0 <= s.znear && s.znear + 0.25 <= s.zfar && s.zfar <= 1) << seed;
    EXPECT_TRUE(1 <= s.attributes && s.attributes <= config.attribute_slots) << seed;
    EXPECT_EQ(s.width, 60);
    EXPECT_EQ(s.height, 300);
    kinds["scissor"] += s.scissor_x1 - s.scissor_x0 < 60 || s.scissor_y1 - s.scissor_y0 < 300;
    kinds["cull front"] += s.cull == Cull::front;
    kinds["cull back"] += s.cull == Cull::back;
    kinds["no perspective"] += !s.perspective;
    kinds["no depth"] += !s.depth;
    kinds["znear"] += s.depth && s.znear > 0;
    kinds["zfar"] += s.depth && s.zfar < 1;
    kinds["fewer attributes"] += s.attributes < config.attribute_slots;
    kinds["no tile skip"] += (s.skip & skip_tiles) == 0;
    kinds["no quad skip"] += (s.skip & skip_quads) == 0;
    kinds["no walk skip"] += (s.skip & skip_walk) == 0;
    kinds["no operand skip"] += (s.skip & skip_operands) == 0;
  }
  for (const auto& [kind, count] : kinds) {
    EXPECT_GT(count, seeds / 8) << kind;
    EXPECT_LT(count, seeds * 3 / 4) << kind;
  }
  const DrawState a = random_draw_state(config, 60, 300, {}, 7), b = random_draw_state(config, 60, 300, {}, 7);
  EXPECT_EQ(a.znear, b.znear);
  EXPECT_EQ(a.scissor_x1, b.scissor_x1);
}

/// Limits taken from a corner: its code, and the next one on either side.
TEST(RandomState, LimitsMeetTheDepthOfCorners) {
  const Config config;
  const std::vector<WindowQuad> quads = make_stress(StressFamily::on_vertex, 30, 1, 1, 64, 64, 1);
  std::map<std::int64_t, int> beside;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const DrawState state = random_draw_state(config, 64, 64, quads, seed);
    if (!state.depth) continue;
    for (const double limit : {state.znear, state.zfar}) {
      if (limit == 0 || limit == 1) continue;
      for (const WindowQuad& quad : quads)
        for (const WindowVertex& v : quad.vertex) {
          const auto code = static_cast<std::int64_t>(std::lround(std::ldexp(v.z / v.w, config.depth_bits)));
          const std::int64_t apart = std::int64_t{depth_code(limit, config)} - code;
          if (std::abs(apart) <= 1) ++beside[apart];
        }
    }
  }
  for (const std::int64_t apart : {-1, 0, 1}) EXPECT_GE(beside[apart], 20) << apart;
}

}  // namespace
}  // namespace quadrille::golden
