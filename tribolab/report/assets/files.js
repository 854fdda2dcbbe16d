"use strict";
// What is packed inside the page, and files that the page hands out. No request leaves it.
{
  report.bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));

  // Fails where the browser has no DecompressionStream (those of before 2023).
  report.unpacked = async (text) => {
    const packed = new Blob([report.bytes(text)]).stream();
    return new Uint8Array(await new Response(packed.pipeThrough(new DecompressionStream("deflate"))).arrayBuffer());
  };

  report.save = (name, type, content) => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([content], { type: `${type};charset=utf-8` }));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  };

  // Figures are inside the page: their copies are made from it, so they are there without the folder.
  document.addEventListener("click", async (event) => {
    const link = event.target.closest?.("a[data-copy]");
    if (!link) return;
    const figure = link.closest("figure"), name = link.getAttribute("href").split("/").pop();
    const image = figure.querySelector("img"), numbers = figure.querySelector("script");
    const svg = link.dataset.copy === "svg" && image?.src.startsWith("data:");
    const csv = link.dataset.copy === "csv" && numbers && typeof DecompressionStream !== "undefined";
    if (!svg && !csv) return; // then the link leads to the file
    event.preventDefault();
    if (svg) report.save(name, "image/svg+xml", decodeURIComponent(image.src.slice(image.src.indexOf(",") + 1)));
    else report.save(name, "text/csv", await report.unpacked(numbers.textContent));
  });

  // Of very many runs the page shows only the table; what stands under a run is unpacked when it is opened.
  report.opened.push(async (details) => {
    const packed = details.querySelector(":scope > script.packed");
    if (!packed) return;
    packed.remove();
    const place = document.createElement("div");
    try {
      place.innerHTML = new TextDecoder().decode(await report.unpacked(packed.textContent));
    } catch {
      place.textContent = "This browser cannot unpack the details of a run; their numbers are in report.json and tables/.";
    }
    details.append(place);
    if (details.open) report.open(details);
  });
}
