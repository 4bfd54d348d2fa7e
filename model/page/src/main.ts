// The page: a state, two workers that draw it, and what changes it.
import { element, fill_options, fill_presets, fill_scenes, named_configurations, set_text, show_costs, show_stats, Sliders } from "./controls";
import { Drag } from "./drag";
import { Latest, Model, type Configuration, type Drawn, type Lists } from "./model";
import { colours_differ, command_line, config_of, config_text, parse_state, request_text, state_text, toml_text, view_text, made_short, without_view, pixel_text, type State } from "./state";
import { show_explained, type Explained } from "./pixel";
import { Stepping, stepping_legend } from "./step";
import { show_sweep, type Point } from "./sweep";
import { difference, is_picture, is_shader, legend, show_legend, views } from "./views";
import type { Answer } from "./worker";

const machine = new Model();
const study = new Model();
let state: State = parse_state(location.hash);
/** Of the address, once there are lists. */
const read_state = () => made_short(parse_state(location.hash), lists);
let drawn: Drawn | null = null;
let lists: Lists;
let sliders: Sliders;
/** Of the requests that they were drawn for. */
let picture = { text: "", bytes: new ArrayBuffer(0) };
let compared = { text: "", bytes: new ArrayBuffer(0) };

const canvas = element<HTMLCanvasElement>("machine");

function size_of(of: State): [number, number] {
  const [width, height] = (of.values.get("size") ?? "512x512").split("x").map(Number);
  return [width, height];
}

export function paint(onto: HTMLCanvasElement, size: [number, number], bytes: ArrayBuffer) {
  if (onto.width !== size[0] || onto.height !== size[1]) {
    [onto.width, onto.height] = size;
    onto.style.aspectRatio = `${size[0]} / ${size[1]}`;
  }
  onto.getContext("2d")!.putImageData(new ImageData(new Uint8ClampedArray(bytes), size[0], size[1]), 0, 0);
}

function show_error(text: string | null) {
  const box = element("error");
  box.hidden = text === null;
  box.textContent = text;
}

/** So many pictures were drawn. */
let frames = 0;

/** When numbers about the picture were shown: while it moves nobody reads more of them, and they take time. */
let told = 0;

function show_drawn(answer: Answer, text: string, last: boolean) {
  if (answer.error) return show_error(answer.error);
  show_error(null);
  drawn = answer.result as unknown as Drawn;
  const size = size_of(state);
  picture = { text, bytes: answer.bytes! };
  if (answer.bytes!.byteLength === 4 * size[0] * size[1]) paint(canvas, size, answer.bytes!);
  const beside = view_text(state);
  if (beside !== null) look.ask(beside);
  show_stepping();
  ask_sweep();
  const pixel = pixel_text(state);
  if (pixel !== null) explain.ask(pixel);
  drag.show(drawn, size);
  ++frames;
  document.body.dataset.drawn = text;
  if (!last && performance.now() - told < 250) return;
  told = performance.now();
  element("rate").textContent = `${answer.time.toFixed(0)} ms, ${drawn.stats.fragments.toLocaleString("en")} fragments`;
  show_stats(element("stats"), drawn);
  const shade = element<HTMLSelectElement>("shade");
  for (const option of shade.options)
    option.disabled = (option.value === "planes" && !drawn.planes) || (option.value === "colour" && !drawn.colours);
  shade.value = drawn.shade;
  element<HTMLSelectElement>("texture").value = drawn.texture;
  element<HTMLInputElement>("perspective").checked = drawn.perspective;
  element<HTMLSelectElement>("cull").value = drawn.cull;
}

const draw = new Latest(machine, "draw", show_drawn);

function show_compared(answer: Answer, text: string) {
  element("view_note").textContent = answer.error ?? "";
  if (answer.error) {
    const beside = element<HTMLCanvasElement>("beside");
    beside.getContext("2d")!.clearRect(0, 0, beside.width, beside.height);
    show_legend(element("legend"), []);
    compared = { text: "", bytes: new ArrayBuffer(0) };
    return;
  }
  compared = { text, bytes: answer.bytes! };
  show_legend(element("legend"), legend(text.match(/view=(.*)$/)![1], answer.result!));
  paint_compared();
}

