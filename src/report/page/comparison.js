// The page of a comparison: any column of both results, and their difference.

function start(data) {
  const places = data.angular_frequency_rad_per_s.map((omega, i) => ({ omega, drive: data.drives[i] }));
  const drives = [...new Set(data.drives)];
  const UNITS = [["_j", "J"], ["_pa", "Pa"], ["_m", "m"], ["_n", "N"]];
  const known = new Map(QUANTITIES.map(([column, , name, unit, factor]) => [column, { name, unit, factor }]));
  const about = (column) => known.get(column) || { name: column.replace(/_/g, " "), unit: (UNITS.find(([end]) => column.endsWith(end)) || ["", ""])[1], factor: 1 };

  function draw() {
    const column = data.columns[Number($("quantity").value)];
    const { name, unit, factor } = about(column.name);
    const here = places.map((place, i) => ({ ...place, i })).filter(({ drive }) => drive === ($("drive").value || drives[0]));
    const x = here.map(({ omega }) => omega);
    const times = (values) => here.map(({ i }) => (values[i] === null ? null : values[i] * factor));
    const old = times(column.baseline), now = times(column.new), bars = times(column.error);
    const omega = { label: "angular frequency ω", name: "ω", unit: "rad/s", log: $("log-x").checked };
    const isLoss = column.name === "energy_loss_j";
    // A case that one of them lacks does not break its curve.
    const drawn = (name, values, dash) => {
      const there = x.map((_, k) => k).filter((k) => values[k] !== null);
      return { name, x: there.map((k) => x[k]), y: there.map((k) => values[k]), marker: 3, dash };
    };
    plot($("curve"), {
      label: `${name} of both results over angular frequency`, legend: true, height: 320,
      x: omega, y: { label: name, unit, log: $("log-y").checked, zero: isLoss },
      series: [drawn("baseline", old, 0), drawn("new", now, 1)],
      none: "Neither result has a value.",
    });
    // Harmonics are relative already: a share of a small one is a share of nothing.
    const isHarmonic = column.name.startsWith("harmonic_");
    const share = (k, value) => (isHarmonic ? value : old[k] ? (100 * value) / Math.abs(old[k]) : null);
    const difference = x.map((_, k) => (old[k] === null || now[k] === null ? null : share(k, now[k] - old[k])));
    const bar = (sign) => x.map((_, k) => (bars[k] === null ? null : share(k, sign * bars[k])));
    const band = bars.some((b) => b !== null) ? [{ name: "error bars of both", x, y: bar(1), colour: 6, dash: 2, faint: true }, { name: "", x, y: bar(-1), colour: 6, dash: 2, faint: true }] : [];
    plot($("difference"), {
      label: `${name}: new result less baseline over angular frequency`, legend: true, height: 250,
      x: omega, y: { label: isHarmonic ? "new − baseline" : "new − baseline / %", name: "difference", zero: true },
      series: [{ ...drawn("new − baseline", difference, 0), colour: 2 }, ...band],
      none: "No case has a value in both results.",
    });
    const seen = difference.filter((v) => v !== null).map(Math.abs);
    const said = (v) => `${significant(v, 3)}${isHarmonic ? "" : " %"}`;
    $("bars").textContent = seen.length ? `Largest difference: ${said(Math.max(...seen))}.${band.length ? " Dotted: the sum of both error bars." : ""}` : "";
  }

  $("quantity").innerHTML = data.columns.map(({ name }, k) => `<option value="${k}">${esc(about(name).name)}</option>`).join("");
  $("drive").innerHTML = drives.map((drive) => `<option>${esc(drive)}</option>`).join("");
  $("drive-choice").hidden = drives.length < 2;
  for (const id of ["quantity", "drive", "log-x", "log-y"]) $(id).addEventListener("change", draw);
  $("copy").addEventListener("click", async () => {
    $("copied").textContent = (await copy(data.csv)) ? "copied" : "The clipboard is closed to this page: download instead.";
  });
  $("download-csv").addEventListener("click", () => download("comparison.csv", data.csv, "text/csv"));
  draw();
}
