#include "tb/support/staged_directory.hpp"

#include "golden/io/interrupt.hpp"
#include "tb/support/errors.hpp"

#include <algorithm>
#include <system_error>

namespace quadrille::tb {

namespace fs = std::filesystem;

StagedDirectory::StagedDirectory(const std::string& directory) : directory_(directory) {
  golden::announce_output(directory);
  std::error_code error;
  fs::create_directories(directory_, error);
  try {
    if (error) throw std::system_error(error);
    folder_.emplace(directory_, golden::Temporary::Kind::folder);
  } catch (const std::system_error& failure) {
    throw UsageError("--out " + directory + ": cannot be written to: " + failure.code().message());
  }
}

void StagedDirectory::commit(const std::vector<std::string>& stale) const {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder())) files.push_back(entry.path().filename());
  std::ranges::sort(files);
  for (const fs::path& file : files)
    if (fs::is_directory(directory_ / file))
      throw UsageError((directory_ / file).string() + ": is a directory; a file is expected");
  std::exception_ptr failure;
  golden::without_interrupt([&] {  // all of it or nothing
    try {
      for (const std::string& name : stale)
        if (name.find('/') == std::string::npos && !fs::exists(folder() / name) &&
            fs::is_regular_file(directory_ / name))
          fs::remove(directory_ / name);
      for (const fs::path& file : files) fs::rename(folder() / file, directory_ / file);
    } catch (...) {
      failure = std::current_exception();
    }
  });
  if (failure) std::rethrow_exception(failure);
  golden::output_written(directory_.string());
}

}  // namespace quadrille::tb
