// What the shaders may lose in fp32 at a pixel: running error analysis (Wilkinson), in double, of their formulas.

/** Half an ulp of fp32, relative. Beyond correct rounding GLSL 4.50 (section 4.7.1) and Vulkan allow 2.5 ulp of a
 * division and 2 ulp of an inverse square root, of which a root is the inverse. */
const unit = 2 ** -24, division_units = 5, root_units = 4 + division_units;
/** Terms of second order, for at most some 50 operations in a row. */
const higher_orders = 1.00001;

// A number is [value, bound of its absolute error].
const made = (value, error, units = 1) => [value, error + units * unit * (Math.abs(value) + error)];
const given = (value) => [value, unit * Math.abs(value)];
const exact = (value) => [value, 0];
const add = (a, b) => made(a[0] + b[0], a[1] + b[1]);
const subtract = (a, b) => made(a[0] - b[0], a[1] + b[1]);
const times = (a, b) => made(a[0] * b[0], Math.abs(a[0]) * b[1] + Math.abs(b[0]) * a[1] + a[1] * b[1]);
const negative = (a) => [-a[0], a[1]];
function divide(a, b) {
  const least = Math.abs(b[0]) - b[1], quotient = a[0] / b[0];
  return least > 0 ? made(quotient, (a[1] + Math.abs(quotient) * b[1]) / least, division_units) : [quotient, Infinity];
}
function root(a) {
  const value = Math.sqrt(Math.max(0, a[0])), least = Math.sqrt(Math.max(0, a[0] - a[1]));
  return made(value, value > 0 ? a[1] / (value + least) : Math.sqrt(a[1]), root_units);
}
/** In any order. */
function sum(terms) {
  const size = terms.reduce((all, t) => all + Math.abs(t[0]) + t[1], 0);
  return [terms.reduce((all, t) => all + t[0], 0), terms.reduce((all, t) => all + t[1], 0) + 3 * unit * size];
}

const all = [0, 1, 2, 3];
const geometry = (x, y, w, px, py) => {
  const sx = all.map((i) => subtract(x[i], times(w[i], exact(px)))), sy = all.map((i) => subtract(y[i], times(w[i], exact(py))));
  return {
    r: all.map((i) => root(add(times(sx[i], sx[i]), times(sy[i], sy[i])))),
    cross: (i, j) => subtract(times(sx[i], sy[j]), times(sy[i], sx[j])),
    dot: (i, j) => add(times(sx[i], sx[j]), times(sy[i], sy[j])),
  };
};

function printed(x, y, w, px, py) {
  const g = geometry(all.map((i) => divide(x[i], w[i])), all.map((i) => divide(y[i], w[i])), all.map(() => exact(1)), px, py);
  const r = all.map((i) => (w[i][0] < 0 ? negative(g.r[i]) : g.r[i]));
  const t = all.map((i) => divide(subtract(times(r[i], r[(i + 1) % 4]), g.dot(i, (i + 1) % 4)), g.cross(i, (i + 1) % 4)));
  const mu = all.map((i) => divide(add(t[(i + 3) % 4], t[i]), r[i])), whole = sum(mu);
  return mu.map((m) => divide(m, whole));
}

function determinant(x, y, w, px, py, size) {
  const near = (c) => (w[0][0] > 0 ? Math.min(Math.max(Math.round(Math.fround(c[0][0] / w[0][0])), 0), size) : size / 2);
  const at = [near(x), near(y)];
  const [dx, dy] = [x, y].map((c, axis) => all.map((i) => subtract(c[i], times(exact(at[axis]), w[i]))));
  const det = (i, j, k) =>
    sum([
      times(dx[i], subtract(times(dy[j], w[k]), times(w[j], dy[k]))),
      times(dy[i], subtract(times(w[j], dx[k]), times(dx[j], w[k]))),
      times(w[i], subtract(times(dx[j], dy[k]), times(dy[j], dx[k]))),
    ]);
  const n = [det(1, 2, 3), negative(det(0, 2, 3)), det(3, 0, 1), negative(det(2, 0, 1))];
  const first = Math.abs(n[1][0]) > Math.abs(n[3][0]) ? 2 : 0, turned = all.map((i) => (first + i) % 4);
  const g = geometry(dx, dy, w, px - at[0], py - at[1]);
  const a = [g.cross(turned[1], turned[2]), g.cross(turned[2], turned[0]), g.cross(turned[0], turned[1]), exact(0)];
  const signed = (i) => (i % 2 ? negative(g.r[turned[i]]) : g.r[turned[i]]);
  const t = divide(sum(all.map((i) => times(signed(i), a[i]))), sum(all.map((i) => times(signed(i), n[turned[i]]))));
  const m = [];
  all.forEach((i) => (m[turned[i]] = subtract(a[i], times(t, n[turned[i]]))));
  return m;
}

/** Of the four weights with perspective. `quad`: x, y, w, k of the corners as the shader gets them; `size`: the viewport's side. */
export function weight_bounds(form, quad, px, py, size) {
  const [x, y, w, k] = all.map((row) => all.map((i) => given(quad[4 * row + i])));
  const m = form === "printed" ? printed(x, y, w, px, py) : determinant(x, y, w, px, py, size);
  const weighed = all.map((i) => times(m[i], form === "printed" ? divide(k[i], w[i]) : k[i])), whole = sum(weighed);
  return weighed.map((value) => higher_orders * divide(value, whole)[1]);
}
