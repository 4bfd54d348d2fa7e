// The formulas in single precision: quads by WebGL2 into textures of floats.
import mean_value from "../../../golden/shaders/mean_value_quad.glsl";
import paper from "../../../golden/shaders/paper_quad.glsl";
import fragment from "./quad.fragment.glsl";
import vertex from "./quad.vertex.glsl";

/** Of a request, by the module's call `shader_quads`. */
export interface ShaderState {
  width: number;
  height: number;
  perspective: boolean;
  depth: boolean;
  cull: string;
  znear: number;
  zfar: number;
}

const corner_vectors = ["corners_x", "corners_y", "corners_w", "corners_k", "corners_z"];
const canvas = new OffscreenCanvas(1, 1);
let context: WebGL2RenderingContext | null = null;
let programs = new Map<string, WebGLProgram>();

function open(): WebGL2RenderingContext {
  if (context && !context.isContextLost()) return context;
  programs = new Map();
  context = canvas.getContext("webgl2", { antialias: false, depth: false });
  if (!context) throw new Error("this browser has no WebGL2, which this view needs");
  if (!context.getExtension("EXT_color_buffer_float"))
    throw new Error("this browser's WebGL2 has no EXT_color_buffer_float, which this view needs");
  return context;
}

function program_of(gl: WebGL2RenderingContext, form: string): WebGLProgram {
  const made = programs.get(form);
  if (made) return made;
  const define = `#define DETERMINANT ${Number(form === "determinant")}\n`;
  const head = `#version 300 es\nprecision highp float;\n${define}${mean_value}${paper}`;
  const program = gl.createProgram()!;
  for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]] as const) {
    const shader = gl.createShader(type)!;
    gl.shaderSource(shader, head + text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost())
      throw new Error(`the shader does not compile: ${gl.getShaderInfoLog(shader)}`);
  }
  corner_vectors.forEach((name, i) => gl.bindAttribLocation(program, i, name));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS))
    throw new Error(`the shaders do not link: ${gl.getProgramInfoLog(program)}`);
  programs.set(form, program);
  return program;
}

/**
 * `quads`: of each x, y, w, k, z of its corners. Returns of each pixel, row by row from the top, four weights, then of
 * each the quad + 1 (0: none), window z, what is negative of a front, and 0.
 */
export async function shader_pixels(form: string, quads: Float32Array, state: ShaderState): Promise<Float32Array> {
  const gl = open();
  const { width, height } = state;
  const largest = gl.getParameter(gl.MAX_RENDERBUFFER_SIZE) as number;
  if (Math.max(width, height) > largest) throw new Error(`WebGL2 draws at most ${largest} pixels a side here`);
  const program = program_of(gl, form);
  const frame = gl.createFramebuffer(), array = gl.createVertexArray();
  const buffer = gl.createBuffer(), read = gl.createBuffer();
  const targets = [gl.RGBA32F, gl.RGBA32F, gl.DEPTH_COMPONENT32F].map((format, i) => {
    const target = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, target);
    gl.renderbufferStorage(gl.RENDERBUFFER, format, width, height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    const place = i < 2 ? gl.COLOR_ATTACHMENT0 + i : gl.DEPTH_ATTACHMENT;
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, target);
    return target;
  });
  const out = new Float32Array(8 * width * height);
  try {
    if (gl.checkFramebufferStatus(gl.FRAMEBUFFER) !== gl.FRAMEBUFFER_COMPLETE)
      throw new Error("this browser's WebGL2 does not draw into pictures of floats");
    gl.drawBuffers([gl.COLOR_ATTACHMENT0, gl.COLOR_ATTACHMENT1]);
    gl.viewport(0, 0, width, height);
    for (const i of [0, 1]) gl.clearBufferfv(gl.COLOR, i, [0, 0, 0, 0]);
    gl.clearBufferfv(gl.DEPTH, 0, [1]);
    gl.disable(gl.DITHER);
    (state.depth ? gl.enable : gl.disable).call(gl, gl.DEPTH_TEST);
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, quads, gl.STATIC_DRAW);
    corner_vectors.forEach((_, i) => {
      gl.enableVertexAttribArray(i);
      gl.vertexAttribPointer(i, 4, gl.FLOAT, false, 16 * corner_vectors.length, 16 * i);
      gl.vertexAttribDivisor(i, 1);
    });
    gl.useProgram(program);
    const place = (name: string) => gl.getUniformLocation(program, name);
    gl.uniform2f(place("viewport"), width, height);
    gl.uniform2f(place("depths"), state.znear, state.zfar);
    gl.uniform2i(place("cull"), Number(state.cull === "back"), Number(state.cull === "front"));
    gl.uniform1i(place("perspective"), Number(state.perspective));
    gl.uniform1i(place("depth"), Number(state.depth));
    gl.drawArraysInstanced(gl.TRIANGLES, 0, 6, quads.length / (4 * corner_vectors.length));
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, read);
    gl.bufferData(gl.PIXEL_PACK_BUFFER, out.byteLength, gl.STREAM_READ);
    for (const i of [0, 1]) {
      gl.readBuffer(gl.COLOR_ATTACHMENT0 + i);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, (i * out.byteLength) / 2);
    }
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0)!;
    gl.flush();
    while (gl.clientWaitSync(fence, 0, 0) === gl.TIMEOUT_EXPIRED) await new Promise((done) => setTimeout(done, 1));
    gl.deleteSync(fence);
    gl.getBufferSubData(gl.PIXEL_PACK_BUFFER, 0, out);
    const error = gl.getError();
    if (error !== gl.NO_ERROR) throw new Error(`WebGL2: error ${error}`);
  } finally {
    targets.forEach((target) => gl.deleteRenderbuffer(target));
    gl.deleteFramebuffer(frame);
    gl.deleteBuffer(buffer);
    gl.deleteBuffer(read);
    gl.deleteVertexArray(array);
  }
  return out;
}
