"use strict";
// In the head: what only scripts make useful has its place from the first moment on.
document.documentElement.classList.add("js");
