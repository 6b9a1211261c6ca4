// Takes the screenshot of the page that the README shows.

import { dirname, join } from "node:path";
import { seek, tests, until } from "./browser.mjs";

tests({
  async the_picture_of_the_readme_is_of_this_page({ open, scene }) {
    const page = await open({ size: { width: 1120, height: 700 } });
    await page.fill("#body-name", "ball");
    await page.press("#body-name", "Enter");
    await seek(page, 44);
    await until(page, () => document.querySelector("#body-values td") && document.querySelector("#legend dd")?.textContent.includes("J"));
    await page.evaluate(() => document.activeElement.blur());
    await page.screenshot({ path: join(dirname(scene), "preview.png") });
  },
});
