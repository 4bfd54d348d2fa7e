#include "tb/device/ninja_file.hpp"

#include "tb/device/cache.hpp"
#include "tb/support/environment_error.hpp"
#include "tb/support/process.hpp"

#include <cstdio>
#include <string_view>

namespace quadrille::tb {

namespace fs = std::filesystem;

namespace {

std::string value(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '$' ? std::string("$$") : std::string(1, c);
  return escaped;
}
std::string path(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '$' || c == ' ' || c == ':') escaped += '$';
    escaped += c;
  }
  return escaped;
}

}  // namespace

std::string shell_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

NinjaFile::NinjaFile(const std::string& chosen, const std::vector<std::string>& flags) {
  std::string compiler = shell_quoted(chosen);
  try {
    compiler = shell_quoted(find_program("ccache", "ccache").string()) + " " + compiler;
  } catch (const EnvironmentError&) {  // does without
  }
  text_ << "rule compile\n  command = " << value(compiler);
  for (const std::string& flag : flags) text_ << ' ' << value(shell_quoted(flag));
  text_ << " $flags -c $in -o $out\nrule link\n  command = " << value(shell_quoted(chosen))
        << " -shared -fPIC -Wl,-Bsymbolic -Wl,--no-undefined -o $out $in -lpthread -latomic $libraries\n";
}

void NinjaFile::object(const std::string& name, const fs::path& source, const std::string& flags) {
  text_ << "build " << path(name) << ": compile " << path(source.string()) << "\n  flags = " << value(flags) << '\n';
  objects_.push_back(name);
}

void NinjaFile::link(const std::string& name, const std::vector<fs::path>& further, const std::string& libraries) {
  text_ << "build " << path(name) << ": link";
  for (const std::string& object : objects_) text_ << ' ' << path(object);
  for (const fs::path& object : further) text_ << ' ' << path(object.string());
  text_ << "\n  libraries = " << libraries << '\n';
  ++steps_;
}

int NinjaFile::run(const fs::path& directory, const fs::path& log, unsigned jobs, BuildNotice& notice,
                   std::size_t before) const {
  write_text(directory / "build.ninja", text_.str());
  const std::vector<std::string> command{find_program("ninja", "ninja-build"), "-j", std::to_string(jobs)};
  const std::size_t total = before + steps();
  return run_watched(
      command, directory, log,
      [&](std::string_view line) {  // "[3/5] …" with the status that Ninja shows of itself
        unsigned number = 0;
        if (std::sscanf(std::string(line).c_str(), "[%u/", &number) == 1) notice.done(before + number, total);
      },
      [&] { notice.tick(); });
}

}  // namespace quadrille::tb
