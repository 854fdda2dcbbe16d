"use strict";
// Tables: sorting by a click on a header; for the runs also filters and the choice of columns.
(() => {
  function key(row, column) {
    const cell = row.cells[Math.min(column, row.cells.length - 1)];
    const text = cell.dataset.sort ?? cell.textContent.trim();
    const value = Number(text);
    return text === "" || text === "–" ? null : Number.isNaN(value) ? text : value;
  }

  const words = new Intl.Collator("en", { numeric: true });
  const compare = (a, b) =>
    typeof a === "number" && typeof b === "number" ? a - b : words.compare(String(a), String(b));

  function sort(table, column, header) {
    const down = header.getAttribute("aria-sort") === "ascending";
    for (const other of header.parentNode.cells) other.removeAttribute("aria-sort");
    header.setAttribute("aria-sort", down ? "descending" : "ascending");
    const body = table.tBodies[0];
    const rows = Array.from(body.rows, (row, place) => ({ row, place, key: key(row, column) }));
    rows.sort((a, b) => {
      // what has no value stands last either way
      if (a.key === null || b.key === null) return (a.key === null) - (b.key === null) || a.place - b.place;
      return (down ? -1 : 1) * compare(a.key, b.key) || a.place - b.place;
    });
    body.append(...rows.map((entry) => entry.row));
  }

  function sortable(table) {
    Array.from(table.tHead.rows[0].cells).forEach((header, column) => {
      const button = document.createElement("button");
      button.type = "button";
      button.append(...header.childNodes);
      button.addEventListener("click", () => sort(table, column, header));
      header.append(button);
    });
  }

  function filtered(form) {
    const table = document.getElementById(form.dataset.for);
    const names = Array.from(table.tHead.rows[0].cells, (cell) => cell.dataset.name);
    const rows = Array.from(table.tBodies[0].rows);
    const said = form.querySelector("output");
    const wants = Array.from(form.querySelectorAll("[data-column]"));
    const bare = (cell) => cell.textContent.replace(/^[^\p{L}\p{N}]+/u, "").trim();

    function apply() {
      let shown = 0;
      for (const row of rows) {
        const fits = wants.every((field) => {
          if (!field.value) return true;
          if (!field.dataset.column) return row.textContent.toLowerCase().includes(field.value.toLowerCase());
          return bare(row.cells[names.indexOf(field.dataset.column)]).split("\n")[0] === field.value;
        });
        row.hidden = !fits;
        shown += fits;
      }
      said.textContent = shown === rows.length ? `${rows.length} runs` : `${shown} of ${rows.length} runs`;
    }

    function columns() {
      for (const box of form.querySelectorAll("[data-hides]")) {
        const place = names.indexOf(box.dataset.hides);
        for (const row of table.rows) row.cells[place].hidden = !box.checked;
      }
    }

    for (const field of wants) field.addEventListener("input", apply);
    form.querySelector(".menu").addEventListener("change", columns);
    form.addEventListener("submit", (event) => event.preventDefault());
    form.addEventListener("reset", () => setTimeout(() => { apply(); columns(); }));
    const menu = form.querySelector("details.columns");
    document.addEventListener("click", (event) => { if (!menu.contains(event.target)) menu.open = false; });
    menu.addEventListener("keydown", (event) => {
      if (event.key !== "Escape") return;
      menu.open = false;
      menu.querySelector("summary").focus();
    });
  }

  document.querySelectorAll("table.sortable").forEach(sortable);
  document.querySelectorAll("form.filters").forEach(filtered);
})();
