"use strict";
// Tables: sorted by several columns, filtered with the figures, copied and handed out; heads that explain themselves.
(() => {
  function key(row, column) {
    const cell = row.cells[Math.min(column, row.cells.length - 1)];
    const text = cell.dataset.sort ?? cell.textContent.trim();
    const value = Number(text);
    return text === "" || text === "–" ? null : Number.isNaN(value) ? text : value;
  }
  const words = new Intl.Collator("en", { numeric: true });
  const compare = (a, b) => (typeof a === "number" && typeof b === "number" ? a - b : words.compare(String(a), String(b)));
  const orders = new WeakMap(); // of a table: columns with their direction, the most important first

  function sort(table) {
    const order = orders.get(table) ?? [], body = table.tBodies[0];
    const heads = table.tHead.rows[0].cells;
    Array.from(heads, (head, column) => {
      const place = order.findIndex(([other]) => other === column);
      if (place < 0) head.removeAttribute("aria-sort");
      else head.setAttribute("aria-sort", order[place][1] > 0 ? "ascending" : "descending");
      head.dataset.place = place < 0 || order.length < 2 ? "" : place + 1;
    });
    table.classList.toggle("sorted", order.length > 0);
    const entries = Array.from(body.rows).filter((row) => !row.classList.contains("group")).map((row) => {
      row.dataset.place ??= row.rowIndex;
      return { row, place: Number(row.dataset.place), keys: order.map(([column]) => key(row, column)) };
    });
    entries.sort((a, b) => {
      for (let k = 0; k < order.length; k++) {
        const [x, y] = [a.keys[k], b.keys[k]];
        // what has no value stands last either way
        if ((x === null) !== (y === null)) return (x === null) - (y === null);
        const sign = x === null ? 0 : order[k][1] * compare(x, y);
        if (sign) return sign;
      }
      return a.place - b.place;
    });
    const fragment = document.createDocumentFragment();
    if (order.length) fragment.append(...entries.map((entry) => entry.row));
    else fragment.append(...Array.from(body.rows).sort((a, b) => a.dataset.place - b.dataset.place));
    body.append(fragment);
  }

  function chosen(table, column, more) {
    const order = orders.get(table) ?? [], place = order.findIndex(([other]) => other === column);
    if (place >= 0 && (more || order.length === 1)) order[place][1] *= -1;
    else if (more) order.push([column, 1]);
    else order.splice(0, order.length, [column, 1]);
    orders.set(table, order);
    sort(table);
  }

  // One tip for all heads and words: shown on hover and focus, gone on Escape.
  const tip = document.createElement("div");
  tip.id = "tip";
  tip.role = "tooltip";
  tip.hidden = true;
  document.body.append(tip);
  let explained = null;
  function explain(event) {
    explained = event.target.closest?.("[data-tip]") ?? null;
    if (explained) place();
  }
  function place() {
    tip.textContent = explained.dataset.tip;
    tip.hidden = false;
    const box = explained.getBoundingClientRect(), own = tip.getBoundingClientRect();
    tip.style.left = `${Math.max(8, Math.min(box.left, innerWidth - own.width - 8))}px`;
    tip.style.top = `${box.top > own.height + 12 ? box.top - own.height - 6 : box.bottom + 6}px`;
  }
  const silent = () => { tip.hidden = true; };
  for (const kind of ["mouseover", "focusin"]) document.addEventListener(kind, explain);
  for (const kind of ["mouseout", "focusout"]) document.addEventListener(kind, silent);
  document.addEventListener("scroll", () => { // to give the focus may scroll, and the tip goes with it
    if (tip.hidden) return;
    if (explained.contains(document.activeElement)) place();
    else silent();
  }, true);
  document.addEventListener("keydown", (event) => { if (event.key === "Escape") silent(); });

  const tidy = (cell) => cell.innerText.replace(/[✓▲✕·]\s*/g, "").replace(/\s*\n\s*/g, "; ").replace(/\s+/g, " ").trim();
  const number = (text) => { const value = Number(text.replace("−", "-")); return text !== "" && Number.isFinite(value) ? value : text; };
  // What is seen of a table: hidden rows and columns are left out.
  report.cells = (table) => Array.from(table.rows)
    .filter((row) => !row.hidden && !row.classList.contains("group"))
    .map((row) => Array.from(row.cells).filter((cell) => !cell.hidden).map(tidy));

  async function copied(text, button) {
    const before = button.textContent;
    try {
      await navigator.clipboard.writeText(text);
    } catch { // pages from a file may not use the clipboard: then the browser copies what is selected
      const area = document.createElement("textarea");
      area.value = text;
      document.body.append(area);
      area.select();
      document.execCommand("copy");
      area.remove();
      button.focus();
    }
    button.textContent = "Copied";
    setTimeout(() => { button.textContent = before; }, 1500);
  }

  function handOut(table, button) {
    const rows = report.cells(table), name = table.closest(".tabled").dataset.file;
    const quote = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
    const kind = button.dataset.out;
    if (kind === "copy") copied(rows.map((row) => row.map(report.harmless).join("\t")).join("\n"), button);
    else if (kind === "csv") report.save(`${name}.csv`, "text/csv", rows.map((row) => row.map(report.harmless).map(quote).join(",")).join("\n") + "\n");
    else report.save(`${name}.xlsx`, "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet", report.workbook(rows.map((row) => row.map(number))));
  }

  function sortable(table) {
    Array.from(table.tHead.rows[0].cells).forEach((head, column) => {
      const button = document.createElement("button");
      button.type = "button";
      button.append(...head.childNodes);
      if (head.dataset.tip) button.setAttribute("aria-describedby", "tip");
      button.addEventListener("click", (event) => chosen(table, column, event.shiftKey));
      head.append(button);
    });
  }

  document.addEventListener("click", (event) => {
    const button = event.target.closest?.("button[data-out]");
    if (button) handOut(button.closest(".tabled").querySelector("table"), button);
  });

  // What is looked at: rows, cards and headings of anything else go.
  function apply() {
    const view = report.view, hidden = view.hidden;
    for (const piece of document.querySelectorAll("[data-surface], [data-medium]")) {
      const { surface, medium, load, run, text } = piece.dataset;
      let fits = run === undefined
        ? view.shows({ surface, medium, load: piece.matches("tr") ? load : undefined })
        : view.holds({ surface, medium, load });
      if (fits && run !== undefined) {
        fits = !hidden.has(run) && (!view.get("find") || view.finds(text ?? piece.textContent)) && (!view.get("status") || piece.dataset.status === view.get("status"));
        const marked = view.marks([run, surface, medium, load].join(" "));
        if (piece.classList.contains("marked") !== marked) piece.classList.toggle("marked", marked);
      }
      if (piece.hidden === fits) piece.hidden = !fits;
    }
    for (const group of document.querySelectorAll("tr.group")) {
      let row = group.nextElementSibling, any = false;
      for (; row && !row.classList.contains("group") && !any; row = row.nextElementSibling) any = !row.hidden;
      group.hidden = !any && !group.closest(".sorted");
    }
    const rows = document.querySelectorAll("#runs-table tbody tr[data-run]");
    const shown = Array.from(rows).filter((row) => !row.hidden).length;
    for (const said of document.querySelectorAll(".filters output")) {
      const gone = hidden.size ? `, ${hidden.size} hidden` : "";
      said.textContent = shown === rows.length ? `${rows.length} ${rows.length === 1 ? "run" : "runs"}` : `${shown} of ${rows.length} runs${gone}`;
    }
    for (const field of document.querySelectorAll("[data-view]")) if (field.value !== view.get(field.dataset.view)) field.value = view.get(field.dataset.view);
    for (const box of document.querySelectorAll("input[data-hide]")) box.checked = !hidden.has(box.dataset.hide);
    for (const piece of document.querySelectorAll("[data-at-load]")) {
      const loads = Array.from(piece.parentNode.querySelectorAll(":scope > [data-at-load]"), (one) => one.dataset.atLoad);
      const wanted = loads.includes(view.get("load")) ? view.get("load") : loads[0];
      piece.classList.toggle("other", piece.dataset.atLoad !== wanted);
    }
  }

  function filters(form) {
    for (const field of form.querySelectorAll("[data-view]")) field.addEventListener("input", () => report.view.set(field.dataset.view, field.value));
    form.addEventListener("submit", (event) => event.preventDefault());
    form.addEventListener("reset", (event) => {
      event.preventDefault();
      report.view.clear();
      for (const table of document.querySelectorAll("table.sorted")) { orders.delete(table); sort(table); }
    });
    const menu = form.querySelector("details.columns"), table = document.getElementById("runs-table");
    if (!menu || !table) return;
    const names = Array.from(table.tHead.rows[0].cells, (cell) => cell.dataset.name);
    menu.addEventListener("change", (event) => {
      const place = names.indexOf(event.target.dataset.hides);
      for (const row of table.rows) if (!row.classList.contains("group")) row.cells[place].hidden = !event.target.checked;
    });
    document.addEventListener("click", (event) => { if (!menu.contains(event.target)) menu.open = false; });
    menu.addEventListener("keydown", (event) => {
      if (event.key !== "Escape") return;
      menu.open = false;
      menu.querySelector("summary").focus();
    });
  }

  document.addEventListener("change", (event) => {
    if (event.target.matches?.("input[data-hide]")) report.view.hide(event.target.dataset.hide, !event.target.checked);
  });
  report.dress = (place) => place.querySelectorAll("table.sortable").forEach(sortable);
  report.dress(document);
  document.querySelectorAll("form.filters").forEach(filters);
  report.view.changed(apply);
  apply();
})();
