#include "golden/io/text_input.hpp"

#include "golden/io/error.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>

namespace quadrille::golden {
namespace {

/// Bytes of the UTF-8 character at the start; 0: none is there (the table of well-formed sequences of Unicode).
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xc2 && first <= 0xdf   ? 2
                             : (first & 0xf0u) == 0xe0        ? 3
                             : first >= 0xf0 && first <= 0xf4 ? 4
                                                              : 0;
  if (length == 0 || length > text.size()) return 0;
  const unsigned low = first == 0xe0 ? 0xa0 : first == 0xf0 ? 0x90 : 0x80;
  const unsigned high = first == 0xed ? 0x9f : first == 0xf4 ? 0x8f : 0xbf;
  if (byte(1) < low || byte(1) > high) return 0;
  for (std::size_t i = 2; i < length; ++i)
    if ((byte(i) & 0xc0u) != 0x80) return 0;
  return length;
}

struct Descriptor {
  int fd;
  ~Descriptor() {
    if (fd >= 0) ::close(fd);
  }
};

}  // namespace

std::string read_file(const std::string& path, std::string_view what) {
  const auto failure = [&](const std::string& reason) {
    return InputError(path + ": cannot be read: " + reason + "; " + std::string(what) + " is expected here");
  };
  // A named pipe may wait for its writer for ever. One without a name (/dev/stdin, <(command)) has its writer already.
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(path, error);
  if (!error && std::filesystem::is_fifo(std::filesystem::symlink_status(real, error)))
    throw failure("it is a named pipe (use `cat " + path + " |` with /dev/stdin)");
  // Not blocking: a device may wait as well.
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  struct stat status {};
  if (file.fd < 0 || ::fstat(file.fd, &status) != 0) throw failure(std::strerror(errno));
  if (S_ISDIR(status.st_mode)) throw failure(std::strerror(EISDIR));
  if (!S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode) && !S_ISSOCK(status.st_mode))
    throw failure("it is a device; a file or a pipe is read");
  std::string bytes;
  std::array<char, 1 << 16> block;
  for (;;) {
    if (bytes.size() > max_file_bytes)
      throw failure("it has more than " + std::to_string(max_file_bytes >> 20) + " MiB");
    const ssize_t got = ::read(file.fd, block.data(), block.size());
    if (got < 0 && errno == EAGAIN) {
      pollfd ready{file.fd, POLLIN, 0};
      ::poll(&ready, 1, -1);
    } else if (got < 0 && errno != EINTR) {
      throw failure(std::strerror(errno));
    } else if (got == 0) {
      return bytes;
    } else if (got > 0) {
      bytes.append(block.data(), static_cast<std::size_t>(got));
    }
  }
}

void refuse_wide_text(std::string_view text, const std::string& name) {
  using namespace std::string_view_literals;
  const bool marked = text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff");
  if (!marked && text.substr(0, 2).find('\0') == std::string_view::npos) return;
  const bool four = text.starts_with("\xff\xfe\0\0"sv) || text.starts_with("\0\0"sv) || text.substr(1, 3) == "\0\0\0"sv;
  throw InputError(name + ": is text in " + (four ? "UTF-32" : "UTF-16") +
                   "; save it as UTF-8 or ASCII, such as with iconv -f " + (four ? "UTF-32" : "UTF-16") + " -t UTF-8");
}

std::string in_quotes(std::string_view token) {
  constexpr std::size_t longest = 40;
  constexpr std::string_view hex = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : token.substr(0, longest)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7f) {
      out += c;
    } else {
      out += "\\x";
      out += hex[byte >> 4];
      out += hex[byte & 15];
    }
  }
  return out + (token.size() > longest ? "…\"" : "\"");
}

std::string printable(std::string_view text) {
  std::string out;
  for (const char c : text) out += c >= 0x20 && c < 0x7f ? c : '?';
  return out;
}

std::string readable(std::string_view text) {
  constexpr std::string_view hex = "0123456789abcdef";
  std::string out;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const auto byte = static_cast<unsigned char>(text.front());
    if (length > 0)
      out += text.substr(0, length);
    else
      (out += "\\x") += {hex[byte >> 4], hex[byte & 15]};
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return out;
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

std::size_t line_at(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  return 1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
}

std::string number_text(double value) {
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

Number parse_number(std::string_view token) {
  // from_chars knows no '+', although printf("%+g") writes it; "+-1" must stay an error.
  if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);
  Number number;
  const char* const end = token.data() + token.size();
  const auto [rest, error] = std::from_chars(token.data(), end, number.value, std::chars_format::general);
  if (error == std::errc::invalid_argument || rest != end) {
    number.problem = "is not a number";
  } else if (error == std::errc::result_out_of_range) {
    number.problem = "is outside the range of a double";
  } else if (!std::isfinite(number.value)) {
    number.problem = "is not finite";
  } else if (std::abs(number.value) > max_input_magnitude) {
    number.problem = "has a magnitude above 2^80";
  }
  return number;
}

TokenLines::TokenLines(std::string_view text, Continuation continuation) : text_(text), continuation_(continuation) {
  if (text_.starts_with("\xef\xbb\xbf")) text_.remove_prefix(3);
}

std::size_t TokenLines::line_end_size() const {
  if (pos_ >= text_.size()) return 0;
  if (text_[pos_] == '\n') return 1;
  if (text_[pos_] != '\r') return 0;
  return pos_ + 1 < text_.size() && text_[pos_ + 1] == '\n' ? 2 : 1;
}

std::optional<std::string_view> TokenLines::line() {
  if (!line_feed_ || *line_feed_ < pos_) line_feed_ = text_.find('\n', pos_);
  if (*line_feed_ == std::string_view::npos) return std::nullopt;
  return text_.substr(pos_, *line_feed_ - pos_);
}

void TokenLines::skip_line() {
  pos_ = line_start_ = *line_feed_ + 1;
  ++line_;
}

bool TokenLines::next(std::vector<Token>& tokens) {
  tokens.clear();
  const auto start_line = [&](std::size_t end_size) {
    pos_ += end_size;
    ++line_;
    line_start_ = pos_;
  };
  // Size of a backslash and the line end that it hides, 0 if there is none.
  const auto joint_size = [&]() -> std::size_t {
    if (continuation_ == Continuation::none || text_[pos_] != '\\') return 0;
    ++pos_;
    const std::size_t end_size = line_end_size();
    --pos_;
    return end_size == 0 ? 0 : end_size + 1;
  };
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; };

  while (pos_ < text_.size()) {
    if (const std::size_t end_size = line_end_size()) {
      start_line(end_size);
      if (!tokens.empty()) return true;
    } else if (text_[pos_] == '#') {
      pos_ = std::min(text_.find_first_of("\r\n", pos_), text_.size());
    } else if (is_blank(text_[pos_])) {
      ++pos_;
    } else if (const std::size_t joint = joint_size()) {
      start_line(joint);
    } else {
      const std::size_t begin = pos_;
      while (pos_ < text_.size() && !is_blank(text_[pos_]) && text_[pos_] != '#' && line_end_size() == 0 &&
             joint_size() == 0) {
        ++pos_;
      }
      tokens.push_back({text_.substr(begin, pos_ - begin), line_, begin - line_start_ + 1});
    }
  }
  return !tokens.empty();
}

}  // namespace quadrille::golden
