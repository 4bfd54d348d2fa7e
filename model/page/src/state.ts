// Everything that the page shows, in the words of a request; its address and the program's command line.
import type { Drawn, Lists } from "./model";
import { is_shader } from "./views";

export interface State {
  /** Keys in their order, as in the address. */
  values: Map<string, string>;
}

/** What of the state is the page's own, and no part of a request. */
const page_keys = new Set(["view", "difference", "pixel", "embed", "theme"]);
/** What of a request is neither a key of the configuration nor a vertex. */
const draw_keys = new Set(["scene", "size", "yaw", "pitch", "dolly", "shade", "texture", "perspective", "cull", "depth"]);
const vertex_key = /^v\d+$/;

export const default_scene = "fig10_convex";

/** The address has these; it may have the long names too. */
const short_names = new Map([
  ["scene", "preset"],
  ["significand_bits", "s"],
  ["subpixel_bits", "subpixel"],
  ["homogeneous_frac_bits", "frac"],
  ["quadratic_frac_bits", "quadratic"],
  ["guard_bits", "guard"],
  ["align_guard_bits", "align"],
  ["sqrt_segments_log2", "sqrt"],
  ["recip_segments_log2", "recip"],
  ["attribute_frac_bits", "attr"],
  ["depth_bits", "z"],
]);
const long_names = new Map([...short_names].map(([long, short]) => [short, long]));
export const short_name = (key: string) => short_names.get(key) ?? key;
/** Vertices 0 to 3 are one value of the address: `quad=X,Y,Z;…`, those that are not moved empty. */
const quad_keys = ["v0", "v1", "v2", "v3"];

/** What is no text of an address stands for itself. */
function decoded(text: string): string {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}

/** Of a location's hash. */
export function parse_state(hash: string): State {
  const values = new Map<string, string>();
  for (const part of hash.replace(/^#/, "").split("&")) {
    if (part === "") continue;
    const at = part.indexOf("=");
    const key = at < 0 ? part : part.slice(0, at);
    const value = at < 0 ? "1" : decoded(part.slice(at + 1));
    if (key !== "quad") values.set(long_names.get(key) ?? key, value);
    else value.split(";").forEach((position, i) => position && values.set(quad_keys[i] ?? `v${i}`, position));
  }
  if (!values.has("scene")) values.set("scene", default_scene);
  return { values };
}

export function state_text(state: State): string {
  const values = new Map<string, string>();
  for (const [key, value] of state.values)
    if (!quad_keys.includes(key)) values.set(short_name(key), value);
    else values.set("quad", quad_keys.map((k) => state.values.get(k) ?? "").join(";").replace(/;+$/, ""));
  const text = (value: string) => encodeURIComponent(value).replace(/%2C/g, ",").replace(/%3B/g, ";").replace(/%3A/g, ":");
  return "#" + [...values].map(([key, value]) => (key === "embed" ? key : `${key}=${text(value)}`)).join("&");
}

export function request_text(state: State): string {
  return [...state.values]
    .filter(([key]) => !page_keys.has(key))
    .map(([key, value]) => `${key}=${value}`)
    .join("\n");
}

/** `fig10` is the first scene of that beginning; a key with its standard value is not set. */
export function made_short(state: State, lists: Lists): State {
  const values = new Map(state.values), scenes = [...lists.scenes, ...lists.workloads].map((s) => s.name);
  const scene = values.get("scene")!;
  if (!scenes.includes(scene)) values.set("scene", scenes.find((name) => name.startsWith(`${scene}_`)) ?? scene);
  for (const key of lists.keys) if (values.get(key.name) === String(key.standard)) values.delete(key.name);
  return { values };
}

/** What stands beside the machine's picture; null where nothing does. */
export function view_text(state: State): string | null {
  const view = state.values.get("view") ?? "error";
  if (view === "" || view === "machine") return null;
  const error = is_shader(view) && state.values.get("difference") === "error";
  return `${request_text(state)}\nview=${view}${error ? "_error" : ""}`;
}

/** The pixel that is taken apart; null: none is. */
export function pixel_text(state: State): string | null {
  const pixel = state.values.get("pixel");
  return pixel === undefined ? null : `${request_text(state)}\npixel=${pixel}`;
}

/** Keys of the configuration that the state sets. */
export function config_of(state: State): [string, string][] {
  return [...state.values].filter(
    ([key]) => !page_keys.has(key) && !draw_keys.has(key) && !vertex_key.test(key),
  );
}

export const config_text = (state: State) => config_of(state).map(([key, value]) => `${key}=${value}`).join("\n");

export function without_view(state: State): State {
  const values = new Map(state.values);
  for (const key of [...values.keys()])
    if (["yaw", "pitch", "dolly"].includes(key) || vertex_key.test(key)) values.delete(key);
  return { values };
}

/** A configuration file. */
export function toml_text(state: State): string {
  return config_of(state)
    .map(([key, value]) => `${key} = ${value === "auto" ? '"auto"' : value}\n`)
    .join("");
}

/** The command draws the same fragments, but a file of quads has neither texture nor light, planes or colours. */
export function colours_differ(state: State, drawn: Drawn): boolean {
  if (drawn.is_scene) return drawn.shade === "texture" && state.values.has("texture");
  return ["normal", "planes", "colour"].includes(drawn.shade) || (drawn.shade === "texture" && drawn.texture !== "checker");
}

/** How the program draws the same fragments. `quads`: a file's text where no scene of the program has them. */
export function command_line(state: State, drawn: Drawn, quads: string): string {
  const words = ["quadrille", "render"];
  if (drawn.is_scene) words.push("--scene", drawn.scene);
  else words.push("--quads", "page.quads");
  words.push("--size", state.values.get("size") ?? "512x512");
  for (const [key, value] of config_of(state)) words.push("--set", `${key}=${value}`);
  if (!drawn.perspective) words.push("--no-perspective");
  if (state.values.has("cull") || (!drawn.is_scene && drawn.cull !== "none")) words.push("--cull", drawn.cull);
  if (state.values.get("depth") === "0") words.push("--no-depth");
  const shades = drawn.is_scene || !["planes", "colour"].includes(drawn.shade);
  if (shades && (state.values.has("shade") || !drawn.is_scene)) words.push("--shade", drawn.shade);
  words.push("--png", "page.png");
  const line = words.join(" ");
  if (drawn.is_scene) return line;
  return `cat >page.quads <<'END'\n${quads}END\n${line}`;
}
