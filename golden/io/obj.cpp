#include "golden/io/obj.hpp"

#include "golden/io/error.hpp"
#include "golden/io/text_input.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <span>
#include <vector>

namespace quadrille::golden {
namespace {

class ObjParser {
 public:
  explicit ObjParser(const std::string& name) : name_(name) {}

  Mesh parse(std::string_view text) {
    TokenLines lines(text, TokenLines::Continuation::backslash);
    std::vector<Token> tokens;
    for (;;) {
      if (const auto line = lines.line(); line && plain_line(*line))
        lines.skip_line();
      else if (lines.next(tokens))
        statement(tokens);
      else
        break;
    }
    if (mesh_.faces.empty()) {
      throw input_error(name_, 0, "no face was found; an OBJ file with at least one 'f' statement is expected");
    }
    if (const std::size_t coloured = mesh_.colours.size(); coloured != 0 && coloured != mesh_.positions.size()) {
      mesh_.notes.push_back(name_ + ": " + std::to_string(coloured) + " of " + std::to_string(mesh_.positions.size()) +
                            " vertices have a colour; none is used");
      mesh_.colours.clear();
    }
    return std::move(mesh_);
  }

 private:
  void statement(std::span<const Token> tokens) {
    const std::string_view keyword = tokens.front().text;
    if (keyword == "v") {
      numbers(tokens, {3, 4, 6, 7}, "3 coordinates, optionally a weight, optionally a colour of 3 numbers");
      mesh_.positions.push_back({values_[0], values_[1], values_[2]});
      if (const std::size_t n = values_.size(); n > 4)
        mesh_.colours.push_back({values_[n - 3], values_[n - 2], values_[n - 1]});
    } else if (keyword == "vt") {
      numbers(tokens, {1, 2, 3}, "1 to 3 coordinates");
      mesh_.texcoords.push_back({values_[0], values_.size() > 1 ? values_[1] : 0.0});
    } else if (keyword == "vn") {
      numbers(tokens, {3}, "3 coordinates");
      mesh_.normals.push_back({values_[0], values_[1], values_[2]});
    } else if (keyword == "f") {
      face(tokens);
    } else {
      ++mesh_.skipped_lines;
      note_swallowed(tokens);
    }
  }

  /// Takes a line as programs write nearly all of them, three numbers or a face of positive indices with nothing else,
  /// in a fifth of the time. False, and nothing taken: what is there is for statement().
  bool plain_line(std::string_view line) {
    if (line.ends_with('\r')) line.remove_suffix(1);
    const auto is = [&](std::string_view keyword) { return line.starts_with(keyword); };
    const char* const end = line.data() + line.size();
    if (is("f ")) return plain_face(line.data() + 2, end);
    Vec3 value;
    if (is("v ") && plain_numbers(line.data() + 2, end, value)) {
      mesh_.positions.push_back(value);
    } else if (is("vn ") && plain_numbers(line.data() + 3, end, value)) {
      mesh_.normals.push_back(value);
    } else if (Vec2 uv; is("vt ") && plain_numbers(line.data() + 3, end, uv)) {
      mesh_.texcoords.push_back(uv);
    } else {
      return false;
    }
    return true;
  }

  template <class Values>
  static bool plain_numbers(const char* at, const char* end, Values& values) {
    for (double& value : values) {
      while (at != end && *at == ' ') ++at;
      const auto [rest, error] = std::from_chars(at, end, value, std::chars_format::general);
      if (error != std::errc() || !(std::abs(value) <= max_input_magnitude)) return false;
      if (rest != end && *rest != ' ') return false;
      at = rest;
    }
    return std::all_of(at, end, [](char c) { return c == ' '; });
  }

  bool plain_face(const char* at, const char* end) {
    constexpr auto most_elements = static_cast<std::size_t>(std::numeric_limits<int>::max());
    std::array<Corner, 8> corners;
    std::size_t count = 0;
    const auto index = [&](std::size_t defined, int& out) {
      std::size_t number = 0;
      const auto [rest, error] = std::from_chars(at, end, number);
      at = rest;
      if (error != std::errc() || number == 0 || number > defined || number > most_elements) return false;
      out = static_cast<int>(number - 1);
      return true;
    };
    for (;;) {
      while (at != end && *at == ' ') ++at;
      if (at == end) break;
      if (count == corners.size()) return false;
      Corner& corner = corners[count++];
      if (!index(mesh_.positions.size(), corner.position)) return false;
      if (at != end && *at == '/') {
        if (++at == end) return false;
        if (*at != '/' && !index(mesh_.texcoords.size(), corner.texcoord)) return false;
        if (at != end && *at == '/') {
          ++at;
          if (!index(mesh_.normals.size(), corner.normal)) return false;
        }
      }
      if ((corner.texcoord < 0) != (corners[0].texcoord < 0) || (corner.normal < 0) != (corners[0].normal < 0))
        return false;
    }
    if (count < 3) return false;
    mesh_.faces.emplace_back(corners.begin(), corners.begin() + count);
    return true;
  }

