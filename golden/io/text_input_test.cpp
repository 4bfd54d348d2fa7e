#include "golden/io/text_input.hpp"

#include "golden/io/camera.hpp"
#include "golden/io/config_file.hpp"
#include "golden/io/obj.hpp"
#include "golden/io/quads_file.hpp"
#include "golden/io/test_support.hpp"

#include <clocale>
#include <random>

namespace quadrille::golden {
namespace {

TEST(WideText, EveryReaderNamesIt) {
  using namespace std::string_literals;
  const auto wide = [](const std::string& narrow, bool little, std::size_t bytes) {
    std::string text;
    for (const char c : narrow) {
      const std::string zeros(bytes - 1, '\0');
      text += little ? c + zeros : zeros + c;
    }
    return text;
  };
  const auto refuses = [](const std::string& text, const char* encoding) {
    expect_input_error([&] { parse_obj(text, "m"); }, "m", {encoding, "UTF-8"});
    expect_input_error([&] { parse_quads(text, "m"); }, "m", {encoding});
    expect_input_error([&] { parse_camera(text, "m"); }, "m", {encoding});
    Config config;
    expect_input_error([&] { parse_config(text, "m", config); }, "m", {encoding});
  };
  const std::string face = "v 0 0 0\n";
  refuses("\xff\xfe" + wide(face, true, 2), "UTF-16");
  refuses("\xfe\xff" + wide(face, false, 2), "UTF-16");
  refuses(wide(face, true, 2), "UTF-16");
  refuses(wide(face, false, 2), "UTF-16");
  refuses("\xff\xfe\0\0"s + wide(face, true, 4), "UTF-32");
  refuses("\0\0\xfe\xff"s + wide(face, false, 4), "UTF-32");
  refuses(wide(face, true, 4), "UTF-32");
  for (const char* text : {"", "v", "\xc3\xbc", "\xef\xbb\xbf#"}) EXPECT_NO_THROW(refuse_wide_text(text, "m"));
}

TEST(Readable, BytesThatAreNoUtf8AreEscaped) {
  EXPECT_EQ(readable("caf\xe9.quads"), "caf\\xe9.quads");
  for (const char* good :
       {"", "plain", "caf\xc3\xa9", "\xe2\x82\xac", "\xf0\x9f\x98\x80", "\xef\xbf\xbf", "\xf4\x8f\xbf\xbf"}) {
    EXPECT_TRUE(is_utf8(good)) << good;
    EXPECT_EQ(readable(good), good);
  }
  // Cut short, overlong, surrogates, beyond U+10FFFF, lone continuation.
  for (const char* bad : {"\xc3", "\xe2\x82", "\xc0\x80", "\xe0\x80\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\x80",
                          "\xff", "\xf0\x8f\xbf\xbf"}) {
    EXPECT_FALSE(is_utf8(bad));
    EXPECT_TRUE(is_utf8(readable(bad))) << readable(bad);
  }
  EXPECT_EQ(readable("\xe2\x82x"), "\\xe2\\x82x");
}

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
    const int exponent = static_cast<int>(random() % 60) - 60, sign = random() % 2 == 0 ? 1 : -1;
    const double value = std::ldexp(static_cast<double>(random()) * sign, exponent);
    EXPECT_EQ(parse_number(number_text(value)).value, value);
  }
  EXPECT_EQ(parse_number(number_text(0x1p-1074)).value, 0x1p-1074);
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
