// The page of a comparison: any column of both results, and their difference.

function start(data) {
  const places = data.frequencies.map((x, i) => ({ x, drive: data.drives[i] }));
  const drives = [...new Set(data.drives)];

  function draw() {
    const column = data.columns[Number($("quantity").value)];
    const { heading: name, unit, factor, is_relative: isRelative } = column;
    const here = places.map((place, i) => ({ ...place, i })).filter(({ drive }) => drive === ($("drive").value || drives[0]));
    const x = here.map((place) => place.x);
    const times = (values) => here.map(({ i }) => (values[i] === null ? null : values[i] * factor));
    const old = times(column.baseline), now = times(column.new), bars = times(column.error);
    const over = { ...data.frequency, log: $("log-x").checked };
    const isLoss = column.name === "energy_loss_j";
    // A case that one of them lacks does not break its curve.
    const drawn = (name, values, dash) => {
      const there = x.map((_, k) => k).filter((k) => values[k] !== null);
      return { name, x: there.map((k) => x[k]), y: there.map((k) => values[k]), marker: 3, dash };
    };
    plot($("curve"), {
      label: `${name} of both results over ${data.frequency.quantity}`, legend: true, height: 320,
      x: over, y: { label: name, unit, log: $("log-y").checked, zero: isLoss },
      series: [drawn("baseline", old, 0), drawn("new", now, 1)],
      none: "Neither result has a value.",
    });
    const share = (k, value) => (isRelative ? value : old[k] ? (100 * value) / Math.abs(old[k]) : null);
    const difference = x.map((_, k) => (old[k] === null || now[k] === null ? null : share(k, now[k] - old[k])));
    const bar = (sign) => x.map((_, k) => (bars[k] === null ? null : share(k, sign * bars[k])));
    const band = bars.some((b) => b !== null) ? [{ name: "error bars of both", x, y: bar(1), colour: 6, dash: 2, faint: true }, { name: "", x, y: bar(-1), colour: 6, dash: 2, faint: true }] : [];
    plot($("difference"), {
      label: `${name}: new result less baseline over ${data.frequency.quantity}`, legend: true, height: 250,
      x: over, y: { label: isRelative ? "new − baseline" : "new − baseline / %", name: "difference", zero: true },
      series: [{ ...drawn("new − baseline", difference, 0), colour: 2 }, ...band],
      none: "No case has a value in both results.",
    });
    const seen = difference.filter((v) => v !== null).map(Math.abs);
    const said = (v) => `${significant(v, 3)}${isRelative ? "" : " %"}`;
    $("bars").textContent = seen.length ? `Largest difference: ${said(Math.max(...seen))}.${band.length ? " Dotted: the sum of both error bars." : ""}` : "";
  }

  $("quantity").innerHTML = data.columns.map(({ heading }, k) => `<option value="${k}">${esc(heading)}</option>`).join("");
  $("drive").innerHTML = drives.map((drive) => `<option>${esc(drive)}</option>`).join("");
  $("drive-choice").hidden = drives.length < 2;
  for (const id of ["quantity", "drive", "log-x", "log-y"]) $(id).addEventListener("change", draw);
  $("copy").addEventListener("click", async () => {
    $("copied").textContent = (await copy(data.csv)) ? "copied" : "The clipboard is closed to this page: download instead.";
  });
  $("download-csv").addEventListener("click", () => download("comparison.csv", data.csv, "text/csv"));
  draw();
}
