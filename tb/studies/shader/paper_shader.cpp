#include "tb/studies/shader/paper_shader.hpp"

#include "tb/studies/shader/gl_context.hpp"
#include "tb/support/environment_error.hpp"

#include <epoxy/gl.h>

#include <stdexcept>

namespace quadrille::tb {
namespace {

constexpr std::size_t vertices_per_quad = 4;

GLuint compile(GLenum stage, const std::string& text) {
  const GLuint shader = glCreateShader(stage);
  const char* lines = text.c_str();
  glShaderSource(shader, 1, &lines, nullptr);
  glCompileShader(shader);
  GLint done = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
  if (done == GL_TRUE) return shader;
  std::string log(4096, '\0');
  GLsizei length = 0;
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  throw std::logic_error("the shader does not compile: " + log);
}

GLuint link(const ShaderSource& source) {
  const GLuint program = glCreateProgram();
  for (const auto& [stage, text] : {std::pair{GL_VERTEX_SHADER, &source.vertex},
                                    {GL_GEOMETRY_SHADER, &source.geometry},
                                    {GL_FRAGMENT_SHADER, &source.fragment}}) {
    const GLuint shader = compile(stage, *text);
    glAttachShader(program, shader);
    glDeleteShader(shader);
  }
  glLinkProgram(program);
  GLint done = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &done);
  if (done == GL_TRUE) return program;
  std::string log(4096, '\0');
  GLsizei length = 0;
  glGetProgramInfoLog(program, static_cast<GLsizei>(log.size()), &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  throw std::logic_error("the shaders do not link: " + log);
}

}  // namespace

struct PaperShader::Impl {
  GlContext context;  // the first to come, the last to go: all else lives in it
  ShaderVariant variant;
  ShaderTargets targets;
  DrawState state;
  GLuint program = 0, vertices = 0, buffer = 0, frame = 0;
  std::vector<GLuint> textures;
  std::vector<float> numbers;
  std::vector<ShaderPixel> pixels;

  explicit Impl(const Settings& settings) : state(settings.state) {
    variant = {.attributes = state.attributes,
               .weights = settings.weights,
               .perspective = state.perspective,
               .depth = state.depth,
               .attributes_over_w = settings.snapped || state.perspective};
    targets = shader_targets(variant);
    make_targets();
    program = link(settings.source.fragment.empty() ? paper_shader_source(variant) : settings.source);
    set_uniforms(settings.snapped);
    make_vertices();
    glViewport(0, 0, state.width, state.height);
    glEnable(GL_SCISSOR_TEST);
    set_scissor();  // of a context without a surface it is empty
    glDisable(GL_DITHER);
  }

  /// What OpenGL holds goes with the context.
  ~Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  /// Row y of a target is row y of the picture: window coordinates are taken over as they are, so that OpenGL's y
  /// points down too.
  void make_targets() {
    GLint largest = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
    if (state.width > largest || state.height > largest)
      throw SystemError("the engine shader draws at most " + std::to_string(largest) + " pixels a side here");
    glGenFramebuffers(1, &frame);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    textures.resize(static_cast<std::size_t>(targets.all));
    glGenTextures(targets.all, textures.data());
    std::vector<GLenum> attached;
    for (const GLuint texture : textures) {
      glBindTexture(GL_TEXTURE_2D, texture);
      glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32F, state.width, state.height);
      attached.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(attached.size()));
      glFramebufferTexture(GL_FRAMEBUFFER, attached.back(), texture, 0);
    }
    glDrawBuffers(targets.all, attached.data());
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw EnvironmentError("this OpenGL does not draw into RGBA32F targets of " + std::to_string(state.width) + "x" +
                             std::to_string(state.height));
  }

  void set_uniforms(bool snapped) const {
    glUseProgram(program);
    const auto place = [&](const char* name) { return glGetUniformLocation(program, name); };
    glUniform2f(place("viewport"), static_cast<float>(state.width), static_cast<float>(state.height));
    glUniform1f(place("to_centre"), snapped ? 0.5F : 0.0F);
    glUniform1f(place("centre"), snapped ? 0.0F : 0.5F);
    glUniform2f(place("depths"), static_cast<float>(state.znear), static_cast<float>(state.zfar));
    glUniform2i(place("cull"), state.cull == Cull::back, state.cull == Cull::front);
  }

  void make_vertices() {
    glGenVertexArrays(1, &vertices);
    glBindVertexArray(vertices);
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    const int vectors = vertex_vectors(variant.attributes);
    for (int i = 0; i < vectors; ++i) {
      const auto index = static_cast<GLuint>(i);
      glEnableVertexAttribArray(index);
      glVertexAttribPointer(index, 4, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(vectors * 4 * sizeof(float)),
                            reinterpret_cast<const void*>(static_cast<std::uintptr_t>(i) * 4 * sizeof(float)));
    }
  }

  void set_scissor() const {
    glScissor(state.scissor_x0, state.scissor_y0, state.scissor_x1 - state.scissor_x0,
              state.scissor_y1 - state.scissor_y0);
  }

  static void no_error(const char* what) {
    if (const GLenum error = glGetError(); error != GL_NO_ERROR)
      throw SystemError(std::string("OpenGL: error ") + std::to_string(error) + " in " + what);
  }

  /// Component `component` of target `target` at pixel `i` of what read() has fetched.
  float number(std::size_t pixels_read, int target, std::size_t i, int component) const {
    return numbers[(static_cast<std::size_t>(target) * pixels_read + i) * 4 + static_cast<std::size_t>(component)];
  }
};

