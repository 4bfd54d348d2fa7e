// The responses of every stage suite at a level, computed and dropped: what scripts/golden_coverage.sh measures.
#include "golden/vectors/stage_suite.hpp"

#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
  using namespace quadrille;
  using namespace quadrille::vectors;
  GenerateOptions options;
  options.level = argc > 1 ? std::atoi(argv[1]) : 1;
  for (const auto& suite : suites()) {
    const auto* stages = dynamic_cast<const StageSuite*>(suite.get());
    if (stages == nullptr) continue;
    const auto stage = stages->stage(options.config);
    const StageSuite::Stimuli stimuli = stages->stimuli(options);
    std::uint64_t count = 0;
    for (const auto* list : {&stimuli.corner, &stimuli.random, &stimuli.realistic})
      for (const Record& record : *list) {
        stage->respond(record);
        ++count;
      }
    std::printf("%s: %llu vectors\n", stages->info().name.c_str(), static_cast<unsigned long long>(count));
  }
  return 0;
}
