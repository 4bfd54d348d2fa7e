#include "tb/studies/method_input.hpp"

#include "tb/support/errors.hpp"

namespace quadrille::tb {

namespace methods = golden::methods;

std::vector<methods::Quad> method_quads(const DrawInput& input, const std::string& method) {
  const bool has_object_space = input.corners.size() == input.quads.size();
  if (!has_object_space && methods::make_method(method)->needs_object_space())
    throw UsageError("method " + method + " needs corners in object space, which " + input.name +
                     " does not have; use --scene or --mesh");
  std::vector<methods::Quad> quads(input.quads.size());
  for (std::size_t i = 0; i < quads.size(); ++i) {
    quads[i].vertex = input.quads[i].vertex;
    quads[i].attribute = input.quads[i].attribute;
    if (has_object_space) quads[i].object = input.corners[i], quads[i].texture = input.textures[i];
  }
  return quads;
}

std::unique_ptr<Engine> make_method_engine(const std::string& method, const DrawInput& input,
                                           const EngineSettings& settings) {
  return make_method_engine(method, method_quads(input, method), settings);
}

}  // namespace quadrille::tb
