"use strict";
{
  const byId = (id) => document.getElementById(id);
  const table = byId("matrix");
  const body = table.tBodies[0];
  const rows = [...body.rows];
  const sortButtons = [...table.tHead.querySelectorAll("button")];
  const pages = new Map([...document.querySelectorAll("[data-page]")].map((page) => [page.dataset.page, page]));
  const filters = { find: byId("find"), status: byId("status"), mistake: byId("mistake") };
  const sort = { column: 0, descending: false };

  const make = (name, text = "", properties = {}) => {
    const element = Object.assign(document.createElement(name), properties);
    element.textContent = text;
    return element;
  };

  // --- sorting ---

  const ORDER = ["failed", "same", "error", "missing", "skipped", "none", "passed"];
  const collator = new Intl.Collator(undefined, { numeric: true });

  const keyOf = (row) => {
    const cell = row.cells[sort.column];
    if (sort.column === 0) return cell.textContent;
    if ("value" in cell.dataset) return Number(cell.dataset.value);
    return ORDER.findIndex((kind) => cell.classList.contains(kind));
  };

  const sortRows = () => {
    const keys = new Map(rows.map((row) => [row, keyOf(row)]));
    const compare = sort.column === 0 ? collator.compare : (a, b) => a - b;
    const sign = sort.descending ? -1 : 1;
    const sorted = [...rows].sort((a, b) => sign * compare(keys.get(a), keys.get(b)));
    body.append(...sorted.flatMap((row) => (sheets.has(row) ? [row, sheets.get(row)] : [row])));
    for (const button of sortButtons) {
      const head = button.closest("th");
      if (Number(button.dataset.column) !== sort.column) head.removeAttribute("aria-sort");
      else head.setAttribute("aria-sort", sort.descending ? "descending" : "ascending");
    }
  };

  for (const button of sortButtons) {
    button.addEventListener("click", () => {
      const column = Number(button.dataset.column);
      sort.descending = column === sort.column && !sort.descending;
      sort.column = column;
      sortRows();
      remember();
    });
  }

  // --- filters ---

  const plain = (text) => text.normalize("NFD").replace(/\p{M}/gu, "").toLowerCase();
  const lists = (tokens, token) => !token || tokens.split(" ").includes(token);

  const filterRows = () => {
    const words = plain(filters.find.value).split(/\s+/);
    const status = filters.status.value;
    const mistake = filters.mistake.value;
    let shown = 0;
    for (const row of rows) {
      const text = plain(row.dataset.find);
      row.hidden =
        !words.every((word) => text.includes(word)) ||
        !lists(row.dataset.status, status) ||
        !lists(row.dataset.mistakes, mistake);
      shown += !row.hidden;
      showSheet(row);
    }
    for (const cell of body.querySelectorAll(".wanted")) cell.classList.remove("wanted");
    if (mistake) {
      for (const cell of body.querySelectorAll(`[data-mistake="${CSS.escape(mistake)}"]`)) cell.classList.add("wanted");
    }
    for (const button of document.querySelectorAll("[data-set-status], [data-set-mistake]")) {
      const { setStatus, setMistake } = button.dataset;
      button.setAttribute("aria-pressed", String(setStatus ? setStatus === status : setMistake === mistake));
    }
    const all = `${rows.length} ${rows.length === 1 ? "learner" : "learners"}`;
    byId("count").textContent = shown === rows.length ? all : `${shown} of ${all}`;
    byId("clear").hidden = shown === rows.length;
    showBanner(mistake, status);
  };

  const showBanner = (value) => {
    const banner = byId("banner");
    banner.hidden = !value;
    banner.replaceChildren();
    if (!value) return;
    const [exercise, id] = [value.slice(0, value.indexOf("/")), value.slice(value.indexOf("/") + 1)];
    const page = pages.get(id);
    const title = page ? page.querySelector(".title").textContent : id;
    banner.append(make("h3", `${exercise}: ${title}`));
    if (page) {
      const [summary, ...rest] = page.querySelector(".explanation").cloneNode(true).children;
      const more = make("details", "", { open: explain });
      more.addEventListener("toggle", () => (explain = more.open));
      const explanation = make("div", "", { className: "explanation" });
      explanation.append(...rest);
      more.append(make("summary", "Explanation, with an example"), explanation);
      banner.append(summary, more);
    }
  };
  let explain = false;

  const change = () => {
    filterRows();
    remember();
  };
  const clear = () => {
    for (const filter of Object.values(filters)) filter.value = "";
    change();
    filters.find.focus();
  };
  for (const filter of Object.values(filters)) filter.addEventListener("input", change);
  document.querySelector(".controls").addEventListener("submit", (event) => event.preventDefault());
  byId("clear").addEventListener("click", clear);

  for (const button of document.querySelectorAll("[data-set-status], [data-set-mistake]")) {
    button.addEventListener("click", () => {
      const pressed = button.getAttribute("aria-pressed") === "true";
      filters.find.value = "";
      filters.status.value = pressed ? "" : button.dataset.setStatus || "";
      filters.mistake.value = pressed ? "" : button.dataset.setMistake || "";
      change();
      if (pressed) return;
      const target = button.dataset.setMistake ? byId("banner") : byId("learners");
      target.focus({ preventScroll: true });
      byId("learners").scrollIntoView();
    });
  }

  // --- details of a learner ---

  const sheets = new Map();
  const buttonOf = (row) => row.cells[0].querySelector("button");
  const isOpen = (row) => buttonOf(row).getAttribute("aria-expanded") === "true";

  const showSheet = (row) => {
    if (sheets.has(row)) sheets.get(row).hidden = row.hidden || !isOpen(row);
  };

  const toggle = (row) => {
    const button = buttonOf(row);
    if (!sheets.has(row)) {
      const sheet = make("div", "", { className: "sheet" });
      sheet.append(byId(button.dataset.details).content.cloneNode(true));
      const cell = make("td", "", { colSpan: row.cells.length });
      const below = make("tr", "", { className: "details", id: `of-${button.dataset.details}` });
      cell.append(sheet);
      below.append(cell);
      below.addEventListener("keydown", (event) => {
        if (event.key !== "Escape") return;
        toggle(row);
        button.focus();
      });
      row.after(below);
      sheets.set(row, below);
      button.setAttribute("aria-controls", below.id);
    }
    button.setAttribute("aria-expanded", String(!isOpen(row)));
    showSheet(row);
  };

  body.addEventListener("click", (event) => {
    const row = event.target.closest("tr");
    if (!rows.includes(row) || event.target.closest("a")) return;
    toggle(row);
    remember();
  });

  document.addEventListener(
    "toggle",
    (event) => {
      const copy = event.target.dataset.copy;
      if (!copy || event.target.children.length > 1 || !pages.has(copy)) return;
      event.target.append(pages.get(copy).querySelector(".explanation").cloneNode(true));
    },
    true,
  );

  body.addEventListener("mouseover", (event) => {
    const cell = event.target.closest(".mark");
    if (!cell || cell.title) return;
    const head = sortButtons.find((button) => Number(button.dataset.column) === cell.cellIndex).closest("th");
    const mistake = (cell.dataset.mistake || "").replace(/^.*?\//, "");
    const page = pages.get(mistake);
    const why = page ? `: ${page.querySelector(".title").textContent}` : "";
    cell.title = `${head.title}\n${cell.textContent}${why}`;
  });

  // --- the address holds what is shown, so that it can be kept and shared ---

  const remember = () => {
    const parameters = new URLSearchParams();
    for (const [name, filter] of Object.entries(filters)) if (filter.value) parameters.set(name, filter.value);
    if (sort.column || sort.descending) parameters.set("sort", `${sort.descending ? "-" : ""}${sort.column}`);
    for (const row of rows) if (isOpen(row)) parameters.append("open", row.dataset.learner);
    const text = String(parameters);
    history.replaceState(null, "", text ? `#${text}` : location.href.split("#")[0]);
  };

  const restore = () => {
    const parameters = new URLSearchParams(location.hash.slice(1));
    for (const [name, filter] of Object.entries(filters)) filter.value = parameters.get(name) || "";
    const column = parameters.get("sort");
    if (column && sortButtons.some((button) => button.dataset.column === column.replace("-", ""))) {
      sort.column = Number(column.replace("-", ""));
      sort.descending = column.startsWith("-");
      sortRows();
    }
    const open = parameters.getAll("open");
    for (const row of rows) if (open.includes(row.dataset.learner) !== isOpen(row)) toggle(row);
    filterRows();
  };
  restore();
  addEventListener("hashchange", () => {
    if (location.hash.includes("=")) restore();
  });
}
