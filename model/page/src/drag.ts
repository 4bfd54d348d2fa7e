// Corners, orbit and dolly by pointer, touch, wheel and keyboard.
import type { Drawn, Vertex } from "./model";

const svg = "http://www.w3.org/2000/svg";

/** Where a vertex goes on the screen keeps its distance from the eye. Null where its position does not follow. */
export function position_at(drawn: Drawn, size: [number, number], vertex: Vertex, x: number, y: number): number[] | null {
  const m = drawn.matrix;
  const [px, py, pz] = vertex.position;
  const row = (i: number) => [m[4 * i], m[4 * i + 1], m[4 * i + 2]];
  const clip = (i: number) => m[4 * i] * px + m[4 * i + 1] * py + m[4 * i + 2] * pz + m[4 * i + 3];
  const w = clip(3);
  // Where the eye sees in parallel, window z stays.
  const kept = row(3).some((c) => c !== 0) ? 3 : 2;
  const a = [row(0), row(1), row(kept)];
  const b = [((2 * x) / size[0] - 1) * w - m[3], (1 - (2 * y) / size[1]) * w - m[7], clip(kept) - m[4 * kept + 3]];
  const det = (u: number[], v: number[], t: number[]) =>
    u[0] * (v[1] * t[2] - v[2] * t[1]) - u[1] * (v[0] * t[2] - v[2] * t[0]) + u[2] * (v[0] * t[1] - v[1] * t[0]);
  const whole = det(a[0], a[1], a[2]);
  if (Math.abs(whole) < 1e-12) return null;
  return [0, 1, 2].map((k) => {
    const c = a.map((r, i) => r.map((value, j) => (j === k ? b[i] : value)));
    return det(c[0], c[1], c[2]) / whole;
  });
}

/** The browser draws again what is set, though it is the same. */
function set_attribute(of: Element, name: string, value: string) {
  if (of.getAttribute(name) !== value) of.setAttribute(name, value);
}

export interface Changes {
  vertex(index: number, position: number[]): void;
  turn(yaw: number, pitch: number): void;
  dolly(by: number): void;
  /** The pixel that was clicked. */
  pick(x: number, y: number): void;
}

/** Degrees that a picture's width of dragging turns. */
const turn_per_width = 180;
/** A pointer that goes no farther, in pixels of the screen, is a click. */
const click_way = 3;
/** Handles have their size in a picture that is so wide. */
const usual_width = 512;
const subpixel = 1 / 256;

export class Drag {
  private drawn: Drawn | null = null;
  private size: [number, number] = [512, 512];
  private handles: SVGGElement[] = [];
  private cross: SVGPathElement | null = null;
  private pointers = new Map<number, { x: number; y: number }>();
  /** Where the only pointer went down on the picture. */
  private pressed: { x: number; y: number } | null = null;

