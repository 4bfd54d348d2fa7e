// The settings beside the pictures.
import type { Configuration, Drawn, Key, Lists } from "./model";
import { short_name } from "./state";

export const element = <T extends Element = HTMLElement>(id: string) => document.getElementById(id) as unknown as T;

export function fill_options(select: HTMLSelectElement, options: [string, string][]) {
  select.replaceChildren(...options.map(([value, text]) => new Option(text, value)));
}

/** Figures by paper. */
export function fill_scenes(select: HTMLSelectElement, lists: Lists) {
  const groups = new Map<string, HTMLOptGroupElement>();
  for (const scene of [...lists.scenes, ...lists.workloads]) {
    const paper = scene.paper.replace(/, (fig\.|section).*/, "");
    let group = groups.get(paper);
    if (!group) {
      group = document.createElement("optgroup");
      group.label = paper === "workload" ? "Loads for the machine" : paper;
      groups.set(paper, group);
    }
    const figure = scene.paper.match(/(fig\.|section) .*/)?.[0];
    group.append(new Option(`${figure ? figure + ": " : ""}${scene.title}`, scene.name));
  }
  select.replaceChildren(...groups.values());
}

/** A figure of each kind that the papers have, one click away. */
export const presets: [string, string][] = [
  ["convex", "fig10_convex"],
  ["concave", "fig10_concave"],
  ["bow-tie", "fig10_crossed"],
  ["exterior", "fig9_e"],
  ["behind the eye", "fig8_behind"],
  ["sphere cap", "bloomenthal13_dense"],
  ["Phong", "phong_mesh"],
];

export function fill_presets(box: HTMLElement, choose: (scene: string) => void) {
  for (const [text, scene] of presets) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = text;
    button.dataset.scene = scene;
    button.addEventListener("click", () => choose(scene));
    box.append(button);
  }
}

/** The keys that a viewer sees act, in the order of the machine. */
const slider_keys = [
  "significand_bits",
  "subpixel_bits",
  "homogeneous_frac_bits",
  "quadratic_frac_bits",
  "guard_bits",
  "align_guard_bits",
  "sqrt_segments_log2",
  "recip_segments_log2",
  "attribute_frac_bits",
  "depth_bits",
];

/** Of rtl/configurations, by build.sh: the aim and the keys of each. */
declare const configurations: Record<string, { aim: string; keys: Record<string, number> }>;

export const named_configurations: [string, Record<string, number>][] = [
  ["default", {}],
  ...Object.entries(configurations).map(
    ([name, { aim, keys }]) => [`${name}: ${aim}`, keys] as [string, Record<string, number>],
  ),
  ["coarse: s = 8", { significand_bits: 8 }],
  ["coarse grid: 2 sub-pixel bits", { subpixel_bits: 2 }],
  ["tables of degree 1", { sqrt_degree: 1, recip_degree: 1 }],
];

export class Sliders {
  private rows = new Map<string, { row: HTMLElement; input: HTMLInputElement; output: HTMLOutputElement; key: Key }>();

  constructor(box: HTMLElement, keys: Key[], change: (key: string, value: string | null) => void) {
    for (const name of slider_keys) {
      const key = keys.find((k) => k.name === name)!;
      const row = document.createElement("div");
      row.className = "slider";
      const label = document.createElement("label");
      label.textContent = name;
      const short = document.createElement("span");
      short.className = "quiet";
      short.textContent = ` ${short_name(name)}`;
      label.append(short);
      label.htmlFor = `key_${name}`;
      label.title = key.meaning;
      const output = document.createElement("output");
      output.htmlFor.add(`key_${name}`);
      const input = document.createElement("input");
      input.type = "range";
      input.id = `key_${name}`;
      input.min = String(key.minimum);
      input.max = String(key.maximum);
      input.addEventListener("input", () => {
        output.textContent = input.value;  // though there be no such machine
        change(name, Number(input.value) === key.standard ? null : input.value);
      });
      input.title = "Delete, or a double click: the standard value";
      input.addEventListener("dblclick", () => change(name, null));
      input.addEventListener("keydown", ({ key }) => key === "Delete" && change(name, null));
      row.append(label, output, input);
      box.append(row);
      this.rows.set(name, { row, input, output, key });
    }
  }

  show(configuration: Configuration, set: Map<string, string>) {
    for (const [name, { row, input, output, key }] of this.rows) {
      const value = configuration.resolved[name];
      input.value = String(value);
      const automatic = key.standard === -1 && !set.has(name);
      output.textContent = `${value}${automatic ? " (auto)" : ""}`;
      input.setAttribute("aria-valuetext", output.textContent);
      row.classList.toggle("set", set.has(name));
    }
  }
}

/** The browser lays out again what is set, though it is the same. */
export function set_text(of: Element, text: string) {
  if (of.textContent !== text) of.textContent = text;
}

export function show_list(list: HTMLElement, rows: [string, string][]) {
  const texts = rows.flat();
  if (list.children.length !== texts.length)
    list.replaceChildren(...texts.map((_, i) => document.createElement(i % 2 === 0 ? "dt" : "dd")));
  texts.forEach((text, i) => set_text(list.children[i], text));
}

const thousands = (n: number) => Math.round(n).toLocaleString("en");

export function power_of_two(value: number): string {
  return `2^${Math.log2(value).toFixed(1).replace("-", "−")}`;
}

export function show_costs(list: HTMLElement, c: Configuration) {
  show_list(list, [
    [`error bound of a weight (${c.proved ? "proved" : "estimated"})`, c.bound === null ? "none" : power_of_two(c.bound)],
    ["LUTs (ECP5, estimated)", thousands(c.luts)],
    ["DSP blocks", thousands(c.dsps)],
    ["block RAMs", thousands(c.block_rams)],
  ]);
}

export function show_stats(list: HTMLElement, drawn: Drawn) {
  show_list(
    list,
    Object.entries(drawn.stats).map(([name, value]) => [name.replaceAll("_", " "), thousands(value)]),
  );
}
