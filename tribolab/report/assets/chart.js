"use strict";
// The traces of a run: drawn by uPlot, zoomed and panned by mouse, keys and buttons.
(() => {
  const TOP = 65534; // as report/packed.py has it
  const LIGHT = {
    ink: "#1c2126", grid: "#d8dee4", mean: "#c00000", suspect: "#b07500", fail: "#a8201a",
    forward: "58, 58, 58", backward: "230, 159, 0", unknown: "86, 180, 233",
  };
  const DARK = {
    ink: "#e4e8ec", grid: "#333b44", mean: "#ff9d94", suspect: "#f0c36a", fail: "#ff9d94",
    forward: "190, 200, 210", backward: "230, 159, 0", unknown: "86, 180, 233",
  };
  const HEIGHTS = [260, 150];
  const PAPER = 640; // fits between the margins of A4 and of Letter
  const charts = new Map(); // by key of the run
  let printing = false;

  function colours() {
    const theme = document.documentElement.dataset.theme;
    const dark = theme ? theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
    return dark && !printing ? DARK : LIGHT;
  }

  // Bytes of one kind stand side by side: the lowest of all steps, the next ones, then those of the values.
  function decode(bytes, signal, [knots, at]) {
    const { points, step_bytes: width } = signal;
    const share = (signal.high - signal.low) / TOP;
    const value = signal.linear_below === null ? (level) => level : (level) => signal.linear_below * Math.sinh(level);
    const times = new Array(points), values = new Array(points);
    for (let k = 0, place = 0, part = 0; k < points; k++) {
      for (let b = 0; b < width; b++) place += bytes[b * points + k] * 256 ** b;
      while (part < knots.length - 2 && place > knots[part + 1]) part++;
      const pace = (at[part + 1] - at[part]) / (knots[part + 1] - knots[part]);
      times[k] = place === knots[part] ? at[part] : at[part] + (place - knots[part]) * pace;
      const level = bytes[width * points + k] + 256 * bytes[(width + 1) * points + k];
      values[k] = level > TOP ? null : value(signal.low + level * share);
    }
    return [times, values];
  }

  // Speeds span decades in both directions, so their axis is linear only near zero.
  function decades(slowest, low, high) {
    const first = Math.floor(Math.log10(slowest) + 1e-9);
    const last = Math.floor(Math.log10(Math.max(-low, high)) + 1e-9);
    const step = Math.max(1, Math.ceil((last - first) / 2));
    const found = [0];
    for (let k = last; k > first || k === last; k -= step) found.push(10 ** k, -(10 ** k));
    return found.filter((v) => v >= low && v <= high).sort((a, b) => a - b);
  }
  const RAISED = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };
  function power(value) {
    if (value === 0) return "0";
    const exponent = Math.round(Math.log10(Math.abs(value)));
    return (value < 0 ? "−" : "") + "10" + String(exponent).replace(/./g, (c) => RAISED[c]);
  }
  const plain = (value) => String(Number(value.toPrecision(6))).replace("-", "−");

  class Chart {
    constructor(figure) {
      this.figure = figure;
      this.place = figure.querySelector(".plot");
      this.data = JSON.parse(figure.querySelector("script").textContent);
      this.finer = figure.querySelector("script.finer");
      this.level = this.data; // what is drawn: this, or the finer one once it is there
      this.range = [0, this.data.length_s];
      this.state = figure.querySelector(".state");
      this.readout = figure.querySelector(".readout");
      this.drawn = this.data.signals.map((signal) => decode(report.bytes(signal.data), signal, this.data.clock));
      this.build();
      this.listen();
      this.tell();
    }

    build() {
      for (const chart of this.plots ?? []) chart.destroy();
      this.plots = this.data.signals.map((signal, row) => new uPlot(this.options(signal, row), this.drawn[row], this.place));
      this.show(...this.range);
    }

    options(signal, row) {
      const colour = colours();
      const log = signal.linear_below !== null;
      const last = row === this.data.signals.length - 1;
      const axis = { stroke: colour.ink, grid: { stroke: colour.grid, width: 1 }, ticks: { stroke: colour.grid, width: 1 }, font: "12px sans-serif", labelFont: "12px sans-serif" };
      const vertical = { ...axis, scale: "y", size: 64, label: signal.label + (signal.unit ? ` (${signal.unit})` : "") };
      if (log) {
        vertical.splits = (u, i, low, high) => decades(signal.linear_below, low, high);
        vertical.values = (u, splits) => splits.map(power);
        vertical.filter = (u, splits) => splits;
      } else {
        vertical.values = (u, splits) => splits.map((v) => (v === null ? "" : plain(v)));
      }
      return {
        width: printing ? PAPER : Math.max(280, this.place.clientWidth), height: HEIGHTS[Math.min(row, 1)],
        legend: { show: false },
        scales: { x: { time: false }, y: log ? { distr: 4, asinh: signal.linear_below } : {} },
        series: [{}, { stroke: colour.ink, width: 1, points: { show: false }, spanGaps: false }],
        axes: [{ ...axis, label: last ? "time (s)" : undefined, size: 30, gap: 3, labelSize: 18, values: (u, splits) => splits.map(plain) }, vertical],
        cursor: {
          sync: { key: this.figure.dataset.key },
          drag: { x: true, y: false, setScale: true },
          bind: { mousedown: (u, target, handler) => (event) => (event.shiftKey ? this.grab(event, u) : handler(event)) },
        },
        hooks: {
          drawClear: [(u) => this.shade(u, row)],
          draw: [(u) => this.means(u, row)],
          setScale: [(u, key) => { if (key === "x") this.follow(u); }],
          setCursor: [(u) => this.read(u, row)],
        },
      };
    }

    shade(u, row) {
      const colour = colours(), { ctx, bbox } = u;
      const at = (t) => Math.min(Math.max(u.valToPos(t, "x", true), bbox.left), bbox.left + bbox.width);
      const fill = (style, from, to, top, height, least = 0) => {
        const a = Math.round(at(from)), width = Math.max(Math.round(at(to)) - a, least);
        if (width <= 0 || to < this.range[0] || from > this.range[1]) return;
        ctx.fillStyle = style;
        ctx.fillRect(a, top, width, height);
      };
      ctx.save();
      for (const [start, stop, inner, outer, sign] of this.data.segments) {
        const rgb = sign > 0 ? colour.forward : sign < 0 ? colour.backward : colour.unknown;
        fill(`rgba(${rgb}, 0.07)`, start, stop, bbox.top, bbox.height);
        fill(`rgba(${rgb}, 0.12)`, inner, outer, bbox.top, bbox.height);
      }
      const bar = 7 * devicePixelRatio;
      for (const span of this.data.flags) {
        if (!this.concerns(span, row)) continue;
        const tone = colour[span.severity];
        ctx.globalAlpha = 0.28;
        fill(tone, span.start_s, span.stop_s, bbox.top, bbox.height, 3);
        ctx.globalAlpha = 1;
        fill(tone, span.start_s, span.stop_s, bbox.top, bar, 3);
        if (span.severity === "fail") fill(tone, span.start_s, span.stop_s, bbox.top + bbox.height - bar, bar, 3);
      }
      ctx.restore();
    }

    concerns(span, row) {
      const motion = /velocity|speed|position/.test(span.signal);
      return motion === (row > 0);
    }

    means(u, row) {
      if (row > 0) return;
      const { ctx } = u;
      ctx.save();
      ctx.beginPath();
      ctx.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height);
      ctx.clip();
      ctx.strokeStyle = colours().mean;
      ctx.lineWidth = 1.5 * devicePixelRatio;
      ctx.beginPath();
      for (const [, , inner, outer, , mean] of this.data.segments) {
        if (mean === null) continue;
        const y = u.valToPos(mean, "y", true);
        ctx.moveTo(u.valToPos(inner, "x", true), y);
        ctx.lineTo(u.valToPos(outer, "x", true), y);
      }
      ctx.stroke();
      ctx.restore();
    }

    // One of the plots was zoomed: the others follow, and the finer trace is unpacked if need be.
    follow(u) {
      const { min, max } = u.scales.x;
      if (this.moving || min === null || (min === this.range[0] && max === this.range[1])) return;
      queueMicrotask(() => this.show(min, max));
    }

    show(low, high) {
      const whole = this.data.length_s;
      const span = Math.min(Math.max(high - low, whole * 1e-6), whole);
      const start = Math.min(Math.max(low, 0), whole - span);
      this.range = [start, start + span];
      this.moving = true;
      for (const plot of this.plots) plot.batch(() => plot.setScale("x", { min: start, max: start + span }));
      this.moving = false;
      if (span < 0.4 * whole && this.finer) this.refine();
      this.tell();
    }

    zoom(factor, about = 0.5) {
      const [low, high] = this.range, at = low + about * (high - low);
      this.show(at - (at - low) * factor, at + (high - at) * factor);
    }

    pan(share) {
      const [low, high] = this.range, by = share * (high - low);
      this.show(low + by, high + by);
    }

    async refine() {
      const finer = JSON.parse(this.finer.textContent);
      this.finer = null; // once is enough
      const unpacking = finer.signals.map((signal) => report.unpacked(signal.data));
      const bytes = await Promise.all(unpacking).catch(() => null);
      if (bytes === null) {
        this.missing = true;
        return this.tell();
      }
      this.level = finer;
      this.drawn = finer.signals.map((signal, row) => decode(bytes[row], signal, this.data.clock));
      this.plots.forEach((plot, row) => plot.setData(this.drawn[row], false));
      this.show(...this.range);
    }

    tell() {
      const [low, high] = this.range;
      const points = this.level.signals[0].points;
      const part = this.level.complete ? `all ${this.data.samples} samples` : `${points} of ${this.data.samples} samples, extremes kept`;
      const lost = this.missing ? "; this browser cannot unpack the finer trace" : "";
      this.state.textContent = `${plain(low)} s to ${plain(high)} s of ${plain(this.data.length_s)} s; ${part}${lost}`;
    }

    read(u, row) {
      const place = u.cursor.idx;
      if (row > 0 || place === null || place === undefined) return;
      const [t, v] = [u.data[0][place], u.data[1][place]];
      const segment = this.data.segments.findIndex(([start, stop]) => t >= start && t <= stop);
      const where = segment < 0 ? "" : `, segment ${segment + 1} (${this.data.segments[segment][6]})`;
      const unit = this.data.signals[0].unit;
      this.readout.textContent = v === null ? "" : `${plain(t)} s: ${this.data.signals[0].label} ${Number(v.toPrecision(4))}${unit && " " + unit}${where}`;
    }

    grab(event, u) {
      event.preventDefault();
      const width = u.bbox.width / devicePixelRatio, [low, high] = this.range;
      const move = (later) => {
        const by = ((event.clientX - later.clientX) / width) * (high - low);
        this.show(low + by, high + by);
      };
      const end = () => {
        removeEventListener("pointermove", move);
        removeEventListener("pointerup", end);
        removeEventListener("pointercancel", end);
      };
      addEventListener("pointermove", move);
      addEventListener("pointerup", end);
      addEventListener("pointercancel", end);
    }

    listen() {
      const keys = {
        ArrowLeft: () => this.pan(-0.2), ArrowRight: () => this.pan(0.2),
        "+": () => this.zoom(0.5), "=": () => this.zoom(0.5), ArrowUp: () => this.zoom(0.5),
        "-": () => this.zoom(2), ArrowDown: () => this.zoom(2),
        Home: () => this.show(0, this.data.length_s), 0: () => this.show(0, this.data.length_s),
      };
      this.place.addEventListener("keydown", (event) => {
        if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
        event.preventDefault();
        keys[event.key]();
      });
      this.place.addEventListener("wheel", (event) => {
        if (!event.ctrlKey && !event.metaKey) return; // else the page scrolls, as everywhere
        event.preventDefault();
        const box = this.place.querySelector(".u-over").getBoundingClientRect();
        this.zoom(event.deltaY < 0 ? 0.7 : 1 / 0.7, Math.min(Math.max((event.clientX - box.left) / box.width, 0), 1));
      }, { passive: false });
      this.place.addEventListener("pointerdown", (event) => {
        if (event.pointerType === "touch") this.grab(event, this.plots[0]);
      });
      const acts = {
        in: keys["+"], out: keys["-"], left: keys.ArrowLeft, right: keys.ArrowRight, all: keys.Home,
        svg: () => report.save(`${this.figure.dataset.key}_view.svg`, "image/svg+xml", report.drawing(this)),
        csv: () => report.save(`${this.figure.dataset.key}_view.csv`, "text/csv", this.table()),
      };
      this.figure.addEventListener("click", (event) => {
        const button = event.target.closest("button");
        if (!button) return;
        if (button.dataset.act) acts[button.dataset.act]();
        if (button.dataset.from) {
          const [from, to] = [Number(button.dataset.from), Number(button.dataset.to)];
          const room = Math.max(to - from, this.data.length_s / 500);
          this.show(from - room, to + room);
          this.place.scrollIntoView({ block: "nearest" });
        }
      });
      new ResizeObserver(() => this.resize()).observe(this.place);
    }

    resize() {
      if (printing) return;
      const width = Math.max(280, this.place.clientWidth);
      if (!this.place.clientWidth || width === this.plots[0].width) return;
      this.plots.forEach((plot, row) => plot.setSize({ width, height: HEIGHTS[Math.min(row, 1)] }));
    }

    // What is seen, as numbers.
    table() {
      const [low, high] = this.range;
      const rows = ["signal,unit,time_s,value"];
      this.level.signals.forEach((signal, row) => {
        const [times, values] = this.drawn[row];
        times.forEach((t, k) => {
          if (t >= low && t <= high && values[k] !== null) rows.push(`${signal.name},${signal.unit || 1},${t},${values[k]}`);
        });
      });
      return rows.join("\n") + "\n";
    }
  }

  const draw = (details) => {
    for (const figure of details.querySelectorAll("figure.chart")) {
      if (!charts.has(figure)) charts.set(figure, new Chart(figure));
    }
  };
  report.opened.push(draw);
  const again = () => { for (const chart of charts.values()) chart.build(); };
  addEventListener("appearance", again);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", again);
  addEventListener("beforeprint", () => { printing = true; again(); });
  addEventListener("afterprint", () => { printing = false; again(); });
})();
