// A target under libFuzzer. What it finds wrong ends the process, as libFuzzer expects.
#include "tb/fuzz/fuzz_target.hpp"

#include <cstddef>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const quadrille::fuzz::Target& target = quadrille::fuzz::target_named(QUADRILLE_FUZZ_TARGET);
  // What is refused stays in the corpus too: refusals are half of what a reader does.
  target.run({data, size});
  return 0;
}
