// In place of quad_shader.cpp where the build found no OpenGL.
#include "tb/studies/shader/quad_shader.hpp"

#include "tb/support/environment_error.hpp"

namespace quadrille::tb {

struct QuadShader::Impl {};

void QuadShader::require() {
  throw EnvironmentError(
      "the engine shader is not in this build: OpenGL was not found; install it (apt-get install libegl1-mesa-dev "
      "libgl1-mesa-dri libepoxy-dev), then configure and build again");
}
QuadShader::QuadShader(const Settings&) { require(); }
QuadShader::~QuadShader() = default;

bool QuadShader::in_build() { return false; }
std::string QuadShader::renderer() const { return {}; }
std::string QuadShader::version() const { return {}; }
void QuadShader::choose(ShaderForm, Triangles) {}
void QuadShader::load(const ShaderQuads&) {}
void QuadShader::clear(const ShaderRect&) {}
void QuadShader::draw_picture() {}
void QuadShader::draw(std::size_t, std::size_t) {}
std::uint64_t QuadShader::count(std::size_t, std::size_t) { return 0; }
void QuadShader::fetch(const ShaderRect&) {}
std::span<const ShaderPixel> QuadShader::read(const ShaderRect&) { return {}; }

}  // namespace quadrille::tb
