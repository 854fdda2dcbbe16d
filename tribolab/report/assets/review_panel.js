"use strict";
// Under the trace of a run: what is chosen of it, what is decided on that, and the form for a decision.
report.ReviewPanel = (() => {
  const WORDS = { reject: "rejected", accept: "accepted", bounds: "new bounds", note: "noted" };
  const SIGNS = { reject: "✕", accept: "✓", bounds: "↔", note: "✎" };
  const STATES = { applied: "", waiting: "not yet in the results", pending: "pending", withdrawn: "withdrawn" };
  const brief = (time) => String(Number(time.toPrecision(6)));
  const today = () => {
    const now = new Date();
    return [now.getFullYear(), now.getMonth() + 1, now.getDate()].map((part) => String(part).padStart(2, "0")).join("-");
  };
  const button = (text, act, name) => {
    const made = document.createElement("button");
    Object.assign(made, { type: "button", textContent: text });
    made.dataset.review = act;
    if (name) made.setAttribute("aria-label", name);
    return made;
  };

  class Panel {
    constructor(details) {
      this.run = details.dataset.run;
      this.details = details;
      this.chosen = null; // place of a segment; null: the whole run
      this.draft = null; // a decision that still wants its reason
      const figure = details.querySelector("figure.trace");
      const trace = figure && JSON.parse(figure.querySelector("script").textContent);
      this.segments = trace?.segments ?? [];
      this.ends = trace ? [trace.clock[1][0], trace.clock[1].at(-1)] : [0, 0];
      this.root = document.getElementById("review-panel").content.firstElementChild.cloneNode(true);
      this.root.setAttribute("aria-label", `Decide on ${this.run}`);
      this.form = this.root.querySelector("form");
      this.pick = this.root.querySelector("select");
      if (figure) figure.querySelector(".buttons").after(this.root);
      else details.querySelector(":scope > div").prepend(this.root);
      this.chart = figure && report.charts.chartOf(figure);
      this.marks = figure && new report.Marks(this.chart, this);
      this.listen();
      this.render();
    }

    // The segments as they were found, which decisions look for: what is new bounds was elsewhere.
    get found() {
      const moved = report.book.of(this.run, []).filter((one) => one.action === "bounds" && one.applied);
      const places = new Map(moved.map((one) => [one.segment, [one.start_s, one.stop_s]]));
      return this.segments.map(([start, stop], place) => places.get(place) ?? [start, stop]);
    }
    get every() { return report.book.of(this.run, this.found); }
    get on() { return this.every.filter((one) => one.segment === this.chosen); }

    // What is to be seen of a segment: its own decisions, and the rejection of the whole run.
    decided(place) { return this.known.filter((one) => one.segment === place || (one.segment === null && one.action === "reject")); }

    tells(one) {
      const state = [one.date, STATES[one.state]].filter(Boolean).join(", ");
      return `${WORDS[one.action]} by ${one.author}: ${one.reason} (${state})`;
    }

    // Where the chosen segment begins and ends: as drafted, as pending, as it is.
    get bounds() { return this.draft?.bounds ?? (this.chosen === null ? null : this.boundsOf(this.chosen)); }
    boundsOf(place) {
      const pending = this.known.find((one) => one.segment === place && one.action === "bounds" && one.state === "pending");
      const [start, stop] = this.segments[place];
      return [pending?.new_start_s ?? start, pending?.new_stop_s ?? stop];
    }

    // A segment may not leave the run or meet another, as that was found, is, or will be.
    get limits() {
      const [start, stop] = this.segments[this.chosen], gap = 1e-8 * this.ends[1];
      let [low, high] = this.ends;
      this.found.forEach((found, place) => {
        if (place === this.chosen) return;
        const all = [found, this.segments[place], this.boundsOf(place)];
        const from = Math.min(...all.map((one) => one[0])), to = Math.max(...all.map((one) => one[1]));
        if (from < start) low = Math.max(low, to + gap);
        else high = Math.min(high, from - gap);
      });
      return [Math.min(low, start), Math.max(high, stop)];
    }

    choose(place) {
      if (this.draft && place !== this.chosen) this.drop();
      this.chosen = place;
      this.render();
      this.details.dispatchEvent(new Event("chosen", { bubbles: true }));
    }

    async step(by) {
      const count = this.segments.length;
      if (!count) return;
      const next = this.chosen === null ? (by > 0 ? 0 : count - 1) : this.chosen + by;
      this.choose(next < 0 || next >= count ? null : next);
      if (this.chosen !== null && this.chart.drawn) await this.marks.bring(0.02);
    }

    async begin(action) {
      if (action === "bounds" && this.chosen === null) return this.say("Choose a segment first; only segments have bounds.");
      this.draft = { action, bounds: action === "bounds" ? [...this.boundsOf(this.chosen)] : undefined };
      const same = this.on.find((one) => one.action === action && one.state !== "withdrawn" && action !== "note");
      this.form.elements.reason.value = same?.reason ?? "";
      this.render();
      if (action === "bounds" && this.chart.drawn) await this.marks.bring(0.1);
      const grip = action === "bounds" && this.marks.ends.find((one) => !one.hidden);
      if (grip) grip.focus({ preventScroll: true });
      else if (action === "bounds") this.form.elements.start.select();
      else this.ask();
      return undefined;
    }

    ask() {
      const { author, reason } = this.form.elements;
      (report.book.author ? reason : author).focus();
    }

    move(side, time) {
      if (this.chosen === null) return;
      if (this.draft?.action !== "bounds") {
        this.draft = { action: "bounds", bounds: [...this.boundsOf(this.chosen)] };
      }
      const { bounds } = this.draft, [low, high] = this.limits, least = (this.ends[1] - this.ends[0]) / 1e6;
      bounds[side] = side ? Math.min(Math.max(time, bounds[0] + least), high) : Math.max(Math.min(time, bounds[1] - least), low);
      this.render();
    }

    drop() {
      this.draft = null;
      this.render();
    }

    // What is wrong with the bounds that were typed or dragged; "" if nothing is.
    wrong() {
      const [low, high] = this.limits, [start, stop] = this.draft.bounds, [from, to] = this.segments[this.chosen];
      if (![start, stop].every(Number.isFinite)) return "State the bounds as numbers, in seconds.";
      if (start >= stop) return "The end of a segment must be after its start.";
      if (start < low || stop > high) return `The bounds must be between ${brief(low)} and ${brief(high)} s, within the run and outside the other segments.`;
      if (start >= to || stop <= from) return "The new bounds lie outside the segment.";
      return start === from && stop === to ? "The bounds are unchanged." : "";
    }

    submit() {
      const { reason, author, start, stop } = this.form.elements, { action } = this.draft;
      if (action === "bounds") {
        // what was dragged has more digits than the fields show
        const typed = [start, stop].map((field, side) => (field.value === brief(this.draft.bounds[side]) ? this.draft.bounds[side] : Number(field.value.replace(",", ".") || NaN)));
        this.draft.bounds = typed;
      }
      const why = reason.value.trim(), who = (report.book.author || author.value).trim();
      let wrong = action === "bounds" ? this.wrong() : "";
      if (!wrong && !who) author.focus(), wrong = "State who decided.";
      else if (!wrong && !why) reason.focus(), wrong = "State the reason.";
      if (!wrong) wrong = this.decide(action, why, who);
      this.form.querySelector(".wrong").textContent = wrong;
      if (wrong) return;
      this.drop();
      this.root.focus({ preventScroll: true });
    }

    decide(action, reason, author) {
      const entry = { run: this.run, action, start_s: null, stop_s: null, new_start_s: null, new_stop_s: null, reason, author, date: today() };
      if (this.chosen !== null) [entry.start_s, entry.stop_s] = this.found[this.chosen];
      if (action === "bounds") {
        const [start, stop] = this.draft.bounds, found = this.found[this.chosen];
        const again = this.every.some((one) => one.segment === this.chosen && one.action === "bounds" && one.applied);
        if (again || start !== found[0]) entry.new_start_s = start;
        if (again || stop !== found[1]) entry.new_stop_s = stop;
      }
      report.book.author = author;
      const wrong = report.book.decide(entry, this.chosen, this.found);
      if (!wrong) this.say(`${this.nameOf(this.chosen)}: ${WORDS[action]}`);
      return wrong;
    }

    nameOf(place) { return place === null ? "the whole run" : place === undefined ? "no segment" : `segment ${place + 1}`; }
    say(text) { this.root.querySelector(".said").textContent = text; }

    render() {
      this.known = this.every;
      const signs = (place) => this.known.filter((one) => one.segment === place && one.state !== "withdrawn").map((one) => SIGNS[one.action]).join("");
      const named = this.segments.map(([start, stop, , , sign, , speed], place) => `${place + 1}: ${brief(start)} to ${brief(stop)} s, ${speed}${{ 1: ", forward", "-1": ", backward" }[sign] ?? ""}`);
      const titles = ["the whole run", ...named].map((title, k) => [title, signs(k ? k - 1 : null)].filter(Boolean).join("  "));
      if (this.pick.options.length !== titles.length) this.pick.replaceChildren(...titles.map((title, k) => new Option(title, k)));
      titles.forEach((title, k) => { if (this.pick.options[k].text !== title) this.pick.options[k].text = title; });
      this.pick.selectedIndex = this.chosen === null ? 0 : this.chosen + 1;
      this.root.querySelector("[data-review=bounds]").disabled = this.chosen === null;
      this.root.querySelector("[data-review=undo]").disabled = !report.book.canUndo;
      this.fill();
      this.root.querySelector(".signs").hidden = !this.known.length || !this.marks;
      this.root.querySelector(".decided").replaceChildren(...this.known.map((one) => this.item(one)));
      this.marks?.follow();
    }

    fill() {
      const { draft, form } = this;
      form.hidden = !draft;
      if (!draft) return form.querySelector(".wrong").textContent = "", form.reset();
      const what = { reject: "Reject", accept: "Accept despite the checks", bounds: "New bounds of", note: "Note on" }[draft.action];
      form.querySelector(".what").textContent = `${what} ${this.nameOf(this.chosen)}`;
      form.querySelector(".ends").hidden = !draft.bounds;
      form.querySelector(".who").hidden = Boolean(report.book.author);
      if (draft.bounds) ["start", "stop"].forEach((end, side) => { form.elements[end].value = brief(draft.bounds[side]); });
      return undefined;
    }

    item(one) {
      const made = document.createElement("li"), text = document.createElement("span");
      made.className = `${one.state} ${one.action}`;
      made.tabIndex = -1;
      text.textContent = `${SIGNS[one.action]} ${this.nameOf(one.segment)} ${this.tells(one)}${this.moved(one)}`;
      const back = one.state === "withdrawn" ? button("Restore", "restore", `Restore: ${text.textContent}`) : button("Withdraw", "take", `Withdraw: ${text.textContent}`);
      back.one = one;
      made.append(text, " ", back);
      return made;
    }
    moved(one) {
      if (one.action !== "bounds") return "";
      const ends = [one.new_start_s !== null && `from ${brief(one.new_start_s)} s`, one.new_stop_s !== null && `to ${brief(one.new_stop_s)} s`];
      return `: ${ends.filter(Boolean).join(" ")}`;
    }

    listen() {
      const acts = {
        back: () => this.step(-1), on: () => this.step(1), cancel: () => { this.drop(); this.root.focus({ preventScroll: true }); },
        take: (pressed) => report.book.take(pressed.one),
        restore: ({ one }) => this.say(report.book.decide(plain(one), one.segment, this.found)),
      };
      const plain = ({ segment, state, ...entry }) => entry;
      this.root.addEventListener("click", (event) => {
        const pressed = event.target.closest("button[data-review]"), act = pressed?.dataset.review;
        if (act in WORDS) this.begin(act);
        else acts[act]?.(pressed);
      });
      this.pick.addEventListener("change", () => this.choose(this.pick.selectedIndex ? this.pick.selectedIndex - 1 : null));
      this.form.addEventListener("submit", (event) => { event.preventDefault(); this.submit(); });
      for (const place of [this.root, ...(this.marks?.ends ?? [])]) {
        place.addEventListener("keydown", (event) => {
          if (event.key !== "Escape" || !this.draft) return;
          event.stopPropagation();
          acts.cancel();
        });
      }
      let before = JSON.stringify(this.every);
      report.book.changed(() => {
        const now = JSON.stringify(this.every);
        this.render();
        if (now !== before && this.chart?.drawn) this.chart.paint();
        before = now;
      });
    }
  }
  return Panel;
})();
