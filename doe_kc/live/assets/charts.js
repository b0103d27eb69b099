"use strict";
// One chart a curve: measured with its band behind, nominal, snapshots and the present axle as uPlot series.
const COLOURS = { nominal: "#e69f00", present: "#0072b2", snapshots: ["#009e73", "#cc79a7", "#8c5a2b"], measured: "#444444" };
const PRESENT_LINE = -1, LINE = 1.6, THIN = 0.8, DASH = [7, 4];

function tickTexts(ticks, unit, at) {
  return ticks.map((v, i) => String(+v.toPrecision(6)).replace("-", "−") + (i === at ? ` ${unit}` : ""));
}

class CurveChart {
  // page: {model, layout, present, references, side, approximate}; place: {loadCase, response}.
  constructor(page, place, changed) {
    this.page = page;
    this.place = place;
    this.zoom = null;
    this.box = document.createElement("div");
    this.box.className = "chart";
    this.top = document.createElement("div");
    this.top.className = "top";
    this.choice = document.createElement("select");
    this.choice.setAttribute("aria-label", "Curve of this chart");
    this.read = document.createElement("span");
    this.read.className = "read";
    this.read.title = "RMS between present and measured, or the values at the pointer";
    this.plotBox = document.createElement("div");
    this.plotBox.className = "plot";
    this.top.append(this.choice, this.read);
    this.box.append(this.top, this.plotBox);
    this.fillChoice();
    this.choice.addEventListener("change", () => {
      const [loadCase, response] = this.choice.value.split(".");
      this.place = { loadCase, response };
      this.zoom = null;
      this.build();
      changed();
    });
    new ResizeObserver(() => this.resize()).observe(this.plotBox);
  }

  fillChoice() {
    for (const c of this.page.model.cases) {
      const group = document.createElement("optgroup");
      group.label = c.label;
      for (const r of this.page.model.responses) {
        const option = document.createElement("option");
        option.value = `${c.id}.${r.id}`;
        option.textContent = `${c.id.replace("_", " ")}: ${r.name}`;
        group.append(option);
      }
      this.choice.append(group);
    }
    this.choice.value = `${this.place.loadCase}.${this.place.response}`;
  }

  get loadCase() { return this.page.model.cases.find((c) => c.id === this.place.loadCase); }
  get response() { return this.page.model.responses.find((r) => r.id === this.place.response); }
  get sides() { return { L: [0], R: [1], both: [0, 1] }[this.page.side]; }

  get measured() {
    const found = this.page.model.measured[this.place.loadCase];
    if (!found || found.unit !== this.loadCase.unit || !(this.place.response in found.responses)) return null;
    return { input: found.input, ...found.responses[this.place.response] };
  }

  // What is drawn, in this order: nominal, snapshots, present (on top), each for the sides shown.
  lineup() {
    const { references, side } = this.page, count = Math.min(references.length, 1 + COLOURS.snapshots.length);
    const one = (of, stroke, width) => this.sides.map((s) => ({ of, side: s, stroke, width: s === 0 || side === "R" ? width : THIN }));
    const lines = [];
    for (let i = 0; i < count; i += 1) lines.push(...one(i, i ? COLOURS.snapshots[i - 1] : COLOURS.nominal, LINE));
    return [...lines, ...one(PRESENT_LINE, COLOURS.present, LINE + 0.4)];
  }

  frame(line) { return line.of === PRESENT_LINE ? this.page.present : this.page.references[line.of]; }

  // x, then a row a line.
  data() {
    const { loadCase, response } = this.place;
    return [this.loadCase.input, ...this.lines.map((line) => {
      const frame = this.frame(line);
      return frame ? this.page.layout.curve(frame.drawn, loadCase, response, line.side) : this.empty();
    })];
  }

  // Row of the present curve on one side, as the chart draws it.
  presentRow(side) { return this.rows[1 + this.lines.findIndex((line) => line.of === PRESENT_LINE && line.side === side)]; }

  empty() { return new Array(this.loadCase.input.length).fill(null); }

  limits() {
    let low = Infinity, high = -Infinity;
    const [from, to] = this.zoom || [-Infinity, Infinity], rows = this.rows, x = rows[0];
    for (let k = 1; k < rows.length; k += 1) {
      const row = rows[k];
      for (let i = 0; i < x.length; i += 1) {
        const v = row[i];
        if (v === null || !(x[i] >= from && x[i] <= to)) continue;
        if (v < low) low = v;
        if (v > high) high = v;
      }
    }
    for (const side of this.sides) for (const [x0, v] of this.record ? this.record.sides[side].points : []) if (x0 >= from && x0 <= to) { if (v < low) low = v; if (v > high) high = v; }
    if (low > high) return [-1, 1];
    const room = 0.06 * (high - low) || 0.1 * Math.abs(high) || 0.1;
    return [low - room, high + room];
  }

  span() {
    const m = this.measured, x = this.loadCase.input;
    const low = m ? Math.min(x[0], m.input[0]) : x[0];
    const high = m ? Math.max(x[x.length - 1], m.input[m.input.length - 1]) : x[x.length - 1];
    return [low, high];
  }

