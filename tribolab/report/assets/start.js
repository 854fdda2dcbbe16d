"use strict";
// Last: opening what a link points to, and drawing.
(() => {
  report.goTo = async (target) => {
    if (!target || target === "answer") report.closeRun?.();
    const place = target && document.getElementById(target);
    if (!place) return;
    if (place.hidden) report.view.clear(); // what a link leads to is shown
    if (place.matches("details.run") && report.openRun) return report.openRun(place);
    if (place.tagName === "DETAILS") {
      place.open = true;
      await report.unfold(place);
      place.querySelector("summary").focus({ preventScroll: true });
    }
    place.closest("details:not([open])")?.setAttribute("open", "");
    place.scrollIntoView();
  };
  report.goToRun = (name) => {
    const place = Array.from(document.querySelectorAll("details.run")).find((one) => one.dataset.run === name);
    if (place) report.view.go(place.id);
  };
  const most = 40; // more at once than anyone prints
  function openAll() {
    const every = Array.from(document.querySelectorAll("details.run:not([hidden])")).slice(0, most);
    return Promise.all(every.map((details) => { details.open = true; return report.unfold(details); }));
  }
  document.addEventListener("click", (event) => {
    const link = event.target.closest?.("a[href^='#']");
    // a link to where the page already stands changes no address
    if (link && link.getAttribute("href").slice(1) === report.view.anchor) report.goTo(report.view.anchor);
  });
  document.addEventListener("toggle", (event) => {
    if (event.target.matches?.("details") && event.target.open) {
      report.unfold(event.target);
      report.charts?.watch(event.target);
    }
  }, true);
  // The page counts as loading, so that who prints it at once waits for what is being unpacked.
  function loading() {
    const frame = document.createElement("iframe");
    frame.hidden = true;
    document.body.append(frame);
    frame.contentDocument.open();
    return () => {
      frame.contentDocument.close();
      frame.remove();
    };
  }
  // Runs are printed only if the address asks for them: ?print=all
  if (new URLSearchParams(location.search).get("print") === "all") {
    document.documentElement.classList.add("print-all");
    const release = loading();
    openAll().then(() => report.charts?.prepare()).finally(release);
  }
  for (const call of report.begun) call();
  addEventListener("load", () => report.goTo(report.view.anchor));
})();
