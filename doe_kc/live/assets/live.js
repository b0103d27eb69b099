"use strict";
// The page: what the server says is kept in `live`, painted once an animation frame, newest data only.
const $ = (id) => document.getElementById(id);
const CHARTS = 8, TOP = 10;
const live = {
  model: null, layout: null, answers: null, state: null, present: null, references: [], influence: null,
  side: "L", approximate: false, seq: 0, sent: 0, painted: -1, shown: -1, shownAt: 0, arrivedAt: 0, order: [], rows: new Map(), charts: [], axle: null,
  dragging: null, point: "", source: null, paints: 0, work: null, rowsSeen: null,
};

function make(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name === "text") node.textContent = value;
    else if (name === "class") node.className = value;
    else node.setAttribute(name, value);
  }
  node.append(...children);
  return node;
}

function say(words) { $("status").textContent = words; }
function send(message) { live.source.send(message); }
function ask(message) {
  live.sent = Math.max(live.sent, live.seq) + 1;
  send({ ...message, seq: live.sent });
}

// ---------------------------------------------------------------- what comes in
function onModel(model) {
  const places = live.model && live.charts.map((c) => c.place);
  live.model = model;
  live.layout = new CurveLayout(model);
  live.answers = new AnswerLayout(model);
  live.influence = null;
  live.references = [];
  live.places = places;
  live.built = false;
  document.title = `${model.study}: live`;
  $("title").textContent = `${model.study}`;
  $("title").title = model.axle;
  fillSelected();
  buildSliders();
  buildEffects();
  buildCharacteristics();
  fillCases();
  live.axle.setModel(model);
  $("advice-box").hidden = !model.data;
  if (!live.source.embedded) say(model.outside ? "connected; dashed curves are a surrogate's, solid ones the outside solver's" : "connected; every picture is the true model's");
}

function onState(state) {
  live.state = state;
  $("undo").disabled = !state.undo;
  $("redo").disabled = !state.redo;
  $("snapshot-keys").replaceChildren(...state.snapshots.map((name, i) => {
    const key = make("span", { class: `key s${i + 1}` }, name, " ");
    const back = make("button", { title: `Go back to ${name}`, text: "↩" }), drop = make("button", { title: `Drop ${name}`, text: "×" });
    back.addEventListener("click", () => ask({ kind: "restore", place: i }));
    drop.addEventListener("click", () => send({ kind: "drop", place: i }));
    key.append(back, drop);
    return key;
  }));
  live.references.length = Math.min(live.references.length, 1 + state.snapshots.length);
  $("since-head").textContent = state.snapshots.length ? `since ${state.snapshots.at(-1)}` : "since nominal";
  for (const row of live.rows.values()) updateSliderState(row);
  for (const row of document.querySelectorAll("#characteristics tr[data-id]")) {
    const box = row.querySelector("input");
    if (box) box.checked = state.held.includes(row.dataset.id);
  }
  updateEffects();
  wantPaint();
}

function onFrame(frame) {
  if (!live.model) return;
  if (frame.kind === PRESENT) {
    if (frame.seq < live.painted || frame.exact.length !== live.answers.d + 2 * live.answers.m + 3) return;
    live.present = frame;
    if (live.model.outside) document.body.classList.toggle("approximate", frame.text.true === false);
    live.arrivedAt = performance.now();
    live.seq = Math.max(live.seq, frame.seq);
  } else if (frame.kind === REFERENCE) {
    live.references[frame.seq] = frame;
  } else if (frame.kind === SHAPE) {
    live.shape = frame;
  } else if (frame.kind === INFLUENCE) {
    if (frame.text.sliders !== live.answers.d) return;
    const first = !live.influence;
    live.influence = frame.exact;
    if (first) arrange();
    else updateBars();
  }
  if (!live.built && live.present && live.references[0]) buildCharts();
  wantPaint();
}

