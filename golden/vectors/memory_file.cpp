#include "golden/vectors/memory_file.hpp"

#include "golden/io/error.hpp"
#include "golden/io/text_input.hpp"
#include "model/port/record.hpp"

#include <algorithm>
#include <charconv>

namespace quadrille::vectors {
namespace {

class MemoryParser {
 public:
  MemoryParser(std::string_view text, const std::string& name, int bits) : rest_(text), name_(name), bits_(bits) {}

  MemoryFile parse() {
    golden::refuse_wide_text(rest_, name_);
    while (!rest_.empty()) {
      if (is_blank(rest_.front()))
        skip(1);
      else if (rest_.starts_with("//"))
        skip(std::min(rest_.find_first_of("\r\n"), rest_.size()));
      else if (rest_.starts_with("/*"))
        skip_comment();
      else
        take_word();
    }
    return std::move(file_);
  }

 private:
  static bool is_blank(char c) { return std::string_view(" \t\r\n\v\f").find(c) != std::string_view::npos; }

  /// Counts the line ends: LF, CRLF or CR.
  void skip(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i)
      line_ += rest_[i] == '\n' || (rest_[i] == '\r' && !rest_.substr(i + 1).starts_with('\n'));
    rest_.remove_prefix(count);
  }

  void skip_comment() {
    const std::size_t end = rest_.find("*/", 2);
    if (end == std::string_view::npos) fail("the comment is not closed");
    skip(end + 2);
  }

  void take_word() {
    std::size_t size = 0;
    while (size < rest_.size() && !is_blank(rest_[size]) && rest_[size] != '/') ++size;
    const std::string_view given = rest_.substr(0, std::max<std::size_t>(size, 1));
    if (given.front() == '@')
      check_address(given.substr(1));
    else
      add_record(given);
    rest_.remove_prefix(given.size());
  }

  void check_address(std::string_view digits) const {
    std::uint64_t address = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), address, 16);
    if (error != std::errc{} || end != digits.data() + digits.size())
      fail("the address " + golden::in_quotes(digits) + " is not hexadecimal");
    if (address != file_.lines)
      fail("the address is " + std::to_string(address) + "; the next record is number " + std::to_string(file_.lines) +
           " (records are in order, without gaps)");
  }

  void add_record(std::string_view given) {
    std::string digits;
    for (const char c : given) {
      if (c == '_' && !digits.empty()) continue;
      digits += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    if (const std::size_t at = digits.find_first_of("xz?"); at != std::string::npos)
      fail("column " + std::to_string(at + 1) + " is an unknown digit, " + golden::in_quotes(digits.substr(at, 1)) +
           "; every bit of a record must be driven");
    try {
      file_.records += Record::from_hex(digits, bits_).to_hex() + "\n";
    } catch (const HexError& error) {
      fail(error.what());
    }
    ++file_.lines;
  }

  [[noreturn]] void fail(const std::string& what) const { throw golden::input_error(name_, line_, what); }

  std::string_view rest_;
  const std::string& name_;
  int bits_;
  std::size_t line_ = 1;
  MemoryFile file_;
};

}  // namespace

MemoryFile read_memory_file(std::string_view text, const std::string& name, int bits) {
  return MemoryParser(text, name, bits).parse();
}

}  // namespace quadrille::vectors
