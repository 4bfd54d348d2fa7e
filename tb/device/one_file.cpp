#include "tb/device/one_file.hpp"

#include "model/port/tables.hpp"
#include "tb/device/verilate.hpp"
#include "tb/support/environment_error.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <vector>

namespace quadrille::tb {

namespace fs = std::filesystem;

namespace {

/// IEEE 1800-2017, annex B; those of one letter case and more than one word alike. Of Verilog-AMS none.
constexpr std::string_view keywords =
    " accept_on alias always always_comb always_ff always_latch and assert assign assume automatic before begin bind "
    "bins binsof bit "
    "break buf bufif0 bufif1 byte case casex casez cell chandle checker class clocking cmos config const constraint "
    "context continue "
    "cover covergroup coverpoint cross deassign default defparam design disable dist do edge else end endcase "
    "endchecker endclass "
    "endclocking endconfig endfunction endgenerate endgroup endinterface endmodule endpackage endprimitive endprogram "
    "endproperty "
    "endsequence endspecify endtable endtask enum event eventually expect export extends extern final first_match for "
    "force foreach "
    "forever fork forkjoin function generate genvar global highz0 highz1 if iff ifnone ignore_bins illegal_bins "
    "implements implies import "
    "incdir include initial inout input inside instance int integer interconnect interface intersect join join_any "
    "join_none large let "
    "liblist library local localparam logic longint macromodule matches medium modport module nand negedge nettype new "
    "nexttime nmos nor "
    "noshowcancelled not notif0 notif1 null or output package packed parameter pmos posedge primitive priority program "
    "property protected "
    "pull0 pull1 pulldown pullup pulsestyle_ondetect pulsestyle_onevent pure rand randc randcase randsequence rcmos "
    "real realtime ref reg "
    "reject_on release repeat restrict return rnmos rpmos rtran rtranif0 rtranif1 s_always s_eventually s_nexttime "
    "s_until s_until_with "
    "scalared sequence shortint shortreal showcancelled signed small soft solve specify specparam static string strong "
    "strong0 strong1 "
    "struct super supply0 supply1 sync_accept_on sync_reject_on table tagged task this throughout time timeprecision "
    "timeunit tran "
    "tranif0 tranif1 tri tri0 tri1 triand trior trireg type typedef union unique unique0 unsigned until until_with "
    "untyped use uwire var "
    "vectored virtual void wait wait_order wand weak weak0 weak1 while wildcard wire with within wor xnor xor ";

bool in_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '$'; }

std::string upper(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return result;
}

/// What a piece of a source is.
enum class Kind { name, comment, string, other };

/// The pieces of a source in order; together they are the text. A name in a comment or a string is a piece of that
/// kind.
template <class F>
void for_each_piece(std::string_view text, F&& piece) {
  Kind within = Kind::name;  // or comment, string
  bool block = false;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at + 1;
    const std::string_view two = text.substr(at, 2);
    if (within == Kind::name && (two == "//" || two == "/*")) {
      within = Kind::comment, block = two == "/*", end = at + 2;
    } else if (within == Kind::comment && ((block && two == "*/") || (!block && text[at] == '\n'))) {
      within = Kind::name, end = at + (block ? 2 : 1);
    } else if (within == Kind::name && (two == "`\"" || two == "``")) {  // in a macro
      end = at + 2;
    } else if (within == Kind::name && text[at] == '"') {
      within = Kind::string;
    } else if (within == Kind::string && text[at] == '\\') {
      end = std::min(at + 2, text.size());
    } else if (within == Kind::string && text[at] == '"') {
      within = Kind::name;
    } else if (in_name(text[at])) {
      while (end < text.size() && in_name(text[end])) ++end;
      piece(text.substr(at, end - at), within);
      at = end;
      continue;
    }
    piece(text.substr(at, end - at), Kind::other);
    at = end;
  }
}

/// The sources as the preprocessor of a tool would see them, up to what only the tool knows.
class Preprocessor {
 public:
  explicit Preprocessor(const Config& config) {
    for (const ConfigKey& key : Config::keys())
      keys_["QUADRILLE_" + upper(key.name)] = std::to_string(config.get(key.name));
  }

