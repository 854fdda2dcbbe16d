"use strict";
// One figure: what it shows comes as data, Plotly draws it. When, charts.js says.
report.drawing = (() => {
  // Okabe and Ito's palette, which people with any common colour deficiency tell apart.
  const HUES = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#6b6b6b", "#000000"];
  const DARKER = ["#5db4ee", "#ff8a3d", "#35c79a", "#e79cc6", "#f2bd45", "#8fd0f5", "#a8b0b8", "#ffffff"];
  const SYMBOLS = ["circle", "square", "diamond", "triangle-up", "triangle-down", "pentagon", "hexagon2", "star"];
  const DASHES = { line: "solid", dashed: "dash", dotted: "dot", dashdot: "dashdot" };
  const FONT = '"Segoe UI", "Helvetica Neue", Roboto, Arial, "Liberation Sans", system-ui, sans-serif';
  const PAPER = 680, HALF = 316; // widths that fit between the margins of A4, of one and of two beside each other
  const AROUND = 70; // above and below the axes: a legend that is no taller than these leaves most to the plot
  const still = matchMedia("(pointer: coarse)").matches; // a finger scrolls the page
  let library = null;
  const state = { printing: false };

  function isDark() {
    const theme = document.documentElement.dataset.theme;
    return !state.printing && (theme ? theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches);
  }
  // Plotly reads a little HTML in labels; names from files are text and nothing else.
  const text = (words) => String(words).replace(/[&<>]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;" })[c]);
  const lines = (words) => text(words).replaceAll("\n", "<br>");
  const force = (load) => `${Number(load.toPrecision(3))} N`;
  const axis = (kind, panel) => kind + (panel ? panel + 1 : "");

  // Known before a figure is drawn: what is below does not move when it comes.
  function heightOf(place, width, panels, labels) {
    const columns = Math.max(1, Math.floor(width / 210));
    const heights = place.dataset.height ? [Number(place.dataset.height)] : [320, 460, 620];
    const low = place.closest(".cards") ? 175 : 240;
    const squeezed = state.printing && panels === 1 && !("rows" in place.dataset); // not where names stand below each other
    const plot = squeezed ? Math.min(low, heights[0]) : heights[Math.min(panels, heights.length) - 1];
    const whole = labels > 1 ? Math.ceil(labels / columns) * 21 : 0, legend = state.printing ? whole : Math.min(whole, plot - AROUND);
    return { plot, legend, cut: legend < whole };
  }

  // The page's policy forbids style attributes as text; the library means what a script may set.
  const asText = Element.prototype.setAttribute;
  Element.prototype.setAttribute = function (name, value) {
    if (name === "style") this.style.cssText = value;
    else asText.call(this, name, value);
  };

  // The library is unpacked and started from the page itself, once.
  function plotly() {
    library ??= (async () => {
      const code = await report.unpacked(document.getElementById("library").textContent);
      const script = document.createElement("script");
      script.src = URL.createObjectURL(new Blob([code], { type: "text/javascript" }));
      await new Promise((done, failed) => {
        script.onload = done;
        script.onerror = failed;
        document.head.append(script);
      });
      return globalThis.Plotly;
    })();
    return library;
  }

  class Chart {
    constructor(figure) {
      this.figure = figure;
      this.place = figure.querySelector(".plot");
      this.load = null; // the one that is shown, of a figure of one load
      this.scales = {}; // what the reader chose: log or linear, by axis
      this.off = new Map(); // what the legend switches, by label
      this.listen();
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
      const marking = report.view.get("mark");
      for (const one of this.shown()) {
        const panel = one.panel ?? 0, place = one.colour ?? 0, style = one.style ?? "line";
        const hue = hues[place % hues.length];
        const faded = marking && !report.view.marks([one.label, ...(one.runs ?? [])].join(" "));
        const base = {
          name: text(one.label), legendgroup: one.label, showlegend: !seen.has(one.label) && style !== "band",
          x: one.x, y: one.y, xaxis: axis("x", panel), yaxis: axis("y", panel), opacity: faded ? 0.15 : 1,
          visible: (this.off.get(one.label) ?? one.faint) ? "legendonly" : true, meta: one.goes_to,
          hovertemplate: `${lines(one.told?.length === 1 ? one.told[0] : one.label)}<br>%{x}, %{y}<extra></extra>`,
        };
        // what is told of a point stands beside it, see tellOf
        if (one.told?.length > 1 || (one.told?.length && style === "points")) Object.assign(base, { customdata: one.x.map((_, k) => one.told[k] ?? one.told[0]), hoverinfo: "none", hovertemplate: null });
        if (style !== "band") seen.add(one.label);
        const symbol = SYMBOLS[place % SYMBOLS.length] + (one.open ? "-open" : "");
        if (style === "points") traces.push({ ...base, mode: "markers", marker: { color: hue, size: one.faint ? 5 : 8, symbol, line: { width: one.open ? 1.6 : 0, color: hue } }, ...this.bars(one, hue) });
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
      const below = least === undefined ? {} : { symmetric: false, arrayminus: array.map((value, k) => Math.max(0, Math.min(value, one.y[k] - least))) };
      return { error_y: { type: "data", array, ...below, color: hue, thickness: 1.4, width: 4 } };
    }

    band(one, base, hue) {
      const log = this.isLog("y", one.panel ?? 0);
      const least = log ? Math.min(...one.high.filter((value) => value > 0)) / 1e3 : -Infinity;
      const edge = { ...base, mode: "lines", line: { width: 0, color: hue }, hoverinfo: "skip", hovertemplate: null, text: null };
      return [
        { ...edge, y: one.y.map((value) => Math.max(value, least)) },
        { ...edge, y: one.high, fill: "tonexty", fillcolor: `${hue}2e` },
      ];
    }

    // Bands may reach far beyond what was measured: the first view is that of points and lines.
    range(side, panel) {
      const log = this.isLog(side, panel);
      let low = Infinity, high = -Infinity;
      const least = side === "y" ? this.data.panels[panel].y.least ?? -Infinity : -Infinity;
      const seen = side === "y" ? this.range("x", panel) : undefined, wide = this.isLog("x", panel);
      const within = (x) => !seen || typeof x !== "number" || ((wide ? Math.log10(x) : x) >= seen[0] && (wide ? Math.log10(x) : x) <= seen[1]);
      for (const one of this.shown()) {
        if ((one.panel ?? 0) !== panel || one.style === "band" || one.style === "bars" || (this.off.get(one.label) ?? one.faint)) continue;
        const values = side === "x" ? one.x : one.y;
        for (let k = 0; k < values.length; k++) {
          const value = values[k], bar = side === "y" ? one.error?.[k] ?? 0 : 0;
          if (typeof value !== "number") { if (typeof value === "string") return undefined; continue; }
          if (side === "y" && !within(one.x[k])) continue;
          for (const end of [Math.max(value - bar, least), value + bar, value]) {
            if (log && !(end > 0)) continue;
            if (log && end < value / 20) continue;
            low = Math.min(low, end);
            high = Math.max(high, end);
          }
        }
      }
      if (!(high >= low)) return undefined;
      const decades = this.data.panels[panel][side].decades;
      if (log) [low, high] = [Math.log10(low), Math.log10(high)];
      if (log && decades) low = Math.max(low, high - decades);
      else if (side === "y" && low > 0 && low < 0.6 * high) low = 0;
      const room = high > low ? (high - low) * 0.06 : log ? 0.3 : Math.abs(high) * 0.5 || 0.5;
      return [low === 0 && !log ? 0 : low - room, high + room];
    }

    layout() {
      const dark = isDark(), ink = dark ? "#e4e8ec" : "#1c2126", grid = dark ? "#333b44" : "#d8dee4";
      const panels = this.data.panels, count = panels.length, narrow = this.width < 520;
      const layout = {
        width: this.width, height: this.height, paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)",
        font: { family: FONT, size: 13, color: ink }, hovermode: "closest", dragmode: still ? false : "zoom",
        margin: { l: 64, r: 14, t: 10, b: 48 }, showlegend: this.legend().length > 1,
        hoverlabel: { align: "left", bgcolor: dark ? "#1d2329" : "#ffffff", bordercolor: grid, font: { color: ink, size: narrow ? 12 : 13 } },
        legend: { orientation: "h", x: 0, y: 1.02, yanchor: "bottom", font: { size: narrow ? 11 : 12 }, maxheight: this.sizes.cut ? this.sizes.legend : undefined, groupclick: "togglegroup", itemsizing: "constant" },
        shapes: this.shapes?.() ?? [],
        ...(this.more?.() ?? {}),
      };
      const gap = 0.09, tall = (1 - gap * (count - 1)) / count;
      panels.forEach((panel, row) => {
        const last = row === count - 1;
        const name = ({ label, unit }) => text(unit ? `${label} (${unit})` : label ?? "");
        const side = (kind, what) => ({
          type: this.isLog(kind, row) ? "log" : what.label || kind === "x" ? "linear" : "category",
          title: { text: kind === "x" && !last ? "" : name(what), standoff: 8 }, gridcolor: grid, linecolor: ink, showline: true, ticks: "outside",
          tickcolor: ink, zeroline: kind === "y" && row > 0, zerolinecolor: ink, exponentformat: "power", automargin: true,
          minorloglabels: "none", nticks: narrow ? 5 : 8, range: this.range(kind, row),
        });
        const x = side("x", panel.x), y = side("y", panel.y);
        if (y.type === "category") Object.assign(y, { tickmode: "linear", dtick: 1, ticks: "" });
        if (y.type !== "log" || this.data.panels[row].y.unit === "") y.exponentformat = "none";
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

    legend() { return [...new Set(this.shown().filter((one) => one.style !== "band").map((one) => one.label))]; }

    get width() {
      if (this.full) return innerWidth - 24;
      if (state.printing) return this.place.closest(".grid, .cards") ? HALF : PAPER;
      return Math.max(260, this.place.clientWidth);
    }

    get sizes() { return heightOf(this.place, this.width, this.data.panels.length, this.legend().length); }

    get height() {
      if (this.full) return innerHeight - 110;
      const { plot, legend } = this.sizes;
      return plot + legend;
    }

    async draw() {
      const [Plotly] = await Promise.all([plotly(), this.unpack()]);
      this.paint(Plotly);
    }

    paint(Plotly = globalThis.Plotly) {
      if (!Plotly || !this.data || !(state.printing || this.place.clientWidth)) return;
      const config = { displayModeBar: false, scrollZoom: false, doubleClick: false, showTips: false, locale: "en" };
      Plotly.react(this.place, this.traces(), this.layout(), config);
      if (!this.drawn) this.attach(Plotly);
      this.drawn = true;
      this.chips();
      this.tell?.();
    }

    attach(Plotly) {
      this.place.on("plotly_click", (event) => {
        const point = event.points[0], goals = point?.data.meta ?? [];
        const goal = goals.length === 1 ? goals[0] : goals[point.pointIndex ?? point.pointNumber];
        if (goal) report.goToRun(goal);
      });
      this.place.on("plotly_legendclick", (event) => {
        const label = event.data[event.curveNumber].legendgroup;
        this.off.set(label, event.data[event.curveNumber].visible !== "legendonly");
        this.paint(Plotly);
        return false;
      });
      this.place.on("plotly_legenddoubleclick", (event) => {
        const label = event.data[event.curveNumber].legendgroup;
        const alone = this.legend().every((one) => one === label || this.off.get(one));
        for (const one of this.legend()) this.off.set(one, !alone && one !== label);
        this.paint(Plotly);
        return false;
      });
      this.place.on("plotly_hover", (event) => { this.tellOf(event.points[0]); });
      this.place.on("plotly_unhover", () => { this.told?.remove(); });
      this.place.on("plotly_doubleclick", () => { this.whole(); });
      this.place.on("plotly_relayout", () => this.follow?.());
    }

    // Above the point or below it, so that it is never covered, and whole.
    tellOf(point) {
      this.told?.remove();
      if (typeof point?.customdata !== "string") return;
      this.told ??= Object.assign(document.createElement("div"), { className: "told" });
      this.told.textContent = point.customdata;
      this.figure.append(this.told);
      const { xaxis, yaxis } = point, plot = this.place.getBoundingClientRect(), figure = this.figure.getBoundingClientRect(), own = this.told.getBoundingClientRect();
      const x = plot.left + xaxis._offset + xaxis.d2p(point.x), y = plot.top + yaxis._offset + yaxis.d2p(point.y);
      const left = Math.max(8, Math.min(x - own.width / 2, document.documentElement.clientWidth - own.width - 8));
      this.told.style.left = `${left - figure.left}px`;
      this.told.style.top = `${(y - own.height - 14 >= 0 ? y - own.height - 14 : y + 14) - figure.top}px`;
    }

    // Chips for the loads, and what the switches say.
    chips() {
      const holder = this.figure.querySelector(".loads");
      if (holder && this.data.one_load) {
        const loads = this.loads.map(force), now = this.chosen();
        if (holder.childElementCount !== loads.length) {
          holder.replaceChildren(...loads.map((load) => {
            const chip = document.createElement("button");
            chip.type = "button";
            chip.textContent = load;
            chip.addEventListener("click", () => report.view.set("load", load));
            return chip;
          }));
          holder.hidden = loads.length < 2;
        }
        for (const chip of holder.children) chip.setAttribute("aria-pressed", String(chip.textContent === now));
      }
      for (const button of this.figure.querySelectorAll("[data-scale]")) {
        const side = button.dataset.scale, log = this.isLog(side, 0);
        button.hidden = side === "y" && !this.data.panels[0].y.label;
        const { label } = this.data.panels[0][side];
        button.textContent = `${label?.match(/ (\S{1,4})$/)?.[1] ?? (side === "x" ? "→" : "↑")}: ${log ? "log" : "linear"}`;
        button.title = `${side === "x" ? "Horizontal" : "Vertical"} axis${label ? ` (${label})` : ""}: ${log ? "logarithmic, make it linear" : "linear, make it logarithmic"}`;
        button.setAttribute("aria-label", `${button.textContent}. ${button.title}`);
      }
    }

    rescale(side) {
      const log = !this.isLog(side, 0);
      this.data.panels.forEach((panel, row) => { if (side === "x" || row === 0 || panel.y.log) this.scales[`${side}${row}`] = log; });
      this.paint();
    }

    zoom(factor, shift = 0) {
      const now = this.place._fullLayout.xaxis.range.map(Number);
      const middle = (now[0] + now[1]) / 2 + shift * (now[1] - now[0]), half = ((now[1] - now[0]) / 2) * factor;
      return globalThis.Plotly.relayout(this.place, { "xaxis.range": [middle - half, middle + half] });
    }

    whole() { this.paint(); }

    async save(kind) {
      await this.draw();
      const name = this.figure.id || "figure";
      if (kind === "csv") return report.save(`${name}.csv`, "text/csv", this.table());
      const size = { width: this.place._fullLayout.width, height: this.place._fullLayout.height };
      const dark = isDark();
      state.printing = true; // what leaves the page is for paper: light
      try {
        const layout = { ...this.layout(), ...size, paper_bgcolor: "#ffffff", plot_bgcolor: "#ffffff" };
        for (const key of Object.keys(layout)) if (/^[xy]axis/.test(key)) layout[key].range = this.place._fullLayout[key].range;
        const picture = await globalThis.Plotly.toImage({ data: this.traces(), layout }, { format: kind, scale: kind === "png" ? 3 : 1, ...size });
        if (kind === "svg") report.save(`${name}.svg`, "image/svg+xml", decodeURIComponent(picture.slice(picture.indexOf(",") + 1)));
        else report.save(`${name}.png`, "image/png", report.bytes(picture.slice(picture.indexOf(",") + 1)));
      } finally {
        state.printing = false;
        if (dark) this.paint();
      }
    }

    // What is seen, as numbers.
    table() {
      const quote = (value) => (/[",\n]/.test(value) ? `"${String(value).replaceAll('"', '""')}"` : value);
      const rows = [["series", "surface", "medium", "load_N", "x", "x_unit", "y", "y_unit", "error", "high", "runs"].join(",")];
      for (const one of this.shown()) {
        const panel = this.data.panels[one.panel ?? 0];
        one.x.forEach((x, k) => {
          const cells = [one.label, one.surface ?? "", one.medium ?? "", one.load ?? "", x, panel.x.unit || 1, one.y[k] ?? "", panel.y.unit || 1, one.error?.[k] ?? "", one.high?.[k] ?? "", (one.runs ?? []).join(" ")];
          rows.push(cells.map(report.harmless).map(quote).join(","));
        });
      }
      return rows.join("\n") + "\n";
    }

    listen() {
      const acts = {
        whole: () => this.whole(), in: () => this.zoom(0.5), out: () => this.zoom(2), left: () => this.zoom(1, -0.2), right: () => this.zoom(1, 0.2),
        svg: () => this.save("svg"), png: () => this.save("png"), csv: () => this.save("csv"),
        full: () => this.enlarge(),
      };
      const keys = { ArrowLeft: "left", ArrowRight: "right", "+": "in", "=": "in", ArrowUp: "in", "-": "out", ArrowDown: "out", Home: "whole", 0: "whole" };
      this.place.addEventListener("keydown", (event) => {
        if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey || !this.drawn) return;
        event.preventDefault();
        acts[keys[event.key]]();
      });
      this.figure.addEventListener("click", (event) => {
        const button = event.target.closest("button");
        if (button?.dataset.act) acts[button.dataset.act]?.();
        if (button?.dataset.scale) this.rescale(button.dataset.scale);
      });
      this.figure.addEventListener("fullscreenchange", () => {
        this.full = document.fullscreenElement === this.figure;
        this.paint();
      });
    }

    enlarge() {
      if (document.fullscreenElement) document.exitFullscreen();
      else this.figure.requestFullscreen?.().catch(() => {});
    }
  }

  return { Chart, plotly, isDark, heightOf, state };
})();
