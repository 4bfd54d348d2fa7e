// The model as the page sees it: asynchronous calls to a worker.
import type { Answer, Call } from "./worker";

export class Model {
  private worker = new Worker("worker.js");
  private waiting = new Map<number, (answer: Answer) => void>();
  private next = 0;

  constructor() {
    this.worker.onmessage = ({ data }: MessageEvent<Answer>) => {
      this.waiting.get(data.id)?.(data);
      this.waiting.delete(data.id);
    };
    this.worker.onerror = (event) => {
      for (const [id, done] of this.waiting) done({ id, time: 0, error: event.message || "worker.js does not load" });
      this.waiting.clear();
    };
  }

  call(call: string, text = "", picture?: Call["picture"], numbers?: number[]): Promise<Answer> {
    const id = this.next++;
    this.worker.postMessage({ id, call, text, picture, numbers } satisfies Call);
    return new Promise((done) => this.waiting.set(id, done));
  }
}

/** One call at a time; of the requests that wait only the newest is made. */
export class Latest {
  busy = false;
  private pending: string | null = null;

  constructor(
    private model: Model,
    private name: string,
    /** `last`: no other answer comes soon. */
    private show: (answer: Answer, text: string, last: boolean) => void,
  ) {}

  async ask(text: string) {
    this.pending = text;
    if (this.busy) return;
    this.busy = true;
    let next = this.start();
    while (next !== null) {
      const { answer, text } = next;
      const made = await answer;
      next = this.start();  // while this one is shown
      this.show(made, text, next === null);
      next ??= this.start();
    }
    this.busy = false;
  }

  private start() {
    if (this.pending === null) return null;
    const text = this.pending;
    this.pending = null;
    return { text, answer: this.model.call(this.name, text) };
  }
}

export interface Vertex {
  position: [number, number, number];
  x: number;
  y: number;
  z: number;
  w: number;
}

export interface Drawn {
  scene: string;
  shade: string;
  texture: string;
  perspective: boolean;
  cull: string;
  /** What only some scenes have to shade. */
  planes: boolean;
  colours: boolean;
  is_scene: boolean;
  quads: number;
  matrix: number[];
  vertices: Vertex[];
  stats: Record<string, number>;
}

export interface Key {
  name: string;
  minimum: number;
  maximum: number;
  standard: number;
  unit: string;
  meaning: string;
}

export interface Scene {
  name: string;
  title: string;
  paper: string;
  quads: number;
}

export interface Lists {
  scenes: Scene[];
  workloads: Scene[];
  keys: Key[];
}

export interface Configuration {
  resolved: Record<string, number>;
  bound: number | null;
  proved: boolean;
  reason: string;
  luts: number;
  dsps: number;
  block_rams: number;
  state_bits: number;
}
