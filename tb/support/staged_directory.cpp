#include "tb/support/staged_directory.hpp"

#include "tb/support/errors.hpp"

#include <stdlib.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace quadrille::cli {

namespace fs = std::filesystem;

StagedDirectory::StagedDirectory(const std::string& directory) : directory_(directory) {
  std::error_code error;
  fs::create_directories(directory_, error);
  std::string name = (directory_ / ".staged-XXXXXX").string();
  if (!fs::is_directory(directory_) || mkdtemp(name.data()) == nullptr)
    throw UsageError("--out " + directory + ": cannot be written to: " +
                     (error ? error : std::error_code(errno, std::generic_category())).message());
  folder_ = name;
}

StagedDirectory::~StagedDirectory() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void StagedDirectory::commit(const std::vector<std::string>& stale) const {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) files.push_back(entry.path().filename());
  std::ranges::sort(files);
  for (const fs::path& file : files)
    if (fs::is_directory(directory_ / file))
      throw UsageError((directory_ / file).string() + ": is a directory; a file of this name is to be written");
  for (const std::string& name : stale)
    if (name.find('/') == std::string::npos && !fs::exists(folder_ / name) && fs::is_regular_file(directory_ / name))
      fs::remove(directory_ / name);
  for (const fs::path& file : files) fs::rename(folder_ / file, directory_ / file);
}

}  // namespace quadrille::cli
