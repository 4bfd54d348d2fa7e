// What makes of main() the program of the studies.
#include "tb/studies/studies.hpp"

#include "golden/io/import_mesh.hpp"
#include "golden/methods/method.hpp"
#include "tb/commands/commands.hpp"
#include "tb/options/input.hpp"
#include "tb/studies/method_input.hpp"
#include "tb/studies/shader/shader_engine.hpp"

namespace quadrille::tb {

namespace {

void add(CLI::App& app, Invocation& invocation) {
  add_bench_command(app, invocation);
  add_compare_command(app, invocation);
  add_stress_command(app, invocation);
  set_shader_engine(make_shader_engine);
  mesh_importer = golden::import_mesh;
  invocation.method = [](const std::string& name) -> MethodEngineMaker {
    golden::methods::make_method(name);  // an unknown one is refused before the input is read
    return [name](const DrawInput& input, const EngineSettings& settings) {
      return make_method_engine(name, input, settings);
    };
  };
}

}  // namespace

void (*const add_studies)(CLI::App& app, Invocation& invocation) = add;

}  // namespace quadrille::tb
