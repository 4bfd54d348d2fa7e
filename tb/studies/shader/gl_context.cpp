#include "tb/studies/shader/gl_context.hpp"

#include "tb/support/environment_error.hpp"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <cstdlib>

namespace quadrille::tb {
namespace {

constexpr const char* needs =
    "; the engine shader needs Mesa's EGL and OpenGL (apt-get install libegl1 libgl1-mesa-dri)";

std::string text(const GLubyte* string) {
  return string == nullptr ? std::string() : reinterpret_cast<const char*>(string);
}

}  // namespace

GlContext::GlContext() {
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 0);
  setenv("LP_NUM_THREADS", "0", 0);
  setenv("MESA_SHADER_CACHE_DISABLE", "true", 0);
  // epoxy would end the process.
  if (dlopen("libEGL.so.1", RTLD_LAZY | RTLD_GLOBAL) == nullptr)
    throw EnvironmentError(std::string("no OpenGL: libEGL.so.1 cannot be loaded") + needs);

  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
    throw EnvironmentError(std::string("no OpenGL: EGL has no surfaceless platform") + needs);
  display_ = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display_ == EGL_NO_DISPLAY || eglInitialize(display_, nullptr, nullptr) == EGL_FALSE)
    throw EnvironmentError(std::string("no OpenGL: EGL's surfaceless display does not open") + needs);
  eglBindAPI(EGL_OPENGL_API);
  const EGLint wanted[] = {
      EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
  if (context_ == EGL_NO_CONTEXT || eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_FALSE) {
    if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
    throw EnvironmentError(std::string("no OpenGL: EGL gives no context of OpenGL 4.5 without a surface") + needs);
  }
}

/// The display stays open: it is one for the whole process.
GlContext::~GlContext() {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
}

std::string GlContext::renderer() const { return text(glGetString(GL_RENDERER)); }
std::string GlContext::version() const { return text(glGetString(GL_VERSION)); }

}  // namespace quadrille::tb
