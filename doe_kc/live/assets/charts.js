"use strict";
// One chart a curve: measured with its band behind, nominal, snapshots and the present axle as uPlot series.
const COLOURS = { nominal: "#e69f00", present: "#0072b2", snapshots: ["#009e73", "#cc79a7", "#8c5a2b"], measured: "#444444" };
const LINE = 1.6, THIN = 0.8, DASH = [7, 4];

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

  // x, then left and right of: nominal, three snapshots, present (on top).
  data() {
    const { layout, present, references } = this.page;
    const { loadCase, response } = this.place;
    const rows = [this.loadCase.input];
    for (const drawn of [...[0, 1, 2, 3].map((i) => references[i] && references[i].drawn), present && present.drawn]) {
      for (const side of [0, 1]) {
        rows.push(drawn && this.sides.includes(side) ? layout.curve(drawn, loadCase, response, side) : this.empty());
      }
    }
    return rows;
  }

  empty() {
    const n = this.loadCase.input.length;
    if (!this.nothing || this.nothing.length !== n) this.nothing = new Array(n).fill(null);
    return this.nothing;
  }

  limits() {
    let low = Infinity, high = -Infinity;
    const see = (v) => { if (v !== null && Number.isFinite(v)) { if (v < low) low = v; if (v > high) high = v; } };
    const [from, to] = this.zoom || [-Infinity, Infinity];
    const rows = this.rows || this.data(), x = rows[0];
    for (let k = 1; k < rows.length; k += 1) for (let i = 0; i < x.length; i += 1) if (x[i] >= from && x[i] <= to) see(rows[k][i]);
    const m = this.measured;
    if (m) for (const s of this.sides) m.input.forEach((v, i) => { if (v >= from && v <= to) see(m.mean[s][i]); });
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

  series() {
    const all = [{}];
    const looks = [[COLOURS.nominal, LINE], ...COLOURS.snapshots.map((c) => [c, LINE]), [COLOURS.present, LINE + 0.4]];
    for (const [stroke, width] of looks) {
      for (const side of [0, 1]) all.push({ stroke, width: side === 0 || this.page.side === "R" ? width : THIN, points: { show: false }, spanGaps: false });
    }
    return all;
  }

  build() {
    if (this.plot) this.plot.destroy();
    const { width, height } = this.plotBox.getBoundingClientRect();
    const font = '11px system-ui, "DejaVu Sans", sans-serif';
    const axis = { font, labelFont: font, stroke: "#56616c", grid: { stroke: "#e6e9ec", width: 1 }, ticks: { size: 3, stroke: "#9aa4ad" } };
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
    this.rows = this.data();
    this.setDashes();
    this.plot.setData(this.rows, true);
    this.readOut(this.plot);
  }

  // Dashed is what the true model did not give: of an outside solver the surrogate's.
  setDashes() {
    const { references, present } = this.page;
    [references[0], references[1], references[2], references[3], present].forEach((frame, i) => {
      const surrogate = (i === 4 && this.page.approximate) || (frame && frame.text.true === false);
      for (const side of [0, 1]) this.plot.series[1 + 2 * i + side].dash = surrogate ? DASH : undefined;
    });
  }

  drawMeasured(u) {
    const m = this.measured, ctx = u.ctx, ratio = devicePixelRatio;
    ctx.save();
    ctx.beginPath();
    ctx.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height);
    ctx.clip();
    const path = (xs, ys) => {
      ctx.beginPath();
      let pen = false;
      xs.forEach((x, i) => {
        if (ys[i] === null || !Number.isFinite(ys[i])) { pen = false; return; }
        ctx[pen ? "lineTo" : "moveTo"](u.valToPos(x, "x", true), u.valToPos(ys[i], "y", true));
        pen = true;
      });
    };
    for (const side of m ? this.sides : []) {
      const mean = m.mean[side], half = m.half[side];
      if (m.sd) {
        const x = [...m.input, ...[...m.input].reverse()];
        const y = [...mean.map((v, i) => v === null ? null : v + m.sd[side][i]), ...mean.map((v, i) => v === null ? null : v - m.sd[side][i]).reverse()];
        path(x, y);
        ctx.fillStyle = "rgba(120,128,136,0.38)";
        ctx.fill();
      }
      ctx.strokeStyle = "#9aa4ad";
      ctx.lineWidth = 0.7 * ratio;
      if (half.some((v) => v !== null && Math.abs(v) > 0)) for (const sign of [1, -1]) {
        path(m.input, mean.map((v, i) => v === null || half[i] === null ? null : v + sign * half[i]));
        ctx.stroke();
      }
      ctx.strokeStyle = COLOURS.measured;
      ctx.lineWidth = (side === 0 || this.page.side === "R" ? 1.2 : 0.6) * ratio;
      path(m.input, mean);
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
    const m = this.measured, { layout, present } = this.page;
    if (!m || !present) return NaN;
    const y = layout.curve(present.drawn, this.place.loadCase, this.place.response, this.sides[0]);
    let sum = 0, n = 0;
    m.input.forEach((x, i) => {
      const v = m.mean[this.sides[0]][i], mine = interpolate(x, this.loadCase.input, y);
      if (v !== null && Number.isFinite(mine)) { sum += (mine - v) ** 2; n += 1; }
    });
    return n ? Math.sqrt(sum / n) : NaN;
  }

  readOut(u) {
    const unit = this.response.unit, i = u.cursor.idx, side = this.sides[0];
    if (i === null || i === undefined || u.cursor.left < 0) {
      const rms = this.rms();
      this.read.textContent = Number.isFinite(rms) ? `${short(rms, 3)} ${unit}` : unit;
      return;
    }
    const x = this.rows[0][i], now = this.rows[9 + side][i], m = this.measured;
    const measured = m ? interpolate(x, m.input, m.mean[side]) : NaN;
    const target = Number.isFinite(measured) ? `, measured ${short(measured, 3)}` : "";
    this.read.textContent = `${short(x, 3)} ${this.loadCase.unit}: ${short(now, 3)}${target} ${unit}`;
  }
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
