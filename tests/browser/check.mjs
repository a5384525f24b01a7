// Opens pages in headless Chromium, offline, and says whether every picture is there and nothing went wrong.
//
//     node tests/browser/check.mjs figures/index.html ...
//
// `chromium.mjs` says what it needs. Exit code 0 if all is well, 1 if not, 2 without a browser.

import { begin, end, inspectPage } from "./chromium.mjs";

/** Runs in the page: what there is to see, and what of it cannot be seen. */
function inspect() {
  const missing = [];
  for (const section of document.querySelectorAll("section")) {
    const broken = section.querySelector("h2 .broken");
    const pictures = [...section.querySelectorAll("svg, img")];
    if (!pictures.length && !broken) missing.push(`${section.id}: no picture`);
    pictures.forEach((picture, index) => {
      const { width, height } = picture.getBoundingClientRect();
      const drawn = picture.tagName === "IMG" ? picture.complete && picture.naturalWidth > 0 : picture.children.length > 4;
      if (width < 200 || height < 100 || !drawn) missing.push(`${section.id}: picture ${index + 1} is empty`);
    });
  }
  const wide = document.documentElement.scrollWidth > document.documentElement.clientWidth;
  if (wide) missing.push("the page is wider than the window");
  const sections = document.querySelectorAll("section").length;
  return { sections, pictures: document.querySelectorAll("section svg, section img").length, missing };
}

/** Opens a page; says what is wrong with it. */
async function check(file) {
  const { found, trouble } = await inspectPage(file, inspect);
  const { sections, pictures, missing } = found ?? { sections: 0, pictures: 0, missing: [] };
  const wrong = [...missing, ...trouble];
  if (!sections || !pictures) wrong.push("there is nothing on the page");
  console.log(`${file}: ${sections} parts, ${pictures} pictures, ${wrong.length} troubles`);
  wrong.forEach((words) => console.log(`  ${words}`));
  return wrong.length === 0;
}

let well = true;
try {
  await begin();
  for (const file of process.argv.slice(2)) well = (await check(file)) && well;
} finally {
  await end();
}
process.exit(well ? 0 : 1);
