// Configurations of the repository that --config takes by name.
#pragma once

#include <string>
#include <vector>

namespace quadrille::tb {

struct NamedConfig {
  std::string name;  ///< of rtl/configurations/NAME.toml
  std::string path;
  std::string aim;  ///< the file's first line, a comment
};

/// All of them by name. Throws EnvironmentError where the data of the program are missing.
std::vector<NamedConfig> named_configs();

/// The file that --config means: `given` itself where that is a file or has a dot or slash, else the named
/// configuration. Throws UsageError with the names for any other word.
std::string config_path(const std::string& given);

}  // namespace quadrille::tb
