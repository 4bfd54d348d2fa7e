#include "tb/studies/shader/quad_shader.hpp"

#include "tb/studies/shader/gl_context.hpp"
#include "tb/support/environment_error.hpp"

#include <epoxy/gl.h>

#include <array>
#include <map>
#include <stdexcept>

namespace quadrille::tb {
namespace {

constexpr std::size_t indices_per_quad = 6;
constexpr std::array<std::array<GLuint, indices_per_quad>, 2> corners_of{{{0, 1, 3, 1, 2, 3}, {0, 1, 2, 0, 2, 3}}};

/// Clearing a target of floats by drawing takes llvmpipe two thirds of the time of glClear.
const ShaderSource clear_source{
    "#version 450 core\nvoid main() { gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0, 1); "
    "}",
    "#version 450 core\nlayout(location = 0) out vec4 target;\nvoid main() { target = vec4(0); }"};

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
  for (const auto& [stage, text] :
       {std::pair{GL_VERTEX_SHADER, &source.vertex}, {GL_FRAGMENT_SHADER, &source.fragment}}) {
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

struct QuadShader::Impl {
  GlContext context;  // the first to come, the last to go: all else lives in it
  ShaderVariant variant;
  ShaderTargets targets;
  DrawState state;
  bool snapped;
  ShaderSource source;
  Triangles triangles;
  std::map<ShaderForm, GLuint> programs;  ///< those that were chosen
  GLuint program = 0, clear_program = 0, corners = 0, frame = 0, depth = 0;
  std::size_t loaded = 0;  ///< quads
  std::vector<GLuint> textures;
  std::vector<float> numbers;
  std::vector<ShaderPixel> pixels;

  explicit Impl(const Settings& settings)
      : state(settings.state), snapped(settings.snapped), source(settings.source), triangles(settings.triangles) {
    variant = {.form = settings.form,
               .picture = settings.picture,
               .attributes = state.attributes,
               .weights = settings.weights,
               .perspective = state.perspective,
               .depth = state.depth,
               .attributes_over_w = settings.snapped || state.perspective};
    targets = shader_targets(variant);
    make_targets();
    choose(settings.form, settings.triangles);
    make_vertices();
    glViewport(0, 0, state.width, state.height);
    if (variant.picture) {
      clear_program = link(clear_source);
    } else {
      glEnable(GL_SCISSOR_TEST);
      set_scissor();  // of a context without a surface it is empty
    }
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
    if (variant.picture) {
      glGenTextures(1, &depth);
      glBindTexture(GL_TEXTURE_2D, depth);
      glTexStorage2D(GL_TEXTURE_2D, 1, GL_DEPTH_COMPONENT32F, state.width, state.height);
      glFramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, depth, 0);
    }
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw EnvironmentError("this OpenGL does not draw into RGBA32F targets of " + std::to_string(state.width) + "x" +
                             std::to_string(state.height));
  }

  void choose(ShaderForm form, Triangles of_quad) {
    triangles = of_quad;
    variant.form = form;
    GLuint& own = programs[form];
    if (own == 0) own = link(source.fragment.empty() ? quad_shader_source(variant) : source);
    program = own;
    glUseProgram(program);
    set_uniforms();
  }

  void set_uniforms() const {
    const auto place = [&](const char* name) { return glGetUniformLocation(program, name); };
    glUniform2f(place("viewport"), static_cast<float>(state.width), static_cast<float>(state.height));
    glUniform1f(place("to_centre"), snapped ? 0.5F : 0.0F);
    glUniform2f(place("depths"), static_cast<float>(state.znear), static_cast<float>(state.zfar));
    glUniform2i(place("cull"), state.cull == Cull::back, state.cull == Cull::front);
  }

  /// The vertex shader fetches corners from a texture buffer, which here is quicker than vertex attributes (each vertex
  /// needs all four corners), a storage buffer or a geometry shader.
  void make_vertices() {
    GLuint array = 0, indices = 0, texture = 0;
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glGenBuffers(1, &indices);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
    glGenBuffers(1, &corners);
    glBindBuffer(GL_TEXTURE_BUFFER, corners);
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_BUFFER, texture);
    glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, corners);
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

QuadShader::QuadShader(const Settings& settings) : impl_(std::make_unique<Impl>(settings)) {
  Impl::no_error("setting up");
}
QuadShader::~QuadShader() = default;

bool QuadShader::in_build() { return true; }
void QuadShader::require() { GlContext(); }
std::string QuadShader::renderer() const { return impl_->context.renderer(); }
std::string QuadShader::version() const { return impl_->context.version(); }

void QuadShader::choose(ShaderForm form, Triangles triangles) { impl_->choose(form, triangles); }

void QuadShader::load(const ShaderQuads& quads) {
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  if (quads.numbers().size() / 4 > static_cast<std::size_t>(most))
    throw SystemError("OpenGL: a texture buffer holds at most " + std::to_string(most) + " vectors");
  impl_->loaded = quads.size();
  glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(quads.numbers().size_bytes()), quads.numbers().data(),
               GL_STATIC_DRAW);
  std::vector<GLuint> indices;
  for (const auto& corners : corners_of)
    for (std::size_t q = 0; q < impl_->loaded; ++q)
      for (const GLuint corner : corners) indices.push_back(static_cast<GLuint>(4 * q) + corner);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(GLuint)), indices.data(),
               GL_STATIC_DRAW);
  Impl::no_error("loading vertices");
}