function onSaid(said) {
  if (said.kind === "model") onModel(said);
  else if (said.kind === "state") onState(said);
  else if (said.kind === "refused") { say(said.reason); document.body.dataset.refused = said.reason; snapBack(); }
  else if (said.kind === "kept") say(said.sentence);
  else if (said.kind === "advice") showAdvice(said);
  else if (said.kind === "work") showWork(said);
}

// ---------------------------------------------------------------- painting
let wanted = false;
function wantPaint() {
  if (wanted) return;
  wanted = true;
  requestAnimationFrame(() => { wanted = false; paint(); });
}

function paint() {
  if (live.shape) {
    live.axle.setShape(live.shape);
    const c = live.model.cases.find((k) => k.id === live.shape.text.load_case);
    put($("axle-input"), `${short(live.shape.text.input, 3)} ${c ? c.unit : ""}`);
    const arrows = live.axle.arrows ? `; arrows: moved points ×${ARROW_FACTOR}` : "";
    put($("arrow-note"), `drawn ×${live.axle.factor}${arrows}`);
    live.shape = null;
  }
  if (!live.present || !live.built) return;
  for (const chart of live.charts) chart.paint();
  paintTotals();
  paintCharacteristics();
  paintSliders();
  const failure = live.present.text.failure;
  $("failure").hidden = !failure;
  put($("failure"), failure ? `No answer: ${failure}. The last good design is shown.` : "");
  live.painted = live.present.seq;
  live.paints += 1;
  document.body.dataset.seq = live.painted;
  const seq = live.painted; // the task after this one begins when the browser has drawn the frame
  setTimeout(() => { live.shown = seq; live.shownAt = performance.now(); }, 0);
}

function paintTotals() {
  const totals = live.answers.totals(live.present.exact);
  put($("gap"), short(totals.gap, 4));
  put($("rating"), short(totals.rating, 4));
  put($("seconds"), Number.isFinite(totals.seconds) ? `${(1000 * totals.seconds).toFixed(0)} ms` : "–");
  const values = live.answers.characteristics(live.present.exact), rated = live.model.characteristics.filter((c) => c.target !== null);
  const inside = rated.filter((c) => { const v = values[live.model.characteristics.indexOf(c)]; return v >= c.low && v <= c.high; });
  put($("inside"), rated.length ? `${inside.length} of ${rated.length}` : "–");
}

// ---------------------------------------------------------------- sliders
function buildSliders() {
  live.rows.clear();
  live.order = live.model.sliders.map((s) => s.path);
  for (const slider of live.model.sliders) live.rows.set(slider.path, sliderRow(slider));
  arrange();
}

function sliderRow(slider) {
  const code = slider.path, name = `${code}, ${slider.label}`;
  const range = make("input", { type: "range", "aria-label": name });
  const number = make("input", { type: "number", "aria-label": `${name}, value in ${slider.unit}` });
  const reset = make("button", { title: "Back to the start", "aria-label": `Reset ${code}`, text: "↺" });
  const lock = make("input", { type: "checkbox", "aria-label": `Lock ${code}` });
  const bar = make("i"), lower = make("input", { type: "number", step: "any", "aria-label": `${code}, lower bound` });
  const upper = make("input", { type: "number", step: "any", "aria-label": `${code}, upper bound` });
  const node = make("div", { class: "slider", "data-path": code },
    make("div", { class: "head" }, make("b", { text: code }), make("span", { text: slider.label, title: name })),
    make("div", { class: "body" }, range, number, make("span", { class: "soft", text: slider.unit === "-" ? "" : slider.unit }), reset,
      make("label", { class: "lock", title: "Lock: advice leaves it alone" }, lock)),
    make("div", { class: "bar" }, bar));
  const more = make("button", { class: "more server", "aria-expanded": "false", "aria-label": `Bounds of ${code}`, text: "bounds" });
  const edges = make("div", { class: "edges", hidden: "" }, make("label", {}, "from ", lower), make("label", {}, "to ", upper));
  more.addEventListener("click", () => { edges.hidden = !edges.hidden; more.setAttribute("aria-expanded", String(!edges.hidden)); });
  node.firstChild.append(more);
  node.append(edges);
  const row = { slider, node, range, number, reset, lock, bar, lower, upper };
  const move = (value, last) => {
    live.dragging = last ? null : code;
    ask({ kind: "move", path: code, value, last });
  };
  range.addEventListener("input", () => { number.value = tidy(Number(range.value), slider); move(Number(range.value), false); });
  range.addEventListener("change", () => move(Number(range.value), true));
  number.addEventListener("change", () => { if (number.value !== "" && Number.isFinite(Number(number.value))) move(Number(number.value), true); else snapBack(); });
  reset.addEventListener("click", () => ask({ kind: "reset", path: code }));
  lock.addEventListener("change", () => send({ kind: "lock", paths: [code], on: lock.checked }));
  const bounds = () => { const a = Number(lower.value), b = Number(upper.value); if (Number.isFinite(a) && Number.isFinite(b)) send({ kind: "bounds", path: code, lower: a, upper: b }); };
  lower.addEventListener("change", bounds);
  upper.addEventListener("change", bounds);
  setBounds(row, slider.lower, slider.upper);
  return row;
}

