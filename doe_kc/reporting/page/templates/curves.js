// The curves section: which layers the chosen load case and response have, and the values under the cursor.
(function () {
  "use strict";
  const source = document.getElementById("curves-data");
  if (!source) return;
  const data = JSON.parse(source.textContent);
  const INK = "#000000", ORANGE = "#e69f00", BLUE = "#0072b2", SIDES = ["left", "right"];
  const caseList = document.getElementById("curves-case"), responseList = document.getElementById("curves-response");
  const controls = document.getElementById("curves-controls"), readout = document.getElementById("curves-readout");
  const shows = (name) => controls.querySelector('[data-show="' + name + '"]').checked;
  const now = () => ({ item: data.cases[caseList.value], response: responseList.value });
  const chart = makeChart(document.getElementById("curves-chart"), {
    name: "Curves", grid: () => { const c = now().item; return (c.measured || c.final || c.baseline).x; }, onCursor: tell,
  });
  function model(layers, set, response, side, colour, dash) {
    if (!set || !set.y[response]) return;
    layers.push({ kind: "line", x: set.x, y: set.y[response][side], colour, dash,
      width: side ? 1.2 : 2.4, opacity: side ? 0.65 : 1 });
  }
  function measured(layers, set, response, side) {
    if (!set || !set.y[response]) return;
    const y = set.y[response][side], sd = set.sd[response][side], half = set.half[response][side];
    layers.push({ kind: "band", x: set.x, low: y.map((v, i) => v - data.band * sd[i]),
      high: y.map((v, i) => v + data.band * sd[i]), colour: "#8a9199" });
    if (shows("branches")) {
      for (const sign of [-1, 1]) {
        layers.push({ kind: "line", x: set.x, y: y.map((v, i) => v + sign * half[i]), colour: "#5b6670", width: 0.8 });
      }
    }
    const every = Math.ceil(set.x.length / 40), some = (list) => list.filter((v, i) => i % every === 0);
    layers.push({ kind: "dots", x: some(set.x), y: some(y), colour: INK, radius: side ? 2.2 : 2.6, width: 1, open: y.map(() => side === 1) });
  }
  function refresh() {
    const { item, response } = now(), layers = [];
    SIDES.forEach((name, side) => {
      if (!shows(name)) return;
      if (shows("measured")) measured(layers, item.measured, response, side);
      if (shows("baseline")) model(layers, item.baseline, response, side, ORANGE, "7 4");
      if (shows("final")) model(layers, item.final, response, side, BLUE);
    });
    chart.show(layers, { x: item.input, y: data.responses[response].axis });
    tell(null);
  }
  const format = (v) => (v === null || v === undefined ? "–" : String(parseFloat(v.toPrecision(5))));
  function between(set, response, side, x) {
    if (!set || !set.y[response]) return null;
    const xs = set.x, ys = set.y[response][side];
    if (x < xs[0] || x > xs[xs.length - 1]) return null;
    const i = Math.max(1, xs.findIndex((v) => v >= x)), share = (x - xs[i - 1]) / (xs[i] - xs[i - 1]);
    return ys[i - 1] + share * (ys[i] - ys[i - 1]);
  }
  function rows(item, response, x) {
    return SIDES.map((name, side) => {
      const rms = (item.rms[response] || [])[side] || [];
      const line = x === null ? [] : [
        between(item.measured, response, side, x), between(item.baseline, response, side, x),
        between(item.final, response, side, x),
      ];
      const off = line[0] === null || line[2] === null || x === null ? null : line[2] - line[0];
      return [name + " wheel", ...(x === null ? [] : [...line, off]).map(format), format(rms[0]), format(rms[1])];
    });
  }
  function tell(x) {
    const { item, response } = now(), unit = data.responses[response].unit;
    const at = x === null ? [] : ["measured", "baseline", "final", "final − measured"].map((h) => h + " / " + unit);
    const heads = [x === null ? "" : format(x) + " " + item.unit, ...at, "RMS baseline / " + unit, "RMS final / " + unit];
    const table = document.createElement("table"), top = table.createTHead().insertRow(), body = table.createTBody();
    for (const head of heads) top.append(Object.assign(document.createElement("th"), { textContent: head }));
    for (const row of rows(item, response, x)) {
      const line = body.insertRow();
      row.forEach((text, i) => { const cell = line.insertCell(); cell.textContent = text; cell.className = i ? "n" : ""; });
    }
    readout.replaceChildren(table);
  }
  controls.addEventListener("input", refresh);
  controls.addEventListener("click", (event) => {
    const act = event.target.dataset && event.target.dataset.zoom;
    if (act) ({ in: () => chart.zoom(0.7), out: () => chart.zoom(1 / 0.7), all: chart.all })[act]();
  });
  refresh();
})();