void QuadShader::clear(const ShaderRect& rect) {
  glScissor(rect.x0, rect.y0, rect.x1 - rect.x0, rect.y1 - rect.y0);
  const float nothing[4] = {0, 0, 0, 0};
  for (int i = 0; i < impl_->targets.all; ++i) glClearBufferfv(GL_COLOR, i, nothing);
  impl_->set_scissor();
  glFinish();
}

void QuadShader::draw_picture() {
  const float farthest = 1;
  glClearBufferfv(GL_DEPTH, 0, &farthest);
  glDisable(GL_DEPTH_TEST);
  glUseProgram(impl_->clear_program);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
  glUseProgram(impl_->program);
  draw(0, impl_->loaded);
}

void QuadShader::draw(std::size_t first, std::size_t count) {
  first += impl_->triangles == Triangles::split_012_023 ? impl_->loaded : 0;
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(count * indices_per_quad), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(first * indices_per_quad * sizeof(GLuint)));
  glFinish();
  Impl::no_error("drawing");
}

std::uint64_t QuadShader::count(std::size_t first, std::size_t count) {
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

void QuadShader::fetch(const ShaderRect& rect) {
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

std::span<const ShaderPixel> QuadShader::read(const ShaderRect& rect) {
  fetch(rect);
  const ShaderTargets& targets = impl_->targets;
  const std::size_t n = static_cast<std::size_t>(rect.x1 - rect.x0) * static_cast<std::size_t>(rect.y1 - rect.y0);
  impl_->pixels.assign(n, {});
  for (std::size_t i = 0; i < n; ++i) {
    const auto number = [&](int target, int component) { return impl_->number(n, target, i, component); };
    ShaderPixel& pixel = impl_->pixels[i];
    pixel.drawn = number(0, 3) != 0;
    if (!pixel.drawn) continue;
    pixel.front = number(0, 3) == 2;
    pixel.z = number(0, 2);
    for (int a = 0; a < impl_->variant.attributes; ++a) {
      const int after = a - ShaderTargets::attributes_in_first;
      pixel.attribute[static_cast<std::size_t>(a)] = after < 0 ? number(0, a) : number(1 + after / 4, after % 4);
    }
    if (impl_->variant.weights)
      for (int c = 0; c < 4; ++c) pixel.lambda[static_cast<std::size_t>(c)] = number(targets.all - 1, c);
  }
  return impl_->pixels;
}

}  // namespace quadrille::tb
