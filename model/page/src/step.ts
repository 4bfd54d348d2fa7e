// The clocked machine, clock by clock, in the picture beside the machine's.
import { show_list } from "./controls";
import type { Model } from "./model";
import type { Answer } from "./worker";

type Place = [number, number];

interface Clock {
  clock: number;
  done: boolean;
  bound: string;
  vertices: number;
  vertex_taken: boolean;
  setup: number | null;
  tile: Place | null;
  tile_size: number;
  tiles: number;
  stamp: Place | null;
  stamp_mask: number;
  pixels: Record<string, Place[]>;
  stalls: boolean;
  stalled: number;
  fragments: number;
}

/** From the pipeline's first register to its last. */
const stage_colours = ["#440154", "#443983", "#31688e", "#21918c", "#35b779", "#90d743", "#fde725"];
const tile_colour = "#ffb000", stamp_colour = "#ffffff";

/** What is drawn over the picture of the clock. */
export const stepping_legend: [string, string][] = [
  [tile_colour, "tile"],
  [stamp_colour, "stamp"],
  ...["diff", "norm", "sqrt", "ratio", "weight", "sum", "fragment"].map((stage, i) => [stage_colours[i], stage] as [string, string]),
];

export class Stepping {
  private text: string | null = null;
  private running = false;
  private busy = false;
  private image: ImageData | null = null;
  private last: Clock | null = null;

  constructor(
    private model: Model,
    private canvas: HTMLCanvasElement,
    private list: HTMLElement,
    private controls: { play: HTMLButtonElement; speed: HTMLSelectElement; stall: HTMLInputElement },
    private colours: () => Uint8ClampedArray,
  ) {}

  get settled() {
    return !this.busy;
  }

  /** Before the first clock of that request; null: another view is shown. */
  async start(text: string | null, size: Place) {
    this.text = text;
    this.pause();
    if (text === null) return;
    const answer = await this.model.call("machine_start", text);
    if (text !== this.text) return;
    this.image = new ImageData(size[0], size[1]);
    for (let p = 0; p < this.image.data.length; p += 4) this.image.data.set([56, 56, 59, 255], p);
    this.show(answer);
  }

  pause() {
    this.running = false;
    this.controls.play.textContent = "Play";
  }

  toggle() {
    if (this.running) return this.pause();
    this.running = true;
    this.controls.play.textContent = "Pause";
    const frame = async () => {
      if (!this.running) return;
      await this.run(Number(this.controls.speed.value));
      if (this.last?.done) this.pause();
      else requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  async run(clocks: number) {
    const text = this.text;
    if (text === null || this.busy) return;
    this.busy = true;
    const answer = await this.model.call("machine_run", "", undefined, [clocks, Number(this.controls.stall.value)]);
    this.busy = false;
    if (text === this.text) this.show(answer);
  }

  private show(answer: Answer) {
    if (answer.error || !this.image) return show_list(this.list, [["error", answer.error ?? ""]]);
    const now = (this.last = answer.result as unknown as Clock);
    const { width, data } = this.image;
    const colours = this.colours();
    for (const place of new Uint32Array(answer.bytes!)) {
      const at = 4 * ((place >>> 16) * width + (place & 0xffff));
      if (colours.length === data.length) data.set(colours.subarray(at, at + 4), at);
      else data.set([255, 255, 255, 255], at);
    }
    if (this.canvas.width !== width || this.canvas.height !== this.image.height)
      [this.canvas.width, this.canvas.height] = [width, this.image.height];
    const context = this.canvas.getContext("2d")!;
    context.putImageData(this.image, 0, 0);
    this.overlay(context, now);
    const place = (p: Place | null) => (p ? `${p[0]}, ${p[1]}` : "–");
    const count = (n: number) => n.toLocaleString("en");
    show_list(this.list, [
      ["clock", `${count(now.clock)}${now.done ? ", done" : ""}`],
      ["this clock was bound by", now.bound || "–"],
      ["vertices taken", `${count(now.vertices)}${now.vertex_taken ? ", one now" : ""}`],
      ["setup gives quad", now.setup === null ? "–" : String(now.setup)],
      ["tile (its first pixel)", place(now.tile)],
      ["stamp (its row)", now.stamp ? `${place(now.stamp)}: ${mask(now)}` : "–"],
      ...Object.entries(now.pixels).map(
        ([stage, at]) => [`pixel in ${stage}`, at.map(place).join("; ") || "–"] as [string, string],
      ),
      ["output stalls", now.stalls ? "yes" : "no"],
      ["stalled clocks", count(now.stalled)],
      ["fragments", count(now.fragments)],
      ["tiles entered", count(now.tiles)],
      ["fragments a clock", now.clock ? (now.fragments / now.clock).toFixed(3) : "–"],
    ]);
  }

  private overlay(context: CanvasRenderingContext2D, now: Clock) {
    context.lineWidth = 1;
    if (now.tile) {
      context.strokeStyle = tile_colour;
      context.strokeRect(now.tile[0] - 0.5, now.tile[1] - 0.5, now.tile_size + 1, now.tile_size + 1);
    }
    if (now.stamp) {
      context.fillStyle = stamp_colour;
      for (let x = 0; x < now.tile_size; x++)
        if ((now.stamp_mask >>> x) & 1) context.fillRect(now.stamp[0] + x, now.stamp[1], 1, 1);
    }
    Object.values(now.pixels).forEach((places, stage) => {
      for (const [x, y] of places) {
        context.fillStyle = stage_colours[stage];
        context.fillRect(x - 1, y - 1, 3, 3);
        context.strokeStyle = "#ffffff";
        context.strokeRect(x - 1.5, y - 1.5, 4, 4);
      }
    });
  }
}

function mask(now: Clock): string {
  return Array.from({ length: now.tile_size }, (_, x) => ((now.stamp_mask >>> x) & 1 ? "■" : "·")).join("");
}
