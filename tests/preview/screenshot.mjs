// Takes the picture of the page that the README shows: ADDRESS FILE.png FRAME BODY

import { drawn, launch, newPage } from "./browser.mjs";

const [address, file, frame, body] = process.argv.slice(2);
const browser = await launch();
const page = await newPage(browser, { size: { width: 1120, height: 700 } });
await page.goto(address);
await page.waitForFunction(() => window.jabuka.settled);
await page.fill("#body-name", body);
await page.press("#body-name", "Enter");
await page.evaluate((number) => window.jabuka.seek(number), Number(frame));
await drawn(page);
await page.waitForFunction(() => document.querySelector("#body-values td") && document.querySelector("#legend dd")?.textContent.includes("J"));
await page.mouse.move(0, 0);
await page.evaluate(() => document.activeElement.blur());
await page.screenshot({ path: file });
if (page.wrong.length) throw new Error(page.wrong.join("\n"));
await browser.close();
