// Opens every page of the site in headless Chromium, offline: no error of a script, every picture loaded, and the search finds a word.
//
//     node tests/site/open_pages.mjs target/book
//
// `tests/browser/chromium.mjs` says what it needs. Exit code 0 if all is well, 1 if not, 2 without a browser.

import { readdirSync } from "node:fs";
import { join } from "node:path";
import { begin, end, inspectPage } from "../browser/chromium.mjs";

/** Runs in the page: which pictures are missing, and whether there is text. */
async function inspect() {
  // Pages that mdBook did not make, such as the benchmark, need no <main>.
  const main = document.querySelector("main") ?? document.body;
  const pictures = [...main.querySelectorAll("img")];
  for (const picture of pictures) await picture.decode().catch(() => {});
  const missing = pictures.filter((picture) => !picture.complete || picture.naturalWidth === 0);
  const words = main.innerText.split(/\s+/).filter(Boolean).length;
  const wide = document.documentElement.scrollWidth > document.documentElement.clientWidth;
  return { pictures: pictures.length, missing: missing.map((picture) => picture.src), words, wide };
}

/** Runs in the page: types a word into the search and returns where its results lead. */
async function search(word) {
  const find = (name) => document.getElementById(`mdbook-${name}`) ?? document.getElementById(name);
  find("search-toggle").click();
  const bar = find("searchbar");
  const results = find("searchresults");
  for (let tries = 0; tries < 50; tries++) {
    bar.value = word;
    for (const event of ["input", "keyup"]) bar.dispatchEvent(new KeyboardEvent(event, { bubbles: true }));
    await new Promise((resolve) => setTimeout(resolve, 100));
    const links = [...results.querySelectorAll("a")].map((link) => link.getAttribute("href"));
    if (links.length) return links;
  }
  return [];
}

const site = process.argv[2];
// 404.html finds its files only where a server sends it; toc.html is the side bar, shown within the others.
const apart = ["404.html", "toc.html"];
const pages = readdirSync(site, { recursive: true }).filter((name) => name.endsWith(".html") && !apart.includes(name));
let faults = 0;
function report(page, wrong) {
  faults += wrong.length;
  wrong.forEach((words) => console.log(`${page}: ${words}`));
}

try {
  await begin();
  for (const page of pages) {
    const { found, trouble } = await inspectPage(join(site, page), inspect);
    const missing = (found?.missing ?? []).map((source) => `not loaded: ${source}`);
    const wide = found?.wide ? ["wider than the window"] : [];
    report(page, [...trouble, ...missing, ...wide, ...(found?.words > 5 ? [] : ["no text"])]);
  }
  const { found, trouble } = await inspectPage(join(site, "index.html"), search, "persuasion");
  report("search", [...trouble, ...(found?.some((link) => link.includes("planners.html")) ? [] : ["`persuasion` does not lead to planners"])]);
  console.log(`${pages.length} pages opened, ${found?.length ?? 0} results of a search: ${faults || "no"} faults`);
} finally {
  await end();
}
process.exit(faults ? 1 : 0);