  std::vector<fs::path> include_directories;
  std::string text;                  ///< so far
  std::vector<std::string> defined;  ///< macros that `text` defines, in order

  void add(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw SystemError(file.string() + ": cannot be read");
    add(in, file);
  }

  void add(std::istream& in, const fs::path& file) {
    const std::size_t depth = conditions_.size();
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
      const std::string place = file.string() + ":" + std::to_string(number);
      for (std::string next; !line.empty() && line.back() == '\\' && std::getline(in, next); ++number)
        line += "\n" + next;
      add_line(line, place, file.parent_path());
    }
    if (conditions_.size() != depth) throw SystemError(file.string() + ": an `ifdef without `endif");
  }

 private:
  struct Condition {
    bool decided, active, taken;  ///< decided: of the project's macros, so its lines go; taken: some branch was active
  };

  void add_line(const std::string& line, const std::string& place, const fs::path& directory) {
    std::istringstream words(line);
    std::string word, name;
    words >> word >> name;
    if (word == "`ifdef" || word == "`ifndef") {
      const bool own = name.starts_with("QUADRILLE_"), active = known(name) == (word == "`ifdef");
      conditions_.push_back({own, !own || active, active});
      if (!own && active_above()) keep(line);
      if (keys_.contains(name)) drop_comment();
    } else if (word == "`elsif" || word == "`else" || word == "`endif") {
      if (conditions_.empty()) throw SystemError(place + ": " + word + " without `ifdef");
      Condition& condition = conditions_.back();
      if (word == "`elsif" && name.starts_with("QUADRILLE_") != condition.decided)
        throw SystemError(place + ": a condition on the project's macros and on a tool's; expected one or the other");
      if (condition.decided) {
        condition.active = !condition.taken && (word == "`else" || (word == "`elsif" && known(name)));
        condition.taken = condition.taken || condition.active;
      } else if (active_above()) {
        keep(line);
      }
      if (word == "`endif") conditions_.pop_back();
    } else if (!active()) {
      return;
    } else if (word == "`include") {
      include(name, place, directory);
    } else if (word == "`define") {
      define(line, name, place);
    } else if (!line.starts_with("// SPDX-")) {
      keep(line);
    }
  }

  bool known(const std::string& name) const { return keys_.contains(name) || macros_.contains(name); }
  bool active() const {
    return std::ranges::all_of(conditions_, [](const Condition& condition) { return condition.active; });
  }
  /// Whether the condition under way is itself in text that stays.
  bool active_above() const {
    return std::all_of(conditions_.begin(), conditions_.end() - 1,
                       [](const Condition& condition) { return condition.active; });
  }

  void include(const std::string& quoted, const std::string& place, const fs::path& directory) {
    const std::string name = quoted.size() > 2 ? quoted.substr(1, quoted.size() - 2) : "";
    std::vector<fs::path> places{directory};
    places.insert(places.end(), include_directories.begin(), include_directories.end());
    for (const fs::path& folder : places)
      if (!name.empty() && fs::is_regular_file(folder / name)) return add(folder / name);
    throw SystemError(place + ": cannot find " + quoted);
  }

  /// A macro without parameters and text only guards a file: it is known, and goes.
  void define(const std::string& line, std::string name, const std::string& place) {
    const std::size_t parameters = name.find('(');
    const bool guard =
        parameters == std::string::npos && line.find_last_not_of(" \t") + 1 == line.find(name) + name.size();
    name.resize(std::min(parameters, name.size()));
    if (!name.starts_with("QUADRILLE_"))
      throw SystemError(place + ": the macro " + name + " does not begin with QUADRILLE_");
    if (keys_.contains(name)) throw SystemError(place + ": the macro " + name + " is a key");
    macros_.insert(name);
    if (guard) return;
    if (std::ranges::find(defined, name) == defined.end()) defined.push_back(name);
    keep(line);
  }

  /// The comment that `text` ends with: of the macros that are about to go.
  void drop_comment() {
    while (text.size() > 1) {
      const std::size_t begin = text.rfind('\n', text.size() - 2) + 1;
      if (!text.substr(begin).starts_with("//")) break;
      text.resize(begin);
    }
  }

  /// The line with the values of keys, never a second empty one.
  void keep(const std::string& line) {
    std::string kept;
    for (std::size_t at = 0; at < line.size();) {
      std::size_t end = at + 1;
      while (end < line.size() && in_name(line[end])) ++end;
      const std::string word = line.substr(at, end - at);
      const auto key = line[at] == '`' ? keys_.find(word.substr(1)) : keys_.end();
      kept += key != keys_.end() ? key->second : word;
      at = end;
    }
    if (!kept.empty() || !(text.empty() || text.ends_with("\n\n"))) text += kept + "\n";
  }

  std::map<std::string, std::string> keys_;
  std::set<std::string> macros_;
  std::vector<Condition> conditions_;
};

