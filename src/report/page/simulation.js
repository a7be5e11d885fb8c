// The page of one history: its signals over time, profiles and fields at the times asked for.

function start(data) {
  const h = data.history;
  const time = { label: "time t", name: "t", unit: "s" };
  const signal = (id, column, label, unit, colour) =>
    plot($(id), { label: `${label} over time`, height: 230, x: time, y: { label, unit }, series: [{ name: label, x: h.time_s, y: h[column], colour }], none: `${label}: nowhere defined` });
  signal("load", "load_n", "load W", "N", 0);
  signal("approach", "approach_m", "approach δ", "m", 1);
  signal("radius", "contact_radius_m", "contact radius a", "m", 2);
  signal("pressure", "peak_pressure_pa", "peak pressure", "Pa", 3);
  plot($("loop"), { label: "Load against approach over the whole history", byArea: true, x: { label: "approach δ", name: "δ", unit: "m" }, y: { label: "load W", name: "W", unit: "N" }, series: [{ name: "history", x: h.approach_m, y: h.load_n }] });

  const timeText = (record) => `${trimmed(significant(record.time_s, 6))} s`;
  function drawProfiles() {
    const chosen = Number($("profile").value);
    const shown = data.profiles.map((record, k) => ({ record, k })).filter(({ k }) => k === chosen || $("all-profiles").checked);
    const over = (id, column, label, unit) =>
      plot($(id), {
        label: `${label} along ${data.line}`, legend: true, byArea: true, x: { label: data.line === "r" ? "distance from the axis r" : "position x", name: data.line, unit: "m" }, y: { label, unit },
        series: shown.map(({ record, k }) => ({ name: timeText(record), x: record.position_m, y: record[column], colour: k, dash: k === chosen ? 0 : Math.floor(k / 7) + 1, faint: k !== chosen })),
      });
    over("profile-pressure", "pressure_pa", "pressure p", "Pa");
    over("profile-displacement", "displacement_m", "displacement u", "m");
  }
  $("profiles").hidden = !data.profiles.length;
  if (data.profiles.length) {
    $("profile").innerHTML = data.profiles.map((record, k) => `<option value="${k}">${esc(timeText(record))}</option>`).join("");
    for (const id of ["profile", "all-profiles"]) $(id).addEventListener("change", drawProfiles);
    drawProfiles();
  }

  function drawField() {
    const record = data.fields[Number($("field-time").value)], column = $("field").value;
    const unit = column === "pressure_pa" ? "Pa" : "m", name = column === "pressure_pa" ? "pressure" : "displacement";
    // One scale for all times, so that they can be compared.
    const all = data.fields.flatMap((f) => f[column].filter((v) => v !== null));
    const range = all.reduce(([a, b], v) => [Math.min(a, v), Math.max(b, v)], [0, 0]);
    const said = `${timeText(record)}, load ${withUnit(record.load_n, "N")}`;
    $("field-time").setAttribute("aria-valuetext", said);
    $("field-spoken").textContent = said;
    heat($("map"), { ...record, values: record[column] }, { label: `${name} over the surface at ${said}`, name, unit, range });
  }
  $("fields").hidden = !data.fields.length;
  if (data.fields.length) {
    $("field-time").max = String(data.fields.length - 1);
    for (const id of ["field-time", "field"]) $(id).addEventListener("input", drawField);
    drawField();
  }
  $("material").hidden = !data.material;
  if (data.material) drawMaterial(data.material);
}