function setBounds(row, lower, upper) {
  if (row.from === lower && row.to === upper) return;
  [row.from, row.to] = [lower, upper];
  Object.assign(row.range, { min: lower, max: upper, step: "any" });
  const step = Math.min(row.slider.step / 10, (upper - lower) / 200);
  row.keyStep = step;
  Object.assign(row.number, { step: "any" });
  row.lower.value = tidy(lower, row.slider);
  row.upper.value = tidy(upper, row.slider);
}

// Arrow keys move a tenth of the parameter's step, Page keys ten times that: "any" alone would leave them to the browser.
document.addEventListener("keydown", (e) => {
  const node = e.target.closest && e.target.closest(".slider");
  if (!node || e.target.type !== "range") return;
  const row = live.rows.get(node.dataset.path), steps = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 10, PageDown: -10 };
  if (!(e.key in steps)) return;
  e.preventDefault();
  const value = Math.min(row.to, Math.max(row.from, Number(row.range.value) + steps[e.key] * row.keyStep));
  row.range.value = value;
  row.number.value = tidy(value, row.slider);
  ask({ kind: "move", path: row.slider.path, value, last: true });
});

function tidy(value, slider) {
  const places = Math.max(0, Math.min(8, 2 - Math.floor(Math.log10(slider.step || 1))));
  return String(Number(value.toFixed(places)));
}

function updateSliderState(row) {
  const { path, lower, upper } = row.slider, state = live.state;
  const [a, b] = state.bounds[path] || [lower, upper];
  setBounds(row, a, b);
  row.lock.checked = state.locked.includes(path);
  row.node.classList.toggle("locked", row.lock.checked);
}

function paintSliders() {
  const values = live.answers.values(live.present.exact);
  if (live.present.seq < live.sent) return; // my own newer value is on its way
  live.model.sliders.forEach((slider, i) => {
    const row = live.rows.get(slider.path), value = values[i];
    if (row.shown === value) return;
    row.shown = value;
    row.moved = Math.abs(value - slider.start) > 1e-12 * Math.max(1, Math.abs(value));
    row.node.classList.toggle("moved", row.moved);
    if (live.dragging === slider.path) return;
    row.range.value = value;
    if (document.activeElement !== row.number) row.number.value = tidy(value, slider);
  });
  if (!live.dragging) refreshShown();
}

// A group that depends on what is set follows it, but never while a hand or the focus is in the list.
function refreshShown() {
  if (!["moved", "free"].includes($("group").value) || $("sliders").contains(document.activeElement)) return;
  const shown = Array.from($("sliders").children, (n) => n.dataset.path).join();
  if (shown !== shownPaths().join()) showSliders();
}

function snapBack() {
  live.sent = live.seq;
  live.dragging = null;
  for (const row of live.rows.values()) { row.shown = undefined; row.from = undefined; updateSliderState(row); }
  if (live.present) paintSliders();
}

