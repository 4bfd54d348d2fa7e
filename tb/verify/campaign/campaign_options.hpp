// What the campaign programs share: `--name value` options, and the frame of main().
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <map>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace quadrille::campaign {

/// Options with their defaults; anything unknown, or not a list of numbers, ends the program with status 2.
class Options {
 public:
  Options(int argc, char** argv, std::map<std::string, std::string> defaults) : values_(std::move(defaults)) {
    for (int i = 1; i < argc; i += 2) {
      const std::string_view name = argv[i];
      const auto found = name.starts_with("--") ? values_.find(std::string(name.substr(2))) : values_.end();
      if (found == values_.end() || i + 1 == argc) {
        std::cerr << argv[0] << ": " << (found == values_.end() ? "unknown option " : "no value for ") << name
                  << "; options are";
        for (const auto& [key, value] : values_) std::cerr << " --" << key << " " << (value.empty() ? "''" : value);
        std::cerr << "\n";
        std::exit(2);
      }
      found->second = argv[i + 1];
    }
  }

  std::string text(const std::string& name) const { return values_.at(name); }
  std::uint64_t number(const std::string& name) const { return numbers(name).at(0); }
  std::vector<std::uint64_t> numbers(const std::string& name) const {
    const std::string& all = values_.at(name);
    std::vector<std::uint64_t> out;
    for (const char *p = all.data(), *end = p + all.size();; ++p) {
      std::uint64_t v = 0;
      const auto [next, error] = std::from_chars(p, end, v);
      if (error != std::errc() || (next != end && *next != ',')) {
        std::cerr << "--" << name << " " << all << " is not a list of numbers\n";
        std::exit(2);
      }
      out.push_back(v);
      if (next == end) return out;
      p = next;
    }
  }

  /// --threads, 0: one per processor.
  unsigned threads() const {
    const std::uint64_t given = number("threads");
    return given != 0 ? static_cast<unsigned>(given) : std::max(1u, std::thread::hardware_concurrency());
  }

 private:
  std::map<std::string, std::string> values_;
};

/// main() of a campaign: what is thrown is told under its name, status 2.
inline int guarded(const char* name, int (*run)(int, char**), int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << "\n";
    return 2;
  }
}

}  // namespace quadrille::campaign
