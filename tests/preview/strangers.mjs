// Tests of attacks by other web pages, and by HTML in a scene's texts.

import assert from "node:assert/strict";
import { createServer } from "node:http";
import { newPage, seek, tests, until } from "./browser.mjs";

/** Runs in a page of another origin: tries to read from the server in many ways, and returns what it received. */
const TRY = async (address) => {
  const { origin, searchParams } = new URL(address);
  const token = searchParams.get("token");
  const of = (path) => `${origin}${path}${path.includes("?") ? "&" : "?"}token=${token}`;
  const got = [];
  const orders = { method: "POST", body: JSON.stringify({ integrator: "rk4", step: "" }) };
  for (const path of ["/", "/main.js", "/api/events", "/api/runs/1", "/api/runs/1/poses", "/api/variants"]) {
    for (const [how, options] of [["fetch", {}], ["post", orders], ["json", { ...orders, headers: { "Content-Type": "application/json" } }]]) {
      const answer = await fetch(of(path), options).then((response) => response.text()).catch(() => null);
      if (answer !== null) got.push(`${how} ${path}: ${answer}`);
    }
    const element = (tag) => new Promise((done) => {
      const made = document.createElement(tag);
      made.onload = () => done(true);
      made.onerror = () => done(false);
      made.src = of(path);
      document.body.append(made);
    });
    if (path !== "/api/events") for (const tag of ["img", "script"]) if (await element(tag)) got.push(`${tag} ${path}`);
  }
  const event = await new Promise((done) => {
    const events = new EventSource(of("/api/events"));
    events.onmessage = (event) => done(event.data);
    events.onerror = () => done(null);
  });
  if (event !== null) got.push(`events: ${event}`);
  const frame = document.createElement("iframe");
  frame.src = address;
  document.body.append(frame);
  await new Promise((done) => (frame.onload = done));
  let inside = null;
  try { inside = frame.contentDocument?.body.innerHTML ?? null; } catch { /* As it should be. */ }
  if (inside) got.push(`iframe: ${inside}`);
  return got;
};

await tests({
  async a_page_of_another_origin_gets_nothing_even_with_the_token({ browser, address, open }) {
    const own = await open();
    const foreign = createServer((_, answer) => answer.setHeader("Content-Type", "text/html").end("<!doctype html><body>"));
    await new Promise((done) => foreign.listen(0, "127.0.0.1", done));
    try {
      const page = await newPage(browser);
      // Cookies treat these two ports as the same host, but they are different origins; the second name is also another site.
      for (const host of ["127.0.0.1", "localhost"]) {
        await page.goto(`http://${host}:${foreign.address().port}/`);
        assert.deepEqual(await page.evaluate(TRY, address), [], host);
      }
      // The server's own page can read this path, which shows that the attack tried a valid one.
      const there = await own.evaluate(async () => (await fetch(`/api/runs/1${location.search}`)).status);
      assert.equal(there, 200);
      assert.equal(await own.evaluate(() => window.jabuka.integrator), "euler-cromer", "nothing has been ordered");
    } finally {
      foreign.closeAllConnections();
      foreign.close();
    }
  },

  async a_name_that_is_let_point_here_gets_nothing({ address, another }) {
    // By DNS rebinding, a page at evil.example has the same origin as the server that its name now points to.
    const page = await newPage(await another({ host: "evil.example" }));
    const there = address.replace("127.0.0.1", "evil.example");
    const answer = await page.goto(there);
    assert.equal(answer.status(), 403);
    const got = await page.evaluate(async () => (await fetch(`/api/runs/1${location.search}`)).status);
    assert.equal(got, 403);
  },

  async a_page_without_the_token_says_what_to_open({ address, browser, keep }) {
    const page = keep(await newPage(browser));
    await page.goto(new URL("/", address).href);
    await page.locator("#nothing").filter({ hasText: "Open the whole address" }).waitFor();
    assert.ok(page.asked.every((request) => !request.url().includes("/api/")));
  },

  async names_titles_and_labels_are_shown_as_text({ open }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.settled);
    const name = "<script>alert(1)</script>";
    assert.equal(await page.locator("#title").innerText(), "<img src=x onerror=alert(2)>");
    assert.equal(await page.title(), "<img src=x onerror=alert(2)> – jabuka");
    assert.deepEqual(await page.evaluate(() => window.jabuka.bodies), [name]);
    await page.keyboard.press("n");
    assert.equal(await page.locator("#body-name").inputValue(), name);
    await page.locator("#other-integrator").selectOption("explicit-euler");
    await seek(page, 20);
    await until(page, (jabuka, name) => jabuka.comparison.includes(name), name);
    await page.locator("#texts span").filter({ hasText: "<b>bold</b>" }).first().waitFor();
    const more = await page.evaluate(() => [...document.querySelectorAll("script, b, #title *, #texts *:not(span), iframe, img")].map((e) => e.outerHTML));
    assert.deepEqual(more.filter((html) => !/^<script type="module" src="main.js">|^<img id="rendered"/.test(html)), []);
  },

  async a_mistake_with_html_in_it_is_shown_as_text({ address, browser, keep }) {
    const page = keep(await newPage(browser));
    await page.goto(address);
    await until(page, (jabuka) => jabuka.problem?.includes("<img src=x onerror=alert(3)>"));
    assert.equal(await page.locator("#problem *").count(), 0);
  },
});