// Influence of every slider on what is selected, over its present range.
function influenceOn() {
  if (!live.influence) return null;
  const d = live.answers.d, row = Number($("selected").value || 0);
  const numbers = live.influence.subarray(row * d, (row + 1) * d);
  return live.model.sliders.map((s, i) => {
    const r = live.rows.get(s.path);
    return row === 0 ? numbers[i] : numbers[i] * (r.to - r.from) / 2;
  });
}

function updateBars() {
  const all = influenceOn();
  if (!all) return;
  const most = Math.max(...all.map(Math.abs)) || 1;
  const row = Number($("selected").value || 0);
  const unit = row === 0 ? "sd less of the gap" : $("selected").selectedOptions[0].dataset.unit;
  live.model.sliders.forEach((s, i) => {
    const { bar, node } = live.rows.get(s.path), width = 50 * Math.abs(all[i]) / most, plus = all[i] >= 0;
    bar.style.width = `${width}%`;
    bar.style.left = plus ? "50%" : `${50 - width}%`;
    bar.className = plus ? "" : "minus";
    bar.parentElement.title = row === 0 ? `alone at its best takes ${short(Math.abs(all[i]), 3)} ${unit}, by ${plus ? "raising" : "lowering"} it`
      : `half its range changes it by ${short(all[i], 3)} ${unit}`;
    node.dataset.influence = all[i];
  });
}

// The order changes only when it is asked for: a list that moves under the hand cannot be used.
function arrange() {
  updateBars();
  const all = influenceOn(), order = live.model.sliders.map((s, i) => [s.path, all ? Math.abs(all[i]) : -i]);
  order.sort((a, b) => b[1] - a[1]);
  live.order = order.map((o) => o[0]);
  showSliders();
}

function shownPaths() {
  const words = $("search").value.trim().toLowerCase().split(/\s+/).filter(Boolean), group = $("group").value;
  const fits = (path) => {
    const { slider } = live.rows.get(path), text = `${path} ${slider.label}`.toLowerCase();
    if (live.point && slider.point !== live.point) return false;
    if (!words.every((w) => text.includes(w))) return false;
    if (words.length || live.point || group === "" || group === "top") return true;
    if (group === "moved") return live.rows.get(path).moved;
    if (group === "free") return !live.state.locked.includes(path);
    return slider.group === group;
  };
  const found = live.order.filter(fits);
  return group === "top" && !words.length && !live.point ? found.slice(0, TOP) : found;
}

function showSliders() {
  const shown = shownPaths();
  $("sliders").replaceChildren(...shown.map((p) => live.rows.get(p).node));
  $("count").textContent = `${shown.length} of ${live.model.sliders.length}${live.point ? `, of point ${live.point}` : ""}`;
}

function fillSelected() {
  const before = $("selected").value, m = live.model.characteristics.length;
  const options = [make("option", { value: 0, text: live.model.data ? "Order and bars: the gap" : "Order and bars: all alike" })];
  const characteristics = make("optgroup", { label: "Characteristics" });
  live.model.characteristics.forEach((c, i) => characteristics.append(make("option", { value: 1 + i, text: `${c.case}: ${c.label}`, "data-unit": c.unit })));
  const curves = make("optgroup", { label: "Curves, RMS change" });
  live.model.cases.forEach((c, i) => live.model.responses.forEach((r, j) =>
    curves.append(make("option", { value: 1 + m + i * live.model.responses.length + j, text: `${c.label}: ${r.name}`, "data-unit": r.unit }))));
  $("selected").replaceChildren(...options, characteristics, curves);
  const steer = live.model.characteristics.findIndex((c) => c.id === "vertical.bump_steer");
  $("selected").value = before || String(live.model.data ? 0 : 1 + Math.max(0, steer));
}

