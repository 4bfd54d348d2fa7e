// The front of a small sweep: what bits cost, and what they gain on the quads that are drawn.

export interface Point {
  significand_bits: number;
  /** In LUTs, DSP blocks and block RAMs at their price. */
  cost: number;
  luts: number;
  dsps: number;
  bound: number | null;
  worst: number;
}

const svg = "http://www.w3.org/2000/svg";

function shape(name: string, attributes: Record<string, string | number>, text = ""): SVGElement {
  const made = document.createElementNS(svg, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
  if (text) made.textContent = text;
  return made;
}

const width = 300, height = 190, left = 40, right = 12, top = 12, bottom = 34;

/** Worst error (dots) and bound (line) over cost, in powers of two. A dot chooses its significand. */
export function show_sweep(plot: SVGSVGElement, points: Point[], now: number, choose: (bits: number) => void) {
  plot.setAttribute("viewBox", `0 0 ${width} ${height}`);
  const log = (value: number) => Math.log2(Math.max(value, 2 ** -40));
  const costs = points.map((p) => p.cost), errors = points.flatMap((p) => [log(p.worst), log(p.bound ?? p.worst)]);
  const [x0, x1] = [Math.min(...costs), Math.max(...costs)];
  const [y0, y1] = [Math.floor(Math.min(...errors)), Math.ceil(Math.max(...errors))];
  const x = (value: number) => left + ((value - x0) / Math.max(1, x1 - x0)) * (width - left - right);
  const y = (value: number) => top + ((y1 - value) / Math.max(1, y1 - y0)) * (height - top - bottom);
  const parts: SVGElement[] = [];
  for (let e = Math.ceil(y0 / 4) * 4; e <= y1; e += 4)
    parts.push(
      shape("line", { class: "grid", x1: left, x2: width - right, y1: y(e), y2: y(e) }),
      shape("text", { x: left - 4, y: y(e) + 3, "text-anchor": "end" }, `2^${e}`.replace("-", "−")),
    );
  for (const [value, anchor] of [[x0, "start"], [x1, "end"]] as const)
    parts.push(
      shape("text", { x: x(value), y: height - 18, "text-anchor": anchor }, `${Math.round(value / 1000)},000`),
    );
  parts.push(shape("text", { x: (left + width) / 2, y: height - 4, "text-anchor": "middle" }, "cost in LUTs, DSP blocks at their price"));
  const line = points.filter((p) => p.bound !== null).map((p) => `${x(p.cost)},${y(log(p.bound!))}`);
  parts.push(shape("polyline", { class: "bound", points: line.join(" ") }));
  for (const p of points) {
    const dot = shape("circle", {
      class: p.significand_bits === now ? "point now" : "point",
      cx: x(p.cost),
      cy: y(log(p.worst)),
      r: p.significand_bits === now ? 5 : 3.5,
      tabindex: 0,
      role: "button",
      "aria-label": `s = ${p.significand_bits}: ${Math.round(p.luts)} LUTs, ${p.dsps} DSP blocks, worst error 2^${log(p.worst).toFixed(1)}`,
    });
    dot.append(shape("title", {}, dot.getAttribute("aria-label")!));
    dot.addEventListener("click", () => choose(p.significand_bits));
    dot.addEventListener("keydown", (event) => {
      if (!["Enter", " "].includes((event as KeyboardEvent).key)) return;
      event.preventDefault();
      choose(p.significand_bits);
    });
    parts.push(dot);
  }
  plot.replaceChildren(...parts);
}
