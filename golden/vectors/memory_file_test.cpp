// What simulators write, and what must not pass for it.
#include "golden/vectors/memory_file.hpp"

#include "golden/io/error.hpp"

#include <gtest/gtest.h>

#include <string>

namespace quadrille::vectors {
namespace {

constexpr int bits = 30;  // eight digits, the first of two bits

std::string records(const std::string& text) { return read_memory_file(text, "f.hex", bits).records; }

TEST(MemoryFile, WhatSimulatorsWrite) {
  const std::string expected = "00000abc\n3f001234\n0000000f\n";
  EXPECT_EQ(records(expected), expected);
  // Icarus 11: an address as a comment every few words; others: @ addresses, capitals, `_` at every fourth digit.
  EXPECT_EQ(records("// 0x00000000\n00000abc\n3f001234\n0000000f\n"), expected);
  EXPECT_EQ(records("@0\r\n0000_0ABC\r\n3F00_1234 \t\r\n@2\r\n0000000F"), expected);
  EXPECT_EQ(records("/* head\n of two lines */ 00000abc 3f001234//end\r0000000f/**/"), expected);
  EXPECT_EQ(records("@00000000 00000abc @1\n3f001234\n@0002\n0000000f\n\n\n"), expected);
  const MemoryFile file = read_memory_file(expected, "f.hex", bits);
  EXPECT_EQ(file.lines, 3u);
  EXPECT_EQ(read_memory_file("// nothing\n", "f.hex", bits).lines, 0u);
}

TEST(MemoryFile, WhatIsWrongHasItsLine) {
  const auto refused = [](const std::string& text, const std::string& line, const std::string& what) {
    try {
      records(text);
      ADD_FAILURE() << "read: " << text;
    } catch (const golden::InputError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.rfind("f.hex:" + line + ": ", 0), 0u) << message;
      EXPECT_NE(message.find(what), std::string::npos) << message;
    }
  };
  refused("00000abc\n0000abc\n", "2", "has 7 characters");
  refused("00000abc\r\n\r\n000000abc\r\n", "3", "has 9 characters");
  refused("/*\n\n*/\n0000xabc\n", "4", "column 5 is an unknown digit, \"x\"");
  refused("Z0000000", "1", "unknown digit, \"z\"");
  refused("00000abg", "1", "column 8");
  refused("40000000", "1", "bit set above bit 29");
  refused("_0000abc0", "1", "has 9 characters");
  refused("00000abc\n@3\n00000abc\n", "2", "the address is 3; the next record is number 1");
  refused("00000abc\n@0\n", "2", "the address is 0");
  refused("@x\n", "1", "is not hexadecimal");
  refused("00000abc / 3f001234\n", "1", "has 1 characters");
  refused("00000abc\n/* open", "2", "not closed");
}

}  // namespace
}  // namespace quadrille::vectors
