// In place of paper_shader.cpp where the build found no OpenGL.
#include "tb/studies/shader/paper_shader.hpp"

#include "tb/support/environment_error.hpp"

namespace quadrille::tb {

struct PaperShader::Impl {};

void PaperShader::require() {
  throw EnvironmentError(
      "the engine shader is not in this build: OpenGL was not found; install it (apt-get install libegl1-mesa-dev "
      "libgl1-mesa-dri libepoxy-dev), then configure and build again");
}
PaperShader::PaperShader(const Settings&) { require(); }
PaperShader::~PaperShader() = default;

bool PaperShader::in_build() { return false; }
std::string PaperShader::renderer() const { return {}; }
std::string PaperShader::version() const { return {}; }
void PaperShader::load(const ShaderQuads&) {}
void PaperShader::clear(const ShaderRect&) {}
void PaperShader::draw(std::size_t, std::size_t) {}
std::uint64_t PaperShader::count(std::size_t, std::size_t) { return 0; }
void PaperShader::fetch(const ShaderRect&) {}
std::span<const ShaderPixel> PaperShader::read(const ShaderRect&) { return {}; }

}  // namespace quadrille::tb
