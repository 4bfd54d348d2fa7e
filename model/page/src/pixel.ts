// One pixel taken apart: what `quadrille explain` says, in the page.

interface Quantity {
  name: string;
  meaning: string;
  unit: string;
  format: "integer" | "fixed" | "significand";
  stored: Record<string, number | string>;
  value: number;
  unused: boolean;
  exact: number | null;
  error_ulp: number | null;
  of_bound: number | null;
}

interface Stage {
  name: string;
  title: string;
  unit: string;
  formulas: string[];
  source: string;
  remarks: string[];
  numbers: Quantity[];
}

interface Explanation {
  quad: number;
  outcome: string;
  why: string;
  seen: boolean;
  place: string;
  flags: string[];
  remarks: string[];
  stages: Stage[];
}

export interface Explained {
  x: number;
  y: number;
  summary: string;
  quads: Explanation[];
}

function node(tag: string, text = "", children: Node[] = [], name = ""): HTMLElement {
  const made = document.createElement(tag);
  if (text) made.textContent = text;
  if (name) made.className = name;
  made.append(...children);
  return made;
}

function hexadecimal(stored: Quantity["stored"]): string {
  return Object.entries(stored)
    .map(([name, value]) => {
      const integer = BigInt(value);
      const digits = (integer < 0n ? -integer : integer).toString(16);
      const hex = `${integer < 0n ? "−" : ""}0x${digits}`;
      return Object.keys(stored).length === 1 ? hex : `${name.replace(/.*\./, "")} ${hex}`;
    })
    .join(", ");
}

const real = (value: number | null) => (value === null ? "" : String(Number(value.toPrecision(9))));

function row(n: Quantity): HTMLElement {
  const cells = [
    node("th", n.name),
    node("td", n.unused ? "not used" : hexadecimal(n.stored), [], "number"),
    node("td", n.unused ? "" : `${real(n.value)} ${n.unit}`, [], "number"),
    node("td", n.unused ? "" : real(n.exact), [], "number"),
    node("td", n.unused || n.of_bound === null ? "" : n.of_bound.toFixed(3), [], "number"),
  ];
  cells[0].setAttribute("scope", "row");
  cells[0].title = n.meaning;
  return node("tr", "", cells);
}

function stage(s: Stage): HTMLElement {
  const head = ["number", "stored", "value", "exact", "error / bound"].map((text) => node("th", text));
  for (const cell of head) cell.setAttribute("scope", "col");
  const header = node("tr", "", head), rows = s.numbers.map(row);
  // Columns with nothing in them take no room.
  for (let at = head.length - 1; rows.every((r) => r.children[at].textContent === "") && at > 2; --at)
    for (const r of [header, ...rows]) r.children[at].remove();
  const parts: Node[] = [node("summary", `${s.name}: ${s.title}`)];
  if (s.formulas.length) parts.push(node("p", s.formulas.join("\n"), [], "formula"));
  if (s.source) parts.push(node("p", s.source, [], "quiet"));
  for (const remark of s.remarks) parts.push(node("p", remark));
  if (s.numbers.length)
    parts.push(
      node("div", "", [node("table", "", [node("thead", "", [header]), node("tbody", "", rows)])], "wide"),
    );
  return node("details", "", parts);
}

export function show_explained(box: HTMLElement, explained: Explained) {
  const open = new Set([...box.querySelectorAll("details[open]")].map((d) => (d as HTMLElement).dataset.stage));
  const parts: Node[] = [];
  for (const e of explained.quads) {
    const flags = e.flags.length ? ` Flags: ${e.flags.join(", ")}.` : "";
    const what = explained.quads.length > 1 ? `Quad ${e.quad}${e.seen ? ", seen" : ""}: ` : "";
    parts.push(node("p", `${what}${e.outcome.replaceAll("_", " ")}: ${e.why.replace(/\.$/, "")}.${flags}`));
    for (const remark of e.remarks) parts.push(node("p", remark, [], "quiet"));
    for (const s of e.stages) {
      const made = stage(s) as HTMLDetailsElement;
      made.dataset.stage = s.name;
      made.open = open.has(s.name);
      parts.push(made);
    }
  }
  if (!explained.quads.length) parts.push(node("p", explained.summary));
  box.replaceChildren(...parts);
}
