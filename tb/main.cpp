// The programs `quadrille` and `quadrille-studies`: commands, and what ends them.
#include "golden/io/error.hpp"
#include "golden/io/interrupt.hpp"
#include "golden/io/json_report.hpp"
#include "model/port/config.hpp"
#include "model/port/snap.hpp"
#include "model/support/edit_distance.hpp"
#include "model/support/lane_target.hpp"
#include "tb/commands/commands.hpp"
#include "tb/device/verilate.hpp"
#include "tb/lockstep/lockstep.hpp"
#include "tb/options/command_line.hpp"
#include "tb/support/choices.hpp"
#include "tb/support/environment_error.hpp"
#include "tb/support/errors.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace {

using namespace quadrille;
using namespace quadrille::tb;

int fail(int status, const std::string& what) {
  golden::yield_to_interrupt();
  std::fprintf(stderr, "quadrille: %s\n", what.c_str());
  return status;
}

/// Help and version requests end here too.
int parse_failure(const CLI::App& app, const CLI::ParseError& error, const std::vector<std::string>& arguments) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app.exit(error);
  std::string place = "quadrille";
  std::vector<std::string> options;
  for (const CLI::App* at = &app; !at->get_subcommands().empty();) {
    at = at->get_subcommands().front();
    place += " " + at->get_name();
    for (const CLI::Option* option : at->get_options())
      for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  }
  std::string text = error.what();
  // A mistyped option deserves a suggestion.
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    for (const std::string& argument : arguments) {
      const std::string name = argument.substr(0, argument.find('='));
      if (name.starts_with("--") && std::find(options.begin(), options.end(), name) == options.end()) {
        if (const std::string near = nearest_name(name, options); !near.empty())
          text += " (did you mean " + near + "?)";
        break;
      }
    }
  }
  return fail(exit_usage, text + "; see `" + place + " --help`");
}

/// An option given without a value, as by a variable of the shell that is not set, is no option left out.
void refuse_empty_values(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options())
    if (option->get_expected_min() > 0 && std::ranges::count(option->results(), "") != 0)
      throw UsageError(option->get_name() + ": the value is empty");
  for (const CLI::App* command : app.get_subcommands()) refuse_empty_values(*command);
}

/// The commands of the studies in the core: names, upon which main() calls the other program.
void name_studies(CLI::App& app, Invocation& invocation) {
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

/// --help of a command and of its own commands.
void group_help(CLI::App& command) {
  if (CLI::Option* help = command.get_help_ptr()) help->description("Print this help")->group(general_group);
  for (CLI::App* sub : command.get_subcommands({})) group_help(*sub);
}

int run(int argc, char** argv) {
  Invocation invocation;
  invocation.arguments.assign(argv, argv + argc);
  if (!invocation.arguments.empty()) invocation.arguments[0] = "quadrille";

  CLI::App app("Quadrille draws a quadrilateral as one primitive, with mean value coordinates.");
  app.formatter(help_formatter());
  app.name("quadrille");
  app.require_subcommand(1);
  const std::string version = "quadrille " + std::string(golden::program_version());
  app.set_version_flag("--version", version, "Print the version")->group(general_group);
  end_help(app, "`quadrille COMMAND --help` has the options of a command.",
           "0 done and within bounds; 1 mismatch or bound exceeded; 2 usage or input error; 3 missing tool",
           {"scenes", "cosim --scene fig7_floor", "render --scene sphere --png sphere.png"});
  add_cosim_command(app, invocation);
  add_render_command(app, invocation);
  add_fragments_command(app, invocation);
  add_explain_command(app, invocation);
  add_config_command(app, invocation);
  add_export_command(app, invocation);
  add_scenes_command(app, invocation);
  add_sweep_command(app, invocation);
  add_golden_command(app, invocation);
  add_cache_command(app, invocation);
  if (add_studies != nullptr)
    add_studies(app, invocation);
  else
    name_studies(app, invocation);
  group_help(app);
  std::vector<std::string> commands;
  for (CLI::App* command : app.get_subcommands({})) {
    command->set_version_flag("--version", version, "Print the version")->group(general_group);
    commands.push_back(command->get_name());
  }

  if (const char* lanes = std::getenv("QUADRILLE_LANES"); lanes != nullptr && *lanes != '\0') set_lane_target(lanes);
  if (argc > 1 && argv[1][0] != '-') choose("command", argv[1], commands);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return parse_failure(app, error, invocation.arguments);
  }
  refuse_empty_values(app);
  return invocation.run();
}

/// The same command line by the program of the studies, which stands beside this one. Returns when there is none.
int run_studies(char** argv, const std::string& what) {
  std::error_code error;
  const std::filesystem::path studies =
      std::filesystem::read_symlink("/proc/self/exe", error).replace_filename("quadrille-studies");
  execv(studies.c_str(), argv);
  return fail(exit_environment, what + " is not built: " + studies.string() + ": " + std::strerror(errno) +
                                    "; scripts/setup.sh builds it");
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files becomes an error of the write
  golden::watch_interrupts();
  try {
    const int status = run(argc, argv);
    golden::yield_to_interrupt();
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) return fail(exit_usage, "cannot write standard output");
    return status;
  } catch (const StudyNeeded& needed) {
    return run_studies(argv, needed.what());
  } catch (const UsageError& error) {
    return fail(exit_usage, error.what());
  } catch (const golden::InputError& error) {
    return fail(exit_usage, error.what());
  } catch (const ConfigError& error) {
    return fail(exit_usage, error.what());
  } catch (const SnapError& error) {
    return fail(exit_usage, error.what());
  } catch (const tb::EnvironmentError& error) {
    return fail(exit_environment, error.what());
  } catch (const tb::SystemError& error) {
    return fail(exit_usage, error.what());
  } catch (const tb::VerilateError& error) {
    return fail(exit_usage, error.what());
  } catch (const tb::DeviceError& error) {
    return fail(exit_mismatch, error.what());
  } catch (const tb::WatchdogError& error) {
    return fail(exit_mismatch, error.what());
  } catch (const std::bad_alloc&) {
    return fail(exit_usage, "out of memory");
  } catch (const std::invalid_argument& error) {
    return fail(exit_usage, error.what());
  } catch (const std::exception& error) {
    return fail(exit_mismatch, std::string("internal error: ") + error.what());
  }
}
