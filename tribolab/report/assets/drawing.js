"use strict";
// What all figures share: colours, sizes, and the library that draws.
report.drawing = (() => {
  // Okabe and Ito's palette, which people with any common colour deficiency tell apart.
  const HUES = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#6b6b6b", "#000000"];
  const DARKER = ["#5db4ee", "#ff8a3d", "#35c79a", "#e79cc6", "#f2bd45", "#8fd0f5", "#a8b0b8", "#ffffff"];
  const SYMBOLS = ["circle", "square", "diamond", "triangle-up", "triangle-down", "pentagon", "hexagon2", "star"];
  const DASHES = { line: "solid", dashed: "dash", dotted: "dot", dashdot: "dashdot", longdash: "longdash" };
  const FONT = '"Segoe UI", "Helvetica Neue", Roboto, Arial, "Liberation Sans", system-ui, sans-serif';
  const PAPER = 680, HALF = 316, THIRD = 206; // widths that fit between the margins of A4, of one to three beside each other
  const SHEET = 850; // height that fits, with a heading above it
  const FEW = 6; // cards that two sheets hold, two beside each other; more are printed smaller
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
  const force = (load) => `${Math.abs(load) >= 100 ? Math.round(load) : Number(load.toPrecision(3))} N`; // as words.force_text has it
  const axis = (kind, panel) => kind + (panel ? panel + 1 : "");

  const isOneOfMany = (place) => place.closest(".cards")?.childElementCount > FEW;

  // On the first screen of a wide window figures have the height that is left.
  const wide = matchMedia("(min-width: 68.76rem) and (min-height: 36rem)");
  const fills = (place) => !state.printing && wide.matches && Boolean(place.closest(".cards"));

  // Known before a figure is drawn: what is below does not move when it comes.
  function heightOf(place, width, panels, labels) {
    if (fills(place)) {
      const rows = labels > 1 ? Math.ceil(labels / Math.max(1, Math.floor(width / 150))) * 21 : 0, room = Math.max(0, place.clientHeight - 120);
      return { plot: place.clientHeight - Math.min(rows, room), legend: Math.min(rows, room), cut: rows > room };
    }
    const columns = Math.max(1, Math.floor(width / (place.closest(".cards") ? 150 : 210))); // the words of a card are short
    const heights = place.dataset.height ? [Number(place.dataset.height)] : [320, 460, 620];
    const low = isOneOfMany(place) ? 130 : place.closest(".cards") ? 175 : 240;
    const squeezed = state.printing && panels === 1 && !("rows" in place.dataset); // not where names stand below each other
    const own = squeezed ? Math.min(low, heights[0]) : heights[Math.min(panels, heights.length) - 1];
    const plot = state.printing ? Math.min(own, SHEET) : own;
    const whole = labels > 1 ? Math.ceil(labels / columns) * 21 : 0, legend = state.printing ? whole : Math.min(whole, plot - AROUND);
    return { plot, legend, cut: legend < whole };
  }

  // The page's policy forbids style attributes as text; the library means what a script may set.
  const asText = Element.prototype.setAttribute;
  Element.prototype.setAttribute = function (name, value) {
    if (name === "style") this.style.cssText = value;
    else asText.call(this, name, value);
  };

  // The library is unpacked and started from the page itself, once; the policy knows its checksum.
  function plotly() {
    library ??= (async () => {
      const code = await report.unpacked(document.getElementById("library").textContent);
      document.head.append(Object.assign(document.createElement("script"), { textContent: new TextDecoder().decode(code) }));
      if (!globalThis.Plotly) throw new Error("the plotting library was blocked");
      return globalThis.Plotly;
    })();
    return library;
  }
  // What stands first on the page has figures: the library comes while the other scripts start.
  if (document.querySelector(".cards figure.live")) plotly().catch(() => {}); // who draws says what failed

  return { HUES, DARKER, SYMBOLS, DASHES, FONT, PAPER, HALF, THIRD, isOneOfMany, still, state, isDark, text, lines, force, axis, heightOf, fills, plotly };
})();
