"use strict";
// Appearance, contents, and opening what a link points to. The page can be read without any of it.
document.documentElement.classList.add("js");

(() => {
  const themes = ["automatic", "light", "dark"];
  const button = document.getElementById("theme");
  const remembered = () => {
    try { return localStorage.getItem("tribolab-appearance"); } catch { return null; } // forbidden on some file addresses
  };
  function appear(theme) {
    if (theme === "automatic") delete document.documentElement.dataset.theme;
    else document.documentElement.dataset.theme = theme;
    button.textContent = `Appearance: ${theme}`;
    dispatchEvent(new Event("appearance"));
  }
  button.addEventListener("click", () => {
    const now = document.documentElement.dataset.theme ?? "automatic";
    const next = themes[(themes.indexOf(now) + 1) % themes.length];
    try { localStorage.setItem("tribolab-appearance", next); } catch { /* then it is not remembered */ }
    appear(next);
  });
  const before = remembered();
  if (themes.includes(before)) appear(before);
})();

(() => {
  // The contents follow the scroll: the section whose head passed the top last is the current one.
  const contents = document.querySelector("nav .contents");
  const here = contents.querySelector(".here");
  const links = new Map();
  for (const section of document.querySelectorAll("main > section")) {
    links.set(section, contents.querySelector(`a[href="#${section.id}"]`));
  }
  const narrow = matchMedia("(max-width: 60rem)");
  let waiting = false;
  function follow() {
    waiting = false;
    let current = null;
    for (const section of links.keys()) {
      if (section.getBoundingClientRect().top <= innerHeight / 3) current = section;
    }
    if (innerHeight + scrollY >= document.documentElement.scrollHeight - 2) current = [...links.keys()].pop();
    for (const [section, link] of links) {
      if (section === current) link.setAttribute("aria-current", "location");
      else link.removeAttribute("aria-current");
    }
    here.textContent = current ? links.get(current).textContent : "";
  }
  function later() {
    if (!waiting) requestAnimationFrame(follow);
    waiting = true;
  }
  const fold = () => { contents.open = !narrow.matches; };
  narrow.addEventListener("change", fold);
  contents.addEventListener("click", (event) => {
    if (narrow.matches && event.target.closest("a")) contents.open = false;
  });
  addEventListener("scroll", later, { passive: true });
  addEventListener("resize", later);
  fold();
  follow();
})();

const report = {
  opened: [], // called with the <details> of a run when it is opened
  open(details) {
    details.open = true;
    for (const call of this.opened) call(details);
  },
};

(() => {
  function openTarget() {
    const target = location.hash && document.getElementById(location.hash.slice(1));
    if (target && target.tagName === "DETAILS") {
      report.open(target);
      target.scrollIntoView();
      target.querySelector("summary").focus({ preventScroll: true });
    }
  }
  const most = 40; // more charts at once than anyone looks at
  function openAll(open) {
    Array.from(document.querySelectorAll("details.run"), (details, place) => {
      if (!open) details.open = false;
      else if (place < most) report.open(details);
    });
  }
  addEventListener("hashchange", openTarget);
  document.addEventListener("click", (event) => {
    // a link to where the page already stands changes no hash
    if (event.target.closest?.("a[href^='#run-']")) setTimeout(openTarget);
  });
  document.addEventListener("toggle", (event) => {
    if (event.target.matches?.("details.run") && event.target.open) report.open(event.target);
  }, true);
  addEventListener("beforeprint", () => {
    if (!document.querySelector("details.run[open]")) openAll(true);
  });
  document.getElementById("open-all")?.addEventListener("click", () => openAll(true));
  document.getElementById("close-all")?.addEventListener("click", () => openAll(false));
  addEventListener("load", openTarget);
})();
