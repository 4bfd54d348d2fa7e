// What stands beside the machine's picture.
import { power_of_two } from "./controls";

export const views: [string, string][] = [
  ["", "nothing"],
  ["error", "error against exact, by the bound"],
  ["exact", "exact (113 bits)"],
  ["split02", "two triangles, diagonal 0–2"],
  ["split13", "two triangles, diagonal 1–3"],
  ["bilinear", "inverse bilinear"],
  ["projective", "projective"],
  ["refine", "refined 20 × 20"],
  ["twofold", "linear along edges, then along rows"],
  ["adaptive", "adaptive subdivision"],
  ["fp32", "paper's formulas in fp32"],
  ["fp32_determinant", "determinant form in fp32"],
  ["coverage", "coverage, ties and notches"],
  ["tiles", "tiles by what became of them"],
  ["clocks", "clock of each pixel"],
  ["machine", "the machine, clock by clock"],
];

/** Those that are pictures of the same quads, and so may be compared by colour. */
export const is_picture = (view: string) => !["", "error", "coverage", "tiles", "clocks", "machine"].includes(view);
/** A shader draws them, whose weights can be judged like the machine's. */
export const is_shader = (view: string) => view.startsWith("fp32");

const share = (value: number) => (value >= 0.001 ? value.toFixed(3) : power_of_two(value));

export function legend(view: string, result: Record<string, unknown>): [string, string][] {
  const count = (name: string) => (result[name] as number).toLocaleString("en");
  switch (view.replace(/^fp32.*_error$/, "error")) {
    case "error": {
      const worst = result.worst as number, bound = result.bound as number | null;
      const limit = bound === null ? "no bound" : `the machine's bound is ${power_of_two(bound)}`;
      const where = worst > 0 && bound !== null ? `; worst error ${power_of_two(worst * bound)}, ${share(worst)} of it, at pixel ${result.x}, ${result.y}` : "";
      const apart: [string, string][] = [
        ["#ff00ff", `the formulas divide by zero ${count("undefined")}`],
        ["#d65e00", `not covered by exact arithmetic ${count("outside")}`],
      ];
      return [
        ["scale", "2^−8 of the bound or less … the bound"],
        ["", `${limit}${where}`],
        ...apart.filter((_, i) => result[i ? "outside" : "undefined"] !== 0),
      ];
    }
    case "coverage":
      return [
        ["#0072b2", `front ${count("front")}`],
        ["#e69f00", `back ${count("back")}`],
        ["#004a74", `notch (darker) ${count("notch")}`],
        ["#cc79a7", `on an edge ${count("on_edge")}`],
        ["#d55e00", `on a corner ${count("on_vertex")}`],
        ["#ffffff", `decided as a tie ${count("ties")}`],
      ];
    case "tiles":
      return [
        ["#57575c", `left out with its block ${count("block_left_out")}`],
        ["#57b5e8", `left out by itself ${count("left_out")}`],
        ["#d65e00", `entered in vain ${count("empty")}`],
        ["#0073b3", `drawn ${count("drawn")}`],
      ];
    case "clocks": {
      const fragments = result.fragments as number, clocks = result.clocks as number;
      return [
        ["scale", `clock ${count("first")} … ${count("last")}`],
        ["", `${count("clocks")} clocks for ${count("fragments")} fragments: ${(fragments / clocks).toFixed(3)} a clock`],
      ];
    }
    default: {
      if (result.fragments === 0) return [["", "Nothing is drawn: no pixel is covered by this method."]];
      const undefined_count = result.undefined as number;
      return undefined_count > 0
        ? [["#ff00ff", `the formulas divide by zero: ${undefined_count.toLocaleString("en")} pixels`]]
        : [];
    }
  }
}

export function show_legend(box: HTMLElement, entries: [string, string][]) {
  box.replaceChildren(
    ...entries.map(([colour, text]) => {
      const entry = document.createElement("span");
      const swatch = document.createElement("span"), words = document.createElement("span");
      entry.className = "entry";
      swatch.className = colour === "scale" ? "swatch scale" : "swatch";
      if (colour.startsWith("#")) swatch.style.background = colour;
      words.textContent = text;
      entry.append(...(colour ? [swatch, words] : [words]));
      return entry;
    }),
  );
}

/** |a − b| of each channel, times `factor`. */
export function difference(a: Uint8ClampedArray, b: Uint8ClampedArray, factor: number): Uint8ClampedArray {
  const out = new Uint8ClampedArray(a.length);
  for (let i = 0; i < a.length; i += 4) {
    for (let c = 0; c < 3; c++) out[i + c] = Math.abs(a[i + c] - b[i + c]) * factor;
    out[i + 3] = 255;
  }
  return out;
}
