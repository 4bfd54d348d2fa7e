// The core program is without the studies.
#include "tb/commands/commands.hpp"

namespace quadrille::tb {

void (*const add_studies)(CLI::App& app, Invocation& invocation) = nullptr;

}  // namespace quadrille::tb
