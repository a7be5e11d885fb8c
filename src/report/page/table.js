// The table of cases: sorted by its headings, copied as CSV, a way to choose a case. That of a large sweep is read page by page.

const PAGE = 50;

/** A table whose rows are made as they are turned to; `shown` has a name, a factor and digits for each column. */
function startPages(shown, rows, choose) {
  const table = $("cases"), body = table.tBodies[0], heads = [...table.tHead.rows[0].cells];
  const text = (row, [name, factor, digits]) => (row[name] === null ? "" : typeof row[name] === "string" ? row[name] : digits ? significant(row[name] * factor, digits) : trimmed(significant(row[name] * factor, 5)));
  let order = [...rows], page = 0;
  function turn(to) {
    const last = Math.max(0, Math.ceil(order.length / PAGE) - 1);
    page = Math.max(0, Math.min(last, to));
    body.innerHTML = order.slice(page * PAGE, (page + 1) * PAGE).map((row) => {
      const cells = shown.map((column, k) => (k ? `<td>${esc(text(row, column))}</td>` : `<th scope="row"><button type="button">${esc(text(row, column))}</button></th>`));
      return `<tr data-index="${row.index}">${cells.join("")}<td class="text">${esc(row.status)}</td></tr>`;
    }).join("");
    $("page-place").textContent = `${page * PAGE + 1} to ${Math.min(order.length, (page + 1) * PAGE)} of ${order.length}`;
    $("page-before").disabled = page === 0;
    $("page-after").disabled = page === last;
  }
  for (const head of heads) {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => {
      sortBy(heads, head, order, (row) => row);
      turn(0);
    });
  }
  body.addEventListener("click", (event) => {
    const line = event.target.closest("tr");
    if (line) choose(Number(line.dataset.index));
  });
  $("page-before").addEventListener("click", () => turn(page - 1));
  $("page-after").addEventListener("click", () => turn(page + 1));
  turn(0);
}

/** Sorts a list by the column of a heading, and the other way round the second time. */
function sortBy(heads, head, list, rowOf) {
  const column = head.dataset.column;
  const down = head.getAttribute("aria-sort") === "ascending";
  for (const other of heads) other.removeAttribute("aria-sort");
  head.setAttribute("aria-sort", down ? "descending" : "ascending");
  return list.sort((a, b) => {
    const [p, q] = [a, b].map((item) => rowOf(item)[column]);
    // Absent values stay at the end, whichever way the others go.
    if (p === null || q === null) return (p === null) - (q === null);
    const sign = p < q ? -1 : p > q ? 1 : 0;
    return down ? -sign : sign;
  });
}

function startTable(columns, rows, choose) {
  const table = $("cases"), body = table.tBodies[0];
  const byIndex = new Map(rows.map((row) => [String(row.index), row]));
  const shown = () => [...body.rows].map((line) => byIndex.get(line.dataset.index));
  for (const head of table.tHead.rows[0].cells) {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => {
      body.append(...sortBy([...table.tHead.rows[0].cells], head, [...body.rows], (line) => byIndex.get(line.dataset.index)));
    });
  }
  for (const line of body.rows) {
    if (!["converged", "transient"].includes(byIndex.get(line.dataset.index).status)) continue;
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
