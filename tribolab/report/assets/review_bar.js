"use strict";
// What is decided on this page and not yet in the results: told, listed, downloaded; and the keys.
report.reviewing = (() => {
  const { book } = report;
  if (!book) return null;
  const DOUBT = ["failed", "rejected", "suspect"], KEYS = "tribolab-keys";
  const bar = document.getElementById("review-bar"), help = document.getElementById("review-help");
  const box = help.querySelector("[name=keys]"), author = help.querySelector("[name=author]");
  const list = bar.querySelector(".decided"), panels = new Map();
  const [campaign, file] = book.files;
  const many = (count, what) => `${count} ${what}${count === 1 ? "" : "s"}`;
  const runOf = (name) => Array.from(document.querySelectorAll("details.run")).find((one) => one.dataset.run === name);
  let current = null, keys = true;
  try { keys = localStorage.getItem(KEYS) !== "off"; } catch { /* then they work */ }

  function join(details) {
    if (!details.matches("details.run") || panels.has(details)) return;
    panels.set(details, new report.ReviewPanel(details));
  }
  const panelOf = async (details) => {
    details.open = true;
    await report.unfold(details);
    return panels.get(details);
  };

  function render() {
    const own = book.own, unsaved = book.unsaved();
    bar.hidden = !own.length && !unsaved && !book.trouble;
    document.documentElement.classList.toggle("deciding", !bar.hidden);
    bar.classList.toggle("unsaved", unsaved > 0);
    bar.querySelector(".count").textContent = unsaved ? `${many(unsaved, "decision")} not yet downloaded` : `${many(own.length, "decision")} downloaded`;
    const next = `Save ${file} next to ${campaign}, replacing any earlier one, and run the campaign again.`;
    const kept = book.stored ? "Until then, the decisions are stored in this browser." : "This browser cannot store them: they are lost when you close the page.";
    bar.querySelector(".next").textContent = [book.trouble, unsaved ? kept : next].filter(Boolean).join(" ");
    bar.classList.toggle("unkept", !book.stored);
    bar.querySelector("[data-review=undo]").disabled = !book.canUndo;
    list.replaceChildren(...own.map(item));
    for (const details of document.querySelectorAll("details.run")) mark(details, own.filter((one) => one.run === details.dataset.run).length);
  }
  function mark(details, count) {
    const summary = details.querySelector("summary"), old = summary.querySelector(".pending");
    if (!count) return old?.remove();
    const made = old ?? document.createElement("span");
    made.className = "chip pending";
    made.textContent = `${count} pending`;
    if (!old) summary.append(" ", made);
    return undefined;
  }
  function item(one) {
    const made = document.createElement("li"), there = runOf(one.run), name = document.createElement(there ? "a" : "span");
    name.textContent = there ? one.run : `${one.run} (run is not on this page)`;
    if (there) name.href = `#${there.id}`;
    const where = one.start_s === null ? "the whole run" : `${Number(one.start_s.toPrecision(5))} to ${Number(one.stop_s.toPrecision(5))} s`;
    made.append(name, ` ${one.state === "withdrawn" ? "no longer: " : ""}${one.action}, ${where}: ${one.reason} (${one.author}, ${one.date}) `);
    if (one.state === "pending") {
      const back = document.createElement("button");
      Object.assign(back, { type: "button", textContent: "Withdraw" });
      back.addEventListener("click", () => book.take(one));
      made.append(back);
    }
    return made;
  }

  const decided = (name) => book.own.some((one) => one.run === name && one.state === "pending" && one.start_s === null && one.action !== "note");
  // The next run that checks object to and nobody has decided on.
  async function doubtful(by) {
    const place = (one) => Number(one.id.slice("run-".length)); // an opened run is moved to the front
    const every = Array.from(document.querySelectorAll("details.run:not([hidden])")).sort((a, b) => place(a) - place(b));
    const from = current ? every.indexOf(current) : by > 0 ? -1 : every.length;
    const next = every.map((_, k) => every[(from + by * (k + 1) + 2 * every.length) % every.length])
      .find((one) => DOUBT.includes(one.dataset.status) && !decided(one.dataset.run));
    if (!next) return say("No run is suspect or failed.");
    current = next;
    if (report.view.anchor === next.id) await report.goTo(next.id);
    else report.view.go(next.id);
    (await panelOf(next)).choose(null);
    return undefined;
  }
  function say(text) {
    bar.hidden = false;
    bar.querySelector(".next").textContent = text;
  }

  const acts = {
    undo: () => book.undo(), download: () => book.download(), close: () => help.close(),
    help: () => {
      author.value = book.author;
      help.showModal();
    },
    list: (pressed) => {
      list.hidden = !list.hidden;
      pressed.setAttribute("aria-expanded", String(!list.hidden));
      pressed.textContent = list.hidden ? "Show" : "Hide";
    },
  };
  document.addEventListener("click", (event) => {
    const pressed = event.target.closest?.("button[data-review]");
    if (pressed) acts[pressed.dataset.review]?.(pressed);
  });
  for (const kind of ["chosen", "focusin", "pointerdown"]) {
    document.addEventListener(kind, (event) => { current = event.target.closest?.("details.run") ?? current; });
  }

  const ofRun = { s: (panel) => panel.step(1), S: (panel) => panel.step(-1), w: (panel) => panel.choose(null), r: (panel) => panel.begin("reject"), a: (panel) => panel.begin("accept"), b: (panel) => panel.begin("bounds"), n: (panel) => panel.begin("note") };
  const ofPage = { d: () => doubtful(1), D: () => doubtful(-1), u: acts.undo, l: () => (book.unsaved() || book.own.length ? book.download() : say("There are no decisions to download.")), "?": acts.help };
  document.addEventListener("keydown", async (event) => {
    const busy = event.target.closest?.("input, textarea, select, [contenteditable], dialog");
    if (!keys || busy || event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    if (!ofPage[event.key] && !(ofRun[event.key] && current)) return;
    event.preventDefault();
    if (ofPage[event.key]) ofPage[event.key]();
    else ofRun[event.key](await panelOf(current));
  });

  box.checked = keys;
  box.addEventListener("change", () => {
    keys = box.checked;
    try { localStorage.setItem(KEYS, keys ? "on" : "off"); } catch { /* then for this time */ }
  });
  author.addEventListener("change", () => { if (author.value.trim()) book.author = author.value.trim(); });

  book.changed(render);
  report.begun.push(render);
  return { join, panelOf };
})();
