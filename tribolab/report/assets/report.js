"use strict";
// Sorting, and opening what a link points to. The page is complete without any of it.
document.documentElement.classList.add("js");

function key(row, column) {
  const cell = row.cells[Math.min(column, row.cells.length - 1)];
  const text = cell.dataset.sort ?? cell.textContent.trim();
  const value = Number(text);
  return text === "" || text === "–" ? null : Number.isNaN(value) ? text : value;
}

function compare(a, b) {
  if (typeof a === "number" && typeof b === "number") return a - b;
  return String(a).localeCompare(String(b), "en", { numeric: true });
}

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

for (const table of document.querySelectorAll("table.sortable")) {
  Array.from(table.tHead.rows[0].cells).forEach((header, column) => {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...header.childNodes);
    button.addEventListener("click", () => sort(table, column, header));
    header.append(button);
  });
}

function openTarget() {
  const target = location.hash && document.getElementById(location.hash.slice(1));
  if (target && target.tagName === "DETAILS") {
    target.open = true;
    target.scrollIntoView();
  }
}

function openAll(open) {
  for (const details of document.querySelectorAll("details.run")) details.open = open;
}

addEventListener("hashchange", openTarget);
document.addEventListener("click", (event) => {
  // a link to where the page already stands changes no hash
  if (event.target.closest?.("a[href^='#run-']")) setTimeout(openTarget);
});
addEventListener("beforeprint", () => openAll(true));
document.getElementById("open-all").addEventListener("click", () => openAll(true));
document.getElementById("close-all").addEventListener("click", () => openAll(false));
openTarget();
