#include "golden/suites/machine_run.hpp"

#include "model/clocked.hpp"
#include "model/support/prng.hpp"

namespace quadrille::vectors {

std::vector<StallClock> make_stalls(std::uint64_t seed, std::size_t length) {
  golden::Prng random(seed, 0x5741);
  std::vector<StallClock> stalls(length);
  // Each side changes between a lively and a sleepy spell, so that queues run full and empty.
  double offer = 0.9, ready = 0.9;
  for (StallClock& clock : stalls) {
    if (random.chance(1.0 / 32)) offer = random.chance(0.5) ? 0.95 : 0.3;
    if (random.chance(1.0 / 32)) ready = random.chance(0.5) ? 0.95 : 0.3;
    clock = {random.chance(offer), random.chance(ready)};
  }
  if (!stalls.empty()) stalls.front() = {};
  return stalls;
}

MachineRun run_machine(std::span<const SnappedQuad> quads, const Config& config, const DrawState& state,
                       std::span<const StallClock> stalls) {
  ClockedModel model(config, state);
  ClockedInputs reset;
  reset.reset = true;
  model.clock(reset);

  MachineRun run;
  ClockedInputs inputs;
  std::size_t next = 0;  // beat
  const std::size_t beats = 4 * quads.size();
  bool offered = false;
  for (std::uint32_t clock = 0;; ++clock) {
    const StallClock now = stalls.empty() ? StallClock{} : stalls[clock % stalls.size()];
    if (!offered && next < beats && now.offer) {
      offered = true;
      inputs.vertex_id = quads[next / 4].id;
      inputs.vertex = quads[next / 4].vertex[next % 4];
    }
    inputs.vertex_valid = offered;
    inputs.fragment_ready = now.ready;
    const ClockedOutputs out = model.comb();
    if (out.fragment_valid && now.ready) run.fragments.push_back({out.fragment, clock});
    if (next == beats && !out.busy) return run;
    if (offered && out.vertex_ready) {
      run.taken.push_back(clock);
      ++next;
      offered = false;
    }
    model.clock(inputs);
  }
}

}  // namespace quadrille::vectors