// ---------------------------------------------------------------- effects
// Those of the axle file first; variants by another law are shown once they are on.
function buildEffects() {
  $("effects-box").hidden = !live.model.effects.length;
  $("effects").replaceChildren(...live.model.effects.map(effectRow));
}

function effectRow(e) {
  const on = make("input", { type: "checkbox", "aria-label": e.label });
  const sizes = e.sizes.map((s) => {
    const field = make("input", { type: "number", step: "any", value: s.value, "aria-label": `${e.label}, ${s.label} in ${s.unit}`, "data-size": s.name });
    return [field, make("label", {}, `${s.label} `, field, s.unit === "-" ? "" : s.unit)];
  });
  const back = make("button", { class: "back", title: e.of_file ? "As in the axle file" : "Off, sizes typical", "aria-label": `Reset ${e.label}`, text: "↺" });
  const lock = make("input", { type: "checkbox", class: "keep", "aria-label": `Lock ${e.label}` });
  const tell = () => ask({ kind: "effect", name: e.name, sizes: on.checked ? Object.fromEntries(sizes.map(([f]) => [f.dataset.size, Number(f.value)])) : null });
  on.addEventListener("change", tell);
  for (const [field] of sizes) field.addEventListener("change", () => on.checked && tell());
  back.addEventListener("click", () => { for (const [i, s] of e.sizes.entries()) sizes[i][0].value = s.value; ask({ kind: "reset_effect", name: e.name }); });
  lock.addEventListener("change", () => send({ kind: "lock_effect", name: e.name, on: lock.checked }));
  const head = make("label", { class: "what" }, on, ` ${e.label}`, e.of_file ? make("small", { class: "soft", text: " of the axle file" }) : "");
  return make("div", { class: "effect", "data-name": e.name, title: e.physics },
    make("div", { class: "head" }, head, back, make("label", { class: "lock", title: "Lock: Discover does not look for it" }, lock)),
    make("div", { class: "sizes" }, ...sizes.map((s) => s[1])));
}

function updateEffects() {
  for (const e of live.model.effects) {
    const node = document.querySelector(`#effects .effect[data-name="${CSS.escape(e.name)}"]`), sizes = live.state.effects[e.name];
    const on = sizes === undefined ? e.of_file : sizes !== null;
    node.querySelector("input[type=checkbox]").checked = on;
    node.querySelector(".keep").checked = live.state.locked_effects.includes(e.name);
    node.querySelector(".back").disabled = sizes === undefined;
    node.classList.toggle("on", on);
    node.hidden = Boolean(e.law) && !on;
    for (const [i, field] of node.querySelectorAll("[data-size]").entries()) {
      if (sizes && field.dataset.size in sizes) field.value = sizes[field.dataset.size];
      else if (e.of_file && sizes === undefined) field.value = e.sizes[i].value;
    }
  }
}

// ---------------------------------------------------------------- beside the page
function seconds(s) { return s < 90 ? `${Math.round(s)} s` : `${(s / 60).toFixed(1)} min`; }

function showWork(work) {
  const task = work.task, ended = task && ["done", "failed"].includes(task.state);
  live.work = { ...work, at: performance.now() };
  $("work").hidden = !task;
  for (const what of ["correlate", "discover"]) $(what).disabled = Boolean(task) && !ended;
  if (task) {
    const name = task.name[0].toUpperCase() + task.name.slice(1);
    document.body.dataset.task = `${task.name} ${task.state}`;
    $("work").className = task.state;
    $("work-bar").hidden = $("work-cancel").hidden = Boolean(ended);
    $("work-cancel").disabled = task.state === "cancelling";
    $("work-forget").hidden = !ended;
    $("work-adopt").hidden = !task.adoptable;
    if (task.total) { $("work-bar").max = task.total; $("work-bar").value = task.done; } else $("work-bar").removeAttribute("value");
    const lines = task.state === "done" ? task.lines : [task.words];
    const said = lines.map((line, i) => make("span", { text: i ? line : `${name}: ${line}` }));
    if ($("work-words").textContent !== said.map((n) => n.textContent).join("")) $("work-words").replaceChildren(...said);
    const left = task.left === null ? "" : `, ${seconds(task.left)} left`, rate = task.rate === null ? "" : `, ${short(task.rate, 2)} a second`;
    $("work-left").textContent = ended ? seconds(task.seconds) : task.total ? `${task.done} of ${task.total}${rate}${left}` : "";
  } else delete document.body.dataset.task;
  showOutside();
}

