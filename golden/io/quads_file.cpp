#include "golden/io/quads_file.hpp"

#include "golden/io/atomic_file.hpp"
#include "golden/io/error.hpp"
#include "golden/io/text_input.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <set>

namespace quadrille::golden {
namespace {

constexpr std::size_t position_fields = 16;

/// Name of the 0-based field, such as v1.w or v2.a0.
std::string field_name(std::size_t index, std::size_t attributes) {
  if (index < position_fields) return "v" + std::to_string(index / 4) + "." + "xyzw"[index % 4];
  const std::size_t rest = index - position_fields;
  if (attributes == 0) return "beyond the last";
  return "v" + std::to_string(rest / attributes) + ".a" + std::to_string(rest % attributes);
}

/// What is wrong with names for that many attributes; empty: nothing.
std::string problem_of_names(std::span<const std::string> names, std::size_t attributes) {
  if (names.size() != attributes)
    return std::to_string(names.size()) + " names for " + std::to_string(attributes) +
           " attributes; a name for each is expected";
  std::set<std::string_view> taken{"quad",  "x",          "y",  "z",  "front", "flags",
                                   "depth", "depth_code", "l0", "l1", "l2",    "l3"};
  for (const std::string& name : names) {
    const bool word = std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
    if (!word || name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) || name.ends_with("_code") ||
        !taken.insert(name).second)
      return "the name " + in_quotes(name) + "; letters, digits and _ are expected, no name twice, and none of " +
             "quad x y z front flags depth l0 l1 l2 l3 …_code";
  }
  return {};
}

constexpr std::string_view names_mark = "attributes:";

class QuadsParser {
 public:
  explicit QuadsParser(const std::string& name) : name_(name) {}

  std::vector<WindowQuad> parse(std::string_view text, std::vector<std::string>* names) {
    TokenLines lines(text, TokenLines::Continuation::none);
    std::vector<Token> tokens;
    std::vector<WindowQuad> quads;
    while (lines.next(tokens)) {
      check_count(tokens);
      quads.push_back(quad(tokens));
      quads.back().id = static_cast<std::uint32_t>(quads.size() - 1);
    }
    if (quads.empty())
      throw input_error(name_, 0, "no quad was found; a line of 16 or more numbers per quad is expected");
    if (std::vector<std::string> found = named(text); names != nullptr) *names = std::move(found);
    return quads;
  }

 private:
  /// The names in a comment before the first quad.
  std::vector<std::string> named(std::string_view text) const {
    std::vector<std::string> names;
    for (std::size_t line = 1; line < first_line_; ++line) {
      const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
      const std::string_view comment = text.substr(0, end);
      text.remove_prefix(std::min(text.size(), end + (text.substr(end).starts_with("\r\n") ? 2 : 1)));
      const std::size_t mark = comment.find_first_not_of("# \t\xef\xbb\xbf");
      if (mark == std::string_view::npos || !comment.substr(mark).starts_with(names_mark)) continue;
      const std::string words(comment.substr(mark + names_mark.size()));
      TokenLines lines(words, TokenLines::Continuation::none);
      std::vector<Token> tokens;
      lines.next(tokens);
      for (const Token& token : tokens) names.emplace_back(token.text);
      if (const std::string problem = problem_of_names(names, attributes_); !problem.empty())
        throw input_error(name_, line, "\"" + std::string(names_mark) + "\" has " + problem);
      break;
    }
    return names;
  }

  void check_count(std::span<const Token> tokens) {
    const std::size_t count = tokens.size();
    const std::size_t line = tokens.front().line;
    const auto failure = [&](const std::string& expected) {
      return input_error(name_, line,
                         "the line has " + std::to_string(count) + " fields, the last in column " +
                             std::to_string(tokens.back().column) + "; " + expected);
    };
    if (count < position_fields || (count - position_fields) % 4 != 0) {
      throw failure(
          "16 numbers (x y z w of four vertices) and the same number of attributes for each vertex are expected");
    }
    const std::size_t attributes = (count - position_fields) / 4;
    if (attributes > max_attribute_slots) {
      throw failure("that is " + std::to_string(attributes) + " attributes per vertex, and at most " +
                    std::to_string(max_attribute_slots) + " are possible");
    }
    if (first_line_ == 0) {
      first_line_ = line;
      attributes_ = attributes;
    } else if (attributes != attributes_) {
      throw failure("line " + std::to_string(first_line_) + " has " +
                    std::to_string(position_fields + 4 * attributes_) + " and every line must have the same number");
    }
  }

