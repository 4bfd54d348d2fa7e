// What compiles and links a simulator: Ninja.
#pragma once

#include "tb/device/build_notice.hpp"

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

namespace quadrille::tb {

std::string shell_quoted(const std::string& text);

/// A build.ninja of objects and one shared object of them, in a directory of its own.
class NinjaFile {
 public:
  NinjaFile(const std::string& compiler, const std::vector<std::string>& flags);

  /// `flags`: its own ones, quoted for the shell.
  void object(const std::string& name, const std::filesystem::path& source, const std::string& flags);
  void link(const std::string& name, const std::vector<std::filesystem::path>& further, const std::string& libraries);
  std::size_t steps() const { return objects_.size() + steps_; }
  /// Runs Ninja in `directory`; `before` of the notice's steps are done. Returns its exit status.
  int run(const std::filesystem::path& directory, const std::filesystem::path& log, unsigned jobs, BuildNotice& notice,
          std::size_t before) const;

 private:
  std::ostringstream text_;
  std::vector<std::string> objects_;
  std::size_t steps_ = 0;
};

}  // namespace quadrille::tb
