// The table of cases: sorted by its headings, copied as CSV, a way to choose a case.

function startTable(columns, rows, choose) {
  const table = $("cases"), body = table.tBodies[0];
  const byIndex = new Map(rows.map((row) => [String(row.index), row]));
  const shown = () => [...body.rows].map((line) => byIndex.get(line.dataset.index));
  for (const head of table.tHead.rows[0].cells) {
    const column = head.dataset.column;
    const button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => {
      const down = head.getAttribute("aria-sort") === "ascending";
      for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
      head.setAttribute("aria-sort", down ? "descending" : "ascending");
      const order = (a, b) => {
        const [p, q] = [a, b].map((line) => byIndex.get(line.dataset.index)[column]);
        // Absent values stay at the end, whichever way the others go.
        if (p === null || q === null) return (p === null) - (q === null);
        const sign = p < q ? -1 : p > q ? 1 : 0;
        return down ? -sign : sign;
      };
      body.append(...[...body.rows].sort(order));
    });
  }
  for (const line of body.rows) {
    if (byIndex.get(line.dataset.index).status !== "converged") continue;
    const head = line.cells[0], button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    head.append(button);
    line.addEventListener("click", () => choose(Number(line.dataset.index)));
  }
  const csv = () => toCsv(columns, shown().map((row) => row.cells));
  $("copy").addEventListener("click", async () => {
    $("copied").textContent = (await copy(csv())) ? `${rows.length} rows copied` : "The clipboard is closed to this page: download instead.";
  });
  $("download-csv").addEventListener("click", () => download("sweep.csv", csv(), "text/csv"));
}
