"use strict";
// Files beside the page, and files that the page hands out. No request leaves the folder.
{
  const waiting = new Map();

  // A page opened from disk may not fetch, but it may load a script; each calls `report.receive`.
  report.load = (file, key, then) => {
    const script = document.createElement("script");
    waiting.set(key, then);
    script.addEventListener("error", () => report.receive(key, null));
    script.src = file;
    document.head.append(script);
  };

  report.receive = (key, what) => {
    const then = waiting.get(key);
    waiting.delete(key);
    then?.(what);
  };

  report.save = (name, type, text) => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text], { type: `${type};charset=utf-8` }));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  };

  // Figures are inside the page: their copies are made from it, so they are there without the folder.
  document.addEventListener("click", (event) => {
    const link = event.target.closest?.("a[data-copy]");
    if (!link) return;
    const figure = link.closest("figure"), name = link.getAttribute("href").split("/").pop();
    const image = figure.querySelector("img"), numbers = figure.querySelector("script");
    const svg = link.dataset.copy === "svg" && image?.src.startsWith("data:");
    if (!svg && !(link.dataset.copy === "csv" && numbers)) return; // then the link leads to the file
    event.preventDefault();
    if (svg) report.save(name, "image/svg+xml", decodeURIComponent(image.src.slice(image.src.indexOf(",") + 1)));
    else report.save(name, "text/csv", JSON.parse(numbers.textContent));
  });

  // Of very many runs the page has only the table; what stands under a run comes when it is opened.
  report.opened.push((details) => {
    const { file } = details.dataset;
    if (!file) return;
    delete details.dataset.file;
    report.load(file, details.id, (text) => {
      const place = document.createElement("div");
      place.innerHTML = text ?? "";
      if (text === null) place.textContent = `${file} is not beside this page.`;
      details.append(place);
      report.open(details);
    });
  });
}
