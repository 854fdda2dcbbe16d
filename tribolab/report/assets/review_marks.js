"use strict";
// What is decided, in the trace: rejected segments hatched, the chosen one framed, its bounds to be dragged.
report.Marks = (() => {
  const LIGHT = { applied: "#a8201a", pending: "#0b5cad", accepted: "#1a6b3c" };
  const DARK = { applied: "#ff9d94", pending: "#79b8f5", accepted: "#82d8a3" };
  const APART = 9; // px between the lines of a hatch
  const NEAR = 12; // px beside a segment that still choose it
  const MOST = 400; // shapes at once
  const STILL = 5; // px that a click may move
  const escaped = (words) => words.replace(/[&<>]/g, (c) => `&#${c.charCodeAt(0)};`);

  return class {
    constructor(chart, panel) {
      this.chart = chart;
      this.panel = panel;
      this.chosen = document.createElement("div");
      this.chosen.className = "chosen";
      this.ends = ["start", "stop"].map((end, side) => this.handle(end, side));
      chart.figure.append(this.chosen, ...this.ends);
      chart.review = this;
      this.listen();
      this.follow();
    }

    handle(end, side) {
      const handle = document.createElement("div");
      Object.assign(handle, { className: `bound ${end}`, tabIndex: 0, role: "slider", hidden: true });
      handle.setAttribute("aria-label", side ? "End of the segment" : "Beginning of the segment");
      handle.dataset.bound = end;
      handle.addEventListener("pointerdown", (event) => {
        event.preventDefault();
        handle.focus();
        handle.setPointerCapture(event.pointerId);
      });
      handle.addEventListener("pointermove", (event) => {
        if (handle.hasPointerCapture(event.pointerId)) this.panel.move(side, this.rounded(this.timeAt(event.clientX)));
      });
      handle.addEventListener("keydown", (event) => {
        const steps = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 }[event.key];
        if (event.key === "Enter") this.panel.ask();
        else if (steps) this.panel.move(side, this.rounded(this.panel.bounds[side] + (steps * (event.shiftKey ? 10 : 1) * this.seen) / 200));
        else return;
        event.preventDefault();
      });
      return handle;
    }

    get axis() { return this.chart.place._fullLayout?.xaxis; }
    get seen() { return this.chart.span[1] - this.chart.span[0]; }

    timeAt(x) {
      const left = this.chart.place.getBoundingClientRect().left + this.axis._offset;
      return this.axis.p2d(x - left);
    }
    // As many digits as a pixel is worth.
    rounded(time) {
      const digits = Math.max(0, Math.ceil(-Math.log10(this.seen / this.axis._length)));
      return Number(time.toFixed(Math.min(digits, 9)));
    }

    // A click, not a drag, anywhere over a segment: beside very short ones the nearest.
    listen() {
      let pressed = null;
      const { place } = this.chart;
      place.addEventListener("pointerdown", (event) => { pressed = event.isPrimary && !event.button ? event : null; }, true);
      addEventListener("pointercancel", () => { pressed = null; });
      addEventListener("pointerup", (event) => {
        const from = pressed;
        pressed = null;
        if (!from || !this.chart.drawn || Math.hypot(event.clientX - from.clientX, event.clientY - from.clientY) > STILL) return;
        const box = place.getBoundingClientRect(), { l, r, t, b } = place._fullLayout._size;
        const x = event.clientX - box.left, y = event.clientY - box.top;
        if (x < l || x > box.width - r || y < t || y > box.height - b) return;
        const time = this.timeAt(event.clientX), reach = (NEAR * this.seen) / this.axis._length;
        const away = this.panel.segments.map(([start, stop]) => Math.max(start - time, time - stop, 0));
        const nearest = away.indexOf(Math.min(...away));
        if (away[nearest] <= reach) this.panel.choose(nearest);
      }, true);
    }

    // What the pointer is told over a segment.
    hover(place) { return this.panel.decided(place).map((one) => `<br>${escaped(this.panel.tells(one))}`).join(""); }

    // Shapes of the figure itself, so that a picture of it has them, too.
    marks() {
      const dark = report.drawing.isDark(), tone = dark ? DARK : LIGHT, shapes = [];
      const [low, high] = this.chart.span, rows = this.chart.trace.signals.length;
      const paper = report.drawing.state.printing; // has what the numbers have
      for (const one of this.panel.known) {
        const whole = one.segment === null && one.action === "reject";
        if (one.action === "note" || !(whole || Number.isInteger(one.segment)) || (one.state === "withdrawn" && !(paper && one.applied))) continue;
        const pending = ["pending", "waiting"].includes(one.state);
        if ((pending && paper) || shapes.length > MOST) continue;
        const colour = pending ? tone.pending : one.action === "accept" ? tone.accepted : tone.applied;
        const moved = one.action === "bounds" && pending, bounds = whole ? this.panel.ends : this.panel.segments[one.segment];
        const [start, stop] = moved ? [one.new_start_s ?? bounds[0], one.new_stop_s ?? bounds[1]] : bounds;
        if (stop < low || start > high) continue;
        const line = { color: colour, width: 1.5, dash: pending ? "dash" : "solid" };
        for (let row = 0; row < rows; row++) {
          const at = { xref: row ? `x${row + 1}` : "x", yref: `y${row ? row + 1 : ""} domain`, line };
          shapes.push({ ...at, type: "rect", x0: start, x1: stop, y0: 0, y1: 1 });
          if (one.action === "reject") shapes.push({ ...at, type: "path", path: this.hatch(Math.max(start, low), Math.min(stop, high), row, pending), line: { ...line, width: 1, dash: "solid" } });
        }
      }
      return shapes;
    }

    // Lines at 45°: rising where it is applied, falling where it is pending.
    hatch(start, stop, row, falling) {
      const [low, high] = this.chart.span, plot = this.axis?._length ?? 800;
      const tall = this.chart.place._fullLayout?.[row ? `yaxis${row + 1}` : "yaxis"]?._length ?? 160;
      const wide = ((stop - start) / (high - low)) * plot, time = (px) => start + (px / plot) * (high - low);
      const parts = [];
      for (let shift = APART - tall; shift < wide; shift += APART) {
        const from = Math.max(shift, 0), to = Math.min(shift + tall, wide);
        const [y0, y1] = [from, to].map((px) => (falling ? 1 - (px - shift) / tall : (px - shift) / tall));
        parts.push(`M${time(from)},${y0.toFixed(4)}L${time(to)},${y1.toFixed(4)}`);
      }
      return parts.join("") || `M${start},0L${stop},1`;
    }

    // The frame around what is chosen stands over the figure: it is not drawn again for it.
    follow() {
      const bounds = this.panel.bounds, axis = this.axis;
      const shown = bounds && axis && this.chart.drawn && this.chart.place.clientWidth > 0;
      const { offsetLeft, offsetTop } = this.chart.place;
      const size = this.chart.place._fullLayout?._size;
      const at = (time) => Math.min(Math.max(axis.d2p(time), 0), axis._length);
      this.chosen.hidden = !shown || bounds[1] < this.chart.span[0] || bounds[0] > this.chart.span[1];
      if (!this.chosen.hidden) {
        const [from, to] = bounds.map(at);
        Object.assign(this.chosen.style, { left: `${offsetLeft + axis._offset + from}px`, width: `${Math.max(to - from, 2)}px`, top: `${offsetTop + size.t}px`, height: `${size.h}px` });
      }
      this.ends.forEach((handle, side) => {
        handle.hidden = this.chosen.hidden || bounds[side] < this.chart.span[0] || bounds[side] > this.chart.span[1];
        if (handle.hidden) return;
        Object.assign(handle.style, { left: `${offsetLeft + axis._offset + at(bounds[side])}px`, top: `${offsetTop + size.t}px`, height: `${size.h}px` });
        const [low, high] = this.panel.limits;
        const said = { "aria-valuemin": low, "aria-valuemax": high, "aria-valuenow": bounds[side], "aria-valuetext": `${Number(bounds[side].toPrecision(6))} s` };
        for (const [name, value] of Object.entries(said)) handle.setAttribute(name, value);
      });
    }

    // What is chosen comes into view, as no less than a share of it.
    bring(share) {
      const [start, stop] = this.panel.bounds, [low, high] = this.chart.span;
      const room = Math.max((stop - start) / 2, this.chart.trace.length_s / 5000);
      const tiny = (stop - start) / (high - low) < share;
      return start < low || stop > high || tiny ? this.chart.show(start - room, stop + room) : undefined;
    }
  };
})();
