// Begins once the page is there; without this script the static figures and tables stay.

document.documentElement.classList.add("js");
startTheme();
start(JSON.parse($("data").textContent));
