"use strict";
// The first screen: which view is shown, at which speed runs compare, and the run opened in its place.
(() => {
  const place = document.getElementById("alongside");
  if (!place) return;
  const views = Array.from(document.querySelectorAll(".view")), table = document.getElementById("runs-table");
  const list = document.getElementById("details");
  let open = null, wanted = views[0]?.dataset.name;

  function show(name) {
    wanted = name ?? wanted;
    place.hidden = !open;
    for (const view of views) view.hidden = Boolean(open) || view.dataset.name !== wanted;
    for (const button of document.querySelectorAll("[data-shows]")) button.setAttribute("aria-pressed", String(!open && button.dataset.shows === wanted));
    for (const row of report.rows?.(table) ?? []) row.classList.toggle("opened", row.dataset.run === open?.dataset.run);
    for (const view of views) if (!view.hidden) report.charts?.watch(view);
  }

  // A run is moved next to the list, and goes back to its place among the others.
  report.openRun = async (details) => {
    if (open !== details) {
      close();
      open = details;
      details.after(Object.assign(document.createElement("template"), { id: "opened-from" }));
      place.append(details);
    }
    details.open = true;
    show();
    await report.unfold(details);
    report.charts?.watch(details);
    if (!details.contains(document.activeElement)) details.querySelector("summary").focus({ preventScroll: true });
    if (matchMedia("(min-width: 68.76rem)").matches) scrollTo(0, 0);
    else place.scrollIntoView();
  };
  function close() {
    if (!open) return;
    document.getElementById("opened-from").replaceWith(open);
    open.open = false;
    open = null;
  }

  document.addEventListener("click", (event) => {
    const button = event.target.closest?.("[data-shows], [data-run-act]");
    if (button?.dataset.shows) close(), show(button.dataset.shows);
    else if (button?.dataset.runAct === "close") {
      const { run } = open.dataset;
      report.closeRun();
      report.view.go("answer");
      report.rows(table).find((row) => row.dataset.run === run)?.querySelector("a").focus();
    } else if (button?.dataset.runAct === "print") {
      document.documentElement.classList.add("print-run");
      print();
    }
    const row = event.target.closest?.("#runs-table tr[data-run]");
    if (row && !event.target.closest("a, input, button")) report.goToRun(row.dataset.run);
  });
  report.closeRun = () => { if (open) close(), show(); };
  addEventListener("afterprint", () => document.documentElement.classList.remove("print-run"));
  document.getElementById("print")?.addEventListener("click", () => print());

  // Friction and deviation at the chosen speed.
  document.querySelector("[data-at]")?.addEventListener("change", (event) => {
    for (const row of report.rows(table)) {
      const [mu, off] = JSON.parse(row.dataset.values)[event.target.value];
      const cells = { mu, off };
      for (const [name, words] of Object.entries(cells)) {
        const cell = row.querySelector(`.${name}`);
        cell.textContent = words || "–";
      }
    }
  });
  if (list) list.classList.add("stored");
})();
