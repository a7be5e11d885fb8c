// Begins once the page is there; without this script the static figures and tables stay.

document.documentElement.classList.add("js");
startTheme();
// Figures that a reader without it sees in the text stand with the others.
for (const still of document.querySelectorAll("figure[data-figure]")) {
  const place = $(`figure-${still.dataset.figure}`);
  if (place) place.prepend(...still.childNodes);
}
start(JSON.parse($("data").textContent));
