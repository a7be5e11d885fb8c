// Begins once the page is there; without this script the static figures and tables stay.

document.documentElement.classList.add("js");
startTheme();
{
  const data = JSON.parse($("data").textContent);
  if (data.kind === "sweep") startSweep(data);
  else if (data.kind === "simulation") startSimulation(data);
  else startMaterial(data);
}