// What is dashed, and for how long the outside solver has been asked.
function showOutside() {
  const outside = live.work && live.work.outside;
  if (!outside) return;
  const asked = outside.confirming === null ? "" : ` The outside solver is at work on this design: ${seconds(outside.confirming + (performance.now() - live.work.at) / 1000)}.`;
  document.body.dataset.confirming = outside.confirming === null ? "no" : "yes";
  $("approximation").hidden = false;
  $("approximation").textContent = outside.sentence + asked;
}
setInterval(() => { if (live.work && live.work.outside && live.work.outside.confirming !== null) showOutside(); }, 1000);

// ---------------------------------------------------------------- curves
function buildCharts() {
  const places = live.places || firstPlaces(live, CHARTS);
  live.built = true;
  live.charts = places.map((place) => new CurveChart(live, place, wantPaint));
  $("charts").replaceChildren(...live.charts.map((c) => c.box));
  for (const chart of live.charts) chart.build();
}

// ---------------------------------------------------------------- characteristics
function buildCharacteristics() {
  const body = document.querySelector("#characteristics tbody");
  body.replaceChildren();
  live.cells = [];
  if (live.rowsSeen) live.rowsSeen.disconnect();
  live.rowsSeen = new IntersectionObserver((changes) => {
    for (const { target, isIntersecting } of changes) target.seen = isIntersecting;
    wantPaint();
  }, { root: body.closest(".scroll"), rootMargin: "60px" });
  let before = "";
  const order = live.model.characteristics.map((c, i) => [c, i]);
  const rank = (c) => c.load_case === "static" ? -1 : live.model.cases.findIndex((k) => k.id === c.load_case);
  order.filter(([c]) => c.load_case === "static" || rank(c) >= 0).sort((a, b) => rank(a[0]) - rank(b[0])).forEach(([c, i]) => {
    const head = rank(c) < 0 ? "Static" : live.model.cases[rank(c)].label;
    if (head !== before) body.append(make("tr", { class: "head" }, make("td", { colspan: 7, text: head })));
    before = head;
    const cells = ["target", "present", "z", "term", "since"].map((k) => make("td", { class: `n ${k}` }));
    const hold = make("td");
    if (c.target !== null && live.model.data && !live.source.embedded) {
      const box = make("input", { type: "checkbox", "aria-label": `Hold ${head}, ${c.label}` });
      box.addEventListener("change", () => send({ kind: "hold", characteristic: c.id, on: box.checked }));
      box.addEventListener("click", (e) => e.stopPropagation());
      hold.append(box);
    }
    cells[0].textContent = short(c.target, 3);
    cells[0].title = c.target === null ? "no target" : `interval ${short(c.low, 4)} to ${short(c.high, 4)}, standard deviation ${short(c.sd, 2)}`;
    const row = make("tr", { "data-id": c.id, title: "Click: order the sliders by their influence on it" },
      make("td", { class: "name" }, c.label, " ", make("small", { text: c.unit })), ...cells, hold);
    row.addEventListener("click", () => { $("selected").value = String(1 + i); arrange(); markChosen(); });
    body.append(row);
    live.cells.push({ c, i, row, cells });
    live.rowsSeen.observe(row);
  });
}

function markChosen() {
  for (const { row, i } of live.cells) row.classList.toggle("chosen", $("selected").value === String(1 + i));
}

