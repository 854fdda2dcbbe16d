"use strict";
// A finger on a figure: sideways it moves along, two of them zoom; up and down the page scrolls.
report.panByTouch = (chart) => {
  const fingers = new Map(); // where they are, by the number of the pointer [px]
  const near = 8; // a tap may tremble so far [px]
  let from = 0;
  const apart = () => { const [one, other] = fingers.values(); return Math.abs(one - other); };

  chart.place.addEventListener("pointerdown", (event) => {
    if (event.pointerType !== "touch" || !chart.drawn) return;
    fingers.set(event.pointerId, event.clientX);
    from = fingers.size === 2 ? apart() : event.clientX;
    chart.panned = false; // told to who takes the end of a movement for a tap
  });
  chart.place.addEventListener("pointermove", (event) => {
    if (!fingers.has(event.pointerId)) return;
    fingers.set(event.pointerId, event.clientX);
    const width = chart.place._fullLayout.xaxis._length;
    const now = fingers.size === 2 ? apart() : event.clientX;
    if (fingers.size > 2 || (!chart.panned && Math.abs(now - from) < near)) return;
    chart.panned = true;
    if (fingers.size === 2) chart.zoom(Math.max(from, near) / Math.max(now, near));
    else chart.zoom(1, (from - now) / width);
    from = now;
  });
  for (const kind of ["pointerup", "pointercancel"]) {
    chart.place.addEventListener(kind, (event) => {
      fingers.delete(event.pointerId);
      from = [...fingers.values()][0] ?? 0;
    });
  }
};
