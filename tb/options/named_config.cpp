#include "tb/options/named_config.hpp"

#include "golden/io/text_input.hpp"
#include "model/support/edit_distance.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/source_paths.hpp"

#include <algorithm>
#include <filesystem>

namespace quadrille::tb {

namespace fs = std::filesystem;

std::vector<NamedConfig> named_configs() {
  std::vector<NamedConfig> configs;
  for (const fs::directory_entry& entry : fs::directory_iterator(rtl_directory() / "configurations")) {
    const fs::path& path = entry.path();
    if (path.extension() != ".toml") continue;
    const std::string text = golden::read_file(path.string(), "a configuration in TOML");
    const std::string line = text.substr(0, text.find('\n'));
    configs.push_back({path.stem().string(), path.string(), line.starts_with("# ") ? line.substr(2) : ""});
  }
  std::ranges::sort(configs, {}, &NamedConfig::name);
  return configs;
}

std::string config_path(const std::string& given) {
  std::error_code ignored;
  if (given.find_first_of("./") != std::string::npos || fs::exists(given, ignored)) return given;
  const std::vector<NamedConfig> configs = named_configs();
  const auto found = std::ranges::find(configs, given, &NamedConfig::name);
  if (found != configs.end()) return found->path;
  std::string names;
  for (const NamedConfig& config : configs) names += (names.empty() ? "" : ", ") + config.name;
  throw UsageError("--config " + given + ": neither a file nor a named configuration" +
                   did_you_mean(given, configs, &NamedConfig::name) + " (" + names + ")");
}

}  // namespace quadrille::tb