  WindowQuad quad(std::span<const Token> tokens) const {
    std::array<double, position_fields + 4 * max_attribute_slots> value{};
    for (std::size_t i = 0; i < tokens.size(); ++i) {
      const Number number = parse_number(tokens[i].text);
      if (!number.problem.empty()) {
        throw input_error(name_, tokens[i].line,
                          place(tokens[i], i) + " is " + in_quotes(tokens[i].text) + ", which " +
                              std::string(number.problem) +
                              "; a finite decimal number of magnitude up to 2^80 is expected");
      }
      value[i] = number.value;
    }
    WindowQuad quad;
    for (std::size_t v = 0; v < 4; ++v) {
      WindowVertex& vertex = quad.vertex[v];
      vertex = {value[4 * v], value[4 * v + 1], value[4 * v + 2], value[4 * v + 3]};
      if (vertex.x == 0 && vertex.y == 0 && vertex.w == 0) {
        throw input_error(name_, tokens[4 * v].line,
                          place(tokens[4 * v], 4 * v) + ": x, y and w of vertex v" + std::to_string(v) +
                              " are all 0, which is no point; at least one must differ from 0");
      }
      const double* const first = value.data() + position_fields + v * attributes_;
      quad.attribute[v].assign(first, first + attributes_);
    }
    return quad;
  }

  std::string place(const Token& token, std::size_t index) const {
    return "field " + std::to_string(index + 1) + " (" + field_name(index, attributes_) + ") in column " +
           std::to_string(token.column);
  }

  const std::string& name_;
  std::size_t first_line_ = 0;  ///< of the first quad, which fixes the number of attributes
  std::size_t attributes_ = 0;
};

/// What load_quads would refuse is refused here with the quad's index, instead of being written.
void check(const std::string& path, std::span<const WindowQuad> quads) {
  if (quads.empty()) throw input_error(path, 0, "there is no quad to write; a .quads file holds at least one");
  const std::size_t attributes = quads.front().attribute[0].size();
  for (std::size_t q = 0; q < quads.size(); ++q) {
    const auto failure = [&](const std::string& what) {
      return input_error(path, 0, "quad " + std::to_string(q) + " " + what);
    };
    const auto check_number = [&](double value) {
      if (!(std::abs(value) <= max_input_magnitude)) {
        throw failure("holds " + number_text(value) + "; finite numbers of magnitude up to 2^80 are expected");
      }
    };
    for (std::size_t v = 0; v < 4; ++v) {
      const WindowVertex& p = quads[q].vertex[v];
      for (const double value : {p.x, p.y, p.z, p.w}) check_number(value);
      if (p.x == 0 && p.y == 0 && p.w == 0)
        throw failure("has x = y = w = 0 at vertex v" + std::to_string(v) + "; that is no point");
      if (quads[q].attribute[v].size() != attributes || attributes > max_attribute_slots) {
        throw failure("has " + std::to_string(quads[q].attribute[v].size()) + " attributes at vertex v" +
                      std::to_string(v) + "; all vertices need the same number, at most " +
                      std::to_string(max_attribute_slots));
      }
      for (const double value : quads[q].attribute[v]) check_number(value);
    }
  }
}

}  // namespace

std::vector<WindowQuad> load_quads(const std::string& path, std::vector<std::string>* names) {
  return parse_quads(read_file(path, "a .quads text"), path, names);
}

std::vector<WindowQuad> parse_quads(std::string_view text, const std::string& name, std::vector<std::string>* names) {
  refuse_wide_text(text, name);
  return QuadsParser(name).parse(text, names);
}

std::string quad_text(const WindowQuad& quad) {
  std::string line;
  const auto append = [&](double value) {
    if (!line.empty()) line += ' ';
    line += number_text(value);
  };
  for (const WindowVertex& p : quad.vertex) {
    for (const double value : {p.x, p.y, p.z, p.w}) append(value);
  }
  for (const std::vector<double>& attributes : quad.attribute) {
    for (const double value : attributes) append(value);
  }
  return line;
}

void save_quads(const std::string& path, std::span<const WindowQuad> quads, std::span<const std::string> names) {
  check(path, quads);
  if (!names.empty())
    if (const std::string problem = problem_of_names(names, quads.front().attribute[0].size()); !problem.empty())
      throw input_error(path, 0, problem);
  AtomicFile file(path, AtomicFile::Dash::standard_output);
  file.write("# x y z w of v0, v1, v2, v3; then " + std::to_string(quads.front().attribute[0].size()) +
             " attributes of v0, of v1, of v2, of v3\n");
  if (!names.empty()) {
    std::string line = "# " + std::string(names_mark);
    for (const std::string& name : names) line += " " + name;
    file.write(line + '\n');
  }
  for (const WindowQuad& quad : quads) file.write(quad_text(quad) + '\n');
  file.commit();
}

}  // namespace quadrille::golden