// Rows out of sight are painted when they come into it: each one costs the browser a layout.
function paintCharacteristics(all = false) {
  const values = live.answers.characteristics(live.present.exact), terms = live.answers.terms(live.present.exact);
  const last = live.references.at(-1) || live.references[0], before = last && last.exact.length ? live.answers.characteristics(referenceExact(last)) : null;
  for (const { c, i, row, cells } of live.cells) {
    if (!all && row.seen === false) continue;
    const v = values[i], z = c.target === null ? NaN : (v - c.target) / c.sd;
    put(cells[1], short(v, 3));
    put(cells[2], Number.isFinite(z) ? (z > 0 ? "+" : "") + short(z, 2) : "");
    put(cells[3], Number.isFinite(terms[i]) ? short(terms[i], 3) : "");
    const change = before ? v - before[i] : NaN;
    const told = Number.isFinite(change) && Math.abs(change) > 5e-4 * Math.max(Math.abs(v), 0.01);
    put(cells[4], told ? (change > 0 ? "+" : "") + short(change, 2) : "");
    const inside = c.target !== null && v >= c.low && v <= c.high;
    row.classList.toggle("inside", inside);
    row.classList.toggle("outside", c.target !== null && !inside);
  }
}

// References were made for the sliders of now: their values come first, then the characteristics.
function referenceExact(frame) {
  return frame.exact.length === live.answers.d + 2 * live.answers.m + 3 ? frame.exact : new Float64Array(live.answers.d + 2 * live.answers.m + 3).fill(NaN);
}

// ---------------------------------------------------------------- the axle
function fillCases() {
  const before = $("axle-case").value;
  $("axle-case").replaceChildren(...live.model.cases.map((c) => make("option", { value: c.id, text: c.label })));
  if (live.model.cases.some((c) => c.id === before)) $("axle-case").value = before;
  setCase(before !== $("axle-case").value);
}

function setCase(fresh = true) {
  const c = live.model.cases.find((k) => k.id === $("axle-case").value), n = c.input.length;
  $("axle-row").max = n - 1;
  if (fresh) $("axle-row").value = n - 1;
  look();
}

function look() { send({ kind: "look", load_case: $("axle-case").value, row: Number($("axle-row").value) }); }

let playing = 0;
function play() {
  if (playing) { clearInterval(playing); playing = 0; }
  else {
    let way = -1;
    playing = setInterval(() => {
      const bar = $("axle-row"), next = Number(bar.value) + way;
      if (next <= 0 || next >= Number(bar.max)) way = -way;
      bar.value = next;
      look();
    }, 40);
  }
  $("play").textContent = playing ? "Stop" : "Play";
  $("play").setAttribute("aria-pressed", String(Boolean(playing)));
}

// ---------------------------------------------------------------- advice
function showAdvice(advice) {
  document.body.dataset.advice = advice.what;
  const rows = advice.rows.map((r) => {
    const show = make("button", { text: "show", title: `Show the slider of ${r.path}` });
    show.addEventListener("click", () => { $("search").value = r.path; live.point = ""; showSliders(); });
    const change = advice.what === "invisible" ? short(r.now, 4) : `${short(r.now, 4)} → ${short(r.value, 4)}`;
    return make("tr", {}, make("td", { text: r.path, title: r.label }), make("td", { class: "n", text: `${change} ${r.unit === "-" ? "" : r.unit}` }), make("td", { class: "name", text: r.note }), make("td", {}, show));
  });
  const undo = advice.adopted ? " Undo goes back." : "";
  $("advice").replaceChildren(make("p", { text: advice.sentence + undo }), make("table", {}, make("tbody", {}, ...rows)));
  if (advice.what === "helpers") {
    const only = make("button", { text: "Unlock these, lock all others" });
    only.addEventListener("click", () => { send({ kind: "lock", on: true }); send({ kind: "lock", paths: advice.rows.map((r) => r.path), on: false }); });
    $("advice").append(only);
  }
  if (advice.what === "invisible" && advice.rows.length) {
    const all = make("button", { text: "Lock these" });
    all.addEventListener("click", () => send({ kind: "lock", paths: advice.rows.map((r) => r.path), on: true }));
    $("advice").insertBefore(all, $("advice").children[1]);
  }
  say("");
}

