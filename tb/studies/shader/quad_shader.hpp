// Quads by shaders in fp32 on a real OpenGL.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"
#include "tb/studies/shader/quad_shader_source.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace quadrille::tb {

/// Quads as the vertex shader reads them: every number rounded to fp32 once.
class ShaderQuads {
 public:
  explicit ShaderQuads(int attributes) : attributes_(attributes) {}
  /// Snapped: relative to pixel centres at the integers; z and attributes with their bases, k_eff a and k z~.
  void add(const SnappedQuad& quad, const Config& config, bool perspective = true);
  /// As given, pixel centres at +0.5.
  void add(const WindowQuad& quad);

  void clear() { numbers_.clear(); }
  std::size_t size() const;  ///< quads
  std::span<const float> numbers() const { return numbers_; }

 private:
  int attributes_;
  std::vector<float> numbers_;
};

/// A rectangle of pixels, y down.
struct ShaderRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// What the shader left at a pixel.
struct ShaderPixel {
  bool drawn = false, front = false;
  float z = 0;
  std::array<float, 4> lambda{};
  std::array<float, max_attribute_slots> attribute{};
};

/// Draws into RGBA32F targets of the viewport's size. Without a depth buffer the last fragment of a pixel stays, and
/// the shader kills what the two triangles of a quad have outside it. To be used on the thread that made it.
class QuadShader {
 public:
  struct Settings {
    DrawState state;  ///< its attributes count
    bool weights = false;
    bool snapped = true;  ///< which of the two forms of ShaderQuads is drawn
    ShaderForm form = ShaderForm::printed;
    Triangles triangles = Triangles::split_012_023;  ///< where an eye in the hull needs them, as coverage says
    bool picture = false;                            ///< ShaderVariant::picture, with a depth buffer
    ShaderSource source = {};                        ///< a test puts faults here; empty: quad_shader_source()
  };
  /// Throws EnvironmentError where there is no OpenGL: not in this build, or not on this machine.
  explicit QuadShader(const Settings& settings);
  ~QuadShader();
  QuadShader(const QuadShader&) = delete;
  QuadShader& operator=(const QuadShader&) = delete;

  static bool in_build();
  /// Throws as the constructor does for want of OpenGL, sooner.
  static void require();

  std::string renderer() const;
  std::string version() const;

  /// Another form and other triangles from now on; a form is compiled when it is first chosen.
  void choose(ShaderForm form, Triangles triangles);
  /// Hands the quads to OpenGL; draw() takes them from there.
  void load(const ShaderQuads& quads);
  /// Makes the pixels of `rect` undrawn, and waits for that.
  void clear(const ShaderRect& rect);
  /// Clears picture and depth buffer, and draws all quads that are loaded into them.
  void draw_picture();
  /// Draws `count` of the loaded quads from the `first` one on, and waits until they are drawn.
  void draw(std::size_t first, std::size_t count);
  /// Fragments of `count` quads from the `first` one on, those that others hide too, by an occlusion query while it
  /// draws them.
  std::uint64_t count(std::size_t first, std::size_t count);
  /// Reads the targets into memory, which is a part of read().
  void fetch(const ShaderRect& rect);
  /// The pixels of a rectangle, row by row; the span is valid until the next call.
  std::span<const ShaderPixel> read(const ShaderRect& rect);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace quadrille::tb
