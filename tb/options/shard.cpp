#include "tb/options/shard.hpp"

#include "tb/options/command_line.hpp"
#include "tb/support/errors.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

namespace quadrille::tb {

Shard Shard::parse(const std::string& text) {
  Shard shard;
  if (text.empty()) return shard;
  const char *begin = text.data(), *end = begin + text.size();
  const auto [slash, bad_index] = std::from_chars(begin, end, shard.index);
  bool good = bad_index == std::errc{} && slash != end && *slash == '/';
  if (good) {
    const auto [last, bad_count] = std::from_chars(slash + 1, end, shard.count);
    good = bad_count == std::errc{} && last == end && shard.index < shard.count && shard.count <= 1'000'000;
  }
  if (!good) throw UsageError("--shard " + text + ": expected I/N with 0 <= I < N, such as 0/4");
  return shard;
}

void ShardOptions::add_to(CLI::App& app, const std::string& what, const std::string& part) {
  constexpr const char* group = "Shards";
  CLI::Option* one = app.add_option("--shard", shard, "Part I (from 0) of N of " + what)->type_name("I/N");
  one->group(group);
  app.add_option("--merge", merge, "Join shards: " + part)->type_name("PART")->group(group)->excludes(one);
}

std::vector<std::string> without_outputs(std::span<const std::string> arguments) {
  constexpr std::string_view flags[]{"--quiet", "--verbose", "--fresh"};
  constexpr std::string_view valued[]{"--json", "--csv", "--out", "--threads", "--shard"};
  std::vector<std::string> kept;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string_view argument = arguments[i], name = argument.substr(0, argument.find('='));
    if (std::ranges::count(flags, argument) != 0) continue;
    const bool merge = name == "--merge";
    if (!merge && std::ranges::count(valued, name) == 0) {
      kept.push_back(arguments[i]);
      continue;
    }
    if (name != argument) continue;  // --json=FILE
    if (!merge)
      ++i;
    else
      while (i + 1 < arguments.size() && !arguments[i + 1].starts_with("--")) ++i;
  }
  return kept;
}

}  // namespace quadrille::tb