function paint_compared() {
  const size = size_of(state);
  let bytes = compared.bytes;
  if (bytes.byteLength !== 4 * size[0] * size[1]) return;
  if (state.values.get("difference") === "1" && is_picture(state.values.get("view") ?? "error") && picture.bytes.byteLength === bytes.byteLength)
    bytes = difference(new Uint8ClampedArray(picture.bytes), new Uint8ClampedArray(bytes), 16).buffer as ArrayBuffer;
  paint(element<HTMLCanvasElement>("beside"), size, bytes);
  document.body.dataset.compared = compared.text;
}

const explain = new Latest(study, "pixel", (answer) => {
  if (answer.error) element("explained").textContent = answer.error;
  else show_explained(element("explained"), answer.result as unknown as Explained);
});
const stepping = new Stepping(
  study,
  element<HTMLCanvasElement>("beside"),
  element("step_list"),
  {
    play: element<HTMLButtonElement>("step_play"),
    speed: element<HTMLSelectElement>("step_speed"),
    stall: element<HTMLInputElement>("step_stall"),
  },
  () => new Uint8ClampedArray(picture.bytes),
);
const sweep = new Latest(study, "sweep", (answer) => {
  if (answer.error) return;
  const points = (answer.result as unknown as { points: Point[] }).points;
  const now = Number(state.values.get("significand_bits") ?? lists.keys.find((k) => k.name === "significand_bits")!.standard);
  show_sweep(element<SVGSVGElement>("front"), points, now, (bits) => change(["significand_bits", String(bits)]));
});
/** While it is open. */
const ask_sweep = () => {
  if (element<HTMLDetailsElement>("sweep").open) sweep.ask(request_text(state));
};

let stepped = "";
/** A machine of the state, from its first clock on, where that is what stands beside. */
function show_stepping() {
  const text = state.values.get("view") === "machine" ? request_text(state) : "";
  element("stepping").hidden = text === "";
  if (text === stepped) return;
  stepped = text;
  stepping.start(text || null, size_of(state));
  if (text) show_legend(element("legend"), stepping_legend);
}

const look = new Latest(study, "view", show_compared);
const configure = new Latest(machine, "configuration", (answer) => {
  if (answer.error) return;
  const configuration = answer.result as unknown as Configuration;
  show_costs(element("costs"), configuration);
  sliders.show(configuration, new Map(config_of(state)));
});

/** What was asked for last. */
let configured: string | null = null;
let address_timer = 0;
/** As the page wrote or read it. */
let address = location.hash;
function show_state() {
  draw.ask(request_text(state));
  if (config_text(state) !== configured) configure.ask((configured = config_text(state)));
  const scene = [...lists.scenes, ...lists.workloads].find((s) => s.name === state.values.get("scene"));
  set_text(element("title"), scene ? `${scene.title} (${scene.paper})` : "");
  element<HTMLSelectElement>("scene").value = scene?.name ?? "";
  for (const button of document.querySelectorAll<HTMLElement>("#presets button"))
    button.ariaPressed = String(button.dataset.scene === scene?.name);
  const config = new Map(config_of(state));
  const named = named_configurations.find(
    ([, keys]) => Object.keys(keys).length === config.size && Object.entries(keys).every(([k, v]) => config.get(k) === String(v)),
  );
  element<HTMLSelectElement>("named").value = named?.[0] ?? "";
  document.body.classList.toggle("embed", state.values.has("embed"));
  const pixel = state.values.get("pixel")?.match(/^(\d+),(\d+)$/)?.slice(1).map(Number) ?? null;
  drag.mark(pixel, size_of(state)[0] || 512);
  for (const [i, id] of ["pixel_x", "pixel_y"].entries())
    if (document.activeElement?.id !== id) element<HTMLInputElement>(id).value = pixel ? String(pixel[i]) : "";
  const view = state.values.get("view") ?? "error";
  const view_select = element<HTMLSelectElement>("view");
  if (![...view_select.options].some((option) => option.value === view)) view_select.add(new Option(view));  // a method with a knob
  view_select.value = view;
  const shown = element<HTMLSelectElement>("difference"), of_picture = state.values.get("difference") ?? "";
  shown.options[2].hidden = !is_shader(view);
  shown.value = of_picture === "error" && !is_shader(view) ? "" : of_picture;
  element("difference_label").hidden = !is_picture(view);
  element("beside_stage").hidden = element("legend").hidden = view === "";
  element("beside_figure").parentElement!.classList.toggle("one", view === "");
  // Browsers allow few changes of an address a second.
  clearTimeout(address_timer);
  address_timer = window.setTimeout(() => {
    if (location.hash !== address) return;  // somebody typed another, which is about to be read
    history.replaceState(null, "", state_text(state));
    address = location.hash;
  }, 200);
}

