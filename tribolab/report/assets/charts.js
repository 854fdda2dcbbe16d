"use strict";
// All figures: drawn when the reader comes near them, again when the light or the view changes, and on paper.
report.charts = (() => {
  const charts = new Map(); // by figure element
  const { plotly, heightOf, fills, state } = report.drawing;

  // Figures are made when the reader comes near; on a browser that cannot unpack, a word says so.
  // One after the other, so that the first of them answers before the last is drawn.
  const waiting = [];
  const near = new IntersectionObserver((entries) => {
    for (const entry of entries) if (entry.isIntersecting) come(entry.target);
  }, { rootMargin: "600px" });
  function come(figure) {
    near.unobserve(figure);
    if (waiting.push(figure) === 1) next();
  }
  async function next() {
    try {
      await show(waiting[0]);
    } finally {
      waiting.shift();
      if (waiting.length) setTimeout(next);
    }
  }
  const sized = new ResizeObserver((entries) => {
    for (const entry of entries) {
      const chart = charts.get(entry.target.closest("figure")), place = entry.target;
      if (!chart?.drawn || state.printing || !place.clientWidth) continue;
      const { width, height } = chart.place._fullLayout, filled = fills(place);
      if (Math.abs(place.clientWidth - width) > 1 || (filled && Math.abs(place.clientHeight - height) > 1)) chart.paint();
    }
  });

  function chartOf(figure) {
    if (!charts.has(figure)) {
      charts.set(figure, new (figure.classList.contains("trace") ? report.Trace : report.Chart)(figure));
      sized.observe(figure.querySelector(".plot"));
    }
    return charts.get(figure);
  }

  async function show(figure) {
    try {
      await chartOf(figure).draw();
    } catch (error) {
      if (typeof DecompressionStream !== "undefined") throw error;
      const words = "This browser is too old for interactive figures; only a picture is shown. The numbers are in the tables.";
      figure.querySelector(".plot").after(Object.assign(document.createElement("p"), { className: "note", textContent: words }));
    }
  }

  function watch(place) {
    const plots = Array.from(place.querySelectorAll("figure.live"), (figure) => figure.querySelector(".plot"));
    const widths = plots.map((plot) => plot.clientWidth); // all are read before the first is written: the page is laid out once
    plots.forEach((plot, place) => {
      const { panels, labels } = plot.dataset;
      const size = panels && widths[place] && !fills(plot) && heightOf(plot, widths[place], Number(panels), Number(labels));
      if (size) plot.style.minHeight = `${size.plot + size.legend}px`;
      if (size) plot.querySelector(".still")?.setAttribute("height", size.plot + size.legend);
      near.observe(plot.closest("figure"));
    });
  }
  const repaint = () => { for (const chart of charts.values()) if (chart.drawn) chart.paint(); };
  addEventListener("appearance", repaint);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", repaint);

  // On paper everything is drawn, what nobody scrolled to as well; that is unpacked beforehand.
  const printed = () => Array.from(document.querySelectorAll("figure.live")).filter((figure) => !figure.closest("details:not([open])"));
  async function prepare() {
    await plotly();
    for (const figure of printed()) await chartOf(figure).unpack().catch(() => {});
  }
  addEventListener("beforeprint", () => {
    state.printing = true;
    document.documentElement.classList.add("printing");
    for (const figure of printed()) chartOf(figure).paint();
  });
  addEventListener("afterprint", () => {
    state.printing = false;
    document.documentElement.classList.remove("printing");
    repaint();
  });

  report.begun.push(() => {
    watch(document);
    const first = document.querySelector(".cards figure.live");
    if (first) come(first); // that the reader is near it, nobody has to see first
    report.view.changed(repaint);
    (globalThis.requestIdleCallback ?? setTimeout)(() => prepare().catch(() => {}));
  });
  return { watch, plotly, chartOf, prepare };
})();
