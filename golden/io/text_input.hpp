// What the text readers share: whole files, tokens that know their place, strict numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::golden {

/// Largest magnitude accepted from a text file: products of a vertex, a camera and a viewport stay far inside double.
inline constexpr double max_input_magnitude = 0x1p80;

/// Largest file that is read.
inline constexpr std::uint64_t max_file_bytes = std::uint64_t{2} << 30;

/// The bytes of a file, or of a pipe that has a writer (/dev/stdin). Throws InputError naming the path and the reason:
/// the system's, more than max_file_bytes, a device, a pipe with a name, which may have no writer. `what` says what was
/// expected there.
std::string read_file(const std::string& path, std::string_view what);

/// Throws InputError for text of two or four bytes a character, as some editors save it: by its byte order mark, or by
/// a zero byte among its first two. `name` stands for the file.
void refuse_wide_text(std::string_view text, const std::string& name);

/// The token in double quotes, for messages: control and non-ASCII bytes as \xNN, long ones shortened.
std::string in_quotes(std::string_view token);

/// The text with control and non-ASCII bytes replaced by '?', for messages of libraries that may quote the file.
std::string printable(std::string_view text);

/// The text with each byte that is no part of valid UTF-8 as \\xNN, for reports: JSON knows no other bytes.
std::string readable(std::string_view text);

/// Whether all of it is UTF-8.
bool is_utf8(std::string_view text);

/// 1-based line number of a byte offset.
std::size_t line_at(std::string_view text, std::size_t offset);

/// Shortest decimal text that reads back as the same double.
std::string number_text(double value);

struct Number {
  double value = 0;
  std::string_view problem;  ///< empty if all of the token is a finite number of magnitude ≤ max_input_magnitude
};

/// Parses a decimal number; independent of the locale; a leading '+' is allowed, hexadecimal is not.
Number parse_number(std::string_view token);

struct Token {
  std::string_view text;
  std::size_t line = 0, column = 0;  ///< 1-based, column in bytes
};

/// Splits a text into lines of tokens separated by blanks. '#' starts a comment that ends with the line; a line ends
/// with LF, CRLF or CR; a UTF-8 byte order mark at the start is skipped. The text must outlive the tokens.
class TokenLines {
 public:
  enum class Continuation { none, backslash };  ///< backslash: one directly before a line's end joins the next line

  TokenLines(std::string_view text, Continuation continuation);

  /// Replaces `tokens` by those of the next line that has any; false at the end of the text.
  bool next(std::vector<Token>& tokens);
  /// The line that next() would begin with, without its LF; nothing where it does not end with one.
  std::optional<std::string_view> line();
  /// Passes over line().
  void skip_line();

 private:
  std::size_t line_end_size() const;  ///< bytes of the line end at pos_, 0 if there is none

  std::string_view text_;
  Continuation continuation_;
  std::size_t pos_ = 0, line_ = 1, line_start_ = 0;
  std::optional<std::size_t> line_feed_;  ///< the next one as line() saw it
};

}  // namespace quadrille::golden
