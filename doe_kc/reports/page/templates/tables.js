// Sorting and filtering of every table.data; the rows are in the page already.
(function () {
  "use strict";
  function cellValue(row, column, numeric) {
    const cell = row.cells[column];
    if (!numeric) return cell.textContent.trim().toLowerCase();
    const value = parseFloat(cell.dataset.value);
    return Number.isFinite(value) ? value : null;
  }
  function compare(a, b) {
    if (a === null || b === null) return a === b ? 0 : a === null ? 1 : -1; // unknown ones last, both ways
    return typeof a === "number" ? a - b : a.localeCompare(b, undefined, { numeric: true });
  }
  function sort(table, column) {
    const heads = table.tHead.rows[0].cells;
    const head = heads[column];
    const down = head.getAttribute("aria-sort") === "ascending";
    for (const other of heads) other.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", down ? "descending" : "ascending");
    const numeric = head.dataset.type === "number";
    const rows = Array.from(table.tBodies[0].rows, (row) => [cellValue(row, column, numeric), row]);
    rows.sort((p, q) => (p[0] === null || q[0] === null || !down ? compare(p[0], q[0]) : compare(q[0], p[0])));
    table.tBodies[0].append(...rows.map((pair) => pair[1]));
  }
  for (const table of document.querySelectorAll("table.data")) {
    Array.from(table.tHead.rows[0].cells).forEach((head, column) => {
      const button = document.createElement("button");
      button.type = "button";
      button.title = "Sort by this column";
      button.append(...head.childNodes);
      button.addEventListener("click", () => sort(table, column));
      head.append(button);
    });
  }
  for (const controls of document.querySelectorAll("[data-table]")) {
    const table = document.getElementById(controls.dataset.table);
    const search = controls.querySelector("input[type=search]");
    const boxes = Array.from(controls.querySelectorAll("[data-only]"));
    const count = controls.querySelector(".count");
    const apply = () => {
      const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
      const wanted = boxes.filter((box) => box.checked).map((box) => box.dataset.only);
      let shown = 0;
      for (const row of table.tBodies[0].rows) {
        const text = (row.textContent + " " + (row.querySelector("[title]") || row).title).toLowerCase();
        const tags = (row.dataset.tags || "").split(" ");
        const keep = words.every((w) => text.includes(w)) && wanted.every((t) => tags.includes(t));
        row.hidden = !keep;
        shown += keep ? 1 : 0;
      }
      count.textContent = shown + " of " + table.tBodies[0].rows.length + " rows";
    };
    controls.addEventListener("input", apply);
    apply();
  }
})();
