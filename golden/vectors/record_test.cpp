// Records as bits and as digits; SHA-256 by the examples of FIPS 180.
#include "model/port/record.hpp"
#include "golden/io/test_support.hpp"
#include "golden/vectors/sha256.hpp"
#include "model/support/prng.hpp"

namespace {

using namespace quadrille;
using namespace quadrille::vectors;

TEST(RecordLayout, FieldsLieFromTheMostSignificantBitDown) {
  RecordLayout layout;
  layout.add({.name = "a", .width = 3});
  layout.add_array({.name = "b", .width = 10, .is_signed = true}, 3);
  layout.add({.name = "c", .width = 64});
  EXPECT_EQ(layout.bits(), 97);
  EXPECT_EQ(layout.digits(), 25u);
  EXPECT_EQ(layout.field("a").position, 94);
  EXPECT_EQ(layout.field("b", 2).position, 84);
  EXPECT_EQ(layout.field("b", 1).position, 74);
  EXPECT_EQ(layout.field("b", 0).position, 64);
  EXPECT_EQ(layout.field("c").position, 0);
  EXPECT_EQ(layout.field("b", 1).label(), "b[1]");
  EXPECT_THROW(layout.field("b"), std::out_of_range);
  EXPECT_THROW(layout.add({.name = "d", .width = 65}), std::invalid_argument);
  EXPECT_THROW(layout.add({.name = "d", .width = 0}), std::invalid_argument);
}

TEST(Record, DigitsByHand) {
  // 1 | -2 in 4 bits | 0x5a in 8 bits = 1 1110 01011010 = 0x1e5a
  RecordLayout layout;
  layout.add({.name = "flag", .width = 1});
  layout.add({.name = "n", .width = 4, .is_signed = true});
  layout.add({.name = "m", .width = 8, .fraction_bits = 4});
  Record record(layout.bits());
  record.set(layout.field("flag"), 1);
  record.set(layout.field("n"), static_cast<std::uint64_t>(-2));
  record.set(layout.field("m"), 0x5a);
  EXPECT_EQ(record.to_hex(), "1e5a");
  EXPECT_EQ(Record::from_hex("1e5a", 13), record);
  EXPECT_EQ(record.get_signed(layout.field("n")), -2);
  EXPECT_EQ(record.get(layout.field("n")), 14u);
  EXPECT_EQ(describe(record, layout.field("n")), "0xe (-2)");
  EXPECT_EQ(describe(record, layout.field("m")), "0x5a (90 = 5.625)");
  Record other = record;
  other.set(layout.field("n"), 3);
  EXPECT_EQ(first_difference(layout, record, other), "n: expected 0xe (-2), actual 0x3 (3)");
  EXPECT_EQ(first_difference(layout, record, record), "");
}

TEST(Record, RandomFieldsReadBackAndKeepTheirNeighbours) {
  golden::Prng prng(1);
  for (int round = 0; round < 300; ++round) {
    const int bits = static_cast<int>(prng.integer(64, 400));
    Record record(bits);
    std::vector<bool> plain(static_cast<std::size_t>(bits));  // the same record, bit by bit
    for (int write = 0; write < 40; ++write) {
      const int width = static_cast<int>(prng.integer(1, 64));
      const int position = static_cast<int>(prng.integer(0, bits - width));
      const std::uint64_t value = prng.next();
      record.set(position, width, value);
      for (int i = 0; i < width; ++i) plain[static_cast<std::size_t>(position + i)] = value >> i & 1;
      ASSERT_EQ(record.get(position, width), width == 64 ? value : value & ((std::uint64_t{1} << width) - 1));
    }
    for (int i = 0; i < bits; ++i) ASSERT_EQ(record.get(i, 1), plain[static_cast<std::size_t>(i)] ? 1u : 0u);
    ASSERT_EQ(Record::from_hex(record.to_hex(), bits), record);
    ASSERT_EQ(record.to_hex().size(), static_cast<std::size_t>((bits + 3) / 4));
  }
}

TEST(Record, WrongDigitsAreRefused) {
  const auto message = [](std::string_view digits, int bits) {
    try {
      Record::from_hex(digits, bits);
    } catch (const HexError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message("0fff", 13), "");
  EXPECT_EQ(message("fff", 13), "has 3 characters; a record of 13 bits has 4 digits");
  EXPECT_EQ(message("00fff", 13), "has 5 characters; a record of 13 bits has 4 digits");
  EXPECT_EQ(message("0fFf", 13), "column 3 is not a lower-case hexadecimal digit");
  EXPECT_EQ(message("0x1f", 13), "column 2 is not a lower-case hexadecimal digit");
  EXPECT_EQ(message("2000", 13), "has a bit set above bit 12");
  EXPECT_EQ(message("10000000000000000", 65), "");
  EXPECT_EQ(message("20000000000000000", 65), "has a bit set above bit 64");
}

// FIPS 180-2 appendix B and the usual test of a million a.
TEST(Sha256, KnownAnswers) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  Sha256 pieces;
  for (int i = 0; i < 1000; ++i) pieces.update(std::string(1000, 'a'));
  EXPECT_EQ(pieces.finish(), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

class Sha256File : public golden::InDirectory {};

TEST_F(Sha256File, DigestOfAFile) {
  const FileDigest digest = digest_file(write("abc", "abc"));
  EXPECT_EQ(digest.sha256, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(digest.bytes, 3u);
  golden::expect_input_error([&] { digest_file(path("none")); }, path("none"), {"cannot be read"});
}

}  // namespace
