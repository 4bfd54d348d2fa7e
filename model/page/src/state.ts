// Everything that the page shows, in the words of a request; its address and the program's command line.
import type { Drawn } from "./model";

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

/** Of a location's hash. */
export function parse_state(hash: string): State {
  const values = new Map<string, string>();
  for (const part of hash.replace(/^#/, "").split("&")) {
    if (part === "") continue;
    const at = part.indexOf("=");
    const key = at < 0 ? part : part.slice(0, at);
    values.set(key, at < 0 ? "1" : decodeURIComponent(part.slice(at + 1)));
  }
  if (!values.has("scene")) values.set("scene", default_scene);
  return { values };
}

export function state_text(state: State): string {
  return (
    "#" +
    [...state.values]
      .map(([key, value]) => `${key}=${encodeURIComponent(value).replace(/%2C/g, ",")}`)
      .join("&")
  );
}

export function request_text(state: State): string {
  return [...state.values]
    .filter(([key]) => !page_keys.has(key))
    .map(([key, value]) => `${key}=${value}`)
    .join("\n");
}

/** What stands beside the machine's picture; null where nothing does. */
export function view_text(state: State): string | null {
  const view = state.values.get("view") ?? "error";
  return view === "" || view === "machine" ? null : `${request_text(state)}\nview=${view}`;
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