PaperShader::PaperShader(const Settings& settings) : impl_(std::make_unique<Impl>(settings)) {
  Impl::no_error("setting up");
}
PaperShader::~PaperShader() = default;

bool PaperShader::in_build() { return true; }
void PaperShader::require() { GlContext(); }
std::string PaperShader::renderer() const { return impl_->context.renderer(); }
std::string PaperShader::version() const { return impl_->context.version(); }

void PaperShader::load(const ShaderQuads& quads) {
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(quads.numbers().size_bytes()), quads.numbers().data(),
               GL_STATIC_DRAW);
  Impl::no_error("loading vertices");
}

void PaperShader::clear(const ShaderRect& rect) {
  glScissor(rect.x0, rect.y0, rect.x1 - rect.x0, rect.y1 - rect.y0);
  const float nothing[4] = {0, 0, 0, 0};
  for (int i = 0; i < impl_->targets.all; ++i) glClearBufferfv(GL_COLOR, i, nothing);
  impl_->set_scissor();
  glFinish();
}

void PaperShader::draw(std::size_t first, std::size_t count) {
  glDrawArrays(GL_LINES_ADJACENCY, static_cast<GLint>(first * vertices_per_quad),
               static_cast<GLsizei>(count * vertices_per_quad));
  glFinish();
  Impl::no_error("drawing");
}

std::uint64_t PaperShader::count(std::size_t first, std::size_t count) {
  GLuint query = 0;
  glGenQueries(1, &query);
  glBeginQuery(GL_SAMPLES_PASSED, query);
  draw(first, count);
  glEndQuery(GL_SAMPLES_PASSED);
  GLuint64 fragments = 0;
  glGetQueryObjectui64v(query, GL_QUERY_RESULT, &fragments);
  glDeleteQueries(1, &query);
  Impl::no_error("counting fragments");
  return fragments;
}

void PaperShader::fetch(const ShaderRect& rect) {
  const int width = rect.x1 - rect.x0, height = rect.y1 - rect.y0;
  const std::size_t n = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4;
  impl_->numbers.resize(n * static_cast<std::size_t>(impl_->targets.all));
  for (int i = 0; i < impl_->targets.all; ++i) {
    glReadBuffer(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i));
    glReadPixels(rect.x0, rect.y0, width, height, GL_RGBA, GL_FLOAT,
                 impl_->numbers.data() + n * static_cast<std::size_t>(i));
  }
  Impl::no_error("reading pixels");
}

std::span<const ShaderPixel> PaperShader::read(const ShaderRect& rect) {
  fetch(rect);
  const ShaderTargets& targets = impl_->targets;
  const std::size_t n = static_cast<std::size_t>(rect.x1 - rect.x0) * static_cast<std::size_t>(rect.y1 - rect.y0);
  impl_->pixels.assign(n, {});
  for (std::size_t i = 0; i < n; ++i) {
    const auto number = [&](int target, int component) { return impl_->number(n, target, i, component); };
    ShaderPixel& pixel = impl_->pixels[i];
    pixel.drawn = number(0, 0) != 0;
    if (!pixel.drawn) continue;
    pixel.front = number(0, 0) == 2;
    pixel.z = number(0, 1);
    for (int a = 0; a < impl_->variant.attributes; ++a) {
      const int place = a + 4 - ShaderTargets::attributes_in_first;
      pixel.attribute[static_cast<std::size_t>(a)] = number(place / 4, place % 4);
    }
    if (impl_->variant.weights)
      for (int c = 0; c < 4; ++c) pixel.lambda[static_cast<std::size_t>(c)] = number(targets.all - 1, c);
  }
  return impl_->pixels;
}

}  // namespace quadrille::tb
