// The page of a material alone.

function start(data) {
  drawMaterial(data.material);
  const draw = () =>
    plot($("over-time"), {
      label: `${data.label} over time`, legend: true, byArea: data.curves.length > 1, height: 320,
      x: { label: "time t", name: "t", unit: "s", log: $("log-x").checked }, y: { label: data.label, unit: data.unit, log: $("log-y").checked },
      series: data.curves.map((c, k) => ({ name: c.name, x: c.time_s, y: c.values, line: !c.scatter, marker: c.scatter ? 2.5 : 0, colour: k })),
    });
  for (const id of ["log-x", "log-y"]) $(id).addEventListener("change", draw);
  draw();
}
