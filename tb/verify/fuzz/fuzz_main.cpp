// A target under libFuzzer. What it finds wrong ends the process, as libFuzzer expects.
#include "tb/verify/fuzz/fuzz_target.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto target =
      std::ranges::find(quadrille::fuzz::targets(), QUADRILLE_FUZZ_TARGET, &quadrille::fuzz::Target::name);
  if (target == quadrille::fuzz::targets().end()) std::abort();
  // What is refused stays in the corpus too: refusals are half of what a reader does.
  target->run({data, size});
  return 0;
}