  series() { return [{}, ...this.lines.map(({ stroke, width }) => ({ stroke, width, points: { show: false }, spanGaps: false }))]; }

  build() {
    if (this.plot) this.plot.destroy();
    const { width, height } = this.plotBox.getBoundingClientRect();
    const font = '11px system-ui, "DejaVu Sans", sans-serif';
    const axis = { font, labelFont: font, stroke: "#56616c", grid: { stroke: "#e6e9ec", width: 1 }, ticks: { size: 3, stroke: "#9aa4ad" } };
    this.lines = this.lineup();
    this.record = prepared(this.measured, this.loadCase.input);
    this.rows = this.data();
    this.plot = new uPlot({
      width: Math.max(80, Math.floor(width)), height: Math.max(70, Math.floor(height)),
      padding: [6, 16, 0, 0],
      scales: { x: { time: false, range: () => this.zoom || this.span() }, y: { range: () => this.limits() } },
      // the unit stands at the last number up, and across at the last but one, which no edge cuts off
      axes: [{ ...axis, size: 22, space: 44, values: (u, ticks) => tickTexts(ticks, this.loadCase.unit, ticks.length - 2) },
        { ...axis, size: 58, space: 24, values: (u, ticks) => tickTexts(ticks, this.response.unit, ticks.length - 1) }],
      series: this.series(),
      cursor: { drag: { x: true, y: false, setScale: false }, points: { show: false }, y: false },
      select: { show: true },
      legend: { show: false },
      hooks: {
        drawAxes: [(u) => this.drawMeasured(u)],
        setCursor: [(u) => this.readOut(u)],
        setSelect: [(u) => {
          if (u.select.width < 6) return;
          this.zoom = [u.posToVal(u.select.left, "x"), u.posToVal(u.select.left + u.select.width, "x")];
          u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
          this.paint();
        }],
      },
    }, this.rows, this.plotBox);
    this.setDashes();
    this.plot.redraw(false);
    this.plot.over.addEventListener("dblclick", () => { this.zoom = null; this.paint(); });
    this.plot.over.setAttribute("aria-hidden", "true");
    this.readOut(this.plot);
  }

  resize() {
    const { width, height } = this.plotBox.getBoundingClientRect();
    if (!this.plot || width < 20 || height < 20) return;
    this.plot.setSize({ width: Math.floor(width), height: Math.floor(height) });
  }

  paint() {
    if (!this.plot) return;
    if (this.lines.length !== this.sides.length * (1 + Math.min(this.page.references.length, 4))) { this.build(); return; }
    this.rows = this.data();
    this.setDashes();
    this.plot.setData(this.rows, true);
    this.readOut(this.plot);
  }

  // Dashed is what the true model did not give: of an outside solver the surrogate's.
  setDashes() {
    this.lines.forEach((line, i) => {
      const frame = this.frame(line), surrogate = (line.of === PRESENT_LINE && this.page.approximate) || (frame && frame.text.true === false);
      this.plot.series[1 + i].dash = surrogate ? DASH : undefined;
    });
  }

  drawMeasured(u) {
    const ctx = u.ctx, ratio = devicePixelRatio, one = this.page.side === "R";
    ctx.save();
    ctx.beginPath();
    ctx.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height);
    ctx.clip();
    const path = (xs, ys) => {
      ctx.beginPath();
      let pen = false;
      for (let i = 0; i < xs.length; i += 1) {
        if (!Number.isFinite(ys[i])) { pen = false; continue; }
        const x = u.valToPos(xs[i], "x", true), y = u.valToPos(ys[i], "y", true);
        if (pen) ctx.lineTo(x, y);
        else ctx.moveTo(x, y);
        pen = true;
      }
    };
    for (const side of this.record ? this.sides : []) {
      const { mean, band, loops } = this.record.sides[side];
      if (band) {
        path(this.record.around, band);
        ctx.fillStyle = "rgba(120,128,136,0.38)";
        ctx.fill();
      }
      ctx.strokeStyle = "#9aa4ad";
      ctx.lineWidth = 0.7 * ratio;
      for (const loop of loops) { path(this.record.input, loop); ctx.stroke(); }
      ctx.strokeStyle = COLOURS.measured;
      ctx.lineWidth = (side === 0 || one ? 1.2 : 0.6) * ratio;
      path(this.record.input, mean);
      ctx.stroke();
    }
    this.drawLoop(u, path);
    ctx.restore();
  }

  // The present axle's own loop, where it has friction.
  drawLoop(u, path) {
    const { layout, present } = this.page;
    if (!present) return;
    const ctx = u.ctx, x = this.loadCase.input;
    ctx.strokeStyle = "#7fb8d8";
    ctx.lineWidth = 0.8 * devicePixelRatio;
    for (const side of this.sides) {
      const half = layout.curve(present.drawn, this.place.loadCase, this.place.response, side, true);
      if (!half.some((v) => v !== 0)) continue;
      const mean = layout.curve(present.drawn, this.place.loadCase, this.place.response, side);
      for (const sign of [1, -1]) { path(x, Array.from(mean, (v, i) => v + sign * half[i])); ctx.stroke(); }
    }
  }

  // RMS between the present and the measured curve of the first side shown, in the response's unit.
  rms() {
    if (!this.record || !this.page.present) return NaN;
    const side = this.sides[0], y = this.presentRow(side), { at, left, share } = this.record, { mean } = this.record.sides[side];
    let sum = 0, n = 0;
    for (let k = 0; k < at.length; k += 1) {
      const i = left[k], v = mean[at[k]], mine = y[i] + share[k] * (y[i + 1] - y[i]);
      if (Number.isFinite(v) && Number.isFinite(mine)) { sum += (mine - v) ** 2; n += 1; }
    }
    return n ? Math.sqrt(sum / n) : NaN;
  }

  readOut(u) {
    const unit = this.response.unit, i = u.cursor.idx, side = this.sides[0];
    if (i === null || i === undefined || u.cursor.left < 0) {
      const rms = this.rms();
      put(this.read, Number.isFinite(rms) ? `${short(rms, 3)} ${unit}` : unit);
      return;
    }
    const x = this.rows[0][i], now = this.presentRow(side)[i];
    const measured = this.record ? interpolate(x, this.record.input, this.record.sides[side].mean) : NaN;
    const target = Number.isFinite(measured) ? `, measured ${short(measured, 3)}` : "";
    put(this.read,  `${short(x, 3)} ${this.loadCase.unit}: ${short(now, 3)}${target} ${unit}`);
  }
}

