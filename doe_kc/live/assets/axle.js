"use strict";
// The axle as lines in space: parallel projection, turned by hand; moves from rest drawn longer than they are.
const VIEWS = { iso: [-0.6, 0.38], rear: [0, 0], side: [-Math.PI / 2, 0], top: [0, Math.PI / 2] };
const RIM_POINTS = 40, NEAR = 12, LONGEST_MOVE = 100;
const ARROW_FACTOR = 20;

class AxleView {
  constructor(canvas, picked) {
    this.canvas = canvas;
    this.ctx = canvas.getContext("2d");
    [this.azimuth, this.elevation] = VIEWS.iso;
    this.zoom = 1;
    this.exaggeration = 0;
    this.factor = 1;
    this.shape = null;
    this.picked = picked;
    this.chosen = "";
    this.listen();
    this.width = this.height = 0;
    new ResizeObserver(([entry]) => { this.width = entry.contentRect.width; this.height = entry.contentRect.height; this.paint(); }).observe(canvas);
  }

  setModel(model) {
    this.lines = model.shape;
    this.n = model.shape.points.length;
    this.nominal = Float64Array.from(model.nominal_points);
    this.frame();
  }

  frame() {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < this.nominal.length; i += 1) {
      low[i % 3] = Math.min(low[i % 3], this.nominal[i]);
      high[i % 3] = Math.max(high[i % 3], this.nominal[i]);
    }
    const r = this.lines.radius, w = this.point(this.nominal, this.lines.wheel_centre);
    low[0] = Math.min(low[0], w[0] - r); high[0] = Math.max(high[0], w[0] + r);
    low[2] = Math.min(low[2], w[2] - r); high[2] = Math.max(high[2], w[2] + r);
    this.centre = low.map((v, k) => (v + high[k]) / 2);
    this.corners = [];
    for (const x of [low[0], high[0]]) for (const y of [low[1], high[1]]) for (const z of [low[2], high[2]]) this.corners.push([x, y, z]);
  }

  point(array, i) { return [array[3 * i], array[3 * i + 1], array[3 * i + 2]]; }

  axes() {
    const ca = Math.cos(this.azimuth), sa = Math.sin(this.azimuth), ce = Math.cos(this.elevation), se = Math.sin(this.elevation);
    return { right: [-sa, ca, 0], up: [-ca * se, -sa * se, ce] };
  }

  scale() {
    const { right, up } = this.axes(), dot = (p, a) => a[0] * (p[0] - this.centre[0]) + a[1] * (p[1] - this.centre[1]) + a[2] * (p[2] - this.centre[2]);
    const across = Math.max(...this.corners.map((p) => Math.abs(dot(p, right)))), high = Math.max(...this.corners.map((p) => Math.abs(dot(p, up))));
    return this.zoom * Math.min((this.width / 2 - 16) / across, (this.height / 2 - 14) / high);
  }

  project(p) {
    const { right, up } = this.now, q = [p[0] - this.centre[0], p[1] - this.centre[1], p[2] - this.centre[2]];
    return [this.width / 2 + this.size * (right[0] * q[0] + right[1] * q[1] + right[2] * q[2]),
      this.height / 2 - this.size * (up[0] * q[0] + up[1] * q[1] + up[2] * q[2])];
  }

  setShape(frame) {
    const n = 2 * this.n * 3, d = frame.drawn;
    this.shape = { design: d.subarray(0, n), rest: d.subarray(n, 2 * n), moved: d.subarray(2 * n, 3 * n),
      restSpin: d.subarray(3 * n, 3 * n + 6), spin: d.subarray(3 * n + 6, 3 * n + 12) };
    this.paint();
  }

  paint() {
    const ratio = devicePixelRatio || 1, across = Math.round(this.width * ratio), high = Math.round(this.height * ratio);
    if (!this.shape || !this.lines || this.width < 10) return;
    if (this.canvas.width !== across || this.canvas.height !== high) {
      this.canvas.width = across;
      this.canvas.height = high;
    }
    const ctx = this.ctx;
    ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
    ctx.clearRect(0, 0, this.width, this.height);
    this.now = this.axes();
    this.size = this.scale();
    const { rest, moved, restSpin, spin } = this.shape, f = this.factor = this.exaggeration || this.fitting();
    const now = Float64Array.from(moved, (v, i) => rest[i] + f * (v - rest[i]));
    const turned = Float64Array.from(spin, (v, i) => restSpin[i] + f * (v - restSpin[i]));
    this.drawAll(rest, restSpin, true);
    this.drawAll(now, turned, false);
    this.drawPoints(now);
    this.drawArrows();
    this.drawTriad();
    this.places = now;
  }

  // The largest round factor by which the longest move from rest is drawn no longer than LONGEST_MOVE.
  fitting() {
    const { rest, moved } = this.shape;
    let longest = 0;
    for (let i = 0; i < 2 * this.n; i += 1) longest = Math.max(longest, Math.hypot(moved[3 * i] - rest[3 * i], moved[3 * i + 1] - rest[3 * i + 1], moved[3 * i + 2] - rest[3 * i + 2]));
    return [50, 20, 10, 5, 2, 1].find((f) => f * longest <= LONGEST_MOVE) || 1;
  }

  drawAll(points, spins, quiet) {
    const ctx = this.ctx;
    ctx.lineCap = "round";
    for (const part of this.lines.parts) {
      ctx.strokeStyle = quiet ? "#c9ced3" : part.colour;
      ctx.lineWidth = quiet ? 1 : 2;
      for (const side of [0, 1]) {
        ctx.beginPath();
        for (const [a, b] of part.lines) {
          const p = this.project(this.point(points, a + side * this.n)), q = this.project(this.point(points, b + side * this.n));
          ctx.moveTo(...p);
          ctx.lineTo(...q);
        }
        ctx.stroke();
      }
      if (part.shared) this.joinSides(points, part);
    }
    for (const side of [0, 1]) {
      ctx.strokeStyle = quiet ? "#dde1e5" : "#56616c";
      ctx.lineWidth = quiet ? 1 : 1.4;
      this.rim(this.point(points, this.lines.wheel_centre + side * this.n), this.point(spins, side));
    }
  }

  // A part that is one for both sides reaches over from its innermost points.
  joinSides(points, part) {
    const own = [...new Set(part.lines.flat())].sort((a, b) => Math.abs(points[3 * a + 1]) - Math.abs(points[3 * b + 1])).slice(0, 2);
    this.ctx.beginPath();
    for (const i of own) {
      this.ctx.moveTo(...this.project(this.point(points, i)));
      this.ctx.lineTo(...this.project(this.point(points, i + this.n)));
    }
    this.ctx.stroke();
  }

  rim(centre, axis) {
    const length = Math.hypot(...axis), s = axis.map((v) => v / length);
    let a = [s[1], -s[0], 0];
    const na = Math.hypot(...a);
    a = a.map((v) => v / na);
    const u = [a[1] * s[2] - a[2] * s[1], a[2] * s[0] - a[0] * s[2], a[0] * s[1] - a[1] * s[0]];
    this.ctx.beginPath();
    for (let k = 0; k <= RIM_POINTS; k += 1) {
      const t = 2 * Math.PI * k / RIM_POINTS, c = Math.cos(t) * this.lines.radius, d = Math.sin(t) * this.lines.radius;
      const p = this.project([0, 1, 2].map((i) => centre[i] + c * a[i] + d * u[i]));
      this.ctx[k ? "lineTo" : "moveTo"](...p);
    }
    this.ctx.stroke();
  }

  drawPoints(points) {
    const ctx = this.ctx;
    ctx.font = "10px system-ui, sans-serif";
    for (let i = 0; i < 2 * this.n; i += 1) {
      const [x, y] = this.project(this.point(points, i)), name = this.lines.points[i % this.n];
      const chosen = name === this.chosen;
      ctx.fillStyle = chosen ? "#d55e00" : "#1f2933";
      ctx.beginPath();
      ctx.arc(x, y, chosen ? 4.5 : 2.2, 0, 2 * Math.PI);
      ctx.fill();
      if (chosen && i < this.n) ctx.fillText(name, x + 7, y - 5);
    }
  }

  // How far each hardpoint is from the nominal axle's, longer than it is.
  drawArrows() {
    const ctx = this.ctx;
    this.arrows = 0;
    for (let i = 0; i < 2 * this.n; i += 1) {
      const from = this.point(this.nominal, i), to = this.point(this.shape.design, i);
      const move = to.map((v, k) => v - from[k]);
      if (Math.hypot(...move) < 0.02) continue;
      this.arrows += 1;
      const a = this.project(from), b = this.project(from.map((v, k) => v + ARROW_FACTOR * move[k]));
      ctx.strokeStyle = ctx.fillStyle = "#e69f00";
      ctx.lineWidth = 2;
      ctx.beginPath();
      ctx.moveTo(...a);
      ctx.lineTo(...b);
      ctx.stroke();
      const t = Math.atan2(b[1] - a[1], b[0] - a[0]);
      ctx.beginPath();
      ctx.moveTo(...b);
      for (const e of [2.6, -2.6]) ctx.lineTo(b[0] + 7 * Math.cos(t + e), b[1] + 7 * Math.sin(t + e));
      ctx.fill();
    }
  }

  drawTriad() {
    const ctx = this.ctx, { right, up } = this.now, o = [26, this.height - 24];
    ctx.font = "10px system-ui, sans-serif";
    ctx.strokeStyle = ctx.fillStyle = "#56616c";
    ctx.lineWidth = 1;
    ["X", "Y", "Z"].forEach((name, k) => {
      const x = o[0] + 18 * right[k], y = o[1] - 18 * up[k];
      ctx.beginPath();
      ctx.moveTo(...o);
      ctx.lineTo(x, y);
      ctx.stroke();
      ctx.fillText(name, x + 2, y - 1);
    });
  }

  view(name) {
    [this.azimuth, this.elevation] = VIEWS[name];
    this.zoom = 1;
    this.paint();
  }

  turn(da, de) {
    this.azimuth += da;
    this.elevation = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, this.elevation + de));
    this.paint();
  }

  pick(x, y) {
    if (!this.places) return;
    let best = NEAR, found = "";
    for (let i = 0; i < 2 * this.n; i += 1) {
      const p = this.project(this.point(this.places, i)), d = Math.hypot(p[0] - x, p[1] - y);
      if (d < best) { best = d; found = this.lines.points[i % this.n]; }
    }
    this.chosen = found;
    this.paint();
    this.picked(found);
  }

  listen() {
    let last = null, path = 0;
    this.canvas.addEventListener("pointerdown", (e) => { last = [e.clientX, e.clientY]; path = 0; this.canvas.setPointerCapture(e.pointerId); });
    this.canvas.addEventListener("pointermove", (e) => {
      if (!last) return;
      const dx = e.clientX - last[0], dy = e.clientY - last[1];
      path += Math.abs(dx) + Math.abs(dy);
      last = [e.clientX, e.clientY];
      if (path > 3) this.turn(-dx / 120, dy / 120);
    });
    this.canvas.addEventListener("pointerup", (e) => {
      if (last && path <= 3) { const box = this.canvas.getBoundingClientRect(); this.pick(e.clientX - box.left, e.clientY - box.top); }
      last = null;
    });
    this.canvas.addEventListener("wheel", (e) => { e.preventDefault(); this.zoom = Math.max(0.3, Math.min(12, this.zoom * Math.exp(-e.deltaY / 600))); this.paint(); }, { passive: false });
    this.canvas.addEventListener("keydown", (e) => {
      const turns = { ArrowLeft: [0.1, 0], ArrowRight: [-0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };
      if (e.key in turns) { e.preventDefault(); this.turn(...turns[e.key]); }
      if (e.key === "+" || e.key === "-") { this.zoom *= e.key === "+" ? 1.2 : 1 / 1.2; this.paint(); }
    });
  }
}
