// The quads with the largest errors that a search has found, kept: a .quads file whose comments say of each what it is
// and how large its error was.
#pragma once

#include "golden/reference/truth.hpp"
#include "golden/scenes/stress.hpp"
#include "model/port/config.hpp"
#include "tb/judge/pixel_error.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace quadrille::tb {

struct WorstQuad {
  golden::StressFamily family = golden::StressFamily::general;  ///< whose code drew it
  Output output = Output::weight;
  double units = 0;  ///< PixelError::units with the arithmetic that it was recorded with
  golden::PixelPlace at;
  WindowQuad quad;  ///< id: its position
};

struct WorstQuads {
  Config config;
  int width = 64, height = 64;
  std::string found_by;  ///< a command, one line
  std::vector<WorstQuad> quads;

  /// Throws InputError with file:line for what is no such text: what load_quads refuses, a quad without a record before
  /// it, and records that are incomplete or outside the viewport.
  static WorstQuads parse(std::string_view text, const std::string& name);
  static WorstQuads load(const std::string& path);
  /// The file; errors with six decimals.
  std::string text() const;

  /// What each quad's error is now.
  std::vector<PixelError> measure() const;
  /// What is wrong, in words: an error that is not the recorded one or beyond the bound, and whatever else the whole
  /// draw of all of them has beyond its bounds (judge_untimed).
  std::vector<std::string> faults(const std::vector<PixelError>& now) const;
};

/// Errors that are equal as the file has them.
bool same_units(double recorded, double now);

}  // namespace quadrille::tb