/// Refuses a module, package or interface whose name with_prefix() would leave as it is.
void require_prefixes(std::string_view text) {
  std::string_view before;
  for_each_piece(text, [&](std::string_view piece, Kind kind) {
    if (kind != Kind::name) return;
    const bool declares = before == "module" || before == "package" || before == "interface" || before == "program";
    if (declares && piece != "automatic" && piece != "static" && piece != "quadrille" &&
        !piece.starts_with("quadrille_"))
      throw SystemError("rtl: the " + std::string(before) + " " + std::string(piece) +
                        " does not begin with quadrille_");
    before = piece;
  });
}

}  // namespace

std::string prefix_fault(std::string_view prefix) {
  const auto allowed = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  if (prefix.empty() || !std::ranges::all_of(prefix, allowed) || (prefix[0] >= '0' && prefix[0] <= '9'))
    return "is no name in lower case; expected letters a to z, digits and _, a letter or _ first";
  if (keywords.find(" " + std::string(prefix) + " ") != std::string_view::npos)
    return "is a keyword of SystemVerilog; expected another name";
  return {};
}

std::string with_prefix(std::string_view text, std::string_view prefix) {
  constexpr std::string_view name = "quadrille", begins = "quadrille_", macro = "QUADRILLE_";
  std::string result;
  for_each_piece(text, [&](std::string_view piece, Kind kind) {
    if (kind == Kind::name && piece == name)
      result += prefix;
    else if (kind != Kind::other && piece.starts_with(begins))
      result += std::string(prefix) + "_" + std::string(piece.substr(begins.size()));
    else if (kind != Kind::other && piece.starts_with(macro))
      result += upper(prefix) + "_" + std::string(piece.substr(macro.size()));
    else
      result += piece;
  });
  return result;
}

std::string one_file(const fs::path& rtl, const Config& config) {
  Preprocessor sources(config);
  const fs::path list = rtl / "quadrille.f";
  std::ifstream in(list);
  if (!in) throw SystemError(list.string() + ": cannot be read");
  constexpr std::string_view incdir = "+incdir+";
  std::size_t files = 0;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line.starts_with("//")) continue;
    if (line.starts_with(incdir)) {
      sources.include_directories.push_back(rtl / line.substr(incdir.size()));
    } else if (line[0] == '+' || line[0] == '-') {
      throw SystemError(list.string() + ": " + line + " is not understood; expected +incdir+DIR or a file");
    } else if (fs::path(line).filename() == "quadrille_tables_pkg.sv") {
      std::istringstream tables(tables_package(config));
      sources.add(tables, line);
      ++files;
    } else {
      sources.add(rtl / line);
      ++files;
    }
    if (!sources.text.empty() && !sources.text.ends_with("\n\n")) sources.text += "\n";
  }
  if (files == 0) throw SystemError(list.string() + ": names no file");
  require_prefixes(sources.text);
  for (const std::string& macro : sources.defined) sources.text += "`undef " + macro + "\n";
  return std::move(sources.text);
}

}  // namespace quadrille::tb
