// quadrille cache: what was built on demand, and making room.
#include "tb/commands/commands.hpp"
#include "tb/options/command_line.hpp"
#include "tb/options/written_file.hpp"

#include "golden/io/json_report.hpp"
#include "tb/device/cache.hpp"
#include "tb/support/errors.hpp"

#include <chrono>
#include <cinttypes>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace quadrille::tb {
namespace {

constexpr std::string_view failed_prefix = "failed-";

std::string meaning(const CacheItem& item) {
  if (!item.description.empty()) return item.description;
  return item.name.starts_with(failed_prefix) ? "log of a failed build" : "of another version";
}

std::string readable(std::uintmax_t bytes) {
  char text[32];
  if (bytes < 1000 * 1024)
    std::snprintf(text, sizeof text, "%.1f KiB", static_cast<double>(bytes) / 1024);
  else
    std::snprintf(text, sizeof text, "%.1f MiB", static_cast<double>(bytes) / (1024 * 1024));
  return text;
}

std::string readable(std::chrono::seconds age) {
  const long long s = age.count();
  if (s < 120) return std::to_string(s) + " s";
  if (s < 2 * 3600) return std::to_string(s / 60) + " min";
  if (s < 48 * 3600) return std::to_string(s / 3600) + " h";
  return std::to_string(s / 86400) + " days";
}

int show(const std::vector<CacheItem>& items, const char* what, const std::string& json_file) {
  const auto now = std::chrono::system_clock::now();
  const auto age = [&](const CacheItem& item) {
    return std::max(std::chrono::seconds{0}, std::chrono::duration_cast<std::chrono::seconds>(now - item.used));
  };
  std::uintmax_t total = 0;
  for (const CacheItem& item : items) total += item.bytes;
  if (!json_file.empty()) {
    nlohmann::ordered_json json;
    json["schema_version"] = 1;
    json["version"] = golden::program_version();
    json["directory"] = cache_directory().string();
    json["limit_bytes"] = cache_limit();
    json["bytes"] = total;
    json[what] = nlohmann::ordered_json::array();
    for (const CacheItem& item : items)
      json[what].push_back({{"name", item.name},
                            {"what", meaning(item)},
                            {"bytes", item.bytes},
                            {"seconds_since_use", age(item).count()},
                            {"in_use", item.in_use}});
    golden::save_json(json_file, json);
  }
  if (json_file == "-") return exit_ok;
  for (const CacheItem& item : items)
    std::printf("%11s  %8s%s  %s\n", readable(item.bytes).c_str(), readable(age(item)).c_str(),
                item.in_use ? " in use" : "       ", meaning(item).c_str());
  const std::uintmax_t limit = cache_limit();
  std::printf("%s%zu %s, %s; limit %s; %s\n", std::string_view(what) == "removed" ? "removed " : "", items.size(),
              items.size() == 1 ? "entry" : "entries", readable(total).c_str(),
              limit == 0 ? "none" : readable(limit).c_str(), cache_directory().c_str());
  return exit_ok;
}

}  // namespace

void add_cache_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("cache", "List or clear the cache of simulators");
  end_help(*command,
           "Directory: $QUADRILLE_CACHE, else $XDG_CACHE_HOME/quadrille, else $HOME/.cache/quadrille. Above "
           "$QUADRILLE_CACHE_SIZE (default: 1G; 0: no limit) the least recently used entries are removed.",
           "0 done; 2 usage error", {"cache", "cache --json -", "cache clear"});
  const auto json = std::make_shared<std::string>();
  writes_file(*command, command->add_option("--json", *json, "JSON report; - is standard output"), "json")
      ->group(output_group);
  command->require_subcommand(0, 1);
  CLI::App* list = command->add_subcommand("list", "List entries, least recently used first (default)");
  CLI::App* clear = command->add_subcommand("clear", "Remove entries that no program uses");
  end_help(*list, "", "0 done; 2 usage error", {"cache list --json -"});
  end_help(*clear, "", "0 done; 2 usage error", {"cache clear"});
  for (CLI::App* sub : {list, clear}) sub->fallthrough();
  command->callback([json, clear, &invocation] {
    const bool remove = clear->parsed();
    invocation.run = [json, remove] {
      return remove ? show(clear_cache(), "removed", *json) : show(cache_items(), "entries", *json);
    };
  });
}

}  // namespace quadrille::tb