  constructor(
    private stage: HTMLElement,
    private canvas: HTMLCanvasElement,
    beside: HTMLCanvasElement,
    private overlay: SVGSVGElement,
    private changes: Changes,
  ) {
    stage.addEventListener("pointerdown", (event) => this.begin(event));
    stage.addEventListener("pointermove", (event) => this.move(event));
    stage.addEventListener("pointerup", (event) => {
      const from = this.pressed;
      this.pointers.delete(event.pointerId);
      this.pressed = null;
      if (from) this.pick(event);
    });
    stage.addEventListener("pointercancel", (event) => {
      this.pointers.delete(event.pointerId);
      this.pressed = null;
    });
    beside.addEventListener("click", (event) => this.pick(event, beside));
    stage.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        this.changes.dolly(-event.deltaY / 1500);
      },
      { passive: false },
    );
    canvas.addEventListener("keydown", (event) => this.turn_by_key(event));
  }

  show(drawn: Drawn, size: [number, number]) {
    this.drawn = drawn;
    this.size = size;
    set_attribute(this.overlay, "viewBox", `0 0 ${size[0]} ${size[1]}`);
    while (this.handles.length > drawn.vertices.length) this.handles.pop()?.remove();
    drawn.vertices.forEach((vertex, index) => {
      const handle = (this.handles[index] ??= this.make_handle(index));
      const seen = Math.abs(vertex.w) > 1e-9 && Number.isFinite(vertex.x / vertex.w);
      handle.style.display = seen ? "" : "none";
      if (!seen) return;
      const x = vertex.x / vertex.w, y = vertex.y / vertex.w;
      // Those outside wait at the border.
      const scale = size[0] / usual_width, border = 4 * scale;
      const inside = (c: number, limit: number) => Math.min(Math.max(c, border), limit - border);
      set_attribute(handle, "transform", `translate(${inside(x, size[0])} ${inside(y, size[1])}) scale(${scale})`);
      handle.classList.toggle("behind", vertex.w < 0);
      const where = `x ${x.toFixed(2)}, y ${y.toFixed(2)}${vertex.w < 0 ? ", behind the eye" : ""}`;
      set_attribute(handle, "aria-label", `Vertex ${index}: ${where}`);
    });
  }

  /** A cross at the pixel of a picture that is so wide; null: none. */
  mark(pixel: number[] | null, width: number) {
    this.cross?.remove();
    this.cross = null;
    if (!pixel) return;
    const scale = width / usual_width, gap = Math.max(3, 0.75 / scale);  // the pixel itself stays seen
    this.cross = document.createElementNS(svg, "path");
    this.cross.setAttribute("class", "cross");
    this.cross.setAttribute("transform", `translate(${pixel[0] + 0.5} ${pixel[1] + 0.5}) scale(${scale})`);
    this.cross.setAttribute("d", `M${-gap - 7} 0h7m${2 * gap} 0h7M0 ${-gap - 7}v7m0 ${2 * gap}v7`);
    this.overlay.prepend(this.cross);
  }

  private make_handle(index: number): SVGGElement {
    const group = document.createElementNS(svg, "g");
    group.classList.add("handle");
    group.setAttribute("tabindex", "0");
    group.setAttribute("role", "button");
    group.dataset.vertex = String(index);
    for (const [name, radius] of [["touch", 18], ["dot", 6]] as const) {
      const circle = document.createElementNS(svg, "circle");
      circle.setAttribute("class", name);
      circle.setAttribute("r", String(radius));
      group.append(circle);
    }
    const label = document.createElementNS(svg, "text");
    label.textContent = String(index);
    label.setAttribute("x", "9");
    label.setAttribute("y", "-8");
    group.append(label);
    group.addEventListener("keydown", (event) => this.step_by_key(event, index));
    this.overlay.append(group);
    return group;
  }

  private pick(event: MouseEvent, of = this.canvas) {
    const [x, y] = this.pixel(event, of).map(Math.floor);
    if (x >= 0 && y >= 0 && x < this.size[0] && y < this.size[1]) this.changes.pick(x, y);
  }

  private pixel(event: MouseEvent, of = this.canvas): [number, number] {
    const box = of.getBoundingClientRect();
    return [
      ((event.clientX - box.left) / box.width) * this.size[0],
      ((event.clientY - box.top) / box.height) * this.size[1],
    ];
  }

  private begin(event: PointerEvent) {
    if (event.button !== 0) return;
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    const handle = (event.target as Element).closest<SVGGElement>(".handle");
    this.pressed = handle || this.pointers.size > 1 ? null : { x: event.clientX, y: event.clientY };
    if (!handle || this.pointers.size > 1) {
      this.stage.setPointerCapture(event.pointerId);
      return;
    }
    event.stopPropagation();
    handle.focus();
    handle.setPointerCapture(event.pointerId);
    handle.classList.add("held");
    const index = Number(handle.dataset.vertex);
    const follow = (moved: PointerEvent) => {
      if (moved.pointerId === event.pointerId) this.place(index, ...this.pixel(moved));
    };
    const end = () => {
      handle.classList.remove("held");
      handle.removeEventListener("pointermove", follow);
    };
    handle.addEventListener("pointermove", follow);
    handle.addEventListener("lostpointercapture", end, { once: true });
  }

  private move(event: PointerEvent) {
    const before = this.pointers.get(event.pointerId);
    if (!before || (event.target as Element).closest(".handle")) return;
    const after = { x: event.clientX, y: event.clientY };
    if (this.pressed && Math.hypot(after.x - this.pressed.x, after.y - this.pressed.y) <= click_way) return;
    this.pressed = null;
    const width = this.canvas.clientWidth;
    if (this.pointers.size === 1) {
      const scale = turn_per_width / width;
      this.changes.turn((after.x - before.x) * scale, (after.y - before.y) * scale);
    } else {
      const other = [...this.pointers].find(([id]) => id !== event.pointerId)![1];
      const distance = (p: { x: number; y: number }) => Math.hypot(p.x - other.x, p.y - other.y);
      this.changes.dolly((distance(after) - distance(before)) / width);
    }
    this.pointers.set(event.pointerId, after);
  }

  private place(index: number, x: number, y: number) {
    if (!this.drawn) return;
    const position = position_at(this.drawn, this.size, this.drawn.vertices[index], x, y);
    if (position) this.changes.vertex(index, position);
  }

  private step_by_key(event: KeyboardEvent, index: number) {
    const direction = arrow(event);
    if (!direction || !this.drawn) return;
    event.preventDefault();
    event.stopPropagation();
    const { x, y, w } = this.drawn.vertices[index];
    const step = event.shiftKey ? 8 : subpixel;
    this.place(index, x / w + direction[0] * step, y / w + direction[1] * step);
  }

  private turn_by_key(event: KeyboardEvent) {
    const direction = arrow(event);
    const step = event.shiftKey ? 15 : 1;
    if (direction) this.changes.turn(direction[0] * step, direction[1] * step);
    else if (event.key === "+" || event.key === "=") this.changes.dolly(0.02);
    else if (event.key === "-") this.changes.dolly(-0.02);
    else return;
    event.preventDefault();
  }
}

function arrow(event: KeyboardEvent): [number, number] | null {
  switch (event.key) {
    case "ArrowLeft":
      return [-1, 0];
    case "ArrowRight":
      return [1, 0];
    case "ArrowUp":
      return [0, -1];
    case "ArrowDown":
      return [0, 1];
    default:
      return null;
  }
}