/** Sets keys, removes those with null. */
function change(...pairs: [string, string | null][]) {
  const values = new Map(state.values);
  for (const [key, value] of pairs)
    if (value === null) values.delete(key);
    else values.set(key, value);
  state = { values };
  show_state();
}

const short = (value: number) => String(Number(value.toPrecision(9)));
const add = (key: string, by: number) => {
  const value = Number(state.values.get(key) ?? 0) + by;
  return [key, Math.abs(value) < 1e-9 ? null : short(Number(value.toFixed(4)))] as [string, string | null];
};

const drag = new Drag(element("stage"), canvas, element("beside"), element<SVGSVGElement>("handles"), {
  vertex: (index, position) => change([`v${index}`, position.map(short).join(",")]),
  turn: (yaw, pitch) => change(add("yaw", yaw), add("pitch", pitch)),
  dolly: (by) => change(add("dolly", by)),
  pick: (x, y) => change(["pixel", `${x},${y}`]),
});

/** The picture stays here: it goes to the workers alone. */
async function take_picture(file: File) {
  const bitmap = await createImageBitmap(file);
  const scale = Math.min(1, 1024 / Math.max(bitmap.width, bitmap.height));
  const width = Math.max(1, Math.round(bitmap.width * scale)), height = Math.max(1, Math.round(bitmap.height * scale));
  const context = new OffscreenCanvas(width, height).getContext("2d")!;
  context.drawImage(bitmap, 0, 0, width, height);
  const bytes = context.getImageData(0, 0, width, height).data;
  for (const model of [machine, study]) await model.call("picture", "", { width, bytes });
  change(["texture", "own"], ["shade", "texture"]);
}

/** The state's, or that of the system. */
function set_theme() {
  const dark = matchMedia("(prefers-color-scheme: dark)").matches;
  document.documentElement.dataset.theme = state.values.get("theme") ?? (dark ? "dark" : "light");
}

