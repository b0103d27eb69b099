"use strict";
// The binary frames of doe_kc/live/frames.py, and where each curve lies in them.
const PRESENT = 1, REFERENCE = 2, SHAPE = 3, INFLUENCE = 4;
const HEADER_BYTES = 24;

function decodeFrame(buffer) {
  const [kind, seq, doubles, floats, text] = new Uint32Array(buffer, 0, 6);
  const exact = new Float64Array(buffer, HEADER_BYTES, doubles);
  const drawn = new Float32Array(buffer, HEADER_BYTES + 8 * doubles, floats);
  const said = new Uint8Array(buffer, HEADER_BYTES + 8 * doubles + 4 * floats, text);
  return { kind, seq, exact, drawn, text: JSON.parse(new TextDecoder().decode(said)) };
}

class CurveLayout {
  constructor(model) {
    this.responses = model.responses.map((r) => r.id);
    this.starts = new Map();
    let at = 0;
    for (const c of model.cases) {
      this.starts.set(c.id, [at, c.input.length]);
      at += c.input.length * this.responses.length * 2;
    }
    this.size = at;
  }
  // Mean (or half-width) curve of one wheel, a view into the frame: side 0 left, 1 right.
  curve(drawn, loadCase, response, side, half = false) {
    const [start, n] = this.starts.get(loadCase);
    const from = start + (2 * this.responses.indexOf(response) + side) * n + (half ? this.size : 0);
    return drawn.subarray(from, from + n);
  }
}

class AnswerLayout {
  constructor(model) {
    this.d = model.sliders.length;
    this.m = model.characteristics.length;
  }
  values(exact) { return exact.subarray(0, this.d); }
  characteristics(exact) { return exact.subarray(this.d, this.d + this.m); }
  terms(exact) { return exact.subarray(this.d + this.m, this.d + 2 * this.m); }
  totals(exact) { const at = this.d + 2 * this.m; return { gap: exact[at], rating: exact[at + 1], seconds: exact[at + 2] }; }
}

// Text of a node, touched only where it is another: the browser lays out anew whatever is touched.
function put(node, text) {
  if (node.shownText === text) return;
  node.shownText = text;
  node.textContent = text;
}

function short(value, digits = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.floor(Math.log10(Math.abs(value)));
  return value.toFixed(Math.min(8, Math.max(0, digits - 1 - size))).replace("-", "−");
}

function interpolate(at, x, y) {
  if (at < x[0] || at > x[x.length - 1]) return NaN;
  let i = 1;
  while (i < x.length - 1 && x[i] < at) i += 1;
  const share = (at - x[i - 1]) / (x[i] - x[i - 1]);
  return y[i - 1] + share * (y[i] - y[i - 1]);
}
