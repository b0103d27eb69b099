"use strict";
// In place of the server: the first-order model of doe_kc/live/first_order.py, with its own undo and snapshots.
function embeddedSource() {
  const data = JSON.parse(document.getElementById("embedded").textContent);
  const floats = (text) => {
    const raw = atob(text), bytes = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; i += 1) bytes[i] = raw.charCodeAt(i);
    return new Float32Array(bytes.buffer);
  };
  const names = ["characteristics", "characteristic_slopes", "curves", "slopes", "pull", "hessian", "influence"];
  const arrays = Object.fromEntries(names.map((name) => [name, floats(data[name])]));
  const points = floats(data.shapes.points), pointSlopes = floats(data.shapes.slopes);
  const k = data.base.length, m = data.model.characteristics.length;
  const place = (value, [lower, upper, logarithmic]) => logarithmic ? Math.log(value / lower) / Math.log(upper / lower) : (value - lower) / (upper - lower);
  const origin = data.base.map((v, i) => place(v, data.places[i]));
  const start = { values: data.base.slice(), snapshots: data.references.slice(1) };
  let state = start, past = [], future = [], gesture = "", seen = ["", 0], seq = 0;

  function linear(base, slopes, shift) {
    const out = new Float32Array(base), moved = [];
    shift.forEach((s, j) => { if (s !== 0) moved.push([j, s]); });
    for (let i = 0; i < out.length && i * k < slopes.length; i += 1) {
      let sum = 0;
      for (const [j, s] of moved) sum += slopes[i * k + j] * s;
      out[i] += sum;
    }
    return out;
  }
  const shiftOf = (values) => values.map((v, i) => v === data.base[i] ? 0 : place(v, data.places[i]) - origin[i]);

  function gapOf(shift) {
    if (!data.data) return NaN;
    let square = data.chi;
    for (let i = 0; i < k; i += 1) {
      square += 2 * arrays.pull[i] * shift[i];
      for (let j = 0; j < k; j += 1) square += shift[i] * arrays.hessian[i * k + j] * shift[j];
    }
    return Math.sqrt(Math.max(0, square) / data.data);
  }
  function exactOf(values, characteristics, gap) {
    const exact = new Float64Array(k + 2 * m + 3).fill(NaN);
    exact.set(values, 0);
    exact.set(characteristics, k);
    exact[k + 2 * m] = gap;
    return exact;
  }
  function answer() {
    const shift = shiftOf(state.values);
    return { curves: linear(arrays.curves, arrays.slopes, shift), gap: gapOf(shift),
      characteristics: linear(arrays.characteristics, arrays.characteristic_slopes, shift) };
  }
  function tellPresent() {
    const now = answer();
    onFrame({ kind: PRESENT, seq, exact: exactOf(state.values, now.characteristics, now.gap), drawn: now.curves, text: { failure: "" } });
    tellShape();
  }
  function tellShape() {
    const rows = data.shapes.rows.map(([c, r], i) => [c, r, i]).filter(([c]) => c === seen[0]);
    if (!rows.length) return;
    const [loadCase, row, i] = rows.reduce((a, b) => Math.abs(b[1] - seen[1]) < Math.abs(a[1] - seen[1]) ? b : a);
    const n = data.shapes.length, shift = shiftOf(state.values), drawn = new Float32Array(points.subarray(i * n, (i + 1) * n));
    shift.forEach((s, j) => { if (s !== 0) { const from = (i * k + j) * n; for (let p = 0; p < n; p += 1) drawn[p] += s * pointSlopes[from + p]; } });
    onFrame({ kind: SHAPE, seq, exact: new Float64Array(0), drawn, text: { load_case: loadCase, row, input: data.shapes.inputs[i] } });
  }
  function tellState() {
    onSaid({ kind: "state", locked: [], held: [], bounds: {}, effects: {}, snapshots: state.snapshots.map((s) => s.name), undo: past.length > 0, redo: future.length > 0 });
    [data.references[0], ...state.snapshots].forEach((r, i) => {
      const characteristics = typeof r.characteristics === "string" ? floats(r.characteristics) : r.characteristics;
      const drawn = typeof r.curves === "string" ? floats(r.curves) : r.curves;
      onFrame({ kind: REFERENCE, seq: i, exact: exactOf(r.values, characteristics, NaN), drawn, text: { name: r.name } });
    });
  }
  function change(next, name = "") {
    if (!name || name !== gesture) past.push(state);
    gesture = name;
    future = [];
    state = next;
  }
  function move(message) {
    const i = data.model.sliders.findIndex((s) => s.path === message.path), s = data.model.sliders[i];
    if (!(message.value >= s.lower && message.value <= s.upper)) {
      onSaid({ kind: "refused", reason: `${s.path} = ${message.value}: outside its bounds ${s.lower} to ${s.upper} ${s.unit}.` });
      return;
    }
    change({ ...state, values: state.values.map((v, j) => j === i ? message.value : v) }, message.path);
    if (message.last) gesture = "";
  }
  const DO = {
    move,
    reset: (message) => change({ ...state, values: state.values.map((v, i) => !message.path || data.model.sliders[i].path === message.path ? data.base[i] : v) }),
    undo: () => { if (past.length) { future.push(state); state = past.pop(); gesture = ""; } },
    redo: () => { if (future.length) { past.push(state); state = future.pop(); gesture = ""; } },
    snapshot: () => { const now = answer(); change({ ...state, snapshots: [...state.snapshots, { name: `Snapshot ${state.snapshots.length + 1}`, values: state.values, ...now }].slice(-3) }); },
    drop: (message) => change({ ...state, snapshots: state.snapshots.filter((s, i) => i !== message.place) }),
    restore: (message) => change({ ...state, values: state.snapshots[message.place].values }),
    look: (message) => { seen = [message.load_case, message.row]; },
  };
  function send(message) {
    if (!(message.kind in DO)) return;
    seq = Math.max(seq, message.seq || 0);
    DO[message.kind](message);
    if (message.kind === "look") { tellShape(); return; }
    if (message.kind !== "move" || message.last) tellState();
    tellPresent();
  }
  document.body.classList.add("static", "approximate");
  live.approximate = true;
  setTimeout(() => {
    onSaid(data.model);
    tellState();
    onFrame({ kind: INFLUENCE, seq: 0, exact: Float64Array.from(arrays.influence), drawn: new Float32Array(0), text: { sliders: k } });
    tellPresent();
    const notice = document.getElementById("approximation");
    notice.hidden = false;
    notice.textContent = data.sentence;
    say("");
  }, 0);
  return { embedded: true, send };
}
