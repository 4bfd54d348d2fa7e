// Runs the model in WebAssembly: a call with a request in, its answer out.

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

async function answer({ id, call, text: request_text, picture, numbers = [] }: Call): Promise<Answer> {
  try {
    const model = await loading;
    const request = picture?.bytes ?? new TextEncoder().encode(request_text);
    const place = model.input(request.length);  // may move the memory
    new Uint8Array(model.memory.buffer, place, request.length).set(request);
    const start = performance.now();
    const failed = (model[call] as (...numbers: number[]) => number)(...(picture ? [picture.width] : numbers));
    const time = performance.now() - start;
    const words = new Uint8Array(model.memory.buffer, model.result(), model.result_size());
    // Integers that are no doubles stay text.
    const text = new TextDecoder().decode(words).replace(/(: )(-?\d{16,})(?=[,}])/g, '$1"$2"');
    const result = JSON.parse(text);
    if (failed) return { id, time, error: result.error };
    const bytes = model.memory.buffer.slice(model.bytes(), model.bytes() + model.bytes_size());
    return { id, time, result, bytes: bytes as ArrayBuffer };
  } catch (error) {
    return { id, time: 0, error: String(error) };
  }
}

self.onmessage = async (event: MessageEvent<Call>) => {
  const reply = await answer(event.data);
  (self as unknown as Worker).postMessage(reply, reply.bytes ? [reply.bytes] : []);
};
