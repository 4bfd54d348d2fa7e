"use strict";
// Draws the figures; a mark of a point shows its configuration and errors, a click keeps them.
const D = JSON.parse(document.getElementById("points").textContent);
const F = JSON.parse(document.getElementById("figures").textContent);
const at = new Map(D.row.map((row, i) => [row, i]));
const escape = text => String(text).replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;");
const error = v => v > 0 ? `${v < 1e-3 ? v.toExponential(3) : v.toPrecision(4)} = 2<sup>${Math.log2(v).toFixed(2)}</sup>`.replace(/-/g, "−") : String(v);
const shown = (column, v) => v === null ? "–" : D.errors.includes(column) ? error(v) : v.toLocaleString("en-US");
function wrap(parts, separator, width) {
  const lines = [""];
  for (const part of parts) {
    if (lines.at(-1) && lines.at(-1).length + part.length > width) lines.push("");
    lines[lines.length - 1] += part + separator;
  }
  return lines.map(line => escape(line.trimEnd())).join("<br>");
}
function hover(name, row, columns) {
  const i = at.get(row);
  const lines = [`<b>${name}</b>, row ${row}`, wrap(D.words[i], "   ", 60)];
  for (const column of columns) lines.push(`${D.titles[column]}: ${shown(column, D.values[column][i])}`);
  if (D.worst[i]) lines.push("worst fragment:<br>" + wrap(D.worst[i].split(" "), " ", 84));
  return lines.join("<br>");
}
function pin(box, row) {
  const i = at.get(row);
  const values = Object.keys(D.values).map(column => `<tr><td>${D.titles[column]}</td><td>${shown(column, D.values[column][i])}</td></tr>`).join("");
  box.innerHTML = `<b>Row ${row}</b>: <code>${escape(D.words[i].join(", "))}</code> <a href="${escape(D.page + D.keys[i])}">draw with it</a> <button type="button">close</button>` +
    (D.worst[i] ? `<br>Its worst fragment: <code>${escape(D.worst[i])}</code>` : "") +
    `<details><summary>All values</summary><table><tbody>${values}</tbody></table></details>`;
  box.querySelector("button").onclick = () => { box.innerHTML = ""; };
}
function prepare(figure) {
  for (const trace of figure.ready ? [] : figure.data) {
    if (!trace.customdata) continue;
    trace.text = trace.customdata.map(row => hover(trace.name, row, figure.columns));
    trace.hovertemplate = "%{text}<extra></extra>";
  }
  figure.ready = true;
  return figure;
}
function plot(div) {
  const figures = F[div.dataset.figures], box = document.getElementById(div.dataset.pin), choice = document.getElementById(div.dataset.choice || "");
  const settings = {responsive: true, displaylogo: false, modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d", "toImage"]};
  const draw = n => {
    const f = prepare(figures[n]);
    return Plotly.react(div, f.data, f.layout, {...settings, displayModeBar: f.layout.height > 350});
  };
  draw(choice ? Number(choice.value) : 0).then(() => div.on("plotly_click", event => {
    const row = event.points[0].customdata;
    if (row !== undefined) pin(box, row);
  }));
  if (choice) choice.onchange = () => draw(Number(choice.value));
}
document.querySelectorAll(".plot").forEach(plot);
