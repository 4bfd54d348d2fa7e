// The commands of the studies in the core program: names and descriptions.
#include "tb/commands/commands.hpp"

#include "tb/support/errors.hpp"

#include <CLI/CLI.hpp>

#include <string>
#include <utility>

namespace quadrille::cli {

void add_study_commands(CLI::App& app, Invocation& invocation) {
  for (const auto& [name, description] :
       {std::pair{"bench", bench_description}, {"compare", compare_description}, {"stress", stress_description}}) {
    CLI::App* command = app.add_subcommand(name, description);
    command->set_help_flag();  // that of the other program
    command->prefix_command();
    command->callback([name = std::string(name), &invocation] {
      invocation.run = [name]() -> int { throw StudyNeeded("the command " + name); };
    });
  }
}

}  // namespace quadrille::cli
