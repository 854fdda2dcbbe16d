"use strict";
// What of the campaign is looked at: surface, medium, load, names. It stands in the page's address,
// and tables and figures follow it.
report.view = (() => {
  const KEYS = ["surface", "medium", "load", "find", "mark", "hide", "status"];
  const listeners = [];
  const known = JSON.parse(document.querySelector("form[data-known]")?.dataset.known ?? "{}");
  let state = {}, anchor = "", unknown = [];

  // As the page writes it; what no run has is told (asked.js), and hides nothing.
  function valid(key, value) {
    if (!known[key]) return value;
    const same = (one) => (key === "load" ? /^[\d.e+-]+\s*N?$/i.test(value) && Number.parseFloat(one) === Number.parseFloat(value) : one.toLowerCase() === value.toLowerCase());
    const kept = known[key].find(same);
    if (!kept) unknown.push([key, value]);
    return kept;
  }

  function decoded(text) {
    try { return decodeURIComponent(text); } catch { return text; }
  }

  function read() {
    state = {};
    anchor = "";
    unknown = [];
    for (const part of location.hash.slice(1).split("&")) {
      const [key, value] = part.split("=", 2);
      if (value === undefined) anchor = anchor || decoded(key);
      else if (KEYS.includes(key) && value) state[key] = valid(key, decoded(value));
    }
  }

  function address(target = anchor) {
    const parts = target ? [encodeURIComponent(target)] : [];
    for (const key of KEYS) if (state[key]) parts.push(`${key}=${encodeURIComponent(key === "load" ? state.load.replace(" ", "") : state[key])}`);
    return parts.length ? `#${parts.join("&")}` : location.pathname + location.search;
  }

  function tell() {
    for (const call of listeners) call(state);
  }

  // A link to a place on the page keeps what is looked at.
  addEventListener("hashchange", () => {
    const before = { ...state };
    const bare = !location.hash.includes("=");
    read();
    if (bare && location.hash.length > 1) {
      state = before;
      history.replaceState(null, "", address());
    } else tell();
    report.goTo(anchor);
  });

  read();
  const words = (text) => (text ?? "").toLowerCase().split(/\s+/).filter(Boolean);
  const list = (text) => new Set((text ?? "").split(",").filter(Boolean));
  return {
    get anchor() { return anchor; },
    get known() { return known; },
    get unknown() { return unknown; }, // what the address asks for, and no run has
    get(key) { return state[key] ?? ""; },
    set(key, value) {
      if ((state[key] ?? "") === value) return;
      if (value) state[key] = value;
      else delete state[key];
      unknown = [];
      history.replaceState(null, "", address());
      tell();
    },
    clear() {
      state = {};
      unknown = [];
      history.replaceState(null, "", address());
      tell();
    },
    go(target) { location.hash = target; },
    changed(call) { listeners.push(call); },
    get hidden() { return list(state.hide); },
    hide(name, hidden) {
      const names = list(state.hide);
      if (hidden) names.add(name);
      else names.delete(name);
      this.set("hide", [...names].join(","));
    },
    // Whether a thing is shown: of another surface, medium or load it is not, of none it is.
    shows(of) {
      if (state.surface && of.surface && of.surface !== state.surface) return false;
      if (state.medium && of.medium && of.medium !== state.medium) return false;
      if (state.load && of.load && of.load !== state.load) return false;
      return true;
    },
    // The same for a run, of which nothing may be known.
    holds(of) { return ["surface", "medium", "load"].every((key) => !state[key] || of[key] === state[key]); },
    finds(text) { const low = text.toLowerCase(); return words(state.find).every((word) => low.includes(word)); },
    marks(text) { return Boolean(state.mark) && text.toLowerCase().includes(state.mark.toLowerCase()); },
  };
})();
