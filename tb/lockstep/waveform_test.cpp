// A waveform of the default configuration, and quadrille.gtkw, which shows it.
#include "golden/scenes/random_quads.hpp"
#include "tb/lockstep/fst_names.hpp"
#include "tb/lockstep/lockstep.hpp"
#include "tb/support/environment_error.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace quadrille::tb {
namespace {

TEST(Waveform, HasTheSignalsOfTheGtkwFile) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "quadrille_waveform_test.fst";
  std::filesystem::remove(file);
  LockstepOptions options;
  options.state = small_state(options.config);
  options.trace = file.string();
  options.optimise = 0;
  const std::vector<SnappedQuad> quads = random_quads(options.config, options.state, 9, 5);
  const LockstepReport report = run_lockstep(quads, options);
  EXPECT_TRUE(report.agreed()) << report.first_divergence.value_or("");
  const std::set<std::string> names = fst_signal_names(file.string());
  EXPECT_GT(names.size(), 1000u);

  // Lines of a signal begin with the top's name, or with another name as +{NAME}; others with one of [ * @ - and so on.
  std::ifstream gtkw(QUADRILLE_SOURCE_DIR "/tb/lockstep/quadrille.gtkw");
  std::size_t signals = 0;
  for (std::string line; std::getline(gtkw, line);) {
    if (line.starts_with("+{")) line.erase(0, line.find("} ") + 2);
    if (!line.starts_with("quadrille.")) continue;
    if (line.ends_with("[0]")) line.replace(line.size() - 3, 3, "[0:0]");  // GTKWave's name
    EXPECT_TRUE(names.contains(line)) << line;
    ++signals;
  }
  EXPECT_GT(signals, 40u);

  std::filesystem::remove(file);
  options.trace = "/nonexistent/directory/wave.fst";
  EXPECT_THROW(run_lockstep(quads, options), SystemError);
}

}  // namespace
}  // namespace quadrille::tb
