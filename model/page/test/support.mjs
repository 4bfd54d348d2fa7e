// What the page's tests share: a server, the browser, the program, and fragments in one form.
import { execFile } from "node:child_process";
import { createHash } from "node:crypto";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { readdir, readFile } from "node:fs/promises";
import { extname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { promisify } from "node:util";

export const run = promisify(execFile);
export const root = resolve(fileURLToPath(import.meta.url), "../../../..");
export const page_folder = join(root, "build/page");
/** Of the program quadrille. */
export const program = process.env.QUADRILLE ?? join(root, "build/release/quadrille");

const { chromium } = createRequire(join(root, "build/page-tools/"))("playwright-core");

const types = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm" };

/** A plain host of static files: of the page or, with a folder, of that, and of the page as page/. */
export async function serve(folder = null) {
  const server = createServer(async (request, response) => {
    const path = new URL(request.url, "http://host").pathname;
    if (path === "/favicon.ico") return response.writeHead(204).end();
    try {
      const of_page = folder === null ? path : path.match(/^\/page(\/.*)/)?.[1];
      const file = await readFile(of_page === undefined ? join(folder, path) : join(page_folder, of_page === "/" ? "index.html" : of_page));
      response.writeHead(200, { "content-type": types[extname(path)] ?? "text/html" }).end(file);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  return { address: `http://127.0.0.1:${server.address().port}/`, close: () => server.close() };
}

const options = { executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox", "--enable-unsafe-swiftshader"] };
export const launch = () => chromium.launch(options);

/** A browser, and the processor time in seconds that the workers of its pages took. */
export async function launch_watched() {
  const host = await chromium.launchServer(options);
  const browser = await chromium.connect(host.wsEndpoint());
  const stat = async (path) => {
    const text = await readFile(path, "utf8").catch(() => "");
    const [, name, rest] = text.match(/\((.*)\) (.*)/s) ?? [null, "", ""];
    const fields = rest.split(" ");
    return { name, parent: Number(fields[1]), ticks: Number(fields[11]) + Number(fields[12]) };
  };
  const worker_seconds = async () => {
    const parents = new Map();
    for (const pid of (await readdir("/proc")).filter((name) => /^\d+$/.test(name)))
      parents.set(Number(pid), (await stat(`/proc/${pid}/stat`)).parent);
    const is_ours = (pid) => pid === host.process().pid || (parents.has(pid) && pid > 1 && is_ours(parents.get(pid)));
    let ticks = 0;
    for (const pid of [...parents.keys()].filter(is_ours))
      for (const task of await readdir(`/proc/${pid}/task`).catch(() => [])) {
        const { name, ticks: own } = await stat(`/proc/${pid}/task/${task}/stat`);
        if (name.startsWith("DedicatedWorker")) ticks += own;
      }
    return ticks / 100;
  };
  return { browser, worker_seconds, close: async () => (await browser.close(), await host.close()) };
}

/** Opens the page with that hash; `problems` collects what must not happen. `prepare`: does more with the context. */
export async function open(browser, address, hash = "", options = {}, prepare = async () => {}) {
  const context = await browser.newContext({ viewport: { width: 1400, height: 900 }, ...options });
  await context.grantPermissions(["clipboard-read", "clipboard-write"]);
  await prepare(context);
  const page = await context.newPage();
  const problems = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) problems.push(`console: ${message.text()}`);
  });
  page.on("pageerror", (error) => problems.push(`error: ${error}`));
  page.on("request", (request) => {
    if (!/^(data|blob):/.test(request.url()) && !request.url().startsWith(address)) problems.push(`request: ${request.url()}`);
  });
  await page.goto(address + hash);
  await drawn(page);
  return { page, problems, close: () => context.close() };
}

/** Waits until the machine's picture is that of the page's state. */
export const drawn = (page) => page.waitForFunction(() => window.quadrille?.settled() ?? false, null, { timeout: 60000 });

/** One line of integers a fragment, by quad, y, x: runs here and in the page. heads: quad, x, y, front, flags, depth. */
export function fragment_lines(heads, codes, columns) {
  const order = Array.from({ length: heads.length / 6 }, (_, i) => i);
  order.sort((a, b) => heads[6 * a] - heads[6 * b] || heads[6 * a + 2] - heads[6 * b + 2] || heads[6 * a + 1] - heads[6 * b + 1]);
  return order.map((i) => [...heads.subarray(6 * i, 6 * i + 6), ...codes.subarray(columns * i, columns * (i + 1))].join(",")).join("\n");
}

export const sha256 = (text) => createHash("sha256").update(text).digest("hex");

/** Fragments of a request by the page: their number and the hash of their lines. */
export function page_fragments(page, text) {
  return page.evaluate(
    async ([request, source]) => {
      const answer = await window.quadrille.call("fragments", request);
      if (answer.error) throw new Error(answer.error);
      const { fragments, columns } = answer.result;
      const heads = new Uint32Array(answer.bytes, 0, 6 * fragments);
      const codes = new BigInt64Array(answer.bytes, 24 * fragments);
      const lines = new Function(`return ${source}`)()(heads, codes, columns);
      const digest = await crypto.subtle.digest("SHA-256", new TextEncoder().encode(lines));
      const hash = [...new Uint8Array(digest)].map((byte) => byte.toString(16).padStart(2, "0")).join("");
      return { fragments, hash };
    },
    [text, fragment_lines.toString()],
  );
}

/** The same of a table of `quadrille fragments`: every real is a code times a power of two. */
export function table_fragments(csv, attribute_frac = 24, depth_bits = 24) {
  const [head, ...rows] = csv.trimEnd().split("\n");
  const columns = head.split(",").length - 6;
  const heads = new Uint32Array(6 * rows.length), codes = new Float64Array(columns * rows.length);
  const code = (text, bits) => {
    const value = Number(text) * 2 ** bits;
    if (!Number.isInteger(value)) throw new Error(`${text} is no code of ${bits} fraction bits`);
    return value;
  };
  rows.forEach((row, i) => {
    const cells = row.split(",");
    heads.set([...cells.slice(0, 5).map(Number), code(cells[9], depth_bits)], 6 * i);
    codes.set([...cells.slice(5, 9), ...cells.slice(10)].map((cell) => code(cell, attribute_frac)), columns * i);
  });
  return { fragments: rows.length, hash: sha256(fragment_lines(heads, codes, columns)) };
}

export async function program_fragments(options, cwd) {
  const { stdout } = await run(program, ["fragments", ...options, "--out", "-", "--quiet"], { maxBuffer: 2 ** 30, cwd });
  return stdout;
}
