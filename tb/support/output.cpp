#include "tb/support/output.hpp"

#include "golden/io/atomic_file.hpp"
#include "golden/io/interrupt.hpp"
#include "tb/support/errors.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace quadrille::tb {

void check_outputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
  namespace fs = std::filesystem;
  // Devices take any number of writers.
  const auto same = [](const std::string& a, const std::string& b) {
    if (a.empty() || b.empty() || (a == "-") != (b == "-")) return false;
    if (a == "-") return true;
    std::error_code ignored;
    if (fs::exists(a, ignored) && !fs::is_regular_file(a, ignored)) return false;
    // Absolute first: the canonical form of a name that does not exist yet would stay relative.
    return fs::weakly_canonical(fs::absolute(a, ignored), ignored) ==
           fs::weakly_canonical(fs::absolute(b, ignored), ignored);
  };
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (!outputs[i].empty() && outputs[i] != "-") golden::require_writable(outputs[i]);
    for (std::size_t j = 0; j < i; ++j)
      if (same(outputs[i], outputs[j]))
        throw UsageError(outputs[i] + ": two outputs have this name; give each its own");
    for (const std::string& input : inputs)
      if (same(outputs[i], input))
        throw UsageError(outputs[i] + ": is an input of this command; use another output file");
  }
  for (const std::string& output : outputs) golden::announce_output(output);
}

PartialFile::PartialFile(std::string path) : path_(std::move(path)) {
  if (!active()) return;
  std::error_code ignored;
  if (std::filesystem::exists(path_, ignored) && !std::filesystem::is_regular_file(path_, ignored))
    throw UsageError(path_ + ": is no regular file; this format needs one");
  // A folder, since writers may put files of their own beside it.
  const std::filesystem::path target = std::filesystem::weakly_canonical(std::filesystem::absolute(path_));
  try {
    folder_.emplace(target.parent_path(), golden::Temporary::Kind::folder);
  } catch (const std::system_error& failure) {
    throw UsageError(path_ + ": cannot be written: " + failure.code().message());
  }
  target_ = target.string();
  partial_ = (folder_->path() / target.filename()).string();
}

void PartialFile::commit() {
  bool renamed = false;
  golden::without_interrupt([&] { renamed = std::rename(partial_.c_str(), target_.c_str()) == 0; });
  if (!renamed) throw UsageError(path_ + ": cannot be written: " + std::strerror(errno));
  folder_.reset();
  golden::output_written(path_);
}

}  // namespace quadrille::tb
