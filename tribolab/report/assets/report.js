"use strict";
// Appearance and contents. The page can be read without any of it.

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
  for (const section of document.querySelectorAll("main section[id]")) {
    const link = contents.querySelector(`a[href="#${section.id}"]`);
    if (link) links.set(section, link);
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
  later(); // with the first picture of the page: asked now, it would be laid out twice
})();

const report = {
  begun: [], // called when all scripts are there
  goTo() {}, // leads to a place on the page
};