// ---------------------------------------------------------------- the server
function socketSource() {
  const address = new URL("socket", location.href);
  address.protocol = "ws:";
  address.search = "";
  const waiting = [];
  const socket = new WebSocket(address);
  socket.binaryType = "arraybuffer";
  socket.onopen = () => { for (const text of waiting.splice(0)) socket.send(text); document.body.dataset.connected = "yes"; };
  socket.onmessage = (e) => { if (typeof e.data === "string") onSaid(JSON.parse(e.data)); else onFrame(decodeFrame(e.data)); };
  socket.onclose = () => { document.body.dataset.connected = "no"; document.body.classList.add("ended"); say("The connection has ended: start doe-kc live again and open its new address. What you see stays."); };
  return { embedded: false, send: (message) => { const text = JSON.stringify(message); if (socket.readyState === 0) waiting.push(text); else if (socket.readyState === 1) socket.send(text); } };
}

function wire() {
  $("search").addEventListener("input", () => { live.point = ""; showSliders(); });
  $("group").addEventListener("change", () => { live.point = ""; showSliders(); });
  $("selected").addEventListener("change", () => { arrange(); markChosen(); });
  $("undo").addEventListener("click", () => ask({ kind: "undo" }));
  $("redo").addEventListener("click", () => ask({ kind: "redo" }));
  $("reset-all").addEventListener("click", () => ask({ kind: "reset" }));
  $("snapshot").addEventListener("click", () => send({ kind: "snapshot" }));
  $("save").addEventListener("click", () => send({ kind: "save" }));
  $("reopen").addEventListener("click", () => send({ kind: "reopen" }));
  $("export").addEventListener("change", () => { if ($("export").value) { say("writing …"); send({ kind: $("export").value }); } $("export").value = ""; });
  $("lock-shown").addEventListener("click", () => send({ kind: "lock", paths: shownPaths(), on: true }));
  $("unlock-shown").addEventListener("click", () => send({ kind: "lock", paths: shownPaths(), on: false }));
  $("lock-others").addEventListener("click", () => { const shown = shownPaths(); send({ kind: "lock", on: true }); send({ kind: "lock", paths: shown, on: false }); });
  for (const what of ["best_step", "helpers", "invisible"]) $(what).addEventListener("click", () => { say("computing …"); send({ kind: what }); });
  for (const what of ["correlate", "discover"]) $(what).addEventListener("click", () => send({ kind: what }));
  for (const what of ["cancel", "forget"]) $(`work-${what}`).addEventListener("click", () => send({ kind: what }));
  $("work-adopt").addEventListener("click", () => ask({ kind: "adopt" }));
  $("side").addEventListener("change", () => { live.side = $("side").value; for (const c of live.charts) c.build(); });
  $("axle-case").addEventListener("change", () => setCase());
  $("axle-row").addEventListener("input", look);
  $("play").addEventListener("click", play);
  for (const b of document.querySelectorAll(".view")) b.addEventListener("click", () => live.axle.view(b.dataset.view));
  $("exaggeration").addEventListener("change", () => { live.axle.exaggeration = Number($("exaggeration").value); look(); });
  document.addEventListener("keydown", (e) => {
    const typing = e.target.matches && e.target.matches("input[type=number], input[type=search]");
    if (!(e.ctrlKey || e.metaKey) || typing || e.key.toLowerCase() !== "z") return;
    e.preventDefault();
    ask({ kind: e.shiftKey ? "redo" : "undo" });
  });
}

window.addEventListener("beforeprint", () => { if (live.present && live.built) paintCharacteristics(true); });
live.axle = new AxleView($("axle"), (point) => { live.point = point; $("search").value = ""; showSliders(); });
wire();
live.source = window.embeddedSource ? window.embeddedSource() : socketSource();
if (!live.source.embedded && location.search) history.replaceState(null, "", location.pathname);
