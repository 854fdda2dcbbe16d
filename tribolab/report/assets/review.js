"use strict";
// The book of decisions: those of the review file that the page carries, and the reader's own since then,
// which are kept in the browser until they are found in the file.
report.book = (() => {
  const holder = document.getElementById("review-data");
  if (!holder) return null;
  const { key, files, head, entries } = JSON.parse(holder.textContent);
  const PLACE = `tribolab-review-${key}`, AUTHOR = "tribolab-author", MOST = 200; // steps that can be undone
  const TIMES = { start_s: "from", stop_s: "to", new_start_s: "new_from", new_stop_s: "new_to" };
  const FIELDS = ["run", "action", ...Object.keys(TIMES), "reason", "author", "date"];
  const nameOf = (entry) => JSON.stringify(FIELDS.map((field) => entry[field] ?? null));
  const carried = new Map(entries.map((entry) => [nameOf(entry), entry]));
  const listeners = [];
  let state = { pending: [], withdrawn: [], downloaded: [], past: [] };
  let author = "", stored = true, trouble = "";

  const read = (place) => { try { return localStorage.getItem(place); } catch { stored = false; return null; } };
  const write = (place, text) => { try { localStorage.setItem(place, text); return true; } catch { return false; } };

  // What the file has by now is pending no more; what it has no more need not be taken out.
  function settle() {
    state.pending = state.pending.filter((entry) => !carried.has(nameOf(entry)));
    state.withdrawn = state.withdrawn.filter((name) => carried.has(name));
    state.downloaded = state.downloaded.filter((name) => (name[0] === "-" ? carried.has(name.slice(1)) : !carried.has(name)));
  }

  function load() {
    const text = read(PLACE);
    if (!text) return;
    try {
      const { pending, withdrawn, downloaded, past } = JSON.parse(text);
      if (![pending, withdrawn, downloaded, past].every(Array.isArray)) throw new TypeError("no book");
      state = { pending, withdrawn, downloaded, past };
    } catch {
      write(`${PLACE}-unread`, text); // not ours to throw away
      trouble = "Earlier decisions stored in this browser cannot be read. They were not deleted.";
    }
    settle();
  }

  const names = () => [...state.pending.map(nameOf), ...state.withdrawn.map((name) => `-${name}`)];
  function unsaved() {
    const now = new Set(names()), then = new Set(state.downloaded);
    return [...now].filter((name) => !then.has(name)).length + [...then].filter((name) => !now.has(name)).length;
  }

  function tell() { for (const call of listeners) call(); }
  function keep() {
    stored = write(PLACE, JSON.stringify(state));
    tell();
  }
  function change(make) {
    const before = { pending: [...state.pending], withdrawn: [...state.withdrawn] };
    make();
    state.past = [...state.past, before].slice(-MOST);
    keep();
  }
  function without(entry) {
    const name = nameOf(entry);
    if (carried.has(name)) state.withdrawn = [...new Set([...state.withdrawn, name])];
    else state.pending = state.pending.filter((one) => nameOf(one) !== name);
  }

  // Which segment an interval means: the one that contains more than half of it, as in the pipeline.
  function segmentOf(entry, found) {
    if (entry.start_s === null) return null;
    if (entry.applied && entry.segments.length) return entry.segments[0] - 1;
    const place = found.findIndex(([start, stop]) => Math.min(stop, entry.stop_s) - Math.max(start, entry.start_s) > 0.5 * (entry.stop_s - entry.start_s));
    return place < 0 ? undefined : place; // undefined: there is no such segment
  }

  // The decisions on a run, in the order of the file that would be downloaded, each with its segment
  // and its state: applied, waiting (in the file, but not in these results), pending or withdrawn.
  function of(run, found) {
    const old = entries.filter((entry) => entry.run === run).map((entry) => {
      const gone = state.withdrawn.includes(nameOf(entry));
      return { ...entry, state: gone ? "withdrawn" : entry.applied ? "applied" : "waiting" };
    });
    const own = state.pending.filter((entry) => entry.run === run).map((entry) => ({ ...entry, state: "pending" }));
    return [...old, ...own].map((entry) => ({ ...entry, segment: segmentOf(entry, found) }));
  }

  // A new decision takes the place of those that it contradicts, or that say the same.
  function displaced(entry, segment, every) {
    const rivals = { reject: ["reject", "accept"], accept: ["accept", "reject"], bounds: ["bounds"], note: [] }[entry.action];
    return every.filter((one) => {
      if (one.state === "withdrawn" || !rivals.includes(one.action)) return false;
      if (one.segment === segment) return true;
      return segment === null && entry.action === "reject" && one.action === "accept";
    });
  }
  function decide(entry, segment, found) {
    const every = of(entry.run, found);
    if (entry.action === "accept" && segment !== null && every.some((one) => one.segment === null && one.action === "reject" && one.state !== "withdrawn")) {
      return "The whole run is rejected; undo that first.";
    }
    change(() => {
      for (const one of displaced(entry, segment, every)) without(one);
      const name = nameOf(entry);
      // decided as it stands in the file already: then that is not taken out after all
      if (carried.has(name)) state.withdrawn = state.withdrawn.filter((other) => other !== name);
      else if (!state.pending.some((one) => nameOf(one) === name)) state.pending = [...state.pending, entry];
    });
    return "";
  }

  function undo() {
    const before = state.past.at(-1);
    if (!before) return false;
    const { pending, withdrawn } = before;
    state = { ...state, pending, withdrawn, past: state.past.slice(0, -1) };
    settle();
    keep();
    return true;
  }

  const quoted = (text) => JSON.stringify(text.toWellFormed?.() ?? text).replaceAll("\u007f", "\\u007f");
  function written(entry) {
    const lines = ["[[decision]]", `run = ${quoted(entry.run)}`, `action = ${quoted(entry.action)}`];
    for (const [field, name] of Object.entries(TIMES)) if (entry[field] !== null) lines.push(`${name} = "${entry[field]} s"`);
    return [...lines, `reason = ${quoted(entry.reason)}`, `author = ${quoted(entry.author)}`, `date = ${entry.date}`, ""].join("\n");
  }
  // The file as it was, to the letter, without what is taken out, and then what is new.
  function toml() {
    const left = entries.filter((entry) => !state.withdrawn.includes(nameOf(entry)));
    let text = head;
    for (const block of [...left.map((entry) => entry.text || written(entry)), ...state.pending.map(written)]) {
      if (text && !text.endsWith("\n")) text += "\n";
      if (text && !text.endsWith("\n\n")) text += "\n";
      text += block;
    }
    return text;
  }
  function download() {
    report.save(files[1], "application/toml", toml());
    state.downloaded = names();
    keep();
  }

  load();
  author = read(AUTHOR) ?? "";
  // Another tab with the same report writes the same book.
  addEventListener("storage", (event) => { if (event.key === PLACE) load(), tell(); });
  addEventListener("beforeunload", (event) => { if (!stored && unsaved()) event.preventDefault(); });
  return {
    files, of, decide, undo, download, toml, unsaved,
    changed(call) { listeners.push(call); },
    take(entry) { change(() => without(entry)); },
    get own() { return [...state.pending.map((entry) => ({ ...entry, state: "pending" })), ...state.withdrawn.map((name) => ({ ...carried.get(name), state: "withdrawn" }))]; },
    get canUndo() { return state.past.length > 0; },
    get stored() { return stored; },
    get trouble() { return trouble; },
    get author() { return author; },
    set author(name) { author = name; write(AUTHOR, name); },
  };
})();
