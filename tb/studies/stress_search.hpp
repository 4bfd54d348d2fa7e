// quadrille stress --search and --kept: the worst quads of the stress families looked for, kept, checked.
#pragma once

#include "tb/options/options.hpp"

#include <cstdint>
#include <string>

namespace quadrille::tb {

/// --search --evaluations --leave --keep --kept
struct StressSearchOptions {
  bool search = false, leave = false;
  std::uint64_t evaluations = 20'000;
  std::string keep, kept;

  /// To the options of `stress`, which must be there.
  void add_to(CLI::App& app);
};

/// `families`: names with commas, all when empty.
int search_stress(const CommonOptions& common, const std::string& families, const StressSearchOptions& options);

int check_kept_stress(const CommonOptions& common, const StressSearchOptions& options);

}  // namespace quadrille::tb
