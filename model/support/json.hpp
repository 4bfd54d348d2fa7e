// Writes one JSON object as text, for what links no JSON library: golden/explain, model/page.
#pragma once

#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

namespace quadrille {

class Json {
 public:
  Json& raw(std::string_view key, std::string_view value) {
    text_ += (text_.empty() ? "{" : ", ") + quoted(key) + ": " + std::string(value);
    return *this;
  }
  Json& put(std::string_view key, std::string_view value) { return raw(key, quoted(value)); }
  Json& put(std::string_view key, const char* value) { return raw(key, quoted(value)); }
  Json& put(std::string_view key, const std::string& value) { return raw(key, quoted(value)); }
  Json& put(std::string_view key, bool value) { return raw(key, value ? "true" : "false"); }
  template <class Number>
  Json& put(std::string_view key, Number value) {
    return raw(key, number(static_cast<double>(value)));
  }
  std::string text() const { return text_.empty() ? "{}" : text_ + "}"; }

  /// null where it is not finite.
  static std::string number(double value) {
    if (!std::isfinite(value)) return "null";
    char buffer[32];
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
  }
  template <class Values, class Text>
  static std::string list(const Values& values, Text&& text) {
    std::string out = "[";
    for (const auto& value : values) out += (out.size() > 1 ? ", " : "") + text(value);
    return out + "]";
  }
  template <class Values>
  static std::string numbers(const Values& values) {
    return list(values, [](double v) { return number(v); });
  }
  static std::string quoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
      if (c == '"' || c == '\\') out += '\\';
      if (static_cast<unsigned char>(c) < 32)
        out += "\\u00" + std::string(1, "01"[c >> 4]) + "0123456789abcdef"[c & 15];
      else
        out += c;
    }
    return out + "\"";
  }

 private:
  std::string text_;
};

}  // namespace quadrille
