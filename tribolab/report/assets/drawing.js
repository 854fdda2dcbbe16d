"use strict";
// What a chart shows as SVG, for print: always light, axes and shading as on the page.
report.drawing = (chart) => {
  const text = (value) => String(value).replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);
  const near = (value) => Math.round(value * 100) / 100;
  const parts = [];
  const width = chart.plots[0].width;
  let top = 0;
  chart.plots.forEach((u, row) => {
    const left = u.bbox.left / devicePixelRatio, over = u.bbox.top / devicePixelRatio;
    const w = u.bbox.width / devicePixelRatio, h = u.bbox.height / devicePixelRatio;
    const x = (t) => near(left + u.valToPos(t, "x")), y = (v) => near(over + u.valToPos(v, "y"));
    const bound = (t) => Math.min(Math.max(x(t), left), left + w);
    const box = (colour, opacity, from, to) => {
      if (bound(to) > bound(from)) parts.push(`<rect x="${near(bound(from))}" y="${near(over)}" width="${near(bound(to) - bound(from))}" height="${near(h)}" fill="${colour}" fill-opacity="${opacity}"/>`);
    };
    parts.push(`<g transform="translate(0 ${near(top)})"><clipPath id="c${row}"><rect x="${near(left)}" y="${near(over)}" width="${near(w)}" height="${near(h)}"/></clipPath>`);
    for (const [start, stop, inner, outer, sign] of chart.data.segments) {
      const colour = sign > 0 ? "#3a3a3a" : sign < 0 ? "#e69f00" : "#56b4e9";
      box(colour, 0.08, start, stop);
      box(colour, 0.12, inner, outer);
    }
    for (const span of chart.data.flags) {
      if (chart.concerns(span, row)) box(span.severity === "fail" ? "#a8201a" : "#b07500", 0.3, span.start_s, Math.max(span.stop_s, span.start_s + u.posToVal(2, "x") - u.posToVal(0, "x")));
    }
    let path = "", down = false;
    const [times, values] = u.data, [low, high] = chart.range;
    times.forEach((t, k) => {
      const seen = (times[k + 1] ?? t) >= low && (times[k - 1] ?? t) <= high;
      if (!seen || values[k] === null) { down = false; return; }
      path += `${down ? " " : "M"}${x(t)} ${y(values[k])}`;
      down = true;
    });
    parts.push(`<g clip-path="url(#c${row})"><path d="${path}" fill="none" stroke="#000" stroke-width="0.7"/>`);
    if (row === 0) {
      for (const [, , inner, outer, , mean] of chart.data.segments) {
        if (mean !== null && outer >= low && inner <= high) parts.push(`<path d="M${x(inner)} ${y(mean)}H${x(outer)}" stroke="#c00000"/>`);
      }
    }
    parts.push("</g>", `<rect x="${near(left)}" y="${near(over)}" width="${near(w)}" height="${near(h)}" fill="none" stroke="#000" stroke-width="0.7"/>`);
    const [across, up] = u.axes;
    (across._splits ?? []).forEach((v, k) => {
      if (v >= low && v <= high) parts.push(`<text x="${x(v)}" y="${near(over + h + 14)}" text-anchor="middle">${text(across._values[k])}</text><path d="M${x(v)} ${near(over + h)}v-4" stroke="#000"/>`);
    });
    (up._splits ?? []).forEach((v, k) => {
      if (v !== null && up._values[k]) parts.push(`<text x="${near(left - 5)}" y="${near(y(v) + 4)}" text-anchor="end">${text(up._values[k])}</text><path d="M${near(left)} ${y(v)}h4" stroke="#000"/>`);
    });
    parts.push(`<text transform="translate(14 ${near(over + h / 2)}) rotate(-90)" text-anchor="middle">${text(up.label)}</text>`);
    if (across.label) parts.push(`<text x="${near(left + w / 2)}" y="${near(over + h + 30)}" text-anchor="middle">${text(across.label)}</text>`);
    parts.push("</g>");
    top += u.height;
  });
  return `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${top}" viewBox="0 0 ${width} ${top}" font-family="sans-serif" font-size="12"><rect width="100%" height="100%" fill="#fff"/>${parts.join("")}</svg>`;
};
