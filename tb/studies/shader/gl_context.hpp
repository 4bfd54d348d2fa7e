// OpenGL without a window: EGL on Mesa's surfaceless platform.
#pragma once

#include <string>

namespace quadrille::tb {

/// A context of OpenGL 4.5 core, current on the thread that made it until it is destroyed there. Unless the environment
/// says otherwise the software rasterizer draws (LIBGL_ALWAYS_SOFTWARE), in the calling thread alone
/// (LP_NUM_THREADS=0), and keeps no compiled shaders on disk (MESA_SHADER_CACHE_DISABLE); the first context of a
/// process sets these variables, so make it before other threads read the environment.
class GlContext {
 public:
  /// Throws EnvironmentError, which says what is missing, where there is no EGL, no such platform or no such context.
  GlContext();
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  std::string renderer() const;  ///< "llvmpipe (LLVM 15.0.6, 256 bits)"
  std::string version() const;   ///< "4.5 (Core Profile) Mesa 22.3.6"

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace quadrille::tb
