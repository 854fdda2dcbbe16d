"use strict";
// The trace of a run: its signals over time, its segments, and what checks flagged.
report.Trace = (() => {
  const TOP = 65534; // as records/packed.py has it
  const MOST = 3000; // points of a signal that are drawn at once
  const LIGHT = { ink: "#1c2126", mean: "#c00000", suspect: "#b07500", fail: "#a8201a", forward: "#3a3a3a", backward: "#e69f00", unknown: "#56b4e9" };
  const DARK = { ink: "#e4e8ec", mean: "#ff9d94", suspect: "#f0c36a", fail: "#ff9d94", forward: "#bec8d2", backward: "#e69f00", unknown: "#56b4e9" };

  // Bytes of one kind stand side by side: the lowest of all steps, the next ones, then those of the values.
  function decode(bytes, signal, [knots, at]) {
    const { points, step_bytes: width } = signal;
    const share = (signal.high - signal.low) / TOP;
    const times = new Array(points), values = new Array(points);
    for (let k = 0, place = 0, part = 0; k < points; k++) {
      for (let b = 0; b < width; b++) place += bytes[b * points + k] * 256 ** b;
      while (part < knots.length - 2 && place > knots[part + 1]) part++;
      const pace = (at[part + 1] - at[part]) / (knots[part + 1] - knots[part]);
      times[k] = place === knots[part] ? at[part] : at[part] + (place - knots[part]) * pace;
      const level = bytes[width * points + k] + 256 * bytes[(width + 1) * points + k];
      values[k] = level > TOP ? null : signal.low + level * share;
    }
    return [times, values];
  }

  // Of very many points the lowest and the highest of equal parts are drawn: no spike is lost.
  function thinned(times, values, low, high) {
    let first = times.findIndex((t) => t >= low), last = times.findLastIndex((t) => t <= high);
    first = Math.max(first - 1, 0);
    last = Math.min(last + 1, times.length - 1);
    const count = last - first + 1;
    if (count <= MOST) return [times.slice(first, last + 1), values.slice(first, last + 1)];
    const x = [], y = [], step = (2 * count) / MOST;
    for (let at = first; at <= last; at += step) {
      const from = Math.floor(at), to = Math.min(Math.floor(at + step), last + 1);
      let least = from, most = from;
      for (let k = from; k < to; k++) {
        if (values[k] < values[least] || values[least] === null) least = k;
        if (values[k] > values[most] || values[most] === null) most = k;
      }
      for (const k of least < most ? [least, most] : least > most ? [most, least] : [least]) x.push(times[k]), y.push(values[k]);
    }
    return [x, y];
  }

  const unpack = (level) => Promise.all(level.signals.map((signal) => (signal.deflated ? report.unpacked : report.bytes)(signal.data)));
  const plain = (value) => String(Number(value.toPrecision(6))).replace("-", "−");
  const moves = (name) => /velocity|speed|position/.test(name);
  const concerns = (span, signal) => moves(span.signal) === moves(signal.name) && signal.name !== "inertial_force";

  return class extends report.Chart {
    async read() {
      const [coarse, fine] = this.figure.querySelectorAll("script");
      const trace = JSON.parse(coarse.textContent), bytes = await unpack(trace);
      this.finer = fine;
      this.trace = trace;
      this.level = trace;
      this.signals = trace.signals.map((signal, row) => decode(bytes[row], signal, trace.clock));
      this.span = [0, trace.length_s];
      const named = (signal) => ({ label: signal.label, unit: signal.unit });
      return { panels: trace.signals.map((signal) => ({ x: { label: "time", unit: "s" }, y: named(signal) })), series: [] };
    }

    legend() { return []; }

    traces() {
      const tone = report.drawing.isDark() ? DARK : LIGHT, axis = (kind, row) => kind + (row ? row + 1 : "");
      const traces = this.trace.signals.map((signal, row) => {
        const [x, y] = thinned(...this.signals[row], ...this.span);
        const unit = signal.unit && ` ${signal.unit}`;
        return {
          x, y, name: signal.label, mode: "lines", xaxis: axis("x", row), yaxis: axis("y", row), line: { color: tone.ink, width: 1 }, connectgaps: false,
          text: x.map((t, k) => y[k] === null ? "" : `${plain(t)} s: ${Number(this.value(signal, y[k]).toPrecision(4))}${unit}${this.where(t)}`),
          hovertemplate: "%{text}<extra></extra>",
        };
      });
      const x = [], y = [];
      for (const [, , inner, outer, , mean] of this.trace.segments) {
        if (mean !== null) x.push(inner, outer, null), y.push(mean, mean, null);
      }
      traces.push({ x, y, name: "mean", mode: "lines", line: { color: tone.mean, width: 2 }, hoverinfo: "skip" });
      return traces;
    }

    value(signal, drawn) { return signal.linear_below === null ? drawn : signal.linear_below * Math.sinh(drawn); }

    where(t) {
      const place = this.trace.segments.findIndex(([start, stop]) => t >= start && t <= stop);
      return place < 0 ? "" : `<br>segment ${place + 1}, ${this.trace.segments[place][6]}${this.review?.hover(place) ?? ""}`;
    }

    get shapes() {
      return () => {
        const tone = report.drawing.isDark() ? DARK : LIGHT, shapes = [], rows = this.trace.signals.length;
        const [low, high] = this.span, least = (high - low) / 400;
        const box = (row, from, to, colour, opacity) => {
          if (to < low || from > high) return;
          shapes.push({ type: "rect", layer: "below", xref: row ? `x${row + 1}` : "x", yref: `y${row ? row + 1 : ""} domain`, x0: from, x1: Math.max(to, from + least), y0: 0, y1: 1, fillcolor: colour, opacity, line: { width: 0 } });
        };
        const seen = this.trace.segments.filter(([start, stop]) => stop >= low && start <= high).slice(0, 120);
        for (let row = 0; row < rows; row++) {
          for (const [start, stop, inner, outer, sign] of seen) {
            const colour = sign > 0 ? tone.forward : sign < 0 ? tone.backward : tone.unknown;
            box(row, start, stop, colour, 0.07);
            box(row, inner, outer, colour, 0.12);
          }
          // what a person rejected is hatched
          for (const flag of this.trace.flags) if (concerns(flag, this.trace.signals[row]) && flag.checks.join() !== "manual") box(row, flag.start_s, flag.stop_s, tone[flag.severity], 0.35);
        }
        return [...shapes, ...(this.review?.marks() ?? [])];
      };
    }

    range(side, panel) {
      if (side === "x") return [...this.span];
      let low = Infinity, high = -Infinity;
      const [times, values] = this.signals[panel];
      for (let k = 0; k < times.length; k++) {
        if (times[k] < this.span[0] || times[k] > this.span[1] || values[k] === null) continue;
        low = Math.min(low, values[k]);
        high = Math.max(high, values[k]);
      }
      const room = 0.05 * (high - low || 1);
      return high >= low ? [low - room, high + room] : undefined;
    }

    // Speeds span decades in both directions: their axis is linear only near zero.
    axes(side, row) {
      const signal = this.trace.signals[row];
      if (side === "x" || signal.linear_below === null) return {};
      const [low, high] = this.range("y", row).map((v) => this.value(signal, v));
      const last = Math.floor(Math.log10(Math.max(-low, high)) + 1e-9), first = Math.floor(Math.log10(signal.linear_below) + 1e-9);
      const step = Math.max(1, Math.ceil((last - first) / 2)), marks = [0];
      for (let k = last; k > first || k === last; k -= step) marks.push(10 ** k, -(10 ** k));
      const fit = marks.filter((v) => v >= low && v <= high).sort((a, b) => a - b);
      const name = (v) => (v === 0 ? "0" : `${v < 0 ? "−" : ""}10<sup>${String(Math.round(Math.log10(Math.abs(v)))).replace("-", "−")}</sup>`);
      return { tickvals: fit.map((v) => Math.asinh(v / signal.linear_below)), ticktext: fit.map(name) };
    }

    get height() { return this.full ? innerHeight - 160 : 180 + 120 * Math.max(1, this.trace.signals.length); }

    // The reader zoomed by hand: what is drawn follows, and the finer trace is unpacked if need be.
    follow() {
      const now = this.place._fullLayout.xaxis.range.map(Number);
      if (Math.abs(now[0] - this.span[0]) + Math.abs(now[1] - this.span[1]) > 1e-9 * this.trace.length_s) this.show(...now);
    }

    async show(low, high) {
      const whole = this.trace.length_s;
      const wide = Math.min(Math.max(high - low, whole * 1e-6), whole);
      const start = Math.min(Math.max(low, 0), whole - wide);
      this.span = [start, start + wide];
      if (wide < 0.4 * whole && this.finer) await this.refine();
      this.paint();
    }

    zoom(factor, shift = 0) {
      const [low, high] = this.span, middle = (low + high) / 2 + shift * (high - low), half = ((high - low) / 2) * factor;
      return this.show(middle - half, middle + half);
    }

    whole() { return this.show(0, this.trace.length_s); }

    async refine() {
      const packed = this.finer.textContent;
      this.finer = null; // once is enough
      const finer = JSON.parse(packed);
      const bytes = await unpack(finer);
      this.level = finer;
      this.signals = finer.signals.map((signal, row) => decode(bytes[row], signal, this.trace.clock));
    }

    tell() {
      const [low, high] = this.span, points = this.level.signals[0].points;
      const part = this.level.complete ? `all ${this.trace.samples} samples` : `${points} of ${this.trace.samples} samples, extremes kept`;
      this.figure.querySelector(".state").textContent = `${plain(low)} s to ${plain(high)} s of ${plain(this.trace.length_s)} s; ${part}`;
      this.review?.follow();
    }

    table() {
      const [low, high] = this.span, rows = ["signal,unit,time_s,value"];
      this.level.signals.forEach((signal, row) => {
        const [times, values] = this.signals[row];
        times.forEach((t, k) => {
          if (t >= low && t <= high && values[k] !== null) rows.push(`${signal.name},${signal.unit || 1},${t},${this.value(signal, values[k])}`);
        });
      });
      return rows.join("\n") + "\n";
    }

    listen() {
      super.listen();
      this.figure.addEventListener("click", (event) => {
        const button = event.target.closest("button[data-from]");
        if (!button) return;
        const [from, to] = [Number(button.dataset.from), Number(button.dataset.to)];
        const room = Math.max(to - from, this.trace.length_s / 500);
        this.show(from - room, to + room);
        this.place.scrollIntoView({ block: "nearest" });
      });
    }
  };
})();
