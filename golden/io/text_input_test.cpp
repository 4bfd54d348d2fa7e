#include "golden/io/text_input.hpp"

#include "golden/io/test_support.hpp"

#include <clocale>
#include <limits>
#include <random>

namespace quadrille::golden {
namespace {

TEST(ParseNumber, AcceptsDecimalNumbersOnly) {
  EXPECT_EQ(parse_number("1.5").value, 1.5);
  EXPECT_EQ(parse_number("+2e3").value, 2000);
  EXPECT_EQ(parse_number("-.5").value, -0.5);
  EXPECT_EQ(parse_number("7.").value, 7);
  EXPECT_EQ(parse_number("1208925819614629174706176").problem, "");  // 2^80
  for (const char* bad : {"", "+", "-", "+-1", "++1", "1,5", "1.5x", "0x10", "1e", "one", "1 ", "--1", "."}) {
    EXPECT_EQ(parse_number(bad).problem, "is not a number") << bad;
  }
  for (const char* bad : {"nan", "inf", "-inf", "NaN", "Infinity", "-nan"}) {
    EXPECT_EQ(parse_number(bad).problem, "is not finite") << bad;
  }
  EXPECT_EQ(parse_number("1e999").problem, "is outside the range of a double");
  EXPECT_EQ(parse_number("-1e25").problem, "has a magnitude above 2^80");
}

TEST(ParseNumber, ReadsBackWhatNumberTextWrites) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 10000; ++i) {
    const double value =
        std::ldexp(static_cast<double>(random()) * (random() % 2 == 0 ? 1 : -1), static_cast<int>(random() % 60) - 60);
    EXPECT_EQ(parse_number(number_text(value)).value, value);
  }
  EXPECT_EQ(parse_number(number_text(std::numeric_limits<double>::denorm_min())).value,
            std::numeric_limits<double>::denorm_min());
}

TEST(InQuotes, KeepsMessagesPrintable) {
  EXPECT_EQ(in_quotes("a\tb\xff"), R"("a\x09b\xff")");
  EXPECT_EQ(in_quotes(std::string(100, 'x')), "\"" + std::string(40, 'x') + "…\"");
}

TEST(TokenLines, KnowsPlacesCommentsAndLineEnds) {
  TokenLines lines("\xef\xbb\xbf a  b\r\n# c\n\rd#e\n f", TokenLines::Continuation::none);
  std::vector<Token> tokens;
  const auto expect = [&](std::size_t i, std::string_view text, std::size_t line, std::size_t column) {
    ASSERT_LT(i, tokens.size());
    EXPECT_EQ(tokens[i].text, text);
    EXPECT_EQ(tokens[i].line, line);
    EXPECT_EQ(tokens[i].column, column);
  };
  ASSERT_TRUE(lines.next(tokens));
  EXPECT_EQ(tokens.size(), 2u);
  expect(0, "a", 1, 2);
  expect(1, "b", 1, 5);
  ASSERT_TRUE(lines.next(tokens));
  expect(0, "d", 4, 1);
  ASSERT_TRUE(lines.next(tokens));
  expect(0, "f", 5, 2);
  EXPECT_FALSE(lines.next(tokens));
}

TEST(TokenLines, JoinsLinesAtABackslash) {
  TokenLines lines("a b\\\nc \\\r\nd\\e\\", TokenLines::Continuation::backslash);
  std::vector<Token> tokens;
  ASSERT_TRUE(lines.next(tokens));
  ASSERT_EQ(tokens.size(), 4u);
  EXPECT_EQ(tokens[2].text, "c");
  EXPECT_EQ(tokens[2].line, 2u);
  EXPECT_EQ(tokens[3].text, "d\\e\\");
  EXPECT_EQ(tokens[3].line, 3u);
  EXPECT_FALSE(lines.next(tokens));
}

TEST_F(InDirectory, ReadFileNamesPathAndReason) {
  expect_input_error([&] { read_file(path("absent"), "a thing"); }, path("absent"), {"No such file", "a thing"});
  expect_input_error([&] { read_file(path(""), "a thing"); }, path(""), {"Is a directory"});
}

}  // namespace
}  // namespace quadrille::golden
