"use strict";
// One figure that answers: drawn, hovered, zoomed, switched, handed out. When it is drawn, charts.js says.
report.Chart = (() => {
  const { state, still, isDark, plotly } = report.drawing;

  return class extends report.Picture {
    constructor(figure) {
      super(figure);
      this.listen();
    }

    async draw() {
      const [Plotly] = await Promise.all([plotly(), this.unpack()]);
      this.paint(Plotly);
    }

    paint(Plotly = globalThis.Plotly) {
      if (!Plotly || !this.data || !(state.printing || this.place.clientWidth)) return;
      const config = { displayModeBar: false, scrollZoom: false, doubleClick: false, showTips: false, locale: "en" };
      this.place.querySelector(".still")?.remove(); // first: one upon the other, they would move the page
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
        if (goal && this.isMeant(event)) report.goToRun(goal);
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
      this.place.on("plotly_unhover", () => { if (!still) this.told?.remove(); });
      this.place.on("plotly_doubleclick", () => { if (!this.panned) this.whole(); });
      this.place.on("plotly_relayout", () => this.follow?.());
    }

    // A finger cannot hover: its first tap reads the point, and another one goes to the run.
    isMeant(event) {
      const point = event.points[0], tapped = `${point.curveNumber} ${point.pointNumber}`;
      if (!still) return true;
      if (this.panned) return false;
      if (this.tapped === tapped) return true;
      this.tapped = tapped;
      this.tellOf(point);
      return false;
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
      const now = this.chosen();
      for (const chip of holder?.children ?? []) chip.setAttribute("aria-pressed", String(chip.textContent === now));
      for (const button of this.figure.querySelectorAll("[data-scale]")) {
        const side = button.dataset.scale, log = this.isLog(side, 0);
        button.hidden = side === "y" && !this.data.panels[0].y.label;
        const { label } = this.data.panels[0][side];
        button.textContent = `${label?.match(/ (\S{1,4})$/)?.[1] ?? label?.match(/^(\S) /)?.[1] ?? (side === "x" ? "→" : "↑")}: ${log ? "log" : "linear"}`;
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
      state.printing = this.saving = true; // what leaves the page is for paper: light
      try {
        const layout = { ...this.layout(), ...size, paper_bgcolor: "#ffffff", plot_bgcolor: "#ffffff" };
        for (const key of Object.keys(layout)) if (/^[xy]axis/.test(key)) layout[key].range = this.place._fullLayout[key].range;
        const picture = await globalThis.Plotly.toImage({ data: this.traces(), layout }, { format: kind, scale: kind === "png" ? 3 : 1, ...size });
        if (kind === "svg") report.save(`${name}.svg`, "image/svg+xml", decodeURIComponent(picture.slice(picture.indexOf(",") + 1)));
        else report.save(`${name}.png`, "image/png", report.bytes(picture.slice(picture.indexOf(",") + 1)));
      } finally {
        state.printing = this.saving = false;
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
      report.panByTouch(this);
      this.figure.addEventListener("click", (event) => {
        const button = event.target.closest("button");
        if (button?.closest(".loads")) report.view.set("load", button.textContent);
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
  };
})();
