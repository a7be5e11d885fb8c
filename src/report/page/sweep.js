// The page of a sweep: the curve, the chosen cycle, loops side by side, the table.

function start(data) {
  const { quantities, over, varied } = data;
  const [, , , , degrees] = quantities.find(([column]) => column === "phase_lag_rad");
  const named = new Set(varied.filter((v) => v.named).map((v) => v.column));
  const { columns, rows } = parseCsv(data.csv, named);
  const results = new Map(data.cases.map((c) => [c.index, c]));
  /** Of what varies: its number in the unit in which it is told, and that with the unit. */
  const numberOf = ({ column, zero, factor }, row) => factor * (row[column] - zero);
  const told = (of, row) => {
    if (of.named) return row[of.column];
    if (PREFIXED.has(of.unit)) return trimmed(withUnit(numberOf(of, row), of.unit));
    return `${trimmed(significant(numberOf(of, row)))}${of.unit === "°" ? "" : " "}${of.unit}`.trim();
  };
  const place = (row) => numberOf(over, row);
  const placeText = (row) => told(over, row);
  const abscissa = () => ({ label: over.label, name: over.name, unit: over.unit, log: $("log-x").checked });
  const key = (row) => JSON.stringify(varied.map(({ column }) => row[column]));
  const drives = [...new Map(rows.map((row) => [key(row), row])).values()];
  const byKey = new Map(drives.map((row) => [key(row), []]));
  for (const row of rows) byKey.get(key(row)).push(row);
  for (const list of byKey.values()) list.sort((a, b) => place(a) - place(b));
  const driveText = (row) => varied.map((of) => told(of, row)).join(", ");
  const branchNames = Array.from({ length: data.branches }, (_, k) => {
    const time = data.retardation_times_s[k];
    return time === undefined ? `branch ${k + 1}` : `branch of ${withUnit(time, "s")}`;
  });
  const rowName = (row) => placeText(row) + (drives.length > 1 ? `, ${driveText(row)}` : "");
  const has = (row) => row.energy_loss_j !== null;
  const done = rows.filter(has);
  const loss = (row) => row.energy_loss_j;
  const best = done.reduce((a, b) => (a && loss(a) >= loss(b) ? a : b), null);
  const state = { chosen: best, drive: key(best || rows[0] || {}), kept: new Set(spread(done, best)) };
  const ofDrive = () => (byKey.get(state.drive) || []).filter(has);

  /** At most five, ends and largest loss among them. */
  function spread(all, largest) {
    const some = all.filter((row) => results.has(row.index) && (!largest || key(row) === key(largest)));
    if (some.length <= 5) return some.map((row) => row.index);
    const at = [0, 1, 2, 3, 4].map((k) => Math.round((k * (some.length - 1)) / 4));
    const place = some.indexOf(largest);
    if (place >= 0 && !at.includes(place)) {
      const near = [1, 2, 3].reduce((a, b) => (Math.abs(at[a] - place) <= Math.abs(at[b] - place) ? a : b));
      at[near] = place;
    }
    return at.map((i) => some[i].index);
  }

  function choose(row) {
    state.chosen = row;
    state.drive = key(row);
    $("drive").value = state.drive;
    fillCases();
    drawCurve();
    drawCycle();
    drawLoops();
  }

  function step(by) {
    const list = ofDrive();
    const at = list.indexOf(state.chosen) + by;
    if (list.length) choose(list[Math.max(0, Math.min(list.length - 1, at))]);
  }

  // ---- the curve
  function drawCurve() {
    const [column, error, name, unit, factor] = quantities[$("quantity").value];
    const times = (v) => (v === null ? null : v * factor);
    const shown = drives.map((drive) => byKey.get(key(drive)));
    const series = shown.map((list, k) => ({
      name: drives.length > 1 ? driveText(list[0]) : name,
      x: list.map(place),
      y: list.map((row) => times(row[column])),
      err: key(list[0]) === state.drive ? list.map((row) => times(row[error])) : undefined,
      marker: key(list[0]) === state.drive ? 3 : 0,
      faint: key(list[0]) !== state.drive,
      colour: k,
    }));
    const at = shown.findIndex((list) => list.includes(state.chosen));
    const isLoss = column === "energy_loss_j";
    plot($("curve"), {
      label: `${name} over ${over.label}`, slider: true, series, height: Math.min(420, Math.max(260, innerHeight * 0.5)),
      x: abscissa(), y: { label: name, unit, log: $("log-y").checked, zero: isLoss },
      marks: isLoss ? data.peaks.map((p) => ({ x: place(p), y: p.energy_loss_j })) : [],
      chosen: state.chosen && at >= 0 ? { series: at, i: shown[at].indexOf(state.chosen) } : null,
      none: "No case has a result: there is nothing to draw.",
      byArea: drives.length > 1,
      onPick: (k, i) => has(shown[k][i]) && choose(shown[k][i]),
    });
    const bars = rows.filter((row) => row[error] !== null && row[column]).map((row) => Math.abs(row[error] / row[column]));
    $("bars").textContent = bars.length
      ? `Error bars are drawn on every point: estimated errors are ${trimmed(significant(100 * Math.min(...bars), 2))} % to ${trimmed(significant(100 * Math.max(...bars), 2))} % of the value.`
      : "There are no error bars: none were asked for, or none could be estimated.";
    const host = $("curve"), list = ofDrive();
    if (!state.chosen) return;
    host.setAttribute("aria-valuemax", String(Math.max(0, list.length - 1)));
    host.setAttribute("aria-valuenow", String(list.indexOf(state.chosen)));
    host.setAttribute("aria-valuetext", `${placeText(state.chosen)}: ${name} ${withUnit(times(state.chosen[column]), unit)}`);
  }

  function fillCases() {
    const some = byKey.get(state.drive) || [];
    $("case").innerHTML = some.map((row) => {
      const why = has(row) ? withUnit(loss(row), "J") : `no result: ${row.message || row.status}`;
      return `<option value="${row.index}"${has(row) ? "" : " disabled"}${row === state.chosen ? " selected" : ""}>${esc(`${placeText(row)} (${why})`)}</option>`;
    }).join("");
    for (const line of document.querySelectorAll("#cases tbody tr")) {
      const isChosen = state.chosen && Number(line.dataset.index) === state.chosen.index;
      line.classList.toggle("chosen", Boolean(isChosen));
      if (isChosen) line.setAttribute("aria-current", "true");
      else line.removeAttribute("aria-current");
    }
  }

  // ---- the chosen cycle
  function drawCycle() {
    const row = state.chosen;
    if (!row) return;
    const cycle = results.get(row.index);
    $("keep").disabled = !cycle;
    $("spoken").textContent = `${rowName(row)}: energy loss ${withUnit(loss(row), "J")}, phase lag ${withUnit(row.phase_lag_rad * degrees, "°")}`;
    if (!cycle) {
      drawNoCycle(row);
      return;
    }
    const period = cycle.time_s[cycle.time_s.length - 1];
    const part = cycle.time_s.map((t) => t / period);
    const ofPeriod = { label: "time / period", name: "t/T" };
    plot($("loop"), {
      label: `Load against approach at ${rowName(row)}`, byArea: true,
      x: { label: "approach δ", name: "δ", unit: "m" }, y: { label: "load W", name: "W", unit: "N" },
      series: [{ name: "loop", x: cycle.approach_m, y: cycle.load_n }],
    });
    const signal = (values) => {
      const low = Math.min(...values), high = Math.max(...values);
      return values.map((v) => (high > low ? (2 * (v - low)) / (high - low) - 1 : 0));
    };
    plot($("phase"), {
      label: `Load and approach over the cycle, each between its extremes; the approach lags by ${withUnit(row.phase_lag_rad * degrees, "°")}`,
      x: ofPeriod, y: { label: "between extremes", name: "value" },
      series: [{ name: "load", x: part, y: signal(cycle.load_n) }, { name: "approach", x: part, y: signal(cycle.approach_m), dash: 1 }],
    });
    plot($("radius"), { label: "Contact radius over the cycle", x: ofPeriod, y: { label: "contact radius a", name: "a", unit: "m" }, series: [{ name: "contact radius", x: part, y: cycle.contact_radius_m, colour: 2 }] });
    plot($("pressure"), {
      label: "Peak pressure over the cycle", x: ofPeriod, y: { label: "peak pressure", name: "p", unit: "Pa" },
      series: [{ name: "peak pressure", x: part, y: cycle.peak_pressure_pa, colour: 3 }], none: "not told: unbounded under an apex or a sharp edge, and not computed of surfaces that attract",
    });
    const relative = (k) => cycle.harmonics.map((h) => (cycle.harmonics[0][k] > 0 ? h[k] / cycle.harmonics[0][k] : null)).slice(1);
    const orders = cycle.harmonics.map((_, n) => n + 1).slice(1);
    plot($("harmonics"), {
      label: "Amplitudes of harmonics 2 to 5 relative to the first", byArea: true, legend: true,
      x: { label: "harmonic", name: "n" }, y: { label: "relative amplitude", name: "amplitude", zero: true },
      series: [
        { name: "approach", x: orders.map((n) => n - 0.07), y: relative(1), stem: true, marker: 4 },
        { name: "load", x: orders.map((n) => n + 0.07), y: relative(0), stem: true, marker: 4 },
      ],
    });
    drawSurface(cycle, period);
    drawFacts(row);
  }

  /** Of a large sweep the page has the cycles of some cases alone. */
  function drawNoCycle(row) {
    const none = `this page has the cycles of ${results.size} of its cases, and this is none of them`;
    for (const id of ["loop", "phase", "radius", "pressure", "harmonics", "profile", "work"]) plot($(id), { label: none, x: {}, y: {}, series: [], none });
    $("profile-y-part").hidden = true;
    $("map-part").hidden = true;
    $("lines-how").textContent = "";
    drawFacts(row);
  }

  /** The pressure along a line at all instants, each over its own places or all over the same. */
  function drawPressure(id, line, instants, period) {
    const at = { r: "distance from the axis r", x: "position x", y: "position y" }[line.along];
    const name = ({ name, load_n, time_s, contact_radius_m }) =>
      `${name}${data.drive_unit === "N" ? "" : ", W"} = ${withUnit(load_n, "N")}, t/T = ${trimmed(significant(time_s / period, 3))}${contact_radius_m > 0 ? "" : ": no contact"}`;
    const places = (k) => line.position_m[k] || line.position_m[0];
    const peak = (k) => withUnit(Math.max(0, ...line.pressure_pa[k]), "Pa");
    plot($(id), {
      label: `Contact pressure over the ${at}; ${instants.map((instant, k) => `${name(instant)}: up to ${peak(k)}`).join("; ")}`,
      legend: true, byArea: true, none: "no contact along this line",
      x: { label: at, name: line.along, unit: "m" }, y: { label: "pressure p", name: "p", unit: "Pa", zero: true },
      series: instants.map((instant, k) => ({ name: name(instant), x: places(k), y: line.pressure_pa[k], dash: k === 3 ? 1 : 0 })),
    });
  }

  function drawSurface({ pressure, work }, period) {
    const across = pressure.lines.find((line) => line.along === "y");
    const line = pressure.lines.find((line) => line !== across);
    if (line) drawPressure("profile", line, pressure.instants, period);
    else plot($("profile"), { label: "Contact pressure", x: {}, y: {}, series: [], none: "no pressure was computed" });
    $("profile-y-part").hidden = !across;
    if (across) drawPressure("profile-y", across, pressure.instants, period);
    const along = work.along === "r" ? "distance from the axis r" : "position x";
    plot($("work"), {
      label: `Work of the indenter on the surface per area and cycle, ${work.line}`,
      x: { label: along, name: work.along, unit: "m" }, y: { label: "work density", unit: "J/m²", zero: true },
      series: [{ name: "work density", x: work.position_m, y: work.density_j_per_m2, colour: 1 }], none: "no work was done, or none computed",
    });
    const through = line && line.along === "x" ? ", on the cells along the axes through the centre" : "";
    $("lines-how").textContent = `Pressure: at the time steps nearest to the quarters of the oscillation${through}. Work density: ${work.line}.`;
    $("map-part").hidden = !work.map;
    if (work.map) heat($("surface"), work.map, { label: "Work of the indenter on the surface per area and cycle", name: "work density", unit: "J/m²" });
  }

  function drawFacts(row) {
    const line = (name, value, error) => `<tr><th scope="row">${esc(name)}</th><td>${esc(value)}</td><td>${esc(error || "")}</td></tr>`;
    const lines = quantities.map(([value, error, name, unit, factor]) =>
      row[value] === null ? line(name, "undefined") : line(name, ...measured(row[value] * factor, row[error] * factor, unit)));
    branchNames.forEach((name, k) => {
      const part = row[`branch_${k + 1}_loss_j`];
      lines.push(line(`dissipated by the ${name}`, `${withUnit(part, "J", 6)} (${significant((100 * part) / row.dissipated_j, 3)} %)`));
    });
    const plain = [["error of the energy balance (dissipated by branches / area of loop − 1)", "energy_imbalance"], ["distance to the stabilised cycle", "steady_distance"]];
    const ratio = (v) => (v === null ? "undefined" : Math.abs(v) < Number.EPSILON ? "less than rounding" : significant(v, 3));
    for (const [name, column] of plain) lines.push(line(name, ratio(row[column])));
    lines.push(line("method", `${row.method}, ${row.cycles} cycles, ${row.steps} steps per cycle, ${row.nodes} ${data.node_name}`));
    if (row.warnings) lines.push(line("warnings", row.warnings));
    if (row.message) lines.push(line("message", row.message));
    document.querySelector("#facts tbody").innerHTML = lines.join("");
  }

  // ---- loops side by side
  function drawLoops() {
    const shown = done.filter((row) => results.has(row.index) && (state.kept.has(row.index) || row === state.chosen));
    const normalised = $("normalised").checked;
    const middle = (values) => (Math.max(...values) + Math.min(...values)) / 2;
    const half = (values) => (Math.max(...values) - Math.min(...values)) / 2;
    const cycles = shown.map((row) => results.get(row.index));
    const largest = (signal) => Math.max(...cycles.map((c) => half(c[signal])), 1e-300);
    const series = shown.map((row, k) => {
      const cycle = cycles[k];
      const of = (signal) => (normalised ? cycle[signal].map((v) => (v - middle(cycle[signal])) / largest(signal)) : cycle[signal]);
      return { name: rowName(row) + (row === state.chosen ? " (chosen)" : ""), x: of("approach_m"), y: of("load_n") };
    });
    plot($("loops"), {
      label: "Hysteresis loops overlaid: load against approach", byArea: true, legend: true, series, height: Math.min(420, Math.max(260, innerHeight * 0.5)),
      x: { label: normalised ? "approach, centred and scaled" : "approach δ", name: "δ", unit: normalised ? "" : "m" },
      y: { label: normalised ? "load, centred and scaled" : "load W", name: "W", unit: normalised ? "" : "N" },
      none: "No loop is kept.",
    });
    $("kept").innerHTML = done.filter((row) => state.kept.has(row.index)).map((row) => `<li><button type="button" data-index="${row.index}">${esc(rowName(row))} <span aria-hidden="true">×</span><span class="sr"> remove</span></button></li>`).join("");
    $("kept").hidden = !state.kept.size;
  }

  function drawBranches() {
    const list = byKey.get(state.drive) || [];
    const count = data.branches;
    $("branches-section").hidden = !count || !done.length;
    if (!count) return;
    const x = list.map(place);
    plot($("branches"), {
      label: `Energy dissipated per cycle by each branch over ${over.label}`, legend: true,
      x: abscissa(), y: { label: "dissipated per cycle", unit: "J", zero: true, log: $("log-y").checked },
      series: [
        ...branchNames.map((name, k) => ({ name, x, y: list.map((row) => row[`branch_${k + 1}_loss_j`]), marker: 2 })),
        ...(count > 1 ? [{ name: "all", x, y: list.map((row) => row.dissipated_j), colour: 6, dash: 1 }] : []),
      ],
    });
  }

  // ---- controls
  $("quantity").innerHTML = quantities.map(([column, , name], k) => (done.some((row) => row[column] !== null) || !k ? `<option value="${k}">${esc(name)}</option>` : "")).join("");
  $("drive").innerHTML = drives.map((row) => `<option value="${esc(key(row))}"${key(row) === state.drive ? " selected" : ""}>${esc(driveText(row))}</option>`).join("");
  $("drive-choice").hidden = drives.length < 2;
  for (const id of ["quantity", "log-x", "log-y"]) $(id).addEventListener("change", () => { drawCurve(); drawBranches(); });
  $("normalised").addEventListener("change", drawLoops);
  $("drive").addEventListener("change", () => {
    state.drive = $("drive").value;
    const from = state.chosen ? place(state.chosen) : 0;
    const away = (row) => Math.abs($("log-x").checked ? Math.log(place(row) / from) : place(row) - from);
    const list = ofDrive();
    if (list.length) choose(list.reduce((a, b) => (away(a) <= away(b) ? a : b)));
    else { fillCases(); drawCurve(); }
    drawBranches();
  });
  $("case").addEventListener("change", () => choose(rows.find((row) => row.index === Number($("case").value))));
  $("previous").addEventListener("click", () => step(-1));
  $("next").addEventListener("click", () => step(1));
  $("keep").addEventListener("click", () => { if (state.chosen) { state.kept.add(state.chosen.index); drawLoops(); } });
  $("clear").addEventListener("click", () => { state.kept.clear(); drawLoops(); });
  $("kept").addEventListener("click", (event) => {
    const button = event.target.closest("button");
    if (!button) return;
    state.kept.delete(Number(button.dataset.index));
    drawLoops();
  });
  const curve = $("curve");
  if (done.length) {
    curve.tabIndex = 0;
    curve.setAttribute("role", "slider");
    curve.setAttribute("aria-label", over.label);
    curve.setAttribute("aria-valuemin", "0");
    const moves = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -5, PageUp: 5, Home: -1e9, End: 1e9 };
    curve.addEventListener("keydown", (event) => {
      if (!(event.key in moves) || event.ctrlKey || event.altKey || event.metaKey) return;
      event.preventDefault();
      step(moves[event.key]);
    });
  } else {
    $("cycle").hidden = true;
  }
  const byIndex = new Map(rows.map((row) => [row.index, row]));
  const pick = (index) => has(byIndex.get(index)) && choose(byIndex.get(index));
  if (data.table.length) startPages(data.table, rows, pick);
  else startTable(columns, rows, pick);
  fillCases();
  drawCurve();
  drawCycle();
  drawLoops();
  drawBranches();
  drawMaterial(data.material);
}
