// The page of the reproduction: numbers chosen by their verdict, and taken along as CSV.

function start(data) {
  const sections = [...document.querySelectorAll("section.reproduced")];
  const rows = [...document.querySelectorAll("tr[data-verdict]")];
  $("verdict").addEventListener("change", () => {
    const wanted = $("verdict").value;
    for (const row of rows) row.hidden = wanted !== "" && row.dataset.verdict !== wanted;
    for (const section of sections) section.hidden = !section.querySelector("tr[data-verdict]:not([hidden])");
    $("copied").textContent = `${rows.filter((row) => !row.hidden).length} of ${rows.length} numbers shown`;
  });
  $("copy").addEventListener("click", async () => {
    $("copied").textContent = (await copy(data.csv)) ? `${rows.length} numbers copied` : "The clipboard is closed to this page: download instead.";
  });
  $("download-csv").addEventListener("click", () => download("claims.csv", data.csv, "text/csv"));
}
