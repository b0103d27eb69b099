// One line chart in SVG: layers, axes (linear or symmetric logarithmic), zoom, cursor. No dependencies.
const makeChart = (function () {
  "use strict";
  const NS = "http://www.w3.org/2000/svg";
  const add = (parent, name, attributes, text) => {
    const node = document.createElementNS(NS, name);
    for (const key in attributes) node.setAttribute(key, attributes[key]);
    if (text !== undefined) node.textContent = text;
    parent.append(node);
    return node;
  };
  function step(span, count) {
    const raw = span / count, power = Math.pow(10, Math.floor(Math.log10(raw)));
    return [1, 2, 2.5, 5, 10].map((m) => m * power).find((s) => s >= raw * 0.7);
  }
  function linearTicks(low, high, count) {
    const by = step(high - low, count), out = [];
    for (let i = Math.ceil(low / by - 1e-9); i * by <= high + 1e-9 * by; i++) out.push(i * by);
    return out;
  }
  function logTicks(low, high, linear) {
    const out = [0];
    for (let size = linear; size <= Math.max(Math.abs(low), Math.abs(high)) * 1.0001; size *= 10) out.push(size, -size);
    return out.filter((v) => v >= low && v <= high);
  }
  const label = (v) => String(parseFloat(v.toPrecision(6))).replace("-", "\u2212");
  function scale(linear) {
    if (!linear) return { to: (v) => v, from: (v) => v };
    return {
      to: (v) => Math.sign(v) * Math.log10(1 + (9 * Math.abs(v)) / linear),
      from: (t) => (Math.sign(t) * linear * (Math.pow(10, Math.abs(t)) - 1)) / 9,
    };
  }
  // options.title, options.size: of a chart for print, which has no zoom and no cursor
  return function (host, options) {
    const PAD = { left: 74, right: 16, top: options.title ? 44 : 12, bottom: 46 };
    const svg = add(host, "svg", { tabindex: 0, role: "img", "aria-label": options.name });
    let layers = [], axes = {}, full = null, view = null, cursor = null, drag = null;
    const yScale = scale(options.linear);
    const size = () => options.size || ({ w: Math.max(host.clientWidth, 260), h: Math.max(host.clientHeight, 240) });
    const across = (x) => PAD.left + ((x - view.x0) / (view.x1 - view.x0)) * (size().w - PAD.left - PAD.right);
    const up = (y) => {
      const s = size(), t = (yScale.to(y) - view.y0) / (view.y1 - view.y0);
      return s.h - PAD.bottom - t * (s.h - PAD.top - PAD.bottom);
    };
    const toX = (px) => view.x0 + ((px - PAD.left) / (size().w - PAD.left - PAD.right)) * (view.x1 - view.x0);
    const toY = (py) => {
      const s = size();
      return view.y0 + ((s.h - PAD.bottom - py) / (s.h - PAD.top - PAD.bottom)) * (view.y1 - view.y0);
    };
    function limits() {
      let x0 = Infinity, x1 = -Infinity, y0 = Infinity, y1 = -Infinity;
      for (const layer of layers) {
        if (layer.free) continue;
        layer.x.forEach((x, i) => {
          for (const y of [layer.y && layer.y[i], layer.low && layer.low[i], layer.high && layer.high[i]]) {
            if (y === null || y === undefined) continue;
            x0 = Math.min(x0, x); x1 = Math.max(x1, x);
            y0 = Math.min(y0, yScale.to(y)); y1 = Math.max(y1, yScale.to(y));
          }
        });
      }
      if (!(x1 >= x0)) { x0 = 0; x1 = 1; y0 = 0; y1 = 1; }
      if (options.zero) { y0 = Math.min(y0, 0); y1 = Math.max(y1, 0); }
      const dx = (x1 - x0 || 1) * 0.02, dy = (y1 - y0 || Math.abs(y1) || 1) * 0.06;
      return { x0: x0 - (options.whole ? 0.5 : dx), x1: x1 + (options.whole ? 0.5 : dx), y0: y0 - dy, y1: y1 + dy };
    }
    function path(xs, ys, stepped) {
      let text = "", pen = false, last = 0;
      xs.forEach((x, i) => {
        const y = ys[i];
        if (y === null || y === undefined) { pen = false; return; }
        const px = across(x).toFixed(1), py = up(y).toFixed(1);
        text += pen ? (stepped ? "L" + px + " " + last : "") + "L" + px + " " + py : "M" + px + " " + py;
        pen = true; last = py;
      });
      return text;
    }
    function draw() {
      const s = size();
      svg.replaceChildren();
      svg.setAttribute("viewBox", "0 0 " + s.w + " " + s.h);
      const clip = "clip-" + host.id;
      add(add(add(svg, "defs", {}), "clipPath", { id: clip }), "rect", {
        x: PAD.left, y: PAD.top, width: s.w - PAD.left - PAD.right, height: s.h - PAD.top - PAD.bottom });
      frame(s);
      const inside = add(svg, "g", { "clip-path": "url(#" + clip + ")" });
      for (const layer of layers) paint(inside, layer, s);
      if (cursor !== null) {
        add(inside, "line", { x1: across(cursor), x2: across(cursor), y1: PAD.top, y2: s.h - PAD.bottom,
          stroke: "#5b6670", "stroke-dasharray": "3 3", class: "cursor" });
      }
      if (drag && drag.now) {
        add(svg, "rect", { x: Math.min(drag.x, drag.now.x), y: Math.min(drag.y, drag.now.y), fill: "#0072b2",
          width: Math.abs(drag.now.x - drag.x), height: Math.abs(drag.now.y - drag.y), "fill-opacity": 0.12 });
      }
    }
    function frame(s) {
      const many = Math.max(2, Math.floor(s.w / (options.size ? 75 : 90)));
      let xs = linearTicks(view.x0, view.x1, many);
      if (options.whole) xs = xs.filter((x) => Number.isInteger(x));
      for (const x of xs) {
        add(svg, "line", { x1: across(x), x2: across(x), y1: PAD.top, y2: s.h - PAD.bottom, stroke: "#e3e6e9" });
        add(svg, "text", { x: across(x), y: s.h - PAD.bottom + 16, "text-anchor": "middle" }, label(x));
      }
      const lowest = yScale.from(view.y0), highest = yScale.from(view.y1);
      let ys = options.linear ? logTicks(lowest, highest, options.linear) : linearTicks(view.y0, view.y1, options.size ? 4 : 6);
      if (options.linear && ys.length < 3) ys = linearTicks(lowest, highest, 5);
      for (const y of ys) {
        add(svg, "line", { x1: PAD.left, x2: s.w - PAD.right, y1: up(y), y2: up(y), stroke: "#e3e6e9" });
        add(svg, "text", { x: PAD.left - 6, y: up(y) + 4, "text-anchor": "end" }, label(y));
      }
      add(svg, "path", { d: "M" + PAD.left + " " + PAD.top + "V" + (s.h - PAD.bottom) + "H" + (s.w - PAD.right),
        fill: "none", stroke: "#1b2127" });
      (options.title || []).forEach((line, i) => add(svg, "text", { x: 8, y: 17 + 16 * i, class: "title" }, line));
      add(svg, "text", { x: (PAD.left + s.w) / 2, y: s.h - 10, "text-anchor": "middle", class: "x-label" }, axes.x);
      add(svg, "text", { transform: "translate(16 " + s.h / 2 + ") rotate(-90)", "text-anchor": "middle",
        class: "y-label" }, axes.y);
    }
    function paint(parent, layer, s) {
      const look = { stroke: layer.colour, "stroke-opacity": layer.opacity || 1, "stroke-width": layer.width || 1.5 };
      if (layer.kind === "band") {
        const there = path(layer.x, layer.high), back = path(layer.x.slice().reverse(), layer.low.slice().reverse());
        add(parent, "path", { d: there + back.replace("M", "L") + "Z", fill: layer.colour, "fill-opacity": 0.35 });
      } else if (layer.kind === "line" || layer.kind === "step") {
        add(parent, "path", { ...look, d: path(layer.x, layer.y, layer.kind === "step"), fill: "none",
          "stroke-dasharray": layer.dash || "none", class: "layer" });
      } else if (layer.kind === "span") {
        add(parent, "rect", { x: across(layer.x[0]), y: PAD.top, width: Math.max(0, s.w - across(layer.x[0])),
          height: s.h - PAD.top - PAD.bottom, fill: layer.colour });
      } else {
        layer.x.forEach((x, i) => mark(parent, layer, look, x, i));
      }
    }
    function mark(parent, layer, look, x, i) {
      if (layer.kind === "cross") {
        add(parent, "path", { ...look, d: "M" + (across(x) - 5) + " " + (PAD.top + 4) + "l10 10m0 -10l-10 10" });
        return;
      }
      const y = layer.y[i];
      if (y === null || y === undefined) return;
      if (layer.kind === "error") {
        add(parent, "path", { ...look, d: "M" + across(x) + " " + up(layer.low[i]) + "V" + up(layer.high[i]) +
          "M" + (across(x) - 4) + " " + up(y) + "h8" });
        return;
      }
      const open = layer.open && layer.open[i];
      add(parent, "circle", { ...look, cx: across(x), cy: up(y), r: layer.radius || 3,
        fill: open ? "#fff" : layer.colour });
    }
    function zoom(factor) {
      const x = cursor === null ? (view.x0 + view.x1) / 2 : cursor, y = (view.y0 + view.y1) / 2;
      view = { x0: x + (view.x0 - x) * factor, x1: x + (view.x1 - x) * factor,
        y0: y + (view.y0 - y) * factor, y1: y + (view.y1 - y) * factor };
      draw();
    }
    function all() { view = { ...full }; draw(); }
    function at(x) {
      const grid = options.grid();
      if (!grid.length) return;
      cursor = grid.reduce((best, g) => (Math.abs(g - x) < Math.abs(best - x) ? g : best), grid[0]);
      draw();
      options.onCursor(cursor);
    }
    function move(by) {
      const grid = options.grid();
      const now = cursor === null ? -1 : grid.indexOf(cursor);
      at(grid[Math.min(grid.length - 1, Math.max(0, cursor === null ? 0 : now + by))]);
    }
    const spot = (event) => {
      const box = svg.getBoundingClientRect();
      return { x: event.clientX - box.left, y: event.clientY - box.top };
    };
    function show(newLayers, newAxes) {
      layers = newLayers; axes = newAxes; full = limits(); view = { ...full }; cursor = null;
      svg.setAttribute("aria-label", options.name + ": " + axes.y + " over " + axes.x);
      draw();
    }
    if (options.size) return { show };
    svg.addEventListener("pointerdown", (event) => { if (event.button === 0) drag = spot(event); });
    svg.addEventListener("pointermove", (event) => {
      const p = spot(event);
      if (drag && event.pointerType === "mouse") { drag.now = p; draw(); } else at(toX(p.x));
    });
    svg.addEventListener("pointerup", (event) => {
      const p = spot(event), from = drag;
      drag = null;
      if (from && Math.abs(p.x - from.x) > 8 && Math.abs(p.y - from.y) > 8 && event.pointerType === "mouse") {
        const xs = [toX(from.x), toX(p.x)].sort((a, b) => a - b), ys = [toY(from.y), toY(p.y)].sort((a, b) => a - b);
        view = { x0: xs[0], x1: xs[1], y0: ys[0], y1: ys[1] };
        draw();
      } else at(toX(p.x));
    });
    svg.addEventListener("pointerleave", () => { if (drag) { drag = null; draw(); } });
    svg.addEventListener("dblclick", all);
    svg.addEventListener("keydown", (event) => {
      const act = { ArrowLeft: () => move(-1), ArrowRight: () => move(1), "+": () => zoom(0.7), "=": () => zoom(0.7),
        "-": () => zoom(1 / 0.7), 0: all }[event.key];
      if (act && !event.ctrlKey && !event.metaKey) { act(); event.preventDefault(); }
    });
    new ResizeObserver(() => { if (view) draw(); }).observe(host);
    return { show, zoom, all };
  };
})();
