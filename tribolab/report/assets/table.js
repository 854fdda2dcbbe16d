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

  // All rows of a table; of very many the first are laid out, and more when they are asked for.
  const MOST = 100;
  const holders = new Map(); // by table: its rows in their order, and how many are shown
  function held(table) {
    if (!holders.has(table)) {
      const rows = Array.from(table.tBodies[0].rows);
      rows.forEach((row, place) => { row.dataset.place = place; });
      holders.set(table, { rows, most: MOST });
    }
    return holders.get(table);
  }

  function lay(table) {
    const { rows, most } = held(table), seen = rows.filter((row) => !row.hidden), left = Math.max(seen.length - most, 0);
    table.tBodies[0].replaceChildren(...seen.slice(0, most));
    const more = table.closest(".tabled")?.querySelector("[data-more]");
    if (!more) return;
    more.hidden = left === 0;
    more.textContent = `Show ${left} more`;
  }

  function sort(table) {
    const order = orders.get(table) ?? [], holder = held(table);
    Array.from(table.tHead.rows[0].cells, (head, column) => {
      const place = order.findIndex(([other]) => other === column);
      if (place < 0) head.removeAttribute("aria-sort");
      else head.setAttribute("aria-sort", order[place][1] > 0 ? "ascending" : "descending");
      head.dataset.place = place < 0 || order.length < 2 ? "" : place + 1;
    });
    table.classList.toggle("sorted", order.length > 0);
    const entries = holder.rows.map((row) => ({ row, place: Number(row.dataset.place), keys: order.map(([column]) => key(row, column)) }));
    entries.sort((a, b) => {
      for (let k = 0; k < order.length; k++) {
        const x = a.keys[k] ?? null, y = b.keys[k] ?? null;
        // what has no value stands last either way
        if ((x === null) !== (y === null)) return (x === null) - (y === null);
        const sign = x === null ? 0 : order[k][1] * compare(x, y);
        if (sign) return sign;
      }
      return a.place - b.place;
    });
    holder.rows = entries.map((entry) => entry.row);
    lay(table);
  }

  // Of very many runs most rows are packed: they come as soon as the page is there.
  async function complete(table) {
    const packed = table.parentNode.querySelector("script.rows");
    if (!packed) return;
    packed.remove();
    const body = document.createElement("tbody");
    body.innerHTML = new TextDecoder().decode(await report.unpacked(packed.textContent));
    const holder = held(table);
    for (const row of Array.from(body.rows)) {
      row.dataset.place = holder.rows.length;
      holder.rows.push(row);
    }
    sort(table);
    apply();
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
    const head = event.target.closest?.("[data-tip]");
    if (!head) return;
    explained = head;
    place();
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
  document.addEventListener("focusout", silent);
  document.addEventListener("mouseout", () => { // what has the focus keeps its tip
    if (!explained?.contains(document.activeElement)) silent();
  });
  document.addEventListener("scroll", () => { // to give the focus may scroll, and the tip goes with it
    if (tip.hidden) return;
    if (explained.contains(document.activeElement)) place();
    else silent();
  }, true);
  document.addEventListener("keydown", (event) => { if (event.key === "Escape") silent(); });

  const words_of = (node) => (node.nodeName === "BR" ? "; " : node.nodeType === Node.TEXT_NODE ? node.data : Array.from(node.childNodes, words_of).join(""));
  const tidy = (cell) => words_of(cell).replace(/[✓▲✕·]\s*/g, "").replace(/\s+/g, " ").replace(/^[\s;]+|[\s;]+$/g, "");
  const number = (text) => { const value = Number(text.replace("−", "-")); return text !== "" && Number.isFinite(value) ? value : text; };
  // What is seen of a table: hidden rows and columns are left out.
  report.cells = (table) => [table.tHead.rows[0], ...held(table).rows]
    .filter((row) => !row.hidden)
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

  // Columns beyond those that fit are there when they are asked for.
  report.rows = (table) => (table ? held(table).rows : []);
  function showEvery(table, every) {
    table.classList.toggle("every", every);
    const button = table.closest(".tabled").querySelector("[data-every]");
    button.textContent = every ? "Fewer columns" : "More columns";
    button.setAttribute("aria-pressed", String(every));
  }

  function sortable(table) {
    held(table);
    const every = table.closest(".tabled")?.querySelector("[data-every]");
    if (every) every.hidden = !table.tHead.querySelector(".extra");
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
    const button = event.target.closest?.("button[data-out], button[data-more], button[data-every]");
    const table = button?.closest(".tabled").querySelector("table");
    if (button?.dataset.out) handOut(table, button);
    else if (button?.dataset.every !== undefined) showEvery(table, !table.classList.contains("every"));
    else if (button) {
      held(table).most *= 5;
      lay(table);
    }
  });

  const texts = new WeakMap(); // of rows, by which they are found
  function text_of(piece) {
    if (!texts.has(piece)) texts.set(piece, piece.dataset.text ?? piece.textContent);
    return texts.get(piece);
  }

  function fits(piece, view, hidden) {
    const { surface, medium, load, run, status } = piece.dataset;
    if (run === undefined) return view.shows({ surface, medium, load: piece.matches("tr") ? load : undefined });
    const wanted = !hidden.has(run) && (!view.get("status") || status === view.get("status"));
    return wanted && view.holds({ surface, medium, load }) && (!view.get("find") || view.finds(text_of(piece)));
  }

  // What is looked at: rows, cards and headings of anything else go.
  function apply() {
    const view = report.view, hidden = view.hidden, marking = view.get("mark");
    const pieces = [...document.querySelectorAll("[data-surface]:not(tr), [data-medium]:not(tr)")];
    for (const { rows } of holders.values()) for (const row of rows) if ("surface" in row.dataset) pieces.push(row);
    for (const piece of pieces) {
      const gone = !fits(piece, view, hidden);
      if (piece.hidden !== gone) piece.hidden = gone;
      const { run, surface, medium, load } = piece.dataset;
      if (run !== undefined) piece.classList.toggle("marked", Boolean(marking) && view.marks([run, surface, medium, load].join(" ")));
    }
    for (const [table, { rows }] of holders) if (rows.some((row) => "surface" in row.dataset)) lay(table);
    const runs = document.getElementById("runs-table");
    const rows = runs ? held(runs).rows.filter((row) => row.dataset.run !== undefined) : [];
    const shown = rows.filter((row) => !row.hidden).length;
    for (const said of document.querySelectorAll(".filters output")) {
      const away = rows.filter((row) => hidden.has(row.dataset.run)).length, gone = away ? `, ${away} hidden` : "";
      said.textContent = shown === rows.length ? "" : `${shown} of ${rows.length} runs${gone}`;
    }
    for (const field of document.querySelectorAll("[data-view]")) if (field.value !== view.get(field.dataset.view)) field.value = view.get(field.dataset.view);
    for (const box of document.querySelectorAll("input[data-hide]")) box.checked = !hidden.has(box.dataset.hide);
  }

  // A button in a head is not repeated on the next sheet of paper; text is.
  addEventListener("beforeprint", () => {
    for (const button of document.querySelectorAll("thead button")) button.before(...button.childNodes);
  });
  addEventListener("afterprint", () => {
    for (const button of document.querySelectorAll("thead button")) {
      while (button.previousSibling) button.prepend(button.previousSibling);
    }
  });

  function filters(form) {
    for (const field of form.querySelectorAll("[data-view]")) field.addEventListener("input", () => report.view.set(field.dataset.view, field.value));
    form.addEventListener("submit", (event) => event.preventDefault());
    form.addEventListener("reset", (event) => {
      event.preventDefault();
      report.view.clear();
      for (const table of document.querySelectorAll("table.sorted")) { orders.delete(table); sort(table); }
    });
  }

  document.addEventListener("change", (event) => {
    if (event.target.matches?.("input[data-hide]")) report.view.hide(event.target.dataset.hide, !event.target.checked);
  });
  report.dress = (place) => place.querySelectorAll("table.sortable").forEach(sortable);
  report.dress(document);
  for (const table of holders.keys()) {
    lay(table);
    complete(table).catch(() => {}); // a browser that cannot unpack shows the first rows
  }
  document.querySelectorAll("form.filters").forEach(filters);
  report.view.changed(apply);
  apply();
})();