// A measured curve as numbers, what does not change with the sliders computed once: band, loops, and where each
// measured input lies among the model's: at[k] of the record is share[k] beyond left[k]. NaN where nothing is known.
function prepared(measured, grid) {
  if (!measured) return null;
  const numbers = (row) => Float64Array.from(row, (v) => v === null ? NaN : v), input = numbers(measured.input), back = Float64Array.from(input).reverse();
  const joined = (a, b) => { const out = new Float64Array(a.length + b.length); out.set(a); out.set(b, a.length); return out; };
  const at = [], left = [], share = [];
  input.forEach((x, k) => {
    if (x < grid[0] || x > grid[grid.length - 1]) return;
    let i = 0;
    while (i < grid.length - 2 && grid[i + 1] < x) i += 1;
    at.push(k);
    left.push(i);
    share.push((x - grid[i]) / (grid[i + 1] - grid[i]));
  });
  const sides = [0, 1].map((side) => {
    const mean = numbers(measured.mean[side]), half = numbers(measured.half[side]), sd = measured.sd && numbers(measured.sd[side]);
    const shifted = (sign, by) => mean.map((v, i) => v + sign * by[i]);
    return {
      mean,
      band: sd ? joined(shifted(1, sd), shifted(-1, sd).reverse()) : null,
      loops: half.some((v) => Math.abs(v) > 0) ? [shifted(1, half), shifted(-1, half)] : [],
      points: Array.from(input, (x, i) => [x, mean[i]]).filter((p) => Number.isFinite(p[1])),
    };
  });
  return { input, around: joined(input, back), sides, at, left, share };
}

// One curve a load case to begin with: where the nominal axle is farthest from the records, by their range.
function firstPlaces(page, count) {
  const { model, layout, references } = page, rated = [];
  for (const c of model.cases) {
    const m = model.measured[c.id];
    for (const r of model.responses) {
      const known = m && m.unit === c.unit && m.responses[r.id];
      if (!known) continue;
      const mine = layout.curve(references[0].drawn, c.id, r.id, 0), values = known.mean[0].filter((v) => v !== null);
      let sum = 0;
      m.input.forEach((x, i) => { const v = interpolate(x, c.input, mine); if (Number.isFinite(v) && known.mean[0][i] !== null) sum += (v - known.mean[0][i]) ** 2; });
      const range = Math.max(...values) - Math.min(...values);
      const noise = known.sd ? Math.max(...known.sd[0].filter((v) => v !== null)) : 0;
      const floor = { deg: 0.05, mm: 0.2, N: 100 }[r.unit];
      rated.push({ loadCase: c.id, response: r.id, gap: Math.sqrt(sum / values.length) / Math.max(range, 10 * noise, floor) });
    }
  }
  rated.sort((a, b) => b.gap - a.gap);
  const chosen = [];
  for (const c of model.cases) {
    const own = rated.find((p) => p.loadCase === c.id) || { loadCase: c.id, response: "toe", gap: 0 };
    if (chosen.length < count) chosen.push(own);
  }
  for (const p of rated) if (chosen.length < count && !chosen.includes(p)) chosen.push(p);
  for (const c of model.cases) if (chosen.length < count) chosen.push({ loadCase: c.id, response: "camber", gap: 0 });
  const order = model.cases.map((c) => c.id);
  return chosen.sort((a, b) => order.indexOf(a.loadCase) - order.indexOf(b.loadCase));
}
