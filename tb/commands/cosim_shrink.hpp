// A failing co-simulation shrinks itself: the least that still fails as one command line, with a waveform of its end.
#pragma once

#include "model/port/records.hpp"
#include "tb/judge/check.hpp"
#include "tb/lockstep/lockstep.hpp"
#include "tb/options/options.hpp"

#include <optional>
#include <string>
#include <vector>

namespace quadrille::tb {

/// A pass of an input that failed, and how it was run.
struct FailedPass {
  std::string input;              ///< its name
  std::vector<WindowQuad> quads;  ///< of the whole input
  LockstepOptions lockstep;       ///< with the pass's draw state
  FragmentChecker::Settings check;
  int slots = 0;             ///< attributes in use per pass
  bool lockstep_ok = false;  ///< the truth alone differs
  bool at_port = false;      ///< the port got other quads than these: nothing to shrink
};

struct ShrinkOptions {
  std::string quads;    ///< the file for what is left; the waveform is beside it (.fst)
  double seconds = 60;  ///< after which the search ends with what it has
};

/// The first pixel at which a run failed, if it is about one.
std::optional<DivergentPixel> faulty_pixel(const LockstepReport& report, const CheckResult& check);

/// The argument as a shell wants it.
std::string quoted(const std::string& argument);

/// Shrinks, writes both files and says on standard error what is left, the command and the waveform.
void shrink_failed_pass(const FailedPass& failed, const ShrinkOptions& options, const CommonOptions& common);

}  // namespace quadrille::tb
