"use strict";
// One figure as the library wants it: from what it shows, its traces and its layout.
report.Picture = (() => {
  const { HUES, DARKER, SYMBOLS, DASHES, FONT, PAPER, HALF, THIRD, isOneOfMany, still, state, isDark, text, lines, force, axis, heightOf } = report.drawing;
  // Loads of one surface are shades of its colour: towards the ink for low loads, towards the paper for high ones.
  // How many powers of ten a logarithmic axis shows.
  const powers = ([low, high]) => Math.floor(high + 1e-9) - Math.ceil(low - 1e-9) + 1;

  function shaded(hue, shade) {
    if (!shade) return hue;
    const target = shade < 0 === isDark() ? 255 : 0, part = Math.abs(shade);
    return `#${[1, 3, 5].map((at) => Math.round(parseInt(hue.slice(at, at + 2), 16) * (1 - part) + target * part).toString(16).padStart(2, "0")).join("")}`;
  }

  const MOST_LABELS = 8; // in the legend of a card

  return class {
    constructor(figure) {
      this.figure = figure;
      this.place = figure.querySelector(".plot");
      this.load = null; // the one that is shown, of a figure of one load
      this.scales = {}; // what the reader chose: log or linear, by axis
      this.off = new Map(); // what the legend switches, by label
    }

    async unpack() {
      this.data ??= await this.read();
      return this.data;
    }

    async read() {
      const packed = this.figure.querySelector("script").textContent;
      return JSON.parse(new TextDecoder().decode(await report.unpacked(packed)));
    }

    get loads() {
      return [...new Set(this.data.series.map((one) => one.load).filter((load) => load !== undefined))].sort((a, b) => a - b);
    }

    // One load is chosen for all figures together; a figure that does not have it shows its lowest.
    chosen() {
      if (!this.data.one_load) return report.view.get("load") || null;
      const loads = this.loads.map(force), wanted = report.view.get("load");
      return loads.includes(wanted) ? wanted : loads[0] ?? null;
    }

    shown() {
      const load = this.chosen(), hidden = report.view.hidden;
      return this.data.series.filter((one) => {
        if (one.load !== undefined && load && force(one.load) !== load) return false;
        if (one.runs?.length && one.runs.every((name) => hidden.has(name))) return false;
        return report.view.shows({ surface: one.surface, medium: one.medium });
      });
    }

    isLog(side, panel) {
      return this.scales[`${side}${panel}`] ?? Boolean(this.data.panels[panel][side].log);
    }

    traces() {
      const hues = isDark() ? DARKER : HUES, seen = new Set(), traces = [];
      const marking = report.view.get("mark"), shown = this.shown(), named = this.named(shown);
      for (const one of shown) {
        const panel = one.panel ?? 0, place = one.colour ?? 0, style = one.style ?? "line";
        const hue = shaded(hues[place % hues.length], one.shade ?? 0);
        const faded = marking && !report.view.marks([one.label, ...(one.runs ?? [])].join(" "));
        const base = {
          name: text(one.label), legendrank: style === "band" ? 1001 : 1000, legendgroup: one.label, showlegend: named.has(one.label) && !seen.has(one.label) && (style !== "band" || named.get(one.label) === "band"),
          x: one.x, y: one.y, xaxis: axis("x", panel), yaxis: axis("y", panel), opacity: faded ? 0.15 : 1,
          visible: this.off.get(one.label) ? "legendonly" : true, meta: one.link,
          hovertemplate: `${lines(one.hover?.length === 1 ? one.hover[0] : one.label)}<br>%{x}, %{y}<extra></extra>`,
        };
        // what is told of a point stands beside it, see tellOf
        if (one.hover?.length > 1 || (one.hover?.length && style === "points")) Object.assign(base, { customdata: one.x.map((_, k) => one.hover[k] ?? one.hover[0]), hoverinfo: "none", hovertemplate: null });
        if (base.showlegend) seen.add(one.label);
        const symbol = SYMBOLS[(one.marker ?? place) % SYMBOLS.length] + (one.open ? "-open" : "");
        const size = one.sizes ? one.sizes.map((area) => 8 * Math.sqrt(area ?? 0)) : 8;
        if (style === "points") traces.push({ ...base, mode: one.joined ? "lines+markers" : "markers", line: { color: hue, width: 1, dash: one.open ? "dash" : "solid" }, marker: { color: hue, size, symbol, line: { width: one.open ? 1.6 : 0, color: hue } }, ...this.bars(one, hue) });
        else if (style === "band") traces.push(...this.band(one, base, hue));
        else if (style === "bars") traces.push({ ...base, type: "bar", orientation: "h", textposition: "none", marker: { color: hue } });
        // colours are levels here, so conditions are told by their markers, in the legend too
        else if (style === "heat") traces.push({ ...base, x: [null], y: [null], mode: "markers", marker: { color: hues[6], symbol, size: 8 } }, { ...base, showlegend: false, mode: "markers", marker: { color: one.high, symbol, size: 7, colorscale: "Cividis", showscale: traces.length === 0, cmin: 0.3, cmax: 3, colorbar: { title: { text: "log₁₀ of the ratio", side: "right" }, thickness: 12 } }, hovertemplate: `${text(one.label)}<br>%{x} m/s, %{y} Hz<br>log₁₀ ratio %{marker.color}<extra></extra>` });
        else traces.push({ ...base, mode: "lines", line: { color: hue, width: style === "line" ? 2 : 1.6, dash: DASHES[style] } });
      }
      return traces;
    }

    bars(one, hue) {
      if (!one.error?.some((value) => value > 0)) return {};
      const array = one.error.map((value) => value ?? 0), { least } = this.data.panels[one.panel ?? 0].y;
      const foot = one.error_below?.map((value) => value ?? 0) ?? array, rows = typeof one.y[0] === "string";
      const below = least === undefined && foot === array ? {} : { symmetric: false, arrayminus: least === undefined ? foot : foot.map((value, k) => Math.max(0, Math.min(value, one.y[k] - least))) };
      return { [rows ? "error_x" : "error_y"]: { type: "data", array, ...below, color: hue, thickness: one.pale ? 4 : 1.4, width: 4 } };
    }

    band(one, base, hue) {
      const log = this.isLog("y", one.panel ?? 0);
      const least = log ? Math.min(...one.high.filter((value) => value > 0)) / 1e3 : -Infinity;
      const edge = { ...base, mode: "lines", line: { width: 0, color: hue }, hoverinfo: "skip", hovertemplate: null, text: null };
      return [
        { ...edge, y: one.y.map((value) => Math.max(value, least)), showlegend: false },
        { ...edge, y: one.high, fill: "tonexty", fillcolor: `${hue}2e` },
      ];
    }

    // Straight lines across a panel, and shaded stretches of it.
    get lines() {
      const hues = isDark() ? DARKER : HUES, dashes = { ...DASHES, line: "solid" };
      return (this.data.marks ?? []).map(({ side, value, until, style, colour = 6, opacity = 1, panel = 0 }) => {
        const ends = [value, until ?? value], hue = hues[colour % hues.length], own = axis(side, panel), other = `${axis(side === "x" ? "y" : "x", panel)} domain`;
        const along = side === "x" ? { x0: ends[0], x1: ends[1], y0: 0, y1: 1, xref: own, yref: other } : { y0: ends[0], y1: ends[1], x0: 0, x1: 1, yref: own, xref: other };
        return until === undefined ? { type: "line", layer: "below", ...along, opacity, line: { color: hue, width: 1, dash: dashes[style ?? "line"] } } : { type: "rect", layer: "below", ...along, opacity, fillcolor: hue, line: { width: 0 } };
      });
    }

    // Bands may reach far beyond what was measured: the first view is that of points and lines.
    // The picture that stands here before (figures/axes.py) shows the same.
    range(side, panel) {
      const log = this.isLog(side, panel), names = side === "y" ? this.names(panel) : 0;
      if (names) return [-0.5, names - 0.5];
      const { view } = this.data.panels[panel][side];
      if (view) return log ? view.map(Math.log10) : view;
      let low = Infinity, high = -Infinity;
      const least = side === "y" ? this.data.panels[panel].y.least ?? -Infinity : -Infinity;
      const seen = side === "y" ? this.range("x", panel) : undefined, wide = this.isLog("x", panel);
      const within = (x) => !seen || typeof x !== "number" || ((wide ? Math.log10(x) : x) >= seen[0] && (wide ? Math.log10(x) : x) <= seen[1]);
      for (const one of this.shown()) {
        if ((one.panel ?? 0) !== panel || one.style === "band" || this.off.get(one.label)) continue;
        const values = side === "x" ? one.x : one.y;
        for (let k = 0; k < values.length; k++) {
          const value = values[k], bar = (side === "y") === (typeof one.y[k] === "number") ? one.error?.[k] ?? 0 : 0, under = bar && (one.error_below?.[k] ?? bar);
          if (typeof value !== "number") continue;
          if (side === "y" && !within(one.x[k])) continue;
          const foot = one.style === "bars" ? [log ? 0.8 * value : 0] : []; // where a bar begins
          for (const end of [Math.max(value - under, least), value + bar, value, ...foot]) {
            if (log && !(end > 0)) continue;
            if (log && end < value / 20) continue;
            low = Math.min(low, end);
            high = Math.max(high, end);
          }
        }
      }
      for (const end of this.data.panels[panel][side].include ?? []) if (!log || end > 0) [low, high] = [Math.min(low, end), Math.max(high, end)];
      if (!(high >= low)) return undefined;
      const decades = this.data.panels[panel][side].decades;
      if (log) [low, high] = [Math.log10(low), Math.log10(high)];
      if (log && decades) low = Math.max(low, high - decades);
      else if (!log && side === "y" && low > 0 && low < 0.6 * high) low = 0;
      // so far apart that no noise in a last digit fills it
      const largest = Math.max(Math.abs(low), Math.abs(high)), alone = high - low <= (log ? 1e-5 : 1e-5 * largest);
      const span = alone ? (log ? 0.6 : largest || 1) : log ? 0.1 : 0.02 * largest, wider = Math.max(0, (span - (high - low)) / 2);
      [low, high] = [low - wider, high + wider];
      const room = (high - low) * 0.06;
      return [low === 0 && !log ? 0 : low - room, high + room];
    }

    // Panels below each other share what lies along them.
    get along() {
      const ranges = this.data.panels.map((_, row) => this.range("x", row)).filter((one) => one);
      return ranges.length ? [Math.min(...ranges.map(([low]) => low)), Math.max(...ranges.map(([, high]) => high))] : undefined;
    }

    // How many rows of names there are up a panel.
    names(panel) {
      const shown = this.shown().filter((one) => (one.panel ?? 0) === panel && typeof one.y[0] === "string" && !this.off.get(one.label));
      return new Set(shown.flatMap((one) => one.y)).size;
    }

    layout() {
      const dark = isDark(), ink = dark ? "#e4e8ec" : "#1c2126", grid = dark ? "#333b44" : "#d8dee4";
      const panels = this.data.panels, count = panels.length, narrow = this.width < 520;
      const small = state.printing && !this.saving; // on paper letters are as high as those around
      const layout = {
        width: this.width, height: this.height, paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)",
        font: { family: FONT, size: small ? 10 : 13, color: ink }, hovermode: "closest", dragmode: still ? false : "zoom",
        margin: { l: 64, r: 14, t: 10, b: 48 }, showlegend: this.written > 1,
        hoverlabel: { align: "left", bgcolor: dark ? "#1d2329" : "#ffffff", bordercolor: grid, font: { color: ink, size: narrow ? 12 : 13 } },
        legend: { orientation: "h", x: 0, y: 1.02, yanchor: "bottom", font: { size: small ? 9 : narrow ? 11 : 12 }, maxheight: this.sizes.cut ? this.sizes.legend : undefined, groupclick: "togglegroup", itemsizing: "constant" },
        shapes: this.shapes?.() ?? this.lines,
        ...(this.more?.() ?? {}),
      };
      const gap = 0.09, tall = (1 - gap * (count - 1)) / count;
      panels.forEach((panel, row) => {
        const last = row === count - 1;
        const name = ({ label, unit }) => text(unit ? `${label} (${unit})` : label ?? "");
        const side = (kind, what, ends) => ({
          type: this.isLog(kind, row) ? "log" : what.label || kind === "x" ? "linear" : "category",
          title: { text: kind === "x" && !last ? "" : name(what), standoff: 8, font: { size: small ? 10 : 13 } }, gridcolor: grid, linecolor: ink, showline: true, ticks: "outside",
          tickcolor: ink, zeroline: kind === "y" && row > 0, zerolinecolor: ink, exponentformat: "power", automargin: true,
          tickfont: { size: (small ? 10 : 12) / (this.isLog(kind, row) ? 1.25 : 1) }, // the library writes powers of ten a quarter larger
          // with a single power of ten in sight, its neighbours are labelled, too
          minorloglabels: ends && powers(ends) < 2 ? "complete" : "none", nticks: narrow ? 5 : 8, range: ends,
        });
        const x = side("x", panel.x, this.along), y = side("y", panel.y, this.range("y", row));
        if (y.type === "category") Object.assign(y, { tickmode: "linear", dtick: 1, ticks: "" });
        if (y.type !== "log" || this.data.panels[row].y.unit === "") y.exponentformat = "none";
        // all nine of a decade do not fit beside each other
        const wide = y.type === "log" && y.range ? y.range[1] - y.range[0] : 0;
        if (wide > 0.7 && powers(y.range) < 2) Object.assign(y, { tickmode: "linear", tick0: 0, dtick: "D2" });
        if (wide > 0.7 && powers(y.range) < 2 && y.range[0] > -3 && y.range[1] < 4) y.exponentformat = "none";
        const few = x.type === "log" && this.along && x.range[1] - x.range[0] > 0.5 ? powers(this.along) : 0;
        if (few === 1 || (few === 2 && !narrow)) Object.assign(x, { tickmode: "linear", tick0: 0, dtick: "D2", minorloglabels: "complete", tickfont: { size: small ? 10 : 12 } });
        if (few === 2 && Math.min(...this.along) > -3 && Math.max(...this.along) < 4) x.exponentformat = "none";
        x.anchor = axis("y", row);
        if (row) x.matches = "x";
        if (!last && count > 1) x.showticklabels = false;
        y.domain = [1 - row * (tall + gap) - tall, 1 - row * (tall + gap)];
        y.anchor = axis("x", row);
        Object.assign(x, this.axes?.("x", row)), Object.assign(y, this.axes?.("y", row));
        layout[axis("xaxis", row)] = x;
        layout[axis("yaxis", row)] = y;
      });
      return layout;
    }

    // A band stands in the legend where it has a name that no line or point has (figures/spec.py).
    named(shown) {
      const named = new Map();
      for (const one of shown) if (one.style !== "band") named.set(one.label, one.style);
      for (const one of shown) if (one.label && !named.has(one.label)) named.set(one.label, "band");
      return named;
    }

    legend() { return [...this.named(this.shown()).keys()]; }

    get width() {
      if (this.full) return innerWidth - 24;
      if (state.printing) return isOneOfMany(this.place) ? THIRD : this.place.closest(".grid, .cards") ? HALF : PAPER;
      return Math.max(260, this.place.clientWidth);
    }

    // a card has no room for many names: a point says its own, and the whole window shows all
    get written() {
      const labels = this.legend().length;
      const low = !this.full && report.drawing.fills(this.place) && this.place.closest(".cards").dataset.columns > 2;
      return low || (this.place.closest(".cards") && !this.full && labels > MOST_LABELS) ? 0 : labels;
    }

    get sizes() { return heightOf(this.place, this.width, this.data.panels.length, this.written); }

    get height() {
      if (this.full) return innerHeight - 110;
      const { plot, legend } = this.sizes;
      return plot + legend;
    }
  };
})();
