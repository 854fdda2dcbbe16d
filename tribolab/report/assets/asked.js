"use strict";
// What the address asks for and the page does not have: it is said, beside what is shown instead.
(() => {
  const { view } = report;
  const list = (names) => (names.length > 5 ? `${names.slice(0, 4).join(", ")} and ${names.length - 4} more` : names.join(", ").replace(/, ([^,]*)$/, " and $1"));

  function instead(key, value) {
    const there = view.known[key];
    if (key === "load") return `no run at ${value.replace(/\s*N$/i, " N")} (shown: ${there.length > 1 ? `the lowest load of each figure; available: ${list(there)}` : there[0]})`;
    const what = key === "status" ? `no run is “${value}”` : `no ${key} “${value}”`;
    return `${what} (all are shown; available: ${list(there)})`;
  }

  const runs = Array.from(document.querySelectorAll("details.run"), ({ dataset }) => dataset);
  function missing() {
    const said = view.unknown.filter(([key]) => view.known[key].length).map(([key, value]) => instead(key, value));
    for (const name of view.hidden) if (!runs.some(({ run }) => run === name)) said.push(`no run “${name}” to hide`);
    const names = runs.map(({ run, surface, medium, load }) => `${run} ${surface} ${medium} ${load}`);
    if (view.get("mark") && !names.some((name) => view.marks(name))) said.push(`nothing named “${view.get("mark")}” to highlight`);
    if (view.anchor && !document.getElementById(view.anchor)) said.push(`no section “${view.anchor}”`);
    return said;
  }

  function tell() {
    const words = missing();
    for (const place of document.querySelectorAll(".asked")) {
      place.textContent = words.length ? `The link refers to something that is not on this page: ${words.join("; ")}.` : "";
      place.hidden = !words.length;
    }
  }
  view.changed(tell);
  addEventListener("hashchange", tell); // a place alone changes nothing else
  tell();
})();
