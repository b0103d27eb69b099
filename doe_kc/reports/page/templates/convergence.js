// The convergence section: every evaluation, what was expected of it, and its words under the cursor.
(function () {
  "use strict";
  const source = document.getElementById("convergence-data");
  if (!source) return;
  const data = JSON.parse(source.textContent);
  const readout = document.getElementById("convergence-readout"), legend = document.getElementById("convergence-legend");
  const minus = (v) => (v === null ? null : -v);
  const rounded = (v, digits) => (v === null ? "–" : String(parseFloat(v.toPrecision(digits))).replace(/-/g, "\u2212"));
  const format = (v) => rounded(v, 4);
  const chart = makeChart(document.getElementById("convergence-chart"), {
    name: "Convergence", linear: data.linear, whole: true, zero: true, grid: () => data.number, onCursor: tell,
  });
  const layers = [];
  if (data.first !== null) layers.push({ kind: "span", free: true, x: [data.first - 0.5], colour: "#eaf3ea" });
  layers.push({ kind: "step", x: data.number, y: data.best.map(minus), colour: "#000000", width: 1.5 });
  const expected = data.number.map((n, i) => i).filter((i) => data.predicted[i] !== null);
  layers.push({ kind: "error", x: expected.map((i) => data.number[i] + 0.25), colour: "#8a9199",
    y: expected.map((i) => minus(data.predicted[i])),
    low: expected.map((i) => minus(data.predicted[i]) - (data.sd[i] || 0)),
    high: expected.map((i) => minus(data.predicted[i]) + (data.sd[i] || 0)) });
  for (const origin of data.origins) {
    const own = data.number.map((n, i) => i).filter((i) => data.origin[i] === origin.name && data.rating[i] !== null);
    layers.push({ kind: "dots", x: own.map((i) => data.number[i]), y: own.map((i) => minus(data.rating[i])),
      colour: origin.colour, radius: 4.5, width: 2, open: own.map((i) => !data.feasible[i]) });
  }
  const failed = data.number.filter((n, i) => data.failed[i]);
  layers.push({ kind: "cross", free: true, x: failed, colour: "#d55e00", width: 2 });
  chart.show(layers, { x: "true-solver evaluation (1 = baseline)", y: "minus merit of the search [-], symmetric log" });
  function entry(text, colour, sign) {
    const item = document.createElement("span"), mark = document.createElement("b");
    mark.style.color = colour;
    mark.textContent = sign;
    item.append(mark, " " + text);
    legend.append(item);
  }
  entry("best so far", "#000000", "━");
  data.origins.forEach((origin) => entry(origin.name, origin.colour, "●"));
  if (data.feasible.some((yes) => !yes)) entry("open: constraints violated", "#5b6670", "○");
  if (expected.length) entry("predicted ± sd", "#8a9199", "┼");
  if (failed.length) entry("no equilibrium", "#d55e00", "✕");
  if (data.first !== null) entry("feasible from evaluation " + data.first, "#cfe5cf", "■");
  function tell(n) {
    const i = n - 1;
    const parts = ["Evaluation " + n + " (" + data.origin[i] + ")"];
    if (data.failed[i]) parts.push("no equilibrium: " + data.reason[i]);
    else parts.push("merit " + format(data.rating[i]), data.feasible[i] ? "feasible" : "constraints violated");
    if (data.predicted[i] !== null) parts.push("predicted " + format(data.predicted[i]) + " ± " + rounded(data.sd[i], 2));
    if (n === data.chosen) parts.push("handed over");
    readout.textContent = parts.join(", ");
  }
  tell(data.chosen);
})();
