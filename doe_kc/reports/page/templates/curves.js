// A curves section: which layers the chosen load case and response have, and the values under the cursor.
for (const controls of document.querySelectorAll("[data-curves]")) (function () {
  "use strict";
  const part = (name) => document.getElementById(controls.dataset.curves + "-" + name);
  const data = JSON.parse(part("data").textContent);
  const INK = "#000000", SIDES = ["left", "right"];
  const caseList = part("case"), responseList = part("response"), readout = part("readout");
  const shows = (name) => {
    const box = controls.querySelector('[data-show="' + name + '"]');
    return box !== null && box.checked;
  };
  const now = () => ({ item: data.cases[caseList.value], response: responseList.value });
  const inputs = (set, response, item) => {
    const x = set.x || (item || now().item).x;
    return Array.isArray(x) ? x : x[response];
  };
  const grid = () => {
    const { item, response } = now();
    const set = [item.measured, ...data.models.map((m) => item[m.id])].find((s) => s && s.y[response]);
    return set ? inputs(set, response) : [];
  };
  const chart = makeChart(part("chart"), { name: "Curves", grid, onCursor: tell });
  function model(layers, set, response, side, colour, dash, item) {
    if (!set || !set.y[response]) return;
    layers.push({ kind: "line", x: inputs(set, response, item), y: set.y[response][side], colour, dash,
      width: side ? 1.2 : 2.4, opacity: side ? 0.65 : 1 });
  }
  function measured(layers, set, response, side, item) {
    if (!set || !set.y[response]) return;
    const x = inputs(set, response, item), y = set.y[response][side];
    const sd = set.sd[response][side], half = set.half[response][side];
    layers.push({ kind: "band", x, low: y.map((v, i) => v - data.band * sd[i]),
      high: y.map((v, i) => v + data.band * sd[i]), colour: "#8a9199" });
    if (shows("branches")) {
      for (const sign of [-1, 1]) {
        layers.push({ kind: "line", x, y: y.map((v, i) => v + sign * half[i]), colour: "#5b6670", width: 0.8 });
      }
    }
    const every = Math.ceil(x.length / 40), some = (list) => list.filter((v, i) => i % every === 0);
    layers.push({ kind: "dots", x: some(x), y: some(y), colour: INK, radius: side ? 2.2 : 2.6, width: 1, open: y.map(() => side === 1) });
  }
  function layersOf(item, response) {
    const layers = [];
    SIDES.forEach((name, side) => {
      if (!shows(name)) return;
      if (shows("measured")) measured(layers, item.measured, response, side, item);
      for (const m of data.models) if (shows(m.id)) model(layers, item[m.id], response, side, m.colour, m.dash, item);
    });
    return layers;
  }
  function refresh() {
    const { item, response } = now();
    chart.show(layersOf(item, response), { x: item.input, y: data.responses[response].axis });
    tell(null);
  }
  const rounded = (v, digits) => (v === null || v === undefined ? "–" : String(parseFloat(v.toPrecision(digits))).replace(/-/g, "\u2212"));
  const format = (v) => rounded(v, 4);
  function between(set, response, side, x) {
    if (!set || !set.y[response]) return null;
    const xs = inputs(set, response), ys = set.y[response][side];
    if (x < xs[0] || x > xs[xs.length - 1]) return null;
    const i = Math.max(1, xs.findIndex((v) => v >= x)), share = (x - xs[i - 1]) / (xs[i] - xs[i - 1]);
    return ys[i - 1] + share * (ys[i] - ys[i - 1]);
  }
  function rows(item, response, x) {
    return SIDES.map((name, side) => {
      const rms = (item.rms[response] || [])[side] || [];
      const sets = [item.measured, ...data.models.map((m) => item[m.id])];
      const line = x === null ? [] : sets.map((set) => between(set, response, side, x));
      const last = line[line.length - 1], off = line.length && line[0] !== null && last !== null ? last - line[0] : null;
      const values = x === null ? [] : data.models.length ? [...line, off] : line;
      return [name + " wheel", ...values.map(format), ...data.models.map((m, i) => rounded(rms[i], 3))];
    });
  }
  function tell(x) {
    const { item, response } = now(), unit = data.responses[response].unit;
    const names = data.models.map((m) => m.label), last = names[names.length - 1];
    const at = x === null ? [] : ["measured", ...names, ...(last ? [last + " − measured"] : [])];
    const heads = [...at, ...names.map((n) => "RMS " + n)].map((h) => h + " [" + unit + "]");
    if (!heads.length || (x === null && !(item.rms[response] || []).flat().some((v) => v !== null))) {
      readout.replaceChildren();
      return;
    }
    heads.unshift(x === null ? "" : format(x) + " " + item.unit);
    const table = document.createElement("table"), top = table.createTHead().insertRow(), body = table.createTBody();
    for (const head of heads) top.append(Object.assign(document.createElement("th"), { textContent: head }));
    for (const row of rows(item, response, x)) {
      const line = body.insertRow();
      row.forEach((text, i) => { const cell = line.insertCell(); cell.textContent = text; cell.className = i ? "n" : ""; });
    }
    readout.replaceChildren(table);
  }
  // Paper has no choice of a load case: every curve is drawn, a block a load case, with title and legend.
  const SMALL = { w: 340, h: 250 };
  const node = (parent, name, text, className) => {
    const made = document.createElement(name);
    if (text) made.textContent = text;
    if (className) made.className = className;
    parent.append(made);
    return made;
  };
  function legend(parent) {
    const line = node(parent, "p", "", "controls");
    for (const box of controls.querySelectorAll("label input:checked")) {
      const item = node(line, "span");
      for (const part of box.parentNode.childNodes) if (part !== box) item.append(part.cloneNode(true));
    }
    if (shows("measured")) node(line, "span", "band: \u00b1 " + data.band + " standard deviations of the noise");
  }
  function printAll() {
    const place = part("printed");
    place.replaceChildren();
    for (const id in data.cases) {
      const item = data.cases[id];
      const there = Object.keys(data.responses).filter((r) => layersOf(item, r).length);
      if (!there.length) continue;
      const block = node(place, "div", "", "printed-case");
      node(block, "h3", "Curves: " + item.label);
      legend(block);
      const grid = node(block, "div", "", there.length > 8 ? "grid five" : "grid");
      for (const response of there) {
        const host = node(grid, "div");
        host.id = part("chart").id + "-" + id + "-" + response.replace(":", "-");
        const title = [item.label, data.responses[response].label];
        const one = makeChart(host, { name: title.join(": "), title, size: SMALL });
        one.show(layersOf(item, response), { x: item.input, y: data.responses[response].unit });
      }
    }
  }
  addEventListener("beforeprint", printAll);
  addEventListener("afterprint", () => part("printed").replaceChildren());
  controls.addEventListener("input", refresh);
  controls.addEventListener("click", (event) => {
    const act = event.target.dataset && event.target.dataset.zoom;
    if (act) ({ in: () => chart.zoom(0.7), out: () => chart.zoom(1 / 0.7), all: chart.all })[act]();
  });
  refresh();
})();