  /// A backslash at the end of a name, such as that of a folder, joins the next line to a statement that is skipped.
  void note_swallowed(std::span<const Token> tokens) {
    for (std::size_t i = 1; i < tokens.size(); ++i) {
      const Token& token = tokens[i];
      if (token.line == tokens[i - 1].line || !is_read(token.text)) continue;
      mesh_.notes.push_back("line " + std::to_string(token.line) + ", '" + std::string(token.text) +
                            "', is not read: the backslash that ends line " + std::to_string(tokens[i - 1].line) +
                            " joins it to '" + printable(tokens.front().text) + "'");
    }
  }

  static bool is_read(std::string_view keyword) {
    return keyword == "v" || keyword == "vt" || keyword == "vn" || keyword == "f";
  }

  /// The statement's arguments into values_.
  void numbers(std::span<const Token> tokens, std::initializer_list<std::size_t> counts, const char* expected) {
    const std::string keyword(tokens.front().text);
    values_.clear();
    for (std::size_t i = 1; i < tokens.size(); ++i) {
      const Number number = parse_number(tokens[i].text);
      if (!number.problem.empty()) {
        throw input_error(name_, tokens[i].line,
                          "'" + keyword + "' number " + std::to_string(i) + " is " + in_quotes(tokens[i].text) +
                              ", which " + std::string(number.problem) +
                              "; a finite decimal number such as -1.5e-3 is expected");
      }
      values_.push_back(number.value);
    }
    for (const std::size_t count : counts) {
      if (count == values_.size()) return;
    }
    throw input_error(name_, tokens.front().line,
                      "'" + keyword + "' has " + std::to_string(values_.size()) + " numbers; it takes " + expected);
  }

  void face(std::span<const Token> tokens) {
    if (tokens.size() < 4) {
      throw input_error(name_, tokens.front().line,
                        "face has " + std::to_string(tokens.size() - 1) + " corners; at least 3 are needed");
    }
    Face face;
    face.reserve(tokens.size() - 1);
    for (std::size_t i = 1; i < tokens.size(); ++i) {
      const Corner corner = parse_corner(tokens[i], i);
      if (i > 1 && ((corner.texcoord < 0) != (face[0].texcoord < 0) || (corner.normal < 0) != (face[0].normal < 0))) {
        throw input_error(name_, tokens[i].line,
                          place(tokens[i], i) + " has another form than corner 1, " + in_quotes(tokens[1].text) +
                              "; all corners of a face must give the same indices");
      }
      face.push_back(corner);
    }
    mesh_.faces.push_back(std::move(face));
  }

  Corner parse_corner(const Token& token, std::size_t number) const {
    // Fields between slashes: position, texture coordinate, normal.
    std::vector<std::string_view> fields;
    for (std::string_view rest = token.text;;) {
      const std::size_t slash = rest.find('/');
      fields.push_back(rest.substr(0, slash));
      if (slash == std::string_view::npos) break;
      rest.remove_prefix(slash + 1);
    }
    const bool known_form = fields.size() <= 3 && !fields.front().empty() && !fields.back().empty();
    if (!known_form) {
      throw input_error(name_, token.line, place(token, number) + "; the forms a, a/b, a//c and a/b/c are known");
    }
    Corner corner;
    corner.position = index(fields[0], mesh_.positions.size(), "position", token, number);
    if (fields.size() > 1 && !fields[1].empty()) {
      corner.texcoord = index(fields[1], mesh_.texcoords.size(), "texture coordinate", token, number);
    }
    if (fields.size() > 2) corner.normal = index(fields[2], mesh_.normals.size(), "normal", token, number);
    return corner;
  }

  /// 0-based index of an element defined so far.
  int index(std::string_view field, std::size_t defined, const std::string& kind, const Token& token,
            std::size_t number) const {
    const auto failure = [&](const std::string& problem) {
      const std::string n = std::to_string(defined);
      const std::string range = defined == 0 ? "none is defined before this line"
                                             : "before this line 1 to " + n + " (or -" + n + " to -1) are defined";
      return input_error(
          name_, token.line,
          place(token, number) + ": " + kind + " index " + in_quotes(field) + " " + problem + "; " + range);
    };
    long long value = 0;
    // from_chars knows no '+', which printf("%+d") writes; "+-1" must stay an error.
    const std::string_view digits = field.size() > 1 && field[0] == '+' && field[1] != '-' ? field.substr(1) : field;
    const char* const end = digits.data() + digits.size();
    const auto [rest, error] = std::from_chars(digits.data(), end, value);
    if (error == std::errc::result_out_of_range && rest == end) throw failure("is out of range");
    if (error != std::errc() || rest != end) throw failure("is not an integer");
    if (value == 0) throw failure("is 0, and indices start at 1");
    const auto count = static_cast<long long>(defined);
    const long long absolute = value > 0 ? value - 1 : count + value;
    if (absolute < 0 || absolute >= count || absolute > std::numeric_limits<int>::max())
      throw failure("is out of range");
    return static_cast<int>(absolute);
  }

  static std::string place(const Token& token, std::size_t number) {
    return "face corner " + std::to_string(number) + " is " + in_quotes(token.text);
  }

  const std::string& name_;
  Mesh mesh_;
  std::vector<double> values_;
};

}  // namespace

Mesh load_obj(const std::string& path) { return parse_obj(read_file(path, "an OBJ mesh"), path); }

Mesh parse_obj(std::string_view text, const std::string& name) {
  refuse_wide_text(text, name);
  return ObjParser(name).parse(text);
}

}  // namespace quadrille::golden
