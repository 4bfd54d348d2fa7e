#include "tb/options/command_line.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <sstream>
#include <vector>

namespace quadrille::tb {
namespace {

constexpr std::size_t text_column = 26;  // of descriptions

std::size_t terminal_width() {
  const char* given = std::getenv("COLUMNS");
  long columns = given != nullptr ? std::strtol(given, nullptr, 10) : 0;
  winsize size{};
  if (columns <= 0 && ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0) columns = size.ws_col;
  return static_cast<std::size_t>(std::clamp(columns <= 0 ? 80L : columns, 60L, 120L));
}

/// The words of `text` after `line`; lines of at most the terminal's width, the later ones indented.
std::string wrapped(std::string line, std::string_view text, std::size_t indent) {
  const std::size_t width = terminal_width();
  std::string result;
  std::istringstream words{std::string(text)};
  for (std::string word; words >> word;) {
    if (line.size() > indent && line.size() + 1 + word.size() > width) {
      result += line + "\n";
      line.assign(indent, ' ');
    }
    if (line.size() > indent) line += ' ';
    line += word;
  }
  return result + line + "\n";
}

/// `text` in the column `indent`, beside `head` or below it.
std::string beside(std::string head, std::string_view text, std::size_t indent) {
  std::string above;
  if (head.size() + 2 > indent) above = head + "\n", head.clear();
  head.resize(indent, ' ');
  return above + wrapped(head, text, indent);
}

/// A line of a note or of an example. In a table, "  NAME  MEANING", the meaning keeps its column.
std::string note_line(const std::string& line, std::size_t indent) {
  const std::size_t begin = line.find_first_not_of(' ');
  if (begin == std::string::npos) return "\n";
  const std::size_t gap = line.find("  ", begin);
  const std::string margin(indent, ' ');
  if (gap == std::string::npos) return begin == 0 ? wrapped(margin, line, indent) : margin + line + "\n";
  const std::size_t column = line.find_first_not_of(' ', gap);
  return wrapped(margin + line.substr(0, column), line.substr(column), indent + column);
}

std::string notes_of(const std::string& text, std::size_t indent) {
  std::string result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) result += note_line(line, indent);
  return result;
}

/// Where in "N:INT in [1 - 8]" the validator begins; not in "random[:SEED]".
std::size_t validator_of(const std::string& type) {
  const std::size_t colon = type.find(':');
  return colon != 0 && colon < type.size() && type[colon - 1] == '[' ? std::string::npos : colon;
}

/// "1 to 8" of "N:INT in [1 - 8]"; empty when there are no limits that a person would reach.
std::string range_of(const std::string& type) {
  const std::size_t begin = type.find(" in ["), dash = type.find(" - ", begin), end = type.find(']', begin);
  if (begin == std::string::npos || dash == std::string::npos || end - dash > 12) return {};
  return type.substr(begin + 5, dash - begin - 5) + " to " + type.substr(dash + 3, end - dash - 3);
}

class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() { label("SUBCOMMAND", "COMMAND"); }

  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    std::vector<std::string> groups = app->get_groups();
    std::ranges::stable_sort(groups, {}, [](const std::string& group) {
      constexpr std::array<std::string_view, 4> last{state_group, config_group, output_group, general_group};
      return group == "Input"                               ? -1
             : std::ranges::find(last, group) == last.end() ? 0
                                                            : 1 + (std::ranges::find(last, group) - last.begin());
    });
    std::string text = wrapped("", app->get_description(), 0) + make_usage(app, name) + make_positionals(app);
    for (const std::string& group : groups) {
      auto options = app->get_options(
          [&](const CLI::Option* option) { return option->get_group() == group && option->nonpositional(); });
      std::stable_partition(
          options.begin(), options.end(), [](const CLI::Option* option) {  // what is common comes last
            return !option->check_name("--json") && !option->check_name("--quiet") && !option->check_name("--verbose");
          });
      if (!group.empty() && !options.empty())
        text += make_group(group == "Options" && app->get_parent() != nullptr ? "Options of " + app->get_name() : group,
                           false, options);
    }
    return text + make_subcommands(app, mode) + "\n" + make_footer(app);
  }

  std::string make_option(const CLI::Option* option, bool positional) const override {
    const std::string type = option->get_type_name();
    std::string head = "  " + make_option_name(option, positional);
    if (const std::size_t negated = head.find(",--no-"); negated != std::string::npos)
      head = "  " + head.substr(negated + 1, head.find('{') - negated - 1);
    if (const std::size_t comma = head.find(','); comma != std::string::npos) head.insert(comma + 1, " ");
    if (!positional && option->get_type_size() != 0) head += " " + type.substr(0, validator_of(type));
    if (option->get_expected_max() == CLI::detail::expected_max_vector_size) head += " ...";

    const std::string all = option->get_description();
    const std::size_t end = std::min(all.find('\n'), all.size());
    std::vector<std::string> facts;
    if (!option->get_default_str().empty()) facts.push_back("default: " + option->get_default_str());
    if (const std::string range = range_of(type); !range.empty()) facts.push_back(range);
    if (option->get_required()) facts.emplace_back("required");
    for (const CLI::Option* needed : option->get_needs()) facts.push_back("with " + needed->get_name());
    const std::string in_brackets = facts.empty() ? "" : " (" + CLI::detail::join(facts, "; ") + ")";
    return beside(head, all.substr(0, end) + in_brackets, text_column) +
           notes_of(all.substr(std::min(end + 1, all.size())), text_column);
  }

  std::string make_subcommand(const CLI::App* command) const override {
    return beside("  " + command->get_name(), command->get_description(), 14);
  }

  std::string make_footer(const CLI::App* app) const override { return notes_of(app->get_footer(), 0); }
};

}  // namespace

std::shared_ptr<CLI::FormatterBase> help_formatter() { return std::make_shared<HelpFormatter>(); }

void end_help(CLI::App& command, const std::string& notes, std::string_view status,
              std::initializer_list<std::string_view> examples) {
  std::string text = notes + (notes.empty() ? "" : "\n\n") + "Exit status:";
  for (const std::string& line : CLI::detail::split(std::string(status), ';')) {
    const std::string one = CLI::detail::trim_copy(line);
    text += "\n  " + one.substr(0, 1) + " " + one.substr(1);
  }
  text += "\n\nExamples:";
  for (const std::string_view example : examples) text += "\n  quadrille " + std::string(example);
  command.footer(text);
}

}  // namespace quadrille::tb