function save(name: string, content: BlobPart, type: string) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([content], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

async function quads_text(): Promise<string> {
  const answer = await machine.call("quads", request_text(state));
  if (answer.error) throw new Error(answer.error);
  return answer.result!.text as string;
}

/** `note`: what whoever pastes it has to know. Browsers let pages of plain http beyond this machine copy nothing. */
async function copy(text: string, what: string, note = "") {
  const done = await navigator.clipboard?.writeText(text).then(() => true, () => false);
  element("shared").textContent = done ? `${what} copied.${note}` : `The browser does not let the page copy.${note}`;
  element("copied").hidden = done === true;
  element("copied").textContent = text;
  if (!done) getSelection()!.selectAllChildren(element("copied"));
}

function listen() {
  const on_change = (id: string, act: (target: HTMLSelectElement & HTMLInputElement) => void) =>
    element(id).addEventListener("change", (event) => act(event.target as HTMLSelectElement & HTMLInputElement));
  const choose_scene = (name: string) => {
    const values = new Map(without_view(state).values);
    values.set("scene", name);
    for (const key of ["shade", "texture", "perspective", "cull"]) values.delete(key);
    state = { values };
    show_state();
  };
  on_change("scene", (select) => choose_scene(select.value));
  fill_presets(element("presets"), choose_scene);
  for (const key of ["shade", "cull"]) on_change(key, (select) => change([key, select.value]));
  on_change("texture", (select) => change(["texture", select.value], ["shade", "texture"]));  // it is to be seen
  on_change("view", (select) => change(["view", select.value]));
  element("pixel_form").addEventListener("submit", (event) => event.preventDefault());
  element("pixel_form").addEventListener("change", () => {
    const at = ["pixel_x", "pixel_y"].map((id) => element<HTMLInputElement>(id).value || "0");
    change(["pixel", at.join(",")]);
  });
  on_change("difference", (select) => {
    change(["difference", select.value || null]);
    paint_compared();
  });
  element("own").addEventListener("change", async (event) => {
    const file = (event.target as HTMLInputElement).files?.[0];
    if (file) await take_picture(file).catch(() => show_error(`${file.name}: expected a picture that the browser knows`));
  });
  on_change("perspective", (box) => change(["perspective", box.checked ? "1" : "0"]));
  on_change("named", (select) => {
    const keys = named_configurations.find(([name]) => name === select.value)?.[1] ?? {};
    change(
      ...config_of(state).map(([key]) => [key, null] as [string, null]),
      ...Object.entries(keys).map(([key, value]) => [key, String(value)] as [string, string]),
    );
  });
  const on_click = (id: string, act: () => unknown) =>
    element(id).addEventListener("click", async () => {
      try {
        await act();
      } catch (error) {
        show_error((error as Error).message);
      }
    });
  on_click("reset", () => {
    state = without_view(state);
    show_state();
  });
  on_click("theme", () => {
    const theme = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
    change(["theme", theme]);
    set_theme();
  });
  element("sweep").addEventListener("toggle", ask_sweep);
  on_click("step_start", () => {
    stepped = "";
    show_stepping();
  });
  on_click("step_one", () => {
    stepping.pause();
    stepping.run(1);
  });
  on_click("step_play", () => stepping.toggle());
  element("step_stall").addEventListener("input", (event) => {
    element("step_stalls").textContent = `${(event.target as HTMLInputElement).value} %`;
  });
  on_click("copy_link", () => copy(location.href.replace(/#.*/, "") + state_text(state), "Link"));
  on_click("copy_command", async () => {
    if (!drawn) return;  // the error that stands there says why
    const note = colours_differ(state, drawn) ? " It draws the same fragments, in colours of the program's own." : "";
    await copy(command_line(state, drawn, drawn.is_scene ? "" : await quads_text()), "Command", note);
  });
  on_click("save_png", () => canvas.toBlob((blob) => save("page.png", blob!, "image/png")));
  on_click("save_quads", async () => save("page.quads", await quads_text(), "text/plain"));
  on_click("save_toml", () => save("page.toml", toml_text(state), "text/plain"));
  window.addEventListener("hashchange", () => {
    address = location.hash;
    state = read_state();
    set_theme();
    show_state();
  });
}

async function start() {
  set_theme();
  const answer = await machine.call("lists");
  if (answer.error) return show_error(answer.error);
  lists = answer.result as unknown as Lists;
  state = read_state();
  fill_scenes(element("scene"), lists);
  fill_options(element("shade"), ["texture", "uv", "normal", "lambda", "depth", "quad", "planes", "colour"].map((s) => [s, s]));
  fill_options(element("texture"), [["checker", "checkers"], ["fine", "fine checkers"], ["grid", "grid"], ["globe", "globe"], ["own", "own picture"]]);
  fill_options(element("cull"), ["none", "front", "back"].map((s) => [s, s]));
  fill_options(element("view"), views);
  fill_options(element("difference"), [["", "the picture"], ["1", "difference × 16"], ["error", "error against exact, by the bound"]]);
  fill_options(element("named"), [["", "own"], ...named_configurations.map(([name]) => [name, name] as [string, string])]);
  sliders = new Sliders(element("sliders"), lists.keys, (key, value) => change([key, value]));
  listen();
  show_state();
}

/** What tests look at: the model's answers to requests of their own, and whether the page is up to date. */
Object.assign(window, {
  quadrille: {
    call: (name: string, text: string) => machine.call(name, text),
    frames: () => frames,
    hash: () => state_text(state),
    request: () => request_text(state),
    config: () => config_text(state),
    settled: () => drawn !== null && !draw.busy && !configure.busy,
    all_settled: () => drawn !== null && !draw.busy && !configure.busy && !look.busy && !explain.busy && !sweep.busy,
  },
});
start();
