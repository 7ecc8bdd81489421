"use strict";

// textual.js opens the terminal when the page is loaded. The size of a character must be known by then, so the fonts come
// first; and the app is at the address that the browser knows this page by, whatever forwards it.
const open = window.onload;

window.onload = async (event) => {
  const page = new URL("ws", window.location.href);
  page.protocol = page.protocol === "https:" ? "wss:" : "ws:";
  page.search = "";
  page.hash = "";
  document.getElementById("terminal").dataset.sessionWebsocketUrl = page.href;
  document.getElementById("again").addEventListener("click", () => window.location.reload());
  const fonts = ["", "bold ", "italic "].map((style) => document.fonts.load(`${style}16px "Roboto Mono"`));
  const patience = new Promise((resolve) => setTimeout(resolve, 2000));
  await Promise.race([Promise.allSettled(fonts), patience]);
  open(event);
  document.querySelector(".xterm-helper-textarea")?.focus();
};
