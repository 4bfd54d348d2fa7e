#include "model/port/boundaries.hpp"

#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

namespace quadrille {
namespace {

/// Bit by bit, from the most significant field: the slow way that BitPacker must agree with.
struct SlowPacker {
  std::vector<bool> bits;  // most significant first
  template <class T>
  void operator()(const FieldType& type, int, T value) {
    const auto v = static_cast<std::uint64_t>(static_cast<std::int64_t>(value));
    for (int i = type.width; i-- > 0;) bits.push_back((v >> i & 1u) != 0);
  }
  std::vector<std::uint32_t> words() const {
    std::vector<std::uint32_t> out((bits.size() + 31) / 32);
    for (std::size_t i = 0; i < bits.size(); ++i) {
      const std::size_t lsb = bits.size() - 1 - i;
      if (bits[i]) out[lsb / 32] |= std::uint32_t{1} << lsb % 32;
    }
    return out;
  }
};

TEST(BitPacker, HandComputedWords) {
  std::uint64_t out[2] = {~0ull, ~0ull};
  BitPacker packer(out, 72);  // {4'hA, 64'h0123456789ABCDEF, 4'h5}
  packer.put(4, 0xA);
  packer.put(64, 0x0123456789ABCDEF);
  packer.put(4, 0xFFF5);
  packer.finish();
  EXPECT_EQ(out[0], 0x123456789ABCDEF5u);
  EXPECT_EQ(out[1], 0xA0u);
}

TEST(BitPacker, FullWordsAndSingleBits) {
  std::uint64_t out[2] = {1, 2};
  BitPacker packer(out, 128);
  packer.put(64, 0xFEDCBA9876543210);
  for (int i = 0; i < 64; ++i) packer.put(1, i == 0 || i == 63);
  packer.finish();
  EXPECT_EQ(out[1], 0xFEDCBA9876543210u);
  EXPECT_EQ(out[0], 0x8000000000000001u);
}

TEST(BitPacker, FragmentOfTheDefaultConfiguration) {
  // quad 24, x 12, y 12, front 1, flags 8, depth 25, attr[3..0] 32 each: 210 bits. attr[0] is bits 31..0.
  const Config config;
  Fragment f;
  f.quad = 0xABCDEF;
  f.x = 0x123;
  f.y = 0x456;
  f.front = true;
  f.flags = 0x81;
  f.depth = 0x1000000;
  f.attribute = {1, -1, 0x7FFFFFFF, -0x80000000ll};
  const RecordLayout layout = boundary_layout(Boundary::fragment, config);
  ASSERT_EQ(layout.bits(), 210);
  Record packed = pack_record(layout.bits(), [&](auto& list) { visit(f, config, list); });
  std::uint32_t words[7];
  std::memcpy(words, packed.words(), sizeof words);
  EXPECT_EQ(words[0], 0x00000001u);  // attr[0]
  EXPECT_EQ(words[1], 0xFFFFFFFFu);  // attr[1]
  EXPECT_EQ(words[2], 0x7FFFFFFFu);  // attr[2]
  EXPECT_EQ(words[3], 0x80000000u);  // attr[3]
  EXPECT_EQ(words[4], 0x03000000u);  // flags from bit 25 on, depth
  EXPECT_EQ(words[5], 0xBC48D15Bu);  // quad from bit 26 on, x, y, front, flags bit 7
  EXPECT_EQ(words[6], 0x0002AF37u);  // the rest of quad
  Fragment again;
  visit(again, config, RecordUnpacker(packed));
  EXPECT_EQ(again, f);
  EXPECT_EQ(Record::from_words(words, layout.bits()), packed);
}

TEST(BitPacker, AgreesWithTheSlowWayOnRandomRecords) {
  golden::Prng random(11);
  for (int round = 0; round < 200; ++round) {
    Config config;
    config.set("viewport_bits", static_cast<int>(random.integer(6, 12)));
    config.set("subpixel_bits", static_cast<int>(random.integer(2, 8)));
    config.set("significand_bits", static_cast<int>(random.integer(8, 26)));
    config.set("attribute_slots", static_cast<int>(random.integer(1, 8)));
    config.set("tile_log2", static_cast<int>(random.integer(2, 4)));
    TileEntry tile;
    tile.slot = static_cast<std::uint32_t>(random.next());
    for (auto& v : tile.linear) v = static_cast<std::int64_t>(random.next());
    for (auto& q : tile.quadratic) q.value = q.gx = q.gy = q.q = static_cast<std::int64_t>(random.next());
    SlowPacker slow;
    visit(tile, config, slow);
    const RecordLayout layout = boundary_layout(Boundary::tile, config);
    ASSERT_EQ(static_cast<std::size_t>(layout.bits()), slow.bits.size());
    const Record packed = pack_record(layout.bits(), [&](auto& list) { visit(tile, config, list); });
    const std::vector<std::uint32_t> expected = slow.words();
    ASSERT_EQ(packed, Record::from_words(expected.data(), layout.bits())) << "round " << round;
    const RecordField& field = layout.field("quad_gx", 7);
    EXPECT_EQ(packed.get_signed(field), tile.quadratic[7].gx << (64 - field.width) >> (64 - field.width));
  }
}

TEST(Layout, FirstFieldIsTheMostSignificant) {
  const Config config;
  const RecordLayout layout = vertex_layout(config);
  EXPECT_EQ(layout.fields().front().name, "id");
  EXPECT_EQ(layout.fields().front().position, layout.bits() - config.quad_id_bits);
  // From the last one on: limits of 26 bits, bases of 25 and four times 32, then attributes of 28.
  EXPECT_EQ(layout.field("depth_high").position, 0);
  EXPECT_EQ(layout.field("depth_low").position, 26);
  EXPECT_EQ(layout.field("base_depth").position, 52);
  EXPECT_EQ(layout.field("base_attr", 0).position, 77);
  EXPECT_EQ(layout.field("base_attr", 3).position, 77 + 3 * 32);
  EXPECT_EQ(layout.field("attr_sig", 0).position, 205);
  EXPECT_EQ(layout.field("attr_neg", 0).position, 205 + 27);
  EXPECT_EQ(layout.field("attr_sig", 2).position, 205 + 2 * 28);
  EXPECT_THROW(layout.field("nonsense"), std::out_of_range);
}

TEST(Layout, NamesTheFirstDifference) {
  const Config config;
  const RecordLayout layout = boundary_layout(Boundary::norm, config);
  const Record a(layout.bits());
  EXPECT_EQ(first_different_field(layout, a, a), nullptr);
  for (const RecordField& field : layout.fields()) {
    Record b = a;
    b.set(field.position + field.width - 1, 1, 1);
    const RecordField* found = first_different_field(layout, a, b);
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->label(), field.label());
  }
}

// Bits of the default configuration, added up by hand by rtl/SPEC.md: VAL = QVAL = 63, GRAD = QGRAD =
// 48, QCURV = 32, LENGTH2 = 64, TC = 10, S = 18, EXP = 12, four slots.
TEST(Boundaries, HaveTheirBits) {
  const std::vector<std::pair<Boundary, int>> bits{{Boundary::setup, 3 + 4 * 10 + 6 + 6 * (63 + 48 + 48) + 6 * 64},
                                                   {Boundary::tile, 1 + 3 + 2 * 10 + 6 * 63 + 10 * (63 + 48 + 48 + 32)},
                                                   {Boundary::stamp, 1 + 4 + 3 + 3 * 8},
                                                   {Boundary::diff, 3 + 12 + 12 + 2 + 16 * 63},
                                                   {Boundary::norm, 4 + 12 * 31 + 4 * 30},
                                                   {Boundary::sqrt, 4 * 30},
                                                   {Boundary::ratio, 12 * 30},
                                                   {Boundary::weight, 4 * 30},
                                                   {Boundary::sum, 7 * 31},
                                                   {Boundary::fragment, 210}};
  for (const auto& [boundary, expected] : bits)
    EXPECT_EQ(boundary_layout(boundary, Config{}).bits(), expected) << boundary_name(boundary);
}

/// The descriptions for people have every bit of the layouts that the machines are compared by.
TEST(Boundaries, DescriptionsAreTheLayouts) {
  Config other;
  other.set("attribute_slots", 7);
  other.set("tile_log2", 2);
  for (const Config& c : {Config{}, other}) {
    const auto expect_layout = [](const BoundaryDescription& d, const RecordLayout& layout) {
      EXPECT_EQ(d.bits, layout.bits()) << d.name;
      int bits = 0;
      std::size_t fields = 0;
      for (const BoundaryField& f : d.fields) {
        bits += f.type.width * std::max(f.count, 1);
        fields += static_cast<std::size_t>(std::max(f.count, 1));
      }
      EXPECT_EQ(bits, layout.bits()) << d.name;
      EXPECT_EQ(fields, layout.fields().size()) << d.name;
    };
    const auto ports = describe_ports(c);
    ASSERT_EQ(ports.size(), 3u);
    expect_layout(ports[0], vertex_layout(c));
    expect_layout(ports[1], state_layout(c));
    expect_layout(ports[2], boundary_layout(Boundary::fragment, c));
    EXPECT_EQ(ports[2].fields.back().count, c.attribute_slots) << "an array is one entry";
    const auto probes = describe_probes(c);
    ASSERT_EQ(probes.size(), 9u);
    for (std::size_t i = 0; i < probes.size(); ++i) {
      EXPECT_EQ(probes[i].name, boundary_name(static_cast<Boundary>(i)));
      expect_layout(probes[i], boundary_layout(static_cast<Boundary>(i), c));
    }
  }
}

TEST(Hex, HasTheDigitsOfItsWidth) {
  EXPECT_EQ(hex(1, 1), "0x1");
  EXPECT_EQ(hex(0x2a, 18), "0x0002a");
  EXPECT_EQ(hex(~0ull, 64), "0xffffffffffffffff");
}

}  // namespace
}  // namespace quadrille
