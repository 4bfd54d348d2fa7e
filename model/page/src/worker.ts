// Runs the model in WebAssembly: a call with a request in, its answer out.
import { shader_pixels, type ShaderState } from "./shader";

interface Model {
  memory: WebAssembly.Memory;
  _initialize(): void;
  input(size: number): number;
  result(): number;
  result_size(): number;
  bytes(): number;
  bytes_size(): number;
  [call: string]: unknown;
}

export interface Call {
  id: number;
  call: string;
  text: string;
  /** Instead of the text: pixels of a picture that is so wide. */
  picture?: { width: number; bytes: Uint8ClampedArray };
  /** Numbers that the call takes. */
  numbers?: number[];
}

export interface Answer {
  id: number;
  /** Of the call alone, in milliseconds. */
  time: number;
  result?: Record<string, unknown>;
  bytes?: ArrayBuffer;
  error?: string;
}

/** The module asks for these and uses none of them: it has no files, no clock and no environment. */
const no_system = new Proxy({}, { get: () => () => 52 }) as WebAssembly.ModuleImports;

const loading = (async (): Promise<Model> => {
  const response = await fetch("quadrille.wasm");
  if (!response.ok) throw new Error(`quadrille.wasm: status ${response.status}`);
  const { instance } = await WebAssembly.instantiate(await response.arrayBuffer(), {
    wasi_snapshot_preview1: no_system,
  });
  const model = instance.exports as unknown as Model;
  model._initialize();
  return model;
})();

/** One call of the module. `input`: what it reads. */
function run(model: Model, call: string, input: Uint8Array, numbers: number[]) {
  const place = model.input(input.length);  // may move the memory
  new Uint8Array(model.memory.buffer, place, input.length).set(input);
  const failed = (model[call] as (...numbers: number[]) => number)(...numbers);
  const words = new Uint8Array(model.memory.buffer, model.result(), model.result_size());
  // Integers that are no doubles stay text.
  const text = new TextDecoder().decode(words).replace(/(: )(-?\d{16,})(?=[,}])/g, '$1"$2"');
  const result = JSON.parse(text);
  if (failed) throw new Error(result.error);
  return { result, bytes: model.memory.buffer.slice(model.bytes(), model.bytes() + model.bytes_size()) as ArrayBuffer };
}

async function answer({ id, call, text, picture, numbers = [] }: Call): Promise<Answer> {
  try {
    const model = await loading;
    const start = performance.now();
    const request = new Uint8Array(picture?.bytes ?? new TextEncoder().encode(text));
    // `shader` gives the numbers of a view `fp32` themselves.
    const by_shader = ["view", "shader"].includes(call) && text.match(/^view=fp32(_determinant)?/m);
    let made;
    if (by_shader) {
      const quads = run(model, "shader_quads", request, []), vertices = new Float32Array(quads.bytes);
      const pixels = await shader_pixels(by_shader[1] ? "determinant" : "printed", vertices, quads.result as ShaderState);
      if (call === "view") made = run(model, "shader_view", new Uint8Array(pixels.buffer), []);
      else made = { result: { ...quads.result, vertices: [...vertices] }, bytes: pixels.buffer as ArrayBuffer };
    } else {
      made = run(model, call, request, picture ? [picture.width] : numbers);
    }
    return { id, time: performance.now() - start, ...made };
  } catch (error) {
    return { id, time: 0, error: error instanceof Error ? error.message : String(error) };
  }
}

/** One call after the other. */
let last = Promise.resolve();
self.onmessage = (event: MessageEvent<Call>) => {
  last = last.then(async () => {
    const reply = await answer(event.data);
    (self as unknown as Worker).postMessage(reply, reply.bytes ? [reply.bytes] : []);
  });
};
